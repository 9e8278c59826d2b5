// glsl/12-whitted.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

struct ToyproofFrame {
    float3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    int _pad5_0;
    float4 iChannelTime[4];
    float3 iChannelResolution[4];
    int _pad7_0;
    float4 iMouse;
    float4 iDate;
    float iSampleRate;
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

struct Ray {
    float3 origin;
    int _pad1_0;
    float3 direction;
    int _end_pad_0;
};

struct Sphere {
    float3 center_;
    float radius;
    int model;
    int _pad3_0;
    int _pad3_1;
    int _pad3_2;
    float3 color;
    int _end_pad_0;
};

struct Intersection {
    float t;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float3 point_;
    int _pad2_0;
    float3 normal;
    int model;
    float3 color;
    int _end_pad_0;
};

struct Branch {
    Ray ray;
    float3 throughput;
    int depth;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const float EPSILON = 0.001;
static const int SPHERES = int(4);
static const int MAX_DEPTH = int(6);
static const float3 AMBIENT = (0.15).xxx;
static const float3 LIGHT = float3(-4.0, 7.0, 1.0);
static const int MATTE = int(0);
static const int MIRROR = int(1);
static const int GLASS = int(2);
static const float IOR = 1.5;

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

Sphere ConstructSphere(float3 arg0, float arg1, int arg2, float3 arg3) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.model = arg2;
    ret.color = arg3;
    return ret;
}

void makeScene()
{
    spheres[int(0)] = ConstructSphere(float3(-0.5, 0.0, -4.5), 0.9, int(2), float3(0.95, 1.0, 0.95));
    spheres[int(1)] = ConstructSphere(float3(1.3, 0.1, -6.5), 1.1, int(1), float3(0.9, 0.9, 0.9));
    spheres[int(2)] = ConstructSphere(float3(-2.4, -0.4, -7.0), 0.6, int(0), float3(0.9, 0.3, 0.2));
    spheres[int(3)] = ConstructSphere(float3(1.1, -0.7, -4.0), 0.3, int(0), float3(0.2, 0.4, 0.9));
    return;
}

float3 sky(float3 direction)
{
    float3 direction_1 = (float3)0;
    float up = (float)0;

    direction_1 = direction;
    float3 _e4 = direction_1;
    up = (0.5 * (1.0 + _e4.y));
    float _e10 = up;
    float _e17 = up;
    return (((1.0 - _e10) * float3(0.9, 0.9, 0.95)) + (_e17 * float3(0.3, 0.5, 0.9)));
}

float intersectSphere(Ray ray, Sphere sphere)
{
    Ray ray_1 = (Ray)0;
    Sphere sphere_1 = (Sphere)0;
    float3 f = (float3)0;
    float b = (float)0;
    float c = (float)0;
    float disc = (float)0;
    float root = (float)0;
    float t = (float)0;

    ray_1 = ray;
    sphere_1 = sphere;
    Ray _e6 = ray_1;
    Sphere _e8 = sphere_1;
    f = (_e6.origin - _e8.center_);
    float3 _e12 = f;
    Ray _e13 = ray_1;
    b = dot(_e12, _e13.direction);
    float3 _e17 = f;
    float3 _e18 = f;
    Sphere _e20 = sphere_1;
    Sphere _e22 = sphere_1;
    c = (dot(_e17, _e18) - (_e20.radius * _e22.radius));
    float _e27 = b;
    float _e28 = b;
    float _e30 = c;
    disc = ((_e27 * _e28) - _e30);
    float _e33 = disc;
    if ((_e33 > 0.0)) {
        {
            float _e36 = disc;
            root = sqrt(_e36);
            float _e39 = b;
            float _e41 = root;
            t = (-(_e39) - _e41);
            float _e44 = t;
            if ((_e44 > EPSILON)) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b;
            float _e49 = root;
            t = (-(_e47) + _e49);
            float _e51 = t;
            if ((_e51 > EPSILON)) {
                {
                    float _e53 = t;
                    return _e53;
                }
            }
        }
    }
    return NO_HIT;
}

float3 checker(float3 point_)
{
    float3 point_1 = (float3)0;
    float square = (float)0;
    float3 local = (float3)0;

    point_1 = point_;
    float3 _e2 = point_1;
    float3 _e5 = point_1;
    square = (floor(_e2.x) + floor(_e5.z));
    float _e10 = square;
    if (((_e10 - (floor((_e10 / 2.0)) * 2.0)) == 0.0)) {
        local = float3(0.9, 0.8, 0.3);
    } else {
        local = float3(0.6, 0.15, 0.1);
    }
    float3 _e27 = local;
    return _e27;
}

Intersection ConstructIntersection(float arg0, float3 arg1, float3 arg2, int arg3, float3 arg4) {
    Intersection ret = (Intersection)0;
    ret.t = arg0;
    ret.point_ = arg1;
    ret.normal = arg2;
    ret.model = arg3;
    ret.color = arg4;
    return ret;
}

Intersection nearestHit(Ray ray_2)
{
    Ray ray_3 = (Ray)0;
    Intersection hit = ConstructIntersection(1000000.0, (0.0).xxx, (0.0).xxx, int(0), (0.0).xxx);
    int i = int(0);
    float t_1 = (float)0;
    float3 point_2 = (float3)0;
    float3 normal = (float3)0;
    float t_2 = (float)0;
    float3 point_3 = (float3)0;

    ray_3 = ray_2;
    while(true) {
        int _e18 = i;
        if (!((_e18 < SPHERES))) {
            break;
        }
        {
            Ray _e21 = ray_3;
            int _e22 = i;
            Sphere _e24 = spheres[min(uint(_e22), 3u)];
            const float _e25 = intersectSphere(_e21, _e24);
            t_1 = _e25;
            float _e27 = t_1;
            Intersection _e28 = hit;
            if ((_e27 < _e28.t)) {
                {
                    Ray _e31 = ray_3;
                    float _e33 = t_1;
                    Ray _e34 = ray_3;
                    point_2 = (_e31.origin + (_e33 * _e34.direction));
                    float3 _e39 = point_2;
                    int _e40 = i;
                    Sphere _e42 = spheres[min(uint(_e40), 3u)];
                    normal = normalize((_e39 - _e42.center_));
                    float _e47 = t_1;
                    float3 _e48 = point_2;
                    float3 _e49 = normal;
                    int _e50 = i;
                    Sphere _e52 = spheres[min(uint(_e50), 3u)];
                    int _e54 = i;
                    Sphere _e56 = spheres[min(uint(_e54), 3u)];
                    hit = ConstructIntersection(_e47, _e48, _e49, _e52.model, _e56.color);
                }
            }
            int _e59 = i;
            i = asint(asuint(_e59) + asuint(int(1)));
        }
    }
    Ray _e63 = ray_3;
    Ray _e67 = ray_3;
    t_2 = ((-1.02 - _e63.origin.y) / _e67.direction.y);
    float _e72 = t_2;
    float _e74 = t_2;
    Intersection _e75 = hit;
    if (((_e72 > EPSILON) && (_e74 < _e75.t))) {
        {
            Ray _e79 = ray_3;
            float _e81 = t_2;
            Ray _e82 = ray_3;
            point_3 = (_e79.origin + (_e81 * _e82.direction));
            float _e87 = t_2;
            float3 _e88 = point_3;
            float3 _e93 = point_3;
            const float3 _e94 = checker(_e93);
            hit = ConstructIntersection(_e87, _e88, float3(0.0, 1.0, 0.0), MATTE, _e94);
        }
    }
    Intersection _e96 = hit;
    const Intersection intersection = _e96;
    return intersection;
}

Ray ConstructRay(float3 arg0, float3 arg1) {
    Ray ret = (Ray)0;
    ret.origin = arg0;
    ret.direction = arg1;
    return ret;
}

float3 shade(Intersection hit_1)
{
    Intersection hit_2 = (Intersection)0;
    float3 sum = AMBIENT;
    float cosine = (float)0;
    float3 origin = (float3)0;
    float3 toLight = (float3)0;
    float distance_ = (float)0;

    hit_2 = hit_1;
    Intersection _e6 = hit_2;
    Intersection _e8 = hit_2;
    cosine = dot(_e6.normal, normalize((LIGHT - _e8.point_)));
    float _e14 = cosine;
    if ((_e14 > 0.0)) {
        {
            Intersection _e17 = hit_2;
            Intersection _e19 = hit_2;
            origin = (_e17.point_ + (EPSILON * _e19.normal));
            float3 _e24 = origin;
            toLight = (LIGHT - _e24);
            float3 _e27 = toLight;
            distance_ = length(_e27);
            float3 _e30 = origin;
            float3 _e31 = toLight;
            float _e32 = distance_;
            const Intersection _e36 = nearestHit(ConstructRay(_e30, (_e31 / (_e32).xxx)));
            float _e38 = distance_;
            if ((_e36.t > _e38)) {
                {
                    float3 _e40 = sum;
                    float _e43 = cosine;
                    sum = (_e40 + ((0.85).xxx * _e43));
                }
            }
        }
    }
    Intersection _e46 = hit_2;
    float3 _e48 = sum;
    return (_e46.color * _e48);
}

float fresnel(float eta, float cosine_1, float beyond)
{
    float eta_1 = (float)0;
    float cosine_2 = (float)0;
    float beyond_1 = (float)0;
    float across = (float)0;
    float along = (float)0;

    eta_1 = eta;
    cosine_2 = cosine_1;
    beyond_1 = beyond;
    float _e6 = eta_1;
    float _e7 = cosine_2;
    float _e9 = beyond_1;
    float _e11 = eta_1;
    float _e12 = cosine_2;
    float _e14 = beyond_1;
    across = (((_e6 * _e7) - _e9) / ((_e11 * _e12) + _e14));
    float _e18 = cosine_2;
    float _e19 = eta_1;
    float _e20 = beyond_1;
    float _e23 = cosine_2;
    float _e24 = eta_1;
    float _e25 = beyond_1;
    along = ((_e18 - (_e19 * _e20)) / (_e23 + (_e24 * _e25)));
    float _e31 = across;
    float _e32 = across;
    float _e34 = along;
    float _e35 = along;
    return (0.5 * ((_e31 * _e32) + (_e34 * _e35)));
}

Branch ConstructBranch(Ray arg0, float3 arg1, int arg2) {
    Branch ret = (Branch)0;
    ret.ray = arg0;
    ret.throughput = arg1;
    ret.depth = arg2;
    return ret;
}

float3 trace(Ray first)
{
    Ray first_1 = (Ray)0;
    Branch stack[8] = { (Branch)0, (Branch)0, (Branch)0, (Branch)0, (Branch)0, (Branch)0, (Branch)0, (Branch)0 };
    int top = int(1);
    float3 color = (0.0).xxx;
    Branch branch = (Branch)0;
    Ray ray_4 = (Ray)0;
    Intersection hit_3 = (Intersection)0;
    int depth = (int)0;
    float3 throughput = (float3)0;
    Ray mirrored = (Ray)0;
    bool entering = (bool)0;
    float3 local_1 = (float3)0;
    float3 normal_1 = (float3)0;
    float local_2 = (float)0;
    float eta_2 = (float)0;
    float cosine_3 = (float)0;
    float sine2_ = (float)0;
    float beyond_2 = (float)0;
    float share = (float)0;
    float3 refracted = (float3)0;

    first_1 = first;
    Ray _e10 = first_1;
    stack[int(0)] = ConstructBranch(_e10, (1.0).xxx, int(0));
    while(true) {
        int _e20 = top;
        if (!((_e20 > int(0)))) {
            break;
        }
        {
            int _e24 = top;
            top = asint(asuint(_e24) - asuint(int(1)));
            int _e27 = top;
            Branch _e29 = stack[min(uint(_e27), 7u)];
            branch = _e29;
            Branch _e31 = branch;
            ray_4 = _e31.ray;
            Ray _e34 = ray_4;
            const Intersection _e35 = nearestHit(_e34);
            hit_3 = _e35;
            Intersection _e37 = hit_3;
            if ((_e37.t == NO_HIT)) {
                {
                    float3 _e40 = color;
                    Branch _e41 = branch;
                    Ray _e43 = ray_4;
                    const float3 _e45 = sky(_e43.direction);
                    color = (_e40 + (_e41.throughput * _e45));
                    continue;
                }
            }
            Intersection _e48 = hit_3;
            if ((_e48.model == MATTE)) {
                {
                    float3 _e51 = color;
                    Branch _e52 = branch;
                    Intersection _e54 = hit_3;
                    const float3 _e55 = shade(_e54);
                    color = (_e51 + (_e52.throughput * _e55));
                    continue;
                }
            }
            Branch _e58 = branch;
            depth = asint(asuint(_e58.depth) + asuint(int(1)));
            int _e63 = depth;
            if ((_e63 == MAX_DEPTH)) {
                {
                    continue;
                }
            }
            Branch _e65 = branch;
            Intersection _e67 = hit_3;
            throughput = (_e65.throughput * _e67.color);
            Intersection _e71 = hit_3;
            Ray _e73 = ray_4;
            Intersection _e75 = hit_3;
            mirrored = ConstructRay(_e71.point_, reflect(_e73.direction, _e75.normal));
            Intersection _e80 = hit_3;
            if ((_e80.model == MIRROR)) {
                {
                    int _e83 = top;
                    top = asint(asuint(_e83) + asuint(int(1)));
                    Ray _e87 = mirrored;
                    float3 _e88 = throughput;
                    int _e89 = depth;
                    stack[min(uint(_e83), 7u)] = ConstructBranch(_e87, _e88, _e89);
                    continue;
                }
            }
            Ray _e91 = ray_4;
            Intersection _e93 = hit_3;
            entering = (dot(_e91.direction, _e93.normal) < 0.0);
            bool _e99 = entering;
            if (_e99) {
                Intersection _e100 = hit_3;
                local_1 = _e100.normal;
            } else {
                Intersection _e102 = hit_3;
                local_1 = -(_e102.normal);
            }
            float3 _e106 = local_1;
            normal_1 = _e106;
            bool _e108 = entering;
            if (_e108) {
                local_2 = 0.6666667;
            } else {
                local_2 = IOR;
            }
            float _e111 = local_2;
            eta_2 = _e111;
            Ray _e113 = ray_4;
            float3 _e115 = normal_1;
            cosine_3 = -(dot(_e113.direction, _e115));
            float _e119 = eta_2;
            float _e120 = eta_2;
            float _e123 = cosine_3;
            float _e124 = cosine_3;
            sine2_ = ((_e119 * _e120) * (1.0 - (_e123 * _e124)));
            float _e129 = sine2_;
            if ((_e129 >= 1.0)) {
                {
                    int _e132 = top;
                    top = asint(asuint(_e132) + asuint(int(1)));
                    Ray _e136 = mirrored;
                    float3 _e137 = throughput;
                    int _e138 = depth;
                    stack[min(uint(_e132), 7u)] = ConstructBranch(_e136, _e137, _e138);
                    continue;
                }
            }
            float _e141 = sine2_;
            beyond_2 = sqrt((1.0 - _e141));
            float _e145 = eta_2;
            float _e146 = cosine_3;
            float _e147 = beyond_2;
            const float _e148 = fresnel(_e145, _e146, _e147);
            share = _e148;
            float _e150 = eta_2;
            Ray _e151 = ray_4;
            float _e154 = eta_2;
            float _e155 = cosine_3;
            float _e157 = beyond_2;
            float3 _e159 = normal_1;
            refracted = ((_e150 * _e151.direction) + (((_e154 * _e155) - _e157) * _e159));
            int _e163 = top;
            top = asint(asuint(_e163) + asuint(int(1)));
            Ray _e167 = mirrored;
            float3 _e168 = throughput;
            float _e169 = share;
            int _e171 = depth;
            stack[min(uint(_e163), 7u)] = ConstructBranch(_e167, (_e168 * _e169), _e171);
            int _e173 = top;
            top = asint(asuint(_e173) + asuint(int(1)));
            Intersection _e177 = hit_3;
            float3 _e179 = refracted;
            float3 _e181 = throughput;
            float _e183 = share;
            int _e186 = depth;
            stack[min(uint(_e173), 7u)] = ConstructBranch(ConstructRay(_e177.point_, _e179), (_e181 * (1.0 - _e183)), _e186);
        }
    }
    float3 _e188 = color;
    return _e188;
}

Ray cameraRay(float2 fragCoord)
{
    float2 fragCoord_1 = (float2)0;
    float aspect = (float)0;
    float x = (float)0;
    float y = (float)0;

    fragCoord_1 = fragCoord;
    float3 _e5 = global.iResolution;
    float3 _e7 = global.iResolution;
    aspect = (_e5.x / _e7.y);
    float2 _e11 = fragCoord_1;
    float3 _e13 = global.iResolution;
    x = (((_e11.x / _e13.x) * 2.0) - 1.0);
    float2 _e21 = fragCoord_1;
    float3 _e23 = global.iResolution;
    float _e30 = aspect;
    y = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x;
    float _e36 = y;
    const Ray ray_5 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_5;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;

    fragCoord_3 = fragCoord_2;
    makeScene();
    float2 _e3 = fragCoord_3;
    const Ray _e4 = cameraRay(_e3);
    const float3 _e5 = trace(_e4);
    fragColor = float4(_e5.x, _e5.y, _e5.z, 1.0);
    return;
}

void main_1()
{
    float4 toyproof_image_color = float4(0.0, 0.0, 0.0, 1.0);

    float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy);
    float4 _e10 = toyproof_image_color;
    float3 _e11 = _e10.xyz;
    toyproof_color = float4(_e11.x, _e11.y, _e11.z, 1.0);
    return;
}

FragmentOutput ConstructFragmentOutput(float4 arg0) {
    FragmentOutput ret = (FragmentOutput)0;
    ret.toyproof_color = arg0;
    return ret;
}

FragmentOutput main(FragmentInput_main fragmentinput_main)
{
    float4 gl_FragCoord = fragmentinput_main.gl_FragCoord_2;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    float4 _e3 = toyproof_color;
    const FragmentOutput fragmentoutput = ConstructFragmentOutput(_e3);
    return fragmentoutput;
}
