// glsl/04-many-objects.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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

struct Intersection {
    float t;
    int sphere;
    int _pad2_0;
    int _pad2_1;
    float3 point_;
    int _pad3_0;
    float3 normal;
    int _end_pad_0;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const int SAMPLES = int(4);
static const int SPHERES = int(7);
static const float3 AMBIENT = (0.08).xxx;

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[7] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static Light light = (Light)0;
static float seed = (float)0;
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

float random()
{
    float _e1 = seed;
    seed = (_e1 + 1.0);
    return frac((sin(_e1) * 43758.547));
}

Sphere ConstructSphere(float3 arg0, float arg1, float3 arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.color = arg2;
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
    spheres[int(0)] = ConstructSphere(float3(0.0, -31.0, -8.0), 30.0, float3(0.5, 0.5, 0.45));
    spheres[int(1)] = ConstructSphere(float3(0.5, -0.7, -4.0), 0.3, float3(0.2, 0.8, 0.3));
    spheres[int(2)] = ConstructSphere(float3(0.0, 0.0, -6.0), 1.0, float3(0.9, 0.8, 0.1));
    spheres[int(3)] = ConstructSphere(float3(-1.5, -0.4, -5.0), 0.6, float3(0.9, 0.2, 0.15));
    spheres[int(4)] = ConstructSphere(float3(1.4, -0.5, -4.8), 0.5, float3(0.15, 0.3, 0.9));
    spheres[int(5)] = ConstructSphere(float3(-0.6, 1.1, -5.5), 0.35, float3(0.8, 0.4, 0.8));
    spheres[int(6)] = ConstructSphere(float3(6.8, 10.2, 5.9), 3.0, float3(0.6, 0.6, 0.6));
    light = ConstructLight(float3(4.0, 6.0, 1.0), (0.9).xxx);
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

Intersection nearestHit(Ray ray_2)
{
    Ray ray_3 = (Ray)0;
    Intersection hit = (Intersection)0;
    int i = int(0);
    float t_1 = (float)0;
    int i_1 = int(0);

    ray_3 = ray_2;
    hit.t = NO_HIT;
    hit.sphere = int(-1);
    while(true) {
        int _e11 = i;
        if (!((_e11 < SPHERES))) {
            break;
        }
        {
            Ray _e14 = ray_3;
            int _e15 = i;
            Sphere _e17 = spheres[min(uint(_e15), 6u)];
            const float _e18 = intersectSphere(_e14, _e17);
            t_1 = _e18;
            float _e20 = t_1;
            Intersection _e21 = hit;
            if ((_e20 < _e21.t)) {
                {
                    float _e25 = t_1;
                    hit.t = _e25;
                    int _e27 = i;
                    hit.sphere = _e27;
                }
            }
            int _e28 = i;
            i = asint(asuint(_e28) + asuint(int(1)));
        }
    }
    while(true) {
        int _e33 = i_1;
        if (!((_e33 < SPHERES))) {
            break;
        }
        {
            int _e36 = i_1;
            Intersection _e37 = hit;
            if ((_e36 == _e37.sphere)) {
                {
                    Ray _e41 = ray_3;
                    Intersection _e43 = hit;
                    Ray _e45 = ray_3;
                    hit.point_ = (_e41.origin + (_e43.t * _e45.direction));
                    Intersection _e50 = hit;
                    int _e52 = i_1;
                    Sphere _e54 = spheres[min(uint(_e52), 6u)];
                    int _e57 = i_1;
                    Sphere _e59 = spheres[min(uint(_e57), 6u)];
                    hit.normal = ((_e50.point_ - _e54.center_) / (_e59.radius).xxx);
                }
            }
            int _e63 = i_1;
            i_1 = asint(asuint(_e63) + asuint(int(1)));
        }
    }
    Intersection _e66 = hit;
    const Intersection intersection = _e66;
    return intersection;
}

Ray ConstructRay(float3 arg0, float3 arg1) {
    Ray ret = (Ray)0;
    ret.origin = arg0;
    ret.direction = arg1;
    return ret;
}

bool inShadow(float3 point_, float3 normal)
{
    float3 point_1 = (float3)0;
    float3 normal_1 = (float3)0;
    float3 origin = (float3)0;
    float3 toLight = (float3)0;
    float distance_ = (float)0;
    Ray ray_4 = (Ray)0;
    int i_2 = int(0);

    point_1 = point_;
    normal_1 = normal;
    float3 _e7 = point_1;
    float3 _e9 = normal_1;
    origin = (_e7 + (0.001 * _e9));
    Light _e13 = light;
    float3 _e15 = origin;
    toLight = (_e13.position - _e15);
    float3 _e18 = toLight;
    distance_ = length(_e18);
    float3 _e21 = origin;
    float3 _e22 = toLight;
    float _e23 = distance_;
    ray_4 = ConstructRay(_e21, (_e22 / (_e23).xxx));
    while(true) {
        int _e30 = i_2;
        if (!((_e30 < SPHERES))) {
            break;
        }
        {
            Ray _e33 = ray_4;
            int _e34 = i_2;
            Sphere _e36 = spheres[min(uint(_e34), 6u)];
            const float _e37 = intersectSphere(_e33, _e36);
            float _e38 = distance_;
            if ((_e37 < _e38)) {
                {
                    return true;
                }
            }
            int _e41 = i_2;
            i_2 = asint(asuint(_e41) + asuint(int(1)));
        }
    }
    return false;
}

float3 trace(Ray ray_5)
{
    Ray ray_6 = (Ray)0;
    Intersection hit_1 = (Intersection)0;
    float3 sum = AMBIENT;
    float cosine = (float)0;

    ray_6 = ray_5;
    Ray _e5 = ray_6;
    const Intersection _e6 = nearestHit(_e5);
    hit_1 = _e6;
    Intersection _e8 = hit_1;
    if ((_e8.sphere < int(0))) {
        {
            return float3(0.3, 0.4, 0.6);
        }
    }
    Intersection _e17 = hit_1;
    Light _e19 = light;
    Intersection _e21 = hit_1;
    cosine = dot(_e17.normal, normalize((_e19.position - _e21.point_)));
    float _e27 = cosine;
    if ((_e27 > 0.0)) {
        {
            Intersection _e30 = hit_1;
            Intersection _e32 = hit_1;
            const bool _e34 = inShadow(_e30.point_, _e32.normal);
            if (!(_e34)) {
                {
                    float3 _e36 = sum;
                    Light _e37 = light;
                    float _e39 = cosine;
                    sum = (_e36 + (_e37.color * _e39));
                }
            }
        }
    }
    Intersection _e42 = hit_1;
    Sphere _e45 = spheres[min(uint(_e42.sphere), 6u)];
    float3 _e47 = sum;
    return (_e45.color * _e47);
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
    float3 color = (0.0).xxx;
    int i_3 = int(0);
    float x_1 = (float)0;
    float y_1 = (float)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    seed = 0.0;
    while(true) {
        int _e13 = i_3;
        if (!((_e13 < SAMPLES))) {
            break;
        }
        {
            float2 _e16 = fragCoord_3;
            const float _e18 = random();
            x_1 = ((_e16.x + _e18) - 0.5);
            float2 _e23 = fragCoord_3;
            const float _e25 = random();
            y_1 = ((_e23.y + _e25) - 0.5);
            float3 _e30 = color;
            float _e31 = x_1;
            float _e32 = y_1;
            const Ray _e34 = cameraRay(float2(_e31, _e32));
            const float3 _e35 = trace(_e34);
            color = (_e30 + _e35);
            int _e37 = i_3;
            i_3 = asint(asuint(_e37) + asuint(int(1)));
        }
    }
    float3 _e40 = color;
    float3 _e43 = (_e40 / (4.0).xxx);
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
