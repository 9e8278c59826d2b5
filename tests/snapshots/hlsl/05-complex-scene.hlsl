// glsl/05-complex-scene.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    float3 color;
    int _end_pad_0;
};

struct Intersection {
    float t;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    Sphere sphere;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const float SHRINK = 2.8;
static const float3 AMBIENT = (0.15).xxx;
static const float3 LIGHT = float3(4.0, 5.0, 2.0);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

int naga_mod(int lhs, int rhs) {
    int divisor = ((lhs == int(-2147483647 - 1) & rhs == -1) | (rhs == 0)) ? 1 : rhs;
    return lhs - (lhs / divisor) * divisor;
}

int toyproof_remainder(int a, int b)
{
    int a_1 = (int)0;
    int b_1 = (int)0;
    int r = (int)0;
    int local = (int)0;

    a_1 = a;
    b_1 = b;
    int _e4 = a_1;
    int _e5 = b_1;
    r = naga_mod(_e4, _e5);
    int _e8 = r;
    int _e11 = r;
    int _e12 = b_1;
    if (((_e8 != int(0)) && ((_e11 ^ _e12) < int(0)))) {
        int _e17 = r;
        int _e18 = b_1;
        local = asint(asuint(_e17) + asuint(_e18));
    } else {
        int _e20 = r;
        local = _e20;
    }
    int _e22 = local;
    return _e22;
}

int naga_div(int lhs, int rhs) {
    return lhs / (((lhs == int(-2147483647 - 1) & rhs == -1) | (rhs == 0)) ? 1 : rhs);
}

float3 side(int i)
{
    int i_1 = (int)0;
    float3 axis = (float3)0;
    float3 local_1 = (float3)0;

    i_1 = i;
    int _e2 = i_1;
    int _e7 = i_1;
    int _e12 = i_1;
    axis = float3(float((naga_div(_e2, int(2)) == int(0))), float((naga_div(_e7, int(2)) == int(1))), float((naga_div(_e12, int(2)) == int(2))));
    int _e22 = i_1;
    const int _e24 = toyproof_remainder(_e22, int(2));
    if ((_e24 == int(0))) {
        float3 _e27 = axis;
        local_1 = _e27;
    } else {
        float3 _e28 = axis;
        local_1 = -(_e28);
    }
    float3 _e31 = local_1;
    return _e31;
}

float3 sideColor(int i_2)
{
    int i_3 = (int)0;

    i_3 = i_2;
    int _e4 = i_3;
    const float3 _e5 = side(_e4);
    return ((0.5).xxx + (0.4 * _e5));
}

float3 turn(float3 v, int frame)
{
    float3 v_1 = (float3)0;
    int frame_1 = (int)0;
    float angle = (float)0;
    float c = (float)0;
    float s = (float)0;

    v_1 = v;
    frame_1 = frame;
    int _e5 = frame_1;
    angle = ((6.2831855 * float(_e5)) / 240.0);
    float _e11 = angle;
    c = cos(_e11);
    float _e14 = angle;
    s = sin(_e14);
    float _e17 = c;
    float3 _e18 = v_1;
    float _e21 = s;
    float3 _e22 = v_1;
    float3 _e26 = v_1;
    float _e28 = c;
    float3 _e29 = v_1;
    float _e32 = s;
    float3 _e33 = v_1;
    return float3(((_e17 * _e18.x) + (_e21 * _e22.z)), _e26.y, ((_e28 * _e29.z) - (_e32 * _e33.x)));
}

Sphere ConstructSphere(float3 arg0, float arg1, float3 arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.color = arg2;
    return ret;
}

Sphere childOf(Sphere parent, int i_4, int frame_2)
{
    Sphere parent_1 = (Sphere)0;
    int i_5 = (int)0;
    int frame_3 = (int)0;
    float radius = (float)0;
    float3 center_ = (float3)0;

    parent_1 = parent;
    i_5 = i_4;
    frame_3 = frame_2;
    Sphere _e7 = parent_1;
    radius = (_e7.radius / SHRINK);
    Sphere _e11 = parent_1;
    Sphere _e13 = parent_1;
    float _e15 = radius;
    int _e17 = i_5;
    const float3 _e18 = side(_e17);
    int _e19 = frame_3;
    const float3 _e20 = turn(_e18, _e19);
    center_ = (_e11.center_ + ((_e13.radius + _e15) * _e20));
    float3 _e24 = center_;
    float _e25 = radius;
    Sphere _e27 = parent_1;
    int _e29 = i_5;
    const float3 _e30 = sideColor(_e29);
    const Sphere sphere_4 = ConstructSphere(_e24, _e25, (0.5 * (_e27.color + _e30)));
    return sphere_4;
}

float intersectSphere(Ray ray, Sphere sphere)
{
    Ray ray_1 = (Ray)0;
    Sphere sphere_1 = (Sphere)0;
    float3 f = (float3)0;
    float b_2 = (float)0;
    float c_1 = (float)0;
    float disc = (float)0;
    float root = (float)0;
    float t = (float)0;

    ray_1 = ray;
    sphere_1 = sphere;
    Ray _e5 = ray_1;
    Sphere _e7 = sphere_1;
    f = (_e5.origin - _e7.center_);
    float3 _e11 = f;
    Ray _e12 = ray_1;
    b_2 = dot(_e11, _e12.direction);
    float3 _e16 = f;
    float3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c_1 = (dot(_e16, _e17) - (_e19.radius * _e21.radius));
    float _e26 = b_2;
    float _e27 = b_2;
    float _e29 = c_1;
    disc = ((_e26 * _e27) - _e29);
    float _e32 = disc;
    if ((_e32 > 0.0)) {
        {
            float _e35 = disc;
            root = sqrt(_e35);
            float _e38 = b_2;
            float _e40 = root;
            t = (-(_e38) - _e40);
            float _e43 = t;
            if ((_e43 > 1e-5)) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b_2;
            float _e49 = root;
            t = (-(_e47) + _e49);
            float _e51 = t;
            if ((_e51 > 1e-5)) {
                {
                    float _e54 = t;
                    return _e54;
                }
            }
        }
    }
    return NO_HIT;
}

void keepNearest(Ray ray_2, Sphere sphere_2, inout Intersection hit)
{
    Ray ray_3 = (Ray)0;
    Sphere sphere_3 = (Sphere)0;
    float t_1 = (float)0;

    ray_3 = ray_2;
    sphere_3 = sphere_2;
    Ray _e5 = ray_3;
    Sphere _e6 = sphere_3;
    const float _e7 = intersectSphere(_e5, _e6);
    t_1 = _e7;
    float _e9 = t_1;
    Intersection _e10 = hit;
    if ((_e9 < _e10.t)) {
        {
            float _e14 = t_1;
            hit.t = _e14;
            Sphere _e16 = sphere_3;
            hit.sphere = _e16;
            return;
        }
    } else {
        return;
    }
}

Intersection ConstructIntersection(float arg0, Sphere arg1) {
    Intersection ret = (Intersection)0;
    ret.t = arg0;
    ret.sphere = arg1;
    return ret;
}

Intersection hitScene(Ray ray_4, int frame_4)
{
    Ray ray_5 = (Ray)0;
    int frame_5 = (int)0;
    Sphere parent_2 = ConstructSphere(float3(0.0, 0.0, -7.5), 1.0, float3(0.9, 0.9, 0.8));
    Intersection hit_1 = (Intersection)0;
    int i_6 = int(0);
    Sphere child = (Sphere)0;
    int j = (int)0;

    ray_5 = ray_4;
    frame_5 = frame_4;
    Sphere _e16 = parent_2;
    hit_1 = ConstructIntersection(NO_HIT, _e16);
    Ray _e19 = ray_5;
    Sphere _e20 = parent_2;
    keepNearest(_e19, _e20, hit_1);
    while(true) {
        int _e23 = i_6;
        if (!((_e23 < int(6)))) {
            break;
        }
        {
            Sphere _e27 = parent_2;
            int _e28 = i_6;
            int _e29 = frame_5;
            const Sphere _e30 = childOf(_e27, _e28, _e29);
            child = _e30;
            Ray _e32 = ray_5;
            Sphere _e33 = child;
            keepNearest(_e32, _e33, hit_1);
            j = int(0);
            while(true) {
                int _e36 = j;
                if (!((_e36 < int(6)))) {
                    break;
                }
                {
                    Ray _e40 = ray_5;
                    Sphere _e41 = child;
                    int _e42 = j;
                    int _e43 = frame_5;
                    const Sphere _e44 = childOf(_e41, _e42, _e43);
                    keepNearest(_e40, _e44, hit_1);
                    int _e45 = j;
                    j = asint(asuint(_e45) + asuint(int(1)));
                }
            }
            int _e48 = i_6;
            i_6 = asint(asuint(_e48) + asuint(int(1)));
        }
    }
    Intersection _e51 = hit_1;
    const Intersection intersection = _e51;
    return intersection;
}

Ray ConstructRay(float3 arg0, float3 arg1) {
    Ray ret = (Ray)0;
    ret.origin = arg0;
    ret.direction = arg1;
    return ret;
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
    const Ray ray_7 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_7;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Ray ray_6 = (Ray)0;
    float3 color = float3(0.05, 0.05, 0.1);
    Intersection hit_2 = (Intersection)0;
    float3 point_ = (float3)0;
    float3 normal = (float3)0;
    float3 toLight = (float3)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    float2 _e10 = fragCoord_3;
    const Ray _e11 = cameraRay(_e10);
    ray_6 = _e11;
    Ray _e18 = ray_6;
    int _e19 = global.iFrame;
    const Intersection _e20 = hitScene(_e18, _e19);
    hit_2 = _e20;
    Intersection _e22 = hit_2;
    if ((_e22.t < NO_HIT)) {
        {
            Ray _e25 = ray_6;
            Intersection _e27 = hit_2;
            Ray _e29 = ray_6;
            point_ = (_e25.origin + (_e27.t * _e29.direction));
            float3 _e34 = point_;
            Intersection _e35 = hit_2;
            normal = normalize((_e34 - _e35.sphere.center_));
            float3 _e41 = point_;
            toLight = normalize((LIGHT - _e41));
            Intersection _e45 = hit_2;
            float3 _e50 = normal;
            float3 _e51 = toLight;
            color = (_e45.sphere.color * (AMBIENT + ((0.85).xxx * max(dot(_e50, _e51), 0.0))));
        }
    }
    float3 _e58 = color;
    fragColor = float4(_e58.x, _e58.y, _e58.z, 1.0);
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
