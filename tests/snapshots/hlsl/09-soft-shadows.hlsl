// glsl/09-soft-shadows.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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

struct Light {
    float3 position;
    float radius;
    float3 color;
    int _end_pad_0;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const int SAMPLES = int(16);
static const int SPHERES = int(4);
static const float3 AMBIENT = (0.25).xxx;

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static Light light = (Light)0;
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

Sphere ConstructSphere(float3 arg0, float arg1, float3 arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.color = arg2;
    return ret;
}

Light ConstructLight(float3 arg0, float arg1, float3 arg2) {
    Light ret = (Light)0;
    ret.position = arg0;
    ret.radius = arg1;
    ret.color = arg2;
    return ret;
}

void makeScene()
{
    spheres[int(0)] = ConstructSphere(float3(0.0, -41.0, -8.0), 40.0, float3(0.7, 0.7, 0.65));
    spheres[int(1)] = ConstructSphere(float3(-1.3, -0.2, -6.5), 0.8, float3(0.9, 0.4, 0.2));
    spheres[int(2)] = ConstructSphere(float3(0.5, 0.6, -7.0), 0.6, float3(0.3, 0.7, 0.4));
    spheres[int(3)] = ConstructSphere(float3(1.5, -0.6, -5.5), 0.4, float3(0.3, 0.4, 0.9));
    light = ConstructLight(float3(3.0, 5.0, -5.0), 0.6, (0.7).xxx);
    return;
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
    Ray _e5 = ray_1;
    Sphere _e7 = sphere_1;
    f = (_e5.origin - _e7.center_);
    float3 _e11 = f;
    Ray _e12 = ray_1;
    b = dot(_e11, _e12.direction);
    float3 _e16 = f;
    float3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c = (dot(_e16, _e17) - (_e19.radius * _e21.radius));
    float _e26 = b;
    float _e27 = b;
    float _e29 = c;
    disc = ((_e26 * _e27) - _e29);
    float _e32 = disc;
    if ((_e32 > 0.0)) {
        {
            float _e35 = disc;
            root = sqrt(_e35);
            float _e38 = b;
            float _e40 = root;
            t = (-(_e38) - _e40);
            float _e43 = t;
            if ((_e43 > 1e-5)) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b;
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

float3 sampleLight(float3 point_, inout float lightDistance)
{
    float3 point_1 = (float3)0;
    float3 toLight = (float3)0;
    float distance_ = (float)0;
    float sine2_ = (float)0;
    float depth = (float)0;
    float u = (float)0;
    float v_2 = (float)0;
    float cosine_2 = (float)0;
    float chord = (float)0;

    point_1 = point_;
    Light _e4 = light;
    float3 _e6 = point_1;
    toLight = (_e4.position - _e6);
    float3 _e9 = toLight;
    distance_ = length(_e9);
    Light _e12 = light;
    Light _e14 = light;
    float _e17 = distance_;
    float _e18 = distance_;
    sine2_ = ((_e12.radius * _e14.radius) / (_e17 * _e18));
    float _e22 = sine2_;
    float _e25 = sine2_;
    depth = (_e22 / (1.0 + sqrt((1.0 - _e25))));
    const float _e31 = random();
    u = _e31;
    const float _e33 = random();
    v_2 = _e33;
    float _e36 = u;
    float _e37 = depth;
    cosine_2 = (1.0 - (_e36 * _e37));
    float _e41 = sine2_;
    float _e43 = cosine_2;
    float _e44 = cosine_2;
    chord = sqrt(max((_e41 - (1.0 - (_e43 * _e44))), 0.0));
    float _e52 = distance_;
    float _e53 = cosine_2;
    float _e54 = chord;
    lightDistance = (_e52 * (_e53 - _e54));
    float3 _e57 = toLight;
    float _e58 = distance_;
    float _e61 = cosine_2;
    float _e62 = v_2;
    const float3 _e63 = around((_e57 / (_e58).xxx), _e61, _e62);
    return _e63;
}

bool inShadow(Ray ray_2, float distance_1)
{
    Ray ray_3 = (Ray)0;
    float distance_2 = (float)0;
    int i_2 = int(0);

    ray_3 = ray_2;
    distance_2 = distance_1;
    while(true) {
        int _e8 = i_2;
        if (!((_e8 < SPHERES))) {
            break;
        }
        {
            Ray _e11 = ray_3;
            int _e12 = i_2;
            Sphere _e14 = spheres[min(uint(_e12), 3u)];
            const float _e15 = intersectSphere(_e11, _e14);
            float _e16 = distance_2;
            if ((_e15 < _e16)) {
                {
                    return true;
                }
            }
            int _e19 = i_2;
            i_2 = asint(asuint(_e19) + asuint(int(1)));
        }
    }
    return false;
}

Ray ConstructRay(float3 arg0, float3 arg1) {
    Ray ret = (Ray)0;
    ret.origin = arg0;
    ret.direction = arg1;
    return ret;
}

float3 trace(Ray ray_4)
{
    Ray ray_5 = (Ray)0;
    float nearest = NO_HIT;
    int hit = int(-1);
    int i_3 = int(0);
    float t_1 = (float)0;
    float3 point_2 = (float3)0;
    float3 normal = (float3)0;
    float distance_3 = (float)0;
    float3 toLight_1 = (float3)0;
    float3 sum = AMBIENT;
    float cosine_3 = (float)0;

    ray_5 = ray_4;
    while(true) {
        int _e12 = i_3;
        if (!((_e12 < SPHERES))) {
            break;
        }
        {
            Ray _e15 = ray_5;
            int _e16 = i_3;
            Sphere _e18 = spheres[min(uint(_e16), 3u)];
            const float _e19 = intersectSphere(_e15, _e18);
            t_1 = _e19;
            float _e21 = t_1;
            float _e22 = nearest;
            if ((_e21 < _e22)) {
                {
                    float _e24 = t_1;
                    nearest = _e24;
                    int _e25 = i_3;
                    hit = _e25;
                }
            }
            int _e26 = i_3;
            i_3 = asint(asuint(_e26) + asuint(int(1)));
        }
    }
    int _e29 = hit;
    if ((_e29 < int(0))) {
        {
            return float3(0.4, 0.5, 0.7);
        }
    }
    Ray _e36 = ray_5;
    float _e38 = nearest;
    Ray _e39 = ray_5;
    point_2 = (_e36.origin + (_e38 * _e39.direction));
    float3 _e44 = point_2;
    int _e45 = hit;
    Sphere _e47 = spheres[min(uint(_e45), 3u)];
    normal = normalize((_e44 - _e47.center_));
    float3 _e53 = point_2;
    const float3 _e54 = sampleLight(_e53, distance_3);
    toLight_1 = _e54;
    float3 _e57 = normal;
    float3 _e58 = toLight_1;
    cosine_3 = dot(_e57, _e58);
    float _e61 = cosine_3;
    if ((_e61 > 0.0)) {
        {
            float3 _e64 = point_2;
            float3 _e66 = normal;
            float3 _e69 = toLight_1;
            float _e71 = distance_3;
            const bool _e72 = inShadow(ConstructRay((_e64 + (0.001 * _e66)), _e69), _e71);
            if (!(_e72)) {
                {
                    float3 _e74 = sum;
                    Light _e75 = light;
                    float _e77 = cosine_3;
                    sum = (_e74 + (_e75.color * _e77));
                }
            }
        }
    }
    int _e80 = hit;
    Sphere _e82 = spheres[min(uint(_e80), 3u)];
    float3 _e84 = sum;
    return (_e82.color * _e84);
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
    const Ray ray_6 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_6;
}

void mainImage(inout float4 fragColor, float2 fragCoord_4)
{
    float2 fragCoord_5 = (float2)0;
    float3 color = (0.0).xxx;
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
            float3 _e30 = color;
            float _e31 = x_1;
            float _e32 = y_1;
            const Ray _e34 = cameraRay(float2(_e31, _e32));
            const float3 _e35 = trace(_e34);
            color = (_e30 + _e35);
            int _e37 = i_4;
            i_4 = asint(asuint(_e37) + asuint(int(1)));
        }
    }
    float3 _e40 = color;
    float3 _e43 = (_e40 / (16.0).xxx);
    fragColor = float4(_e43.x, _e43.y, _e43.z, 1.0);
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
