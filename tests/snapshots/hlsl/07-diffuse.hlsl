// glsl/07-diffuse.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    float3 albedo;
    int _end_pad_0;
};

struct Sphere {
    float3 center_;
    float radius;
    Material material;
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
static const float PI = 3.1415927;
static const int SPHERES = int(4);
static const int LIGHTS = int(2);
static const float3 AMBIENT = float3(0.3, 0.35, 0.45);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static Light lights[2] = { (Light)0, (Light)0 };
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

Material ConstructMaterial(float3 arg0) {
    Material ret = (Material)0;
    ret.albedo = arg0;
    return ret;
}

Sphere ConstructSphere(float3 arg0, float arg1, Material arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.material = arg2;
    return ret;
}

Light ConstructLight(float3 arg0, float3 arg1) {
    Light ret = (Light)0;
    ret.position = arg0;
    ret.color = arg1;
    return ret;
}

void makeScene()
{
    spheres[int(0)] = ConstructSphere(float3(0.0, -101.0, -7.0), 100.0, ConstructMaterial(float3(0.5, 0.5, 0.5)));
    spheres[int(1)] = ConstructSphere(float3(-1.9, 0.0, -7.5), 1.0, ConstructMaterial(float3(0.8, 0.25, 0.2)));
    spheres[int(2)] = ConstructSphere(float3(0.2, -0.1, -6.5), 0.9, ConstructMaterial(float3(0.75, 0.75, 0.75)));
    spheres[int(3)] = ConstructSphere(float3(1.9, -0.3, -6.0), 0.7, ConstructMaterial(float3(0.2, 0.45, 0.8)));
    lights[int(0)] = ConstructLight(float3(4.0, 6.0, -2.0), float3(9.0, 8.5, 7.5));
    lights[int(1)] = ConstructLight(float3(-5.0, 3.0, 0.0), float3(2.0, 2.5, 4.0));
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

bool inShadow(float3 point_, float3 normal, Light light)
{
    float3 point_1 = (float3)0;
    float3 normal_1 = (float3)0;
    Light light_1 = (Light)0;
    float3 origin = (float3)0;
    float3 toLight = (float3)0;
    float distance_ = (float)0;
    Ray ray_2 = (Ray)0;
    int i = int(0);

    point_1 = point_;
    normal_1 = normal;
    light_1 = light;
    float3 _e8 = point_1;
    float3 _e10 = normal_1;
    origin = (_e8 + (0.001 * _e10));
    Light _e14 = light_1;
    float3 _e16 = origin;
    toLight = (_e14.position - _e16);
    float3 _e19 = toLight;
    distance_ = length(_e19);
    float3 _e22 = origin;
    float3 _e23 = toLight;
    float _e24 = distance_;
    ray_2 = ConstructRay(_e22, (_e23 / (_e24).xxx));
    while(true) {
        int _e31 = i;
        if (!((_e31 < SPHERES))) {
            break;
        }
        {
            Ray _e34 = ray_2;
            int _e35 = i;
            Sphere _e37 = spheres[min(uint(_e35), 3u)];
            const float _e38 = intersectSphere(_e34, _e37);
            float _e39 = distance_;
            if ((_e38 < _e39)) {
                {
                    return true;
                }
            }
            int _e42 = i;
            i = asint(asuint(_e42) + asuint(int(1)));
        }
    }
    return false;
}

float3 brdf(Material material)
{
    Material material_1 = (Material)0;

    material_1 = material;
    Material _e2 = material_1;
    return (_e2.albedo / (3.1415927).xxx);
}

float3 shade(float3 point_2, float3 normal_2, Material material_2)
{
    float3 point_3 = (float3)0;
    float3 normal_3 = (float3)0;
    Material material_3 = (Material)0;
    float3 radiance = (float3)0;
    int i_1 = int(0);
    float cosine = (float)0;

    point_3 = point_2;
    normal_3 = normal_2;
    material_3 = material_2;
    Material _e9 = material_3;
    radiance = (AMBIENT * _e9.albedo);
    while(true) {
        int _e15 = i_1;
        if (!((_e15 < LIGHTS))) {
            break;
        }
        {
            float3 _e18 = normal_3;
            int _e19 = i_1;
            Light _e21 = lights[min(uint(_e19), 1u)];
            float3 _e23 = point_3;
            cosine = dot(_e18, normalize((_e21.position - _e23)));
            float _e28 = cosine;
            if ((_e28 > 0.0)) {
                {
                    float3 _e31 = point_3;
                    float3 _e32 = normal_3;
                    int _e33 = i_1;
                    Light _e35 = lights[min(uint(_e33), 1u)];
                    const bool _e36 = inShadow(_e31, _e32, _e35);
                    if (!(_e36)) {
                        {
                            float3 _e38 = radiance;
                            int _e39 = i_1;
                            Light _e41 = lights[min(uint(_e39), 1u)];
                            Material _e43 = material_3;
                            const float3 _e44 = brdf(_e43);
                            float _e46 = cosine;
                            radiance = (_e38 + ((_e41.color * _e44) * _e46));
                        }
                    }
                }
            }
            int _e49 = i_1;
            i_1 = asint(asuint(_e49) + asuint(int(1)));
        }
    }
    float3 _e52 = radiance;
    return _e52;
}

float3 toneMap(float3 color)
{
    float3 color_1 = (float3)0;

    color_1 = color;
    float3 _e2 = color_1;
    float3 _e3 = color_1;
    return (_e2 / (_e3 + (1.0).xxx));
}

float3 gammaCorrect(float3 color_2)
{
    float3 color_3 = (float3)0;

    color_3 = color_2;
    float3 _e2 = color_3;
    return pow(_e2, (0.45454544).xxx);
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
    const Ray ray_4 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_4;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Ray ray_3 = (Ray)0;
    float3 color_4 = float3(0.5, 0.6, 0.8);
    float nearest = NO_HIT;
    int hit = int(-1);
    int i_2 = int(0);
    float t_1 = (float)0;
    float3 point_4 = (float3)0;
    float3 normal_4 = (float3)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    float2 _e8 = fragCoord_3;
    const Ray _e9 = cameraRay(_e8);
    ray_3 = _e9;
    while(true) {
        int _e21 = i_2;
        if (!((_e21 < SPHERES))) {
            break;
        }
        {
            Ray _e24 = ray_3;
            int _e25 = i_2;
            Sphere _e27 = spheres[min(uint(_e25), 3u)];
            const float _e28 = intersectSphere(_e24, _e27);
            t_1 = _e28;
            float _e30 = t_1;
            float _e31 = nearest;
            if ((_e30 < _e31)) {
                {
                    float _e33 = t_1;
                    nearest = _e33;
                    int _e34 = i_2;
                    hit = _e34;
                }
            }
            int _e35 = i_2;
            i_2 = asint(asuint(_e35) + asuint(int(1)));
        }
    }
    int _e38 = hit;
    if ((_e38 >= int(0))) {
        {
            Ray _e41 = ray_3;
            float _e43 = nearest;
            Ray _e44 = ray_3;
            point_4 = (_e41.origin + (_e43 * _e44.direction));
            float3 _e49 = point_4;
            int _e50 = hit;
            Sphere _e52 = spheres[min(uint(_e50), 3u)];
            normal_4 = normalize((_e49 - _e52.center_));
            float3 _e57 = point_4;
            float3 _e58 = normal_4;
            int _e59 = hit;
            Sphere _e61 = spheres[min(uint(_e59), 3u)];
            const float3 _e63 = shade(_e57, _e58, _e61.material);
            color_4 = _e63;
        }
    }
    float3 _e64 = color_4;
    const float3 _e65 = toneMap(_e64);
    const float3 _e66 = gammaCorrect(_e65);
    fragColor = float4(_e66.x, _e66.y, _e66.z, 1.0);
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
