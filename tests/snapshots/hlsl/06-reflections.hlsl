// glsl/06-reflections.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const float EPSILON = 0.001;
static const int SPHERES = int(4);
static const int MAX_DEPTH = int(100);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

Sphere ConstructSphere(float3 arg0, float arg1, float3 arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.color = arg2;
    return ret;
}

void makeScene()
{
    spheres[int(0)] = ConstructSphere(float3(-1.3, -0.4, -5.2), 0.6, float3(0.9, 0.6, 0.6));
    spheres[int(1)] = ConstructSphere(float3(0.0, 0.0, -7.0), 1.2, float3(0.95, 0.93, 0.88));
    spheres[int(2)] = ConstructSphere(float3(0.2, -0.6, -3.6), 0.3, float3(0.7, 0.9, 0.7));
    spheres[int(3)] = ConstructSphere(float3(1.2, 0.5, -5.0), 0.7, float3(0.6, 0.7, 0.95));
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
    return (((1.0 - _e10) * float3(0.9, 0.5, 0.25)) + (_e17 * float3(0.1, 0.2, 0.5)));
}

float intersectSphere(Ray ray, Sphere sphere, float tMin)
{
    Ray ray_1 = (Ray)0;
    Sphere sphere_1 = (Sphere)0;
    float tMin_1 = (float)0;
    float3 f = (float3)0;
    float b = (float)0;
    float c = (float)0;
    float disc = (float)0;
    float root = (float)0;
    float t = (float)0;

    ray_1 = ray;
    sphere_1 = sphere;
    tMin_1 = tMin;
    Ray _e7 = ray_1;
    Sphere _e9 = sphere_1;
    f = (_e7.origin - _e9.center_);
    float3 _e13 = f;
    Ray _e14 = ray_1;
    b = dot(_e13, _e14.direction);
    float3 _e18 = f;
    float3 _e19 = f;
    Sphere _e21 = sphere_1;
    Sphere _e23 = sphere_1;
    c = (dot(_e18, _e19) - (_e21.radius * _e23.radius));
    float _e28 = b;
    float _e29 = b;
    float _e31 = c;
    disc = ((_e28 * _e29) - _e31);
    float _e34 = disc;
    if ((_e34 > 0.0)) {
        {
            float _e37 = disc;
            root = sqrt(_e37);
            float _e40 = b;
            float _e42 = root;
            t = (-(_e40) - _e42);
            float _e45 = t;
            float _e46 = tMin_1;
            if ((_e45 > _e46)) {
                {
                    float _e48 = t;
                    return _e48;
                }
            }
            float _e49 = b;
            float _e51 = root;
            t = (-(_e49) + _e51);
            float _e53 = t;
            float _e54 = tMin_1;
            if ((_e53 > _e54)) {
                {
                    float _e56 = t;
                    return _e56;
                }
            }
        }
    }
    return NO_HIT;
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
    const Ray ray_3 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_3;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Ray ray_2 = (Ray)0;
    float3 color = (0.0).xxx;
    float3 throughput = (1.0).xxx;
    int depth = int(0);
    float nearest = (float)0;
    int hit = (int)0;
    int i = (int)0;
    float t_1 = (float)0;
    float3 point_ = (float3)0;
    float3 normal = (float3)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    float2 _e10 = fragCoord_3;
    const Ray _e11 = cameraRay(_e10);
    ray_2 = _e11;
    while(true) {
        int _e21 = depth;
        if (!((_e21 < MAX_DEPTH))) {
            break;
        }
        {
            nearest = NO_HIT;
            hit = int(-1);
            i = int(0);
            while(true) {
                int _e29 = i;
                if (!((_e29 < SPHERES))) {
                    break;
                }
                {
                    Ray _e32 = ray_2;
                    int _e33 = i;
                    Sphere _e35 = spheres[min(uint(_e33), 3u)];
                    const float _e36 = intersectSphere(_e32, _e35, EPSILON);
                    t_1 = _e36;
                    float _e38 = t_1;
                    float _e39 = nearest;
                    if ((_e38 < _e39)) {
                        {
                            float _e41 = t_1;
                            nearest = _e41;
                            int _e42 = i;
                            hit = _e42;
                        }
                    }
                    int _e43 = i;
                    i = asint(asuint(_e43) + asuint(int(1)));
                }
            }
            int _e46 = hit;
            if ((_e46 < int(0))) {
                {
                    float3 _e49 = throughput;
                    Ray _e50 = ray_2;
                    const float3 _e52 = sky(_e50.direction);
                    color = (_e49 * _e52);
                    break;
                }
            }
            Ray _e54 = ray_2;
            float _e56 = nearest;
            Ray _e57 = ray_2;
            point_ = (_e54.origin + (_e56 * _e57.direction));
            float3 _e62 = point_;
            int _e63 = hit;
            Sphere _e65 = spheres[min(uint(_e63), 3u)];
            normal = normalize((_e62 - _e65.center_));
            float3 _e70 = throughput;
            int _e71 = hit;
            Sphere _e73 = spheres[min(uint(_e71), 3u)];
            throughput = (_e70 * _e73.color);
            float3 _e76 = point_;
            Ray _e77 = ray_2;
            float3 _e79 = normal;
            ray_2 = ConstructRay(_e76, reflect(_e77.direction, _e79));
            int _e82 = depth;
            depth = asint(asuint(_e82) + asuint(int(1)));
        }
    }
    float3 _e85 = color;
    fragColor = float4(_e85.x, _e85.y, _e85.z, 1.0);
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
