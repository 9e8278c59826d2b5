// glsl/03-shading.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    int _pad1_0;
    float3 color;
    int _end_pad_0;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const float3 AMBIENT = float3(0.1, 0.1, 0.15);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Light lights[2] = { (Light)0, (Light)0 };
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

Light ConstructLight(float3 arg0, float3 arg1) {
    Light ret = (Light)0;
    ret.position = arg0;
    ret.color = arg1;
    return ret;
}

void makeScene()
{
    lights[int(0)] = ConstructLight(float3(5.0, 5.0, 0.0), float3(0.8, 0.8, 0.7));
    lights[int(1)] = ConstructLight(float3(-6.0, 1.0, -2.0), float3(0.1, 0.1, 0.3));
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

float3 shade(float3 point_, float3 normal, float3 color)
{
    float3 point_1 = (float3)0;
    float3 normal_1 = (float3)0;
    float3 color_1 = (float3)0;
    float3 sum = AMBIENT;
    int i = int(0);
    float3 toLight = (float3)0;

    point_1 = point_;
    normal_1 = normal;
    color_1 = color;
    while(true) {
        int _e11 = i;
        if (!((_e11 < int(2)))) {
            break;
        }
        {
            int _e15 = i;
            Light _e17 = lights[min(uint(_e15), 1u)];
            float3 _e19 = point_1;
            toLight = normalize((_e17.position - _e19));
            float3 _e23 = sum;
            int _e24 = i;
            Light _e26 = lights[min(uint(_e24), 1u)];
            float3 _e28 = normal_1;
            float3 _e29 = toLight;
            sum = (_e23 + (_e26.color * max(dot(_e28, _e29), 0.0)));
            int _e35 = i;
            i = asint(asuint(_e35) + asuint(int(1)));
        }
    }
    float3 _e38 = color_1;
    float3 _e39 = sum;
    return (_e38 * _e39);
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

Sphere ConstructSphere(float3 arg0, float arg1, float3 arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.color = arg2;
    return ret;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Sphere sphere_2 = ConstructSphere(float3(0.0, 0.0, -6.0), 1.5, float3(0.9, 0.6, 0.2));
    Ray ray_2 = (Ray)0;
    float3 color_2 = float3(0.02, 0.02, 0.05);
    float t_1 = (float)0;
    float3 hitPoint = (float3)0;
    float3 normal_2 = (float3)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    float2 _e17 = fragCoord_3;
    const Ray _e18 = cameraRay(_e17);
    ray_2 = _e18;
    Ray _e25 = ray_2;
    Sphere _e26 = sphere_2;
    const float _e27 = intersectSphere(_e25, _e26);
    t_1 = _e27;
    float _e29 = t_1;
    if ((_e29 < NO_HIT)) {
        {
            Ray _e31 = ray_2;
            float _e33 = t_1;
            Ray _e34 = ray_2;
            hitPoint = (_e31.origin + (_e33 * _e34.direction));
            float3 _e39 = hitPoint;
            Sphere _e40 = sphere_2;
            Sphere _e43 = sphere_2;
            normal_2 = ((_e39 - _e40.center_) / (_e43.radius).xxx);
            float3 _e48 = hitPoint;
            float3 _e49 = normal_2;
            Sphere _e50 = sphere_2;
            const float3 _e52 = shade(_e48, _e49, _e50.color);
            color_2 = _e52;
        }
    }
    float3 _e53 = color_2;
    fragColor = float4(_e53.x, _e53.y, _e53.z, 1.0);
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
