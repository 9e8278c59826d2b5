// glsl/11-animation.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
static const float TAU = 6.2831855;
static const int BODIES = int(6);
static const float3 AMBIENT = (0.12).xxx;
static const float3 SUN = float3(0.0, 0.2, -7.0);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere bodies[6] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static float3 lamp = (float3)0;
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

float3 rotate(float3 v, float3 axis, float angle)
{
    float3 v_1 = (float3)0;
    float3 axis_1 = (float3)0;
    float angle_1 = (float)0;
    float c = (float)0;
    float s = (float)0;

    v_1 = v;
    axis_1 = axis;
    angle_1 = angle;
    float _e6 = angle_1;
    c = cos(_e6);
    float _e9 = angle_1;
    s = sin(_e9);
    float _e12 = c;
    float3 _e13 = v_1;
    float _e15 = s;
    float3 _e16 = axis_1;
    float3 _e17 = v_1;
    float _e22 = c;
    float3 _e24 = axis_1;
    float3 _e25 = v_1;
    float3 _e28 = axis_1;
    return (((_e12 * _e13) + (_e15 * cross(_e16, _e17))) + (((1.0 - _e22) * dot(_e24, _e25)) * _e28));
}

float3 rotateAbout(float3 p, float3 pivot, float3 axis_2, float turns)
{
    float3 p_1 = (float3)0;
    float3 pivot_1 = (float3)0;
    float3 axis_3 = (float3)0;
    float turns_1 = (float)0;

    p_1 = p;
    pivot_1 = pivot;
    axis_3 = axis_2;
    turns_1 = turns;
    float3 _e9 = pivot_1;
    float3 _e10 = p_1;
    float3 _e11 = pivot_1;
    float3 _e13 = axis_3;
    float _e14 = turns_1;
    const float3 _e17 = rotate((_e10 - _e11), _e13, (TAU * frac(_e14)));
    return (_e9 + _e17);
}

float3 year(float3 p_2)
{
    float3 p_3 = (float3)0;

    p_3 = p_2;
    float3 _e5 = p_3;
    float _e10 = global.iTime;
    const float3 _e13 = rotateAbout(_e5, SUN, float3(0.0, 1.0, 0.0), (_e10 / 8.0));
    return _e13;
}

float3 month(float3 p_4)
{
    float3 p_5 = (float3)0;

    p_5 = p_4;
    float3 _e4 = p_5;
    float _e13 = global.iTime;
    const float3 _e16 = rotateAbout(_e4, float3(2.0, 0.2, -7.0), float3(0.0, 0.8, 0.6), (_e13 / 2.0));
    const float3 _e17 = year(_e16);
    return _e17;
}

float3 orbit(float3 p_6)
{
    float3 p_7 = (float3)0;

    p_7 = p_6;
    float3 _e4 = p_7;
    int _e13 = global.iFrame;
    const float3 _e17 = rotateAbout(_e4, float3(2.75, 0.2, -7.0), float3(1.0, 0.0, 0.0), (float(_e13) / 60.0));
    const float3 _e18 = month(_e17);
    return _e18;
}

float3 retrograde(float3 p_8)
{
    float3 p_9 = (float3)0;

    p_9 = p_8;
    float3 _e5 = p_9;
    float _e10 = global.iTime;
    const float3 _e14 = rotateAbout(_e5, SUN, float3(0.0, 0.96, -0.28), (-(_e10) / 5.0));
    return _e14;
}

Sphere ConstructSphere(float3 arg0, float arg1, float3 arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.color = arg2;
    return ret;
}

void makeScene()
{
    bodies[int(0)] = ConstructSphere(float3(0.0, 0.2, -7.0), 0.8, float3(1.0, 0.8, 0.3));
    const float3 _e20 = year(float3(2.0, 0.2, -7.0));
    bodies[int(1)] = ConstructSphere(_e20, 0.35, float3(0.3, 0.5, 0.9));
    const float3 _e33 = month(float3(2.75, 0.2, -7.0));
    bodies[int(2)] = ConstructSphere(_e33, 0.15, float3(0.8, 0.8, 0.8));
    const float3 _e46 = orbit(float3(2.75, 0.45, -7.0));
    bodies[int(3)] = ConstructSphere(_e46, 0.06, float3(0.9, 0.3, 0.9));
    const float3 _e59 = retrograde(float3(-1.4, 0.2, -7.0));
    bodies[int(4)] = ConstructSphere(_e59, 0.22, float3(0.9, 0.4, 0.2));
    bodies[int(5)] = ConstructSphere(float3(0.0, -52.0, -8.0), 50.0, float3(0.4, 0.4, 0.5));
    const float3 _e82 = retrograde(float3(3.0, 5.0, -4.0));
    lamp = _e82;
    return;
}

float intersectSphere(Ray ray, Sphere sphere)
{
    Ray ray_1 = (Ray)0;
    Sphere sphere_1 = (Sphere)0;
    float3 f = (float3)0;
    float b = (float)0;
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
    b = dot(_e11, _e12.direction);
    float3 _e16 = f;
    float3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c_1 = (dot(_e16, _e17) - (_e19.radius * _e21.radius));
    float _e26 = b;
    float _e27 = b;
    float _e29 = c_1;
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

bool inShadow(float3 point_, float3 normal)
{
    float3 point_1 = (float3)0;
    float3 normal_1 = (float3)0;
    float3 origin = (float3)0;
    float3 toLight = (float3)0;
    float distance_ = (float)0;
    Ray ray_2 = (Ray)0;
    int i = int(0);

    point_1 = point_;
    normal_1 = normal;
    float3 _e7 = point_1;
    float3 _e9 = normal_1;
    origin = (_e7 + (0.001 * _e9));
    float3 _e13 = lamp;
    float3 _e14 = origin;
    toLight = (_e13 - _e14);
    float3 _e17 = toLight;
    distance_ = length(_e17);
    float3 _e20 = origin;
    float3 _e21 = toLight;
    float _e22 = distance_;
    ray_2 = ConstructRay(_e20, (_e21 / (_e22).xxx));
    while(true) {
        int _e29 = i;
        if (!((_e29 < BODIES))) {
            break;
        }
        {
            Ray _e32 = ray_2;
            int _e33 = i;
            Sphere _e35 = bodies[min(uint(_e33), 5u)];
            const float _e36 = intersectSphere(_e32, _e35);
            float _e37 = distance_;
            if ((_e36 < _e37)) {
                {
                    return true;
                }
            }
            int _e40 = i;
            i = asint(asuint(_e40) + asuint(int(1)));
        }
    }
    return false;
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
    float3 color = float3(0.02, 0.02, 0.06);
    float nearest = NO_HIT;
    int hit = int(-1);
    int i_1 = int(0);
    float t_1 = (float)0;
    float3 point_2 = (float3)0;
    float3 normal_2 = (float3)0;
    float cosine = (float)0;
    float3 sum = AMBIENT;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    float2 _e10 = fragCoord_3;
    const Ray _e11 = cameraRay(_e10);
    ray_3 = _e11;
    while(true) {
        int _e23 = i_1;
        if (!((_e23 < BODIES))) {
            break;
        }
        {
            Ray _e26 = ray_3;
            int _e27 = i_1;
            Sphere _e29 = bodies[min(uint(_e27), 5u)];
            const float _e30 = intersectSphere(_e26, _e29);
            t_1 = _e30;
            float _e32 = t_1;
            float _e33 = nearest;
            if ((_e32 < _e33)) {
                {
                    float _e35 = t_1;
                    nearest = _e35;
                    int _e36 = i_1;
                    hit = _e36;
                }
            }
            int _e37 = i_1;
            i_1 = asint(asuint(_e37) + asuint(int(1)));
        }
    }
    int _e40 = hit;
    if ((_e40 >= int(0))) {
        {
            Ray _e43 = ray_3;
            float _e45 = nearest;
            Ray _e46 = ray_3;
            point_2 = (_e43.origin + (_e45 * _e46.direction));
            float3 _e51 = point_2;
            int _e52 = hit;
            Sphere _e54 = bodies[min(uint(_e52), 5u)];
            normal_2 = normalize((_e51 - _e54.center_));
            float3 _e59 = normal_2;
            float3 _e60 = lamp;
            float3 _e61 = point_2;
            cosine = dot(_e59, normalize((_e60 - _e61)));
            float _e67 = cosine;
            if ((_e67 > 0.0)) {
                {
                    float3 _e70 = point_2;
                    float3 _e71 = normal_2;
                    const bool _e72 = inShadow(_e70, _e71);
                    if (!(_e72)) {
                        {
                            float3 _e74 = sum;
                            float _e77 = cosine;
                            sum = (_e74 + ((0.88).xxx * _e77));
                        }
                    }
                }
            }
            int _e80 = hit;
            Sphere _e82 = bodies[min(uint(_e80), 5u)];
            float3 _e84 = sum;
            color = (_e82.color * _e84);
        }
    }
    float3 _e86 = color;
    fragColor = float4(_e86.x, _e86.y, _e86.z, 1.0);
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
