// glsl/13-importance-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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

struct Material {
    int model;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float3 color;
    float exponent;
};

struct Sphere {
    float3 center_;
    float radius;
    Material material;
};

struct Intersection {
    float t;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float3 point_;
    int _pad2_0;
    float3 normal;
    int _pad3_0;
    Material material;
    int sphere;
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const float PI = 3.1415927;
static const float EPSILON = 0.001;
static const int SAMPLES = int(16);
static const int SPHERES = int(6);
static const int EMITTERS = int(2);
static const int MAX_DEPTH = int(4);
static const int DIFFUSE = int(0);
static const int GLOSSY = int(1);
static const int EMITTER = int(2);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[6] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static uint state = (uint)0;
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

uint pcg(uint v)
{
    uint v_1 = (uint)0;
    uint s = (uint)0;
    uint word = (uint)0;

    v_1 = v;
    uint _e2 = v_1;
    s = ((_e2 * 747796405u) + 2891336453u);
    uint _e8 = s;
    uint _e9 = s;
    uint _e15 = s;
    word = (((_e8 >> ((_e9 >> 28u) + 4u)) ^ _e15) * 277803737u);
    uint _e20 = word;
    uint _e23 = word;
    return ((_e20 >> 22u) ^ _e23);
}

float random()
{
    uint _e1 = state;
    const uint _e2 = pcg(_e1);
    state = _e2;
    uint _e3 = state;
    return (float((_e3 >> 8u)) / 16777216.0);
}

uint naga_f2u32(float value) {
    return uint(clamp(value, 0.0, 4294967000.0));
}

void startSample(float2 fragCoord, int i)
{
    float2 fragCoord_1 = (float2)0;
    int i_1 = (int)0;

    fragCoord_1 = fragCoord;
    i_1 = i;
    float2 _e5 = fragCoord_1;
    float2 _e8 = fragCoord_1;
    int _e11 = i_1;
    const uint _e13 = pcg(uint(_e11));
    const uint _e15 = pcg((naga_f2u32(_e8.y) + _e13));
    const uint _e17 = pcg((naga_f2u32(_e5.x) + _e15));
    state = _e17;
    return;
}

Material ConstructMaterial(int arg0, float3 arg1, float arg2) {
    Material ret = (Material)0;
    ret.model = arg0;
    ret.color = arg1;
    ret.exponent = arg2;
    return ret;
}

Sphere ConstructSphere(float3 arg0, float arg1, Material arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.material = arg2;
    return ret;
}

void makeScene()
{
    spheres[int(0)] = ConstructSphere(float3(-2.5, 1.4, -6.5), 0.25, ConstructMaterial(int(2), float3(80.0, 70.0, 55.0), 0.0));
    spheres[int(1)] = ConstructSphere(float3(2.2, 1.4, -7.5), 0.8, ConstructMaterial(int(2), float3(2.5, 3.0, 4.0), 0.0));
    spheres[int(2)] = ConstructSphere(float3(-1.8, -0.3, -6.0), 0.7, ConstructMaterial(int(1), float3(0.9, 0.7, 0.3), 300.0));
    spheres[int(3)] = ConstructSphere(float3(0.0, -0.3, -6.5), 0.7, ConstructMaterial(int(1), float3(0.8, 0.8, 0.8), 30.0));
    spheres[int(4)] = ConstructSphere(float3(1.7, -0.4, -5.5), 0.6, ConstructMaterial(int(0), float3(0.8, 0.25, 0.2), 0.0));
    spheres[int(5)] = ConstructSphere(float3(0.6, -0.75, -4.2), 0.25, ConstructMaterial(int(0), float3(0.3, 0.7, 0.4), 0.0));
    return;
}

float intersectSphere(Ray ray, Sphere sphere)
{
    Ray ray_1 = (Ray)0;
    Sphere sphere_1 = (Sphere)0;
    float3 f = (float3)0;
    float b = (float)0;
    float3 closest = (float3)0;
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
    float _e18 = b;
    Ray _e19 = ray_1;
    closest = (_e17 - (_e18 * _e19.direction));
    Sphere _e24 = sphere_1;
    Sphere _e26 = sphere_1;
    float3 _e29 = closest;
    float3 _e30 = closest;
    disc = ((_e24.radius * _e26.radius) - dot(_e29, _e30));
    float _e34 = disc;
    if ((_e34 > 0.0)) {
        {
            float _e37 = disc;
            root = sqrt(_e37);
            float _e40 = b;
            float _e42 = root;
            t = (-(_e40) - _e42);
            float _e45 = t;
            if ((_e45 > EPSILON)) {
                {
                    float _e47 = t;
                    return _e47;
                }
            }
            float _e48 = b;
            float _e50 = root;
            t = (-(_e48) + _e50);
            float _e52 = t;
            if ((_e52 > EPSILON)) {
                {
                    float _e54 = t;
                    return _e54;
                }
            }
        }
    }
    return NO_HIT;
}

Intersection nearestHit(Ray ray_2)
{
    Ray ray_3 = (Ray)0;
    Intersection hit = (Intersection)0;
    int i_2 = int(0);
    float t_1 = (float)0;
    float t_2 = (float)0;

    ray_3 = ray_2;
    hit.t = NO_HIT;
    hit.sphere = int(-1);
    while(true) {
        int _e12 = i_2;
        if (!((_e12 < SPHERES))) {
            break;
        }
        {
            Ray _e15 = ray_3;
            int _e16 = i_2;
            Sphere _e18 = spheres[min(uint(_e16), 5u)];
            const float _e19 = intersectSphere(_e15, _e18);
            t_1 = _e19;
            float _e21 = t_1;
            Intersection _e22 = hit;
            if ((_e21 < _e22.t)) {
                {
                    float _e26 = t_1;
                    hit.t = _e26;
                    int _e28 = i_2;
                    hit.sphere = _e28;
                }
            }
            int _e29 = i_2;
            i_2 = asint(asuint(_e29) + asuint(int(1)));
        }
    }
    Ray _e33 = ray_3;
    Ray _e37 = ray_3;
    t_2 = ((-1.0 - _e33.origin.y) / _e37.direction.y);
    float _e42 = t_2;
    float _e44 = t_2;
    Intersection _e45 = hit;
    if (((_e42 > EPSILON) && (_e44 < _e45.t))) {
        {
            float _e50 = t_2;
            hit.t = _e50;
            hit.sphere = int(-1);
            hit.normal = float3(0.0, 1.0, 0.0);
            hit.material = ConstructMaterial(int(0), float3(0.6, 0.6, 0.65), 0.0);
        }
    }
    Ray _e67 = ray_3;
    Intersection _e69 = hit;
    Ray _e71 = ray_3;
    hit.point_ = (_e67.origin + (_e69.t * _e71.direction));
    Intersection _e75 = hit;
    if ((_e75.sphere >= int(0))) {
        {
            Intersection _e80 = hit;
            Intersection _e82 = hit;
            Sphere _e85 = spheres[min(uint(_e82.sphere), 5u)];
            hit.normal = normalize((_e80.point_ - _e85.center_));
            Intersection _e90 = hit;
            Sphere _e93 = spheres[min(uint(_e90.sphere), 5u)];
            hit.material = _e93.material;
        }
    }
    Intersection _e95 = hit;
    const Intersection intersection = _e95;
    return intersection;
}

float3 around(float3 w, float cosine, float turn)
{
    float3 w_1 = (float3)0;
    float cosine_1 = (float)0;
    float turn_1 = (float)0;
    float3 local = (float3)0;
    float3 up = (float3)0;
    float3 a = (float3)0;
    float3 b_1 = (float3)0;
    float sine = (float)0;
    float phi = (float)0;

    w_1 = w;
    cosine_1 = cosine;
    turn_1 = turn;
    float3 _e6 = w_1;
    if ((abs(_e6.y) > 0.9)) {
        local = float3(1.0, 0.0, 0.0);
    } else {
        local = float3(0.0, 1.0, 0.0);
    }
    float3 _e20 = local;
    up = _e20;
    float3 _e22 = up;
    float3 _e23 = w_1;
    a = normalize(cross(_e22, _e23));
    float3 _e27 = w_1;
    float3 _e28 = a;
    b_1 = cross(_e27, _e28);
    float _e32 = cosine_1;
    float _e33 = cosine_1;
    sine = sqrt(max((1.0 - (_e32 * _e33)), 0.0));
    float _e41 = turn_1;
    phi = (6.2831855 * _e41);
    float _e44 = sine;
    float _e45 = phi;
    float3 _e48 = a;
    float _e50 = sine;
    float _e51 = phi;
    float3 _e54 = b_1;
    float _e57 = cosine_1;
    float3 _e58 = w_1;
    return ((((_e44 * cos(_e45)) * _e48) + ((_e50 * sin(_e51)) * _e54)) + (_e57 * _e58));
}

float coneDepth(float3 point_, Sphere emitter)
{
    float3 point_1 = (float3)0;
    Sphere emitter_1 = (Sphere)0;
    float3 toCenter = (float3)0;
    float sine2_ = (float)0;

    point_1 = point_;
    emitter_1 = emitter;
    Sphere _e4 = emitter_1;
    float3 _e6 = point_1;
    toCenter = (_e4.center_ - _e6);
    Sphere _e9 = emitter_1;
    Sphere _e11 = emitter_1;
    float3 _e14 = toCenter;
    float3 _e15 = toCenter;
    sine2_ = ((_e9.radius * _e11.radius) / dot(_e14, _e15));
    float _e19 = sine2_;
    float _e22 = sine2_;
    return (_e19 / (1.0 + sqrt((1.0 - _e22))));
}

float lightDensity(float3 point_2, Sphere emitter_2)
{
    float3 point_3 = (float3)0;
    Sphere emitter_3 = (Sphere)0;

    point_3 = point_2;
    emitter_3 = emitter_2;
    float3 _e6 = point_3;
    Sphere _e7 = emitter_3;
    const float _e8 = coneDepth(_e6, _e7);
    return (1.0 / ((6.2831855 * _e8) * 2.0));
}

float3 brdf(Material material, float3 reflected, float3 direction)
{
    Material material_1 = (Material)0;
    float3 reflected_1 = (float3)0;
    float3 direction_1 = (float3)0;
    float lobe = (float)0;

    material_1 = material;
    reflected_1 = reflected;
    direction_1 = direction;
    Material _e7 = material_1;
    if ((_e7.model == GLOSSY)) {
        {
            float3 _e10 = reflected_1;
            float3 _e11 = direction_1;
            Material _e15 = material_1;
            lobe = pow(max(dot(_e10, _e11), 0.0), _e15.exponent);
            Material _e19 = material_1;
            Material _e21 = material_1;
            float _e29 = lobe;
            return (((_e19.color * (_e21.exponent + 2.0)) / (6.2831855).xxx) * _e29);
        }
    }
    Material _e31 = material_1;
    return (_e31.color / (3.1415927).xxx);
}

float brdfDensity(Material material_2, float3 normal, float3 reflected_2, float3 direction_2)
{
    Material material_3 = (Material)0;
    float3 normal_1 = (float3)0;
    float3 reflected_3 = (float3)0;
    float3 direction_3 = (float3)0;
    float lobe_1 = (float)0;

    material_3 = material_2;
    normal_1 = normal;
    reflected_3 = reflected_2;
    direction_3 = direction_2;
    Material _e10 = material_3;
    if ((_e10.model == GLOSSY)) {
        {
            float3 _e13 = reflected_3;
            float3 _e14 = direction_3;
            Material _e18 = material_3;
            lobe_1 = pow(max(dot(_e13, _e14), 0.0), _e18.exponent);
            Material _e22 = material_3;
            float _e28 = lobe_1;
            return (((_e22.exponent + 1.0) / 6.2831855) * _e28);
        }
    }
    float3 _e30 = normal_1;
    float3 _e31 = direction_3;
    return (max(dot(_e30, _e31), 0.0) / PI);
}

float3 sampleBrdf(Material material_4, float3 normal_2, float3 reflected_4)
{
    Material material_5 = (Material)0;
    float3 normal_3 = (float3)0;
    float3 reflected_5 = (float3)0;
    float u = (float)0;
    float v_2 = (float)0;

    material_5 = material_4;
    normal_3 = normal_2;
    reflected_5 = reflected_4;
    const float _e7 = random();
    u = _e7;
    const float _e9 = random();
    v_2 = _e9;
    Material _e11 = material_5;
    if ((_e11.model == GLOSSY)) {
        {
            float3 _e14 = reflected_5;
            float _e16 = u;
            Material _e19 = material_5;
            float _e25 = v_2;
            const float3 _e26 = around(_e14, pow((1.0 - _e16), (1.0 / (_e19.exponent + 1.0))), _e25);
            return _e26;
        }
    }
    float3 _e27 = normal_3;
    float _e29 = u;
    float _e32 = v_2;
    const float3 _e33 = around(_e27, sqrt((1.0 - _e29)), _e32);
    return _e33;
}

float weight(float density, float other)
{
    float density_1 = (float)0;
    float other_1 = (float)0;
    float ratio = (float)0;

    density_1 = density;
    other_1 = other;
    float _e4 = other_1;
    float _e5 = density_1;
    ratio = (_e4 / _e5);
    float _e10 = ratio;
    float _e11 = ratio;
    return (1.0 / (1.0 + (_e10 * _e11)));
}

bool inShadow(Ray ray_4, int emitter_4)
{
    Ray ray_5 = (Ray)0;
    int emitter_5 = (int)0;
    float distance_ = (float)0;
    int i_3 = int(0);
    bool local_1 = (bool)0;
    float t_3 = (float)0;

    ray_5 = ray_4;
    emitter_5 = emitter_4;
    Ray _e7 = ray_5;
    int _e8 = emitter_5;
    Sphere _e10 = spheres[min(uint(_e8), 5u)];
    const float _e11 = intersectSphere(_e7, _e10);
    distance_ = _e11;
    while(true) {
        int _e15 = i_3;
        if (!((_e15 < SPHERES))) {
            break;
        }
        {
            int _e18 = i_3;
            int _e19 = emitter_5;
            if ((_e18 != _e19)) {
                Ray _e21 = ray_5;
                int _e22 = i_3;
                Sphere _e24 = spheres[min(uint(_e22), 5u)];
                const float _e25 = intersectSphere(_e21, _e24);
                float _e26 = distance_;
                local_1 = (_e25 < _e26);
            } else {
                local_1 = false;
            }
            bool _e30 = local_1;
            if (_e30) {
                {
                    return true;
                }
            }
            int _e32 = i_3;
            i_3 = asint(asuint(_e32) + asuint(int(1)));
        }
    }
    Ray _e36 = ray_5;
    Ray _e40 = ray_5;
    t_3 = ((-1.0 - _e36.origin.y) / _e40.direction.y);
    float _e45 = t_3;
    float _e47 = t_3;
    float _e48 = distance_;
    return ((_e45 > EPSILON) && (_e47 < _e48));
}

Ray ConstructRay(float3 arg0, float3 arg1) {
    Ray ret = (Ray)0;
    ret.origin = arg0;
    ret.direction = arg1;
    return ret;
}

int naga_f2i32(float value) {
    return int(clamp(value, -2147483600.0, 2147483500.0));
}

float3 sampleLight(Intersection hit_1, float3 reflected_6)
{
    Intersection hit_2 = (Intersection)0;
    float3 reflected_7 = (float3)0;
    int emitter_6 = (int)0;
    float u_1 = (float)0;
    float v_3 = (float)0;
    float cosine_2 = (float)0;
    float3 direction_4 = (float3)0;
    float facing = (float)0;
    float density_2 = (float)0;
    float other_2 = (float)0;

    hit_2 = hit_1;
    reflected_7 = reflected_6;
    const float _e6 = random();
    emitter_6 = min(naga_f2i32((_e6 * 2.0)), int(1));
    const float _e13 = random();
    u_1 = _e13;
    const float _e15 = random();
    v_3 = _e15;
    float _e18 = u_1;
    Intersection _e19 = hit_2;
    int _e21 = emitter_6;
    Sphere _e23 = spheres[min(uint(_e21), 5u)];
    const float _e24 = coneDepth(_e19.point_, _e23);
    cosine_2 = (1.0 - (_e18 * _e24));
    int _e28 = emitter_6;
    Sphere _e30 = spheres[min(uint(_e28), 5u)];
    Intersection _e32 = hit_2;
    float _e36 = cosine_2;
    float _e37 = v_3;
    const float3 _e38 = around(normalize((_e30.center_ - _e32.point_)), _e36, _e37);
    direction_4 = _e38;
    Intersection _e40 = hit_2;
    float3 _e42 = direction_4;
    facing = dot(_e40.normal, _e42);
    float _e45 = facing;
    if ((_e45 <= 0.0)) {
        {
            return (0.0).xxx;
        }
    }
    Intersection _e50 = hit_2;
    Intersection _e52 = hit_2;
    float3 _e56 = direction_4;
    int _e58 = emitter_6;
    const bool _e59 = inShadow(ConstructRay((_e50.point_ + (EPSILON * _e52.normal)), _e56), _e58);
    if (_e59) {
        {
            return (0.0).xxx;
        }
    }
    Intersection _e62 = hit_2;
    int _e64 = emitter_6;
    Sphere _e66 = spheres[min(uint(_e64), 5u)];
    const float _e67 = lightDensity(_e62.point_, _e66);
    density_2 = _e67;
    Intersection _e69 = hit_2;
    Intersection _e71 = hit_2;
    float3 _e73 = reflected_7;
    float3 _e74 = direction_4;
    const float _e75 = brdfDensity(_e69.material, _e71.normal, _e73, _e74);
    other_2 = _e75;
    int _e77 = emitter_6;
    Sphere _e79 = spheres[min(uint(_e77), 5u)];
    Intersection _e82 = hit_2;
    float3 _e84 = reflected_7;
    float3 _e85 = direction_4;
    const float3 _e86 = brdf(_e82.material, _e84, _e85);
    float _e88 = facing;
    float _e90 = density_2;
    float _e91 = other_2;
    const float _e92 = weight(_e90, _e91);
    float _e94 = density_2;
    return ((((_e79.material.color * _e86) * _e88) * _e92) / (_e94).xxx);
}

float3 trace(Ray ray_6)
{
    Ray ray_7 = (Ray)0;
    float3 color = (0.0).xxx;
    float3 throughput = (1.0).xxx;
    float density_3 = 0.0;
    int depth = int(0);
    Intersection hit_3 = (Intersection)0;
    float share = (float)0;
    float3 reflected_8 = (float3)0;
    float3 direction_5 = (float3)0;
    float facing_1 = (float)0;

    ray_7 = ray_6;
    while(true) {
        int _e17 = depth;
        if (!((_e17 < MAX_DEPTH))) {
            break;
        }
        {
            Ray _e20 = ray_7;
            const Intersection _e21 = nearestHit(_e20);
            hit_3 = _e21;
            Intersection _e23 = hit_3;
            if ((_e23.t == NO_HIT)) {
                {
                    float3 _e26 = color;
                    float3 _e27 = throughput;
                    return (_e26 + (_e27 * float3(0.05, 0.06, 0.08)));
                }
            }
            Intersection _e34 = hit_3;
            if ((_e34.material.model == EMITTER)) {
                {
                    share = 1.0;
                    float _e40 = density_3;
                    if ((_e40 > 0.0)) {
                        {
                            float _e43 = density_3;
                            Ray _e44 = ray_7;
                            Intersection _e46 = hit_3;
                            Sphere _e49 = spheres[min(uint(_e46.sphere), 5u)];
                            const float _e50 = lightDensity(_e44.origin, _e49);
                            const float _e51 = weight(_e43, _e50);
                            share = _e51;
                        }
                    }
                    float3 _e52 = color;
                    float3 _e53 = throughput;
                    Intersection _e54 = hit_3;
                    float _e58 = share;
                    return (_e52 + ((_e53 * _e54.material.color) * _e58));
                }
            }
            int _e61 = depth;
            if ((asint(asuint(_e61) + asuint(int(1))) == MAX_DEPTH)) {
                {
                    float3 _e65 = color;
                    return _e65;
                }
            }
            Ray _e66 = ray_7;
            Intersection _e68 = hit_3;
            reflected_8 = reflect(_e66.direction, _e68.normal);
            float3 _e72 = color;
            float3 _e73 = throughput;
            Intersection _e74 = hit_3;
            float3 _e75 = reflected_8;
            const float3 _e76 = sampleLight(_e74, _e75);
            color = (_e72 + (_e73 * _e76));
            Intersection _e79 = hit_3;
            Intersection _e81 = hit_3;
            float3 _e83 = reflected_8;
            const float3 _e84 = sampleBrdf(_e79.material, _e81.normal, _e83);
            direction_5 = _e84;
            Intersection _e86 = hit_3;
            float3 _e88 = direction_5;
            facing_1 = dot(_e86.normal, _e88);
            float _e91 = facing_1;
            if ((_e91 <= 0.0)) {
                {
                    float3 _e94 = color;
                    return _e94;
                }
            }
            Intersection _e95 = hit_3;
            Intersection _e97 = hit_3;
            float3 _e99 = reflected_8;
            float3 _e100 = direction_5;
            const float _e101 = brdfDensity(_e95.material, _e97.normal, _e99, _e100);
            density_3 = _e101;
            float3 _e102 = throughput;
            Intersection _e103 = hit_3;
            float3 _e105 = reflected_8;
            float3 _e106 = direction_5;
            const float3 _e107 = brdf(_e103.material, _e105, _e106);
            float _e108 = facing_1;
            float _e110 = density_3;
            throughput = (_e102 * ((_e107 * _e108) / (_e110).xxx));
            Intersection _e114 = hit_3;
            Intersection _e116 = hit_3;
            float3 _e120 = direction_5;
            ray_7 = ConstructRay((_e114.point_ + (EPSILON * _e116.normal)), _e120);
            int _e122 = depth;
            depth = asint(asuint(_e122) + asuint(int(1)));
        }
    }
    float3 _e125 = color;
    return _e125;
}

Ray cameraRay(float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    float aspect = (float)0;
    float x = (float)0;
    float y = (float)0;

    fragCoord_3 = fragCoord_2;
    float3 _e5 = global.iResolution;
    float3 _e7 = global.iResolution;
    aspect = (_e5.x / _e7.y);
    float2 _e11 = fragCoord_3;
    float3 _e13 = global.iResolution;
    x = (((_e11.x / _e13.x) * 2.0) - 1.0);
    float2 _e21 = fragCoord_3;
    float3 _e23 = global.iResolution;
    float _e30 = aspect;
    y = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x;
    float _e36 = y;
    const Ray ray_8 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_8;
}

void mainImage(inout float4 fragColor, float2 fragCoord_4)
{
    float2 fragCoord_5 = (float2)0;
    float3 color_1 = (0.0).xxx;
    int i_4 = int(0);
    float x_1 = (float)0;
    float y_1 = (float)0;

    fragCoord_5 = fragCoord_4;
    fragColor = (0.0).xxxx;
    makeScene();
    while(true) {
        int _e11 = i_4;
        if (!((_e11 < SAMPLES))) {
            break;
        }
        {
            float2 _e14 = fragCoord_5;
            int _e15 = i_4;
            startSample(_e14, _e15);
            float2 _e16 = fragCoord_5;
            const float _e18 = random();
            x_1 = ((_e16.x + _e18) - 0.5);
            float2 _e23 = fragCoord_5;
            const float _e25 = random();
            y_1 = ((_e23.y + _e25) - 0.5);
            float3 _e30 = color_1;
            float _e31 = x_1;
            float _e32 = y_1;
            const Ray _e34 = cameraRay(float2(_e31, _e32));
            const float3 _e35 = trace(_e34);
            color_1 = (_e30 + _e35);
            int _e37 = i_4;
            i_4 = asint(asuint(_e37) + asuint(int(1)));
        }
    }
    float3 _e40 = color_1;
    color_1 = (_e40 / (16.0).xxx);
    float3 _e44 = color_1;
    float3 _e45 = color_1;
    float3 _e52 = pow((_e44 / (_e45 + (1.0).xxx)), (0.45454544).xxx);
    fragColor = float4(_e52.x, _e52.y, _e52.z, 1.0);
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
