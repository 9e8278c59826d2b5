// glsl/15-parallel-rays.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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

static const float NO_HIT = 1000000.0;
static const float WIDTH = 6.0;
static const int SPHERES = int(5);
static const float3 AMBIENT = float3(0.1, 0.1, 0.12);
static const float3 LIGHT = float3(3.0, 5.0, 4.0);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[5] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
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
    spheres[int(0)] = ConstructSphere(float3(-2.0, 0.0, -4.0), 0.7, float3(0.9, 0.3, 0.2));
    spheres[int(1)] = ConstructSphere(float3(-1.0, 0.3, -6.0), 0.7, float3(0.9, 0.6, 0.2));
    spheres[int(2)] = ConstructSphere(float3(0.0, 0.0, -9.0), 0.7, float3(0.9, 0.9, 0.3));
    spheres[int(3)] = ConstructSphere(float3(1.0, -0.3, -13.0), 0.7, float3(0.3, 0.8, 0.4));
    spheres[int(4)] = ConstructSphere(float3(2.0, 0.0, -18.0), 0.7, float3(0.3, 0.5, 0.9));
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
    float3 _e4 = global.iResolution;
    float3 _e6 = global.iResolution;
    aspect = (_e4.x / _e6.y);
    float2 _e10 = fragCoord_1;
    float3 _e12 = global.iResolution;
    x = (((_e10.x / _e12.x) * 2.0) - 1.0);
    float2 _e20 = fragCoord_1;
    float3 _e22 = global.iResolution;
    float _e29 = aspect;
    y = ((((_e20.y / _e22.y) * 2.0) - 1.0) / _e29);
    float _e33 = x;
    float _e34 = y;
    const Ray ray_3 = ConstructRay((3.0 * float3(_e33, _e34, 0.0)), float3(0.0, 0.0, -1.0));
    return ray_3;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Ray ray_2 = (Ray)0;
    float3 color = float3(0.05, 0.05, 0.08);
    float nearest = NO_HIT;
    int hit = int(-1);
    int i = int(0);
    float t_1 = (float)0;
    float3 point_ = (float3)0;
    float3 normal = (float3)0;
    float3 toLight = (float3)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    float2 _e10 = fragCoord_3;
    const Ray _e11 = cameraRay(_e10);
    ray_2 = _e11;
    while(true) {
        int _e23 = i;
        if (!((_e23 < SPHERES))) {
            break;
        }
        {
            Ray _e26 = ray_2;
            int _e27 = i;
            Sphere _e29 = spheres[min(uint(_e27), 4u)];
            const float _e30 = intersectSphere(_e26, _e29);
            t_1 = _e30;
            float _e32 = t_1;
            float _e33 = nearest;
            if ((_e32 < _e33)) {
                {
                    float _e35 = t_1;
                    nearest = _e35;
                    int _e36 = i;
                    hit = _e36;
                }
            }
            int _e37 = i;
            i = asint(asuint(_e37) + asuint(int(1)));
        }
    }
    int _e40 = hit;
    if ((_e40 >= int(0))) {
        {
            Ray _e43 = ray_2;
            float _e45 = nearest;
            Ray _e46 = ray_2;
            point_ = (_e43.origin + (_e45 * _e46.direction));
            float3 _e51 = point_;
            int _e52 = hit;
            Sphere _e54 = spheres[min(uint(_e52), 4u)];
            normal = normalize((_e51 - _e54.center_));
            float3 _e59 = point_;
            toLight = normalize((LIGHT - _e59));
            int _e63 = hit;
            Sphere _e65 = spheres[min(uint(_e63), 4u)];
            float3 _e69 = normal;
            float3 _e70 = toLight;
            color = (_e65.color * (AMBIENT + ((0.9).xxx * max(dot(_e69, _e70), 0.0))));
        }
    }
    float3 _e77 = color;
    fragColor = float4(_e77.x, _e77.y, _e77.z, 1.0);
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
