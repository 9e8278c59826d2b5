// glsl/14-accelerator.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
};

struct Intersection {
    float t;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    int3 cell;
    int _end_pad_0;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const int3 CELLS = int3(int(11), int(5), int(10));
static const float3 CORNER = float3(-4.125, -1.875, -13.5);
static const float SPACING = 0.75;
static const uint SEED = 7u;
static const float3 AMBIENT = (0.15).xxx;
static const float3 LIGHT = float3(6.0, 8.0, -2.0);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
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

Sphere ConstructSphere(float3 arg0, float arg1) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    return ret;
}

Sphere sphereIn(int3 cell)
{
    int3 cell_1 = (int3)0;
    float radius = (float)0;
    float room = (float)0;
    float x = (float)0;
    float y = (float)0;
    float z = (float)0;

    cell_1 = cell;
    int3 _e6 = cell_1;
    int3 _e9 = cell_1;
    int3 _e12 = cell_1;
    state = (SEED + uint(asint(asuint(_e6.x) + asuint(asint(asuint(int(11)) * asuint(asint(asuint(_e9.y) + asuint(asint(asuint(int(5)) * asuint(_e12.z))))))))));
    const float _e22 = random();
    radius = lerp(0.1, 0.3, _e22);
    float _e26 = radius;
    room = (SPACING - (2.0 * _e26));
    const float _e30 = random();
    x = _e30;
    const float _e32 = random();
    y = _e32;
    const float _e34 = random();
    z = _e34;
    int3 _e36 = cell_1;
    float _e40 = radius;
    float _e43 = room;
    float _e44 = x;
    float _e45 = y;
    float _e46 = z;
    float _e50 = radius;
    const Sphere sphere_3 = ConstructSphere((((CORNER + (SPACING * float3(_e36))) + (_e40).xxx) + (_e43 * float3(_e44, _e45, _e46))), _e50);
    return sphere_3;
}

float3 nextColor()
{
    float r = (float)0;
    float g = (float)0;
    float b = (float)0;

    const float _e0 = random();
    r = _e0;
    const float _e2 = random();
    g = _e2;
    const float _e4 = random();
    b = _e4;
    float _e9 = r;
    float _e10 = g;
    float _e11 = b;
    return (0.95 * ((0.2).xxx + (0.8 * float3(_e9, _e10, _e11))));
}

float intersectSphere(Ray ray, Sphere sphere)
{
    Ray ray_1 = (Ray)0;
    Sphere sphere_1 = (Sphere)0;
    float3 f = (float3)0;
    float b_1 = (float)0;
    float3 closest = (float3)0;
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
    b_1 = dot(_e11, _e12.direction);
    float3 _e16 = f;
    float _e17 = b_1;
    Ray _e18 = ray_1;
    closest = (_e16 - (_e17 * _e18.direction));
    Sphere _e23 = sphere_1;
    Sphere _e25 = sphere_1;
    float3 _e28 = closest;
    float3 _e29 = closest;
    disc = ((_e23.radius * _e25.radius) - dot(_e28, _e29));
    float _e33 = disc;
    if ((_e33 > 0.0)) {
        {
            float _e36 = disc;
            root = sqrt(_e36);
            float _e39 = b_1;
            float _e41 = root;
            t = (-(_e39) - _e41);
            float _e44 = t;
            if ((_e44 > 1e-5)) {
                {
                    float _e47 = t;
                    return _e47;
                }
            }
            float _e48 = b_1;
            float _e50 = root;
            t = (-(_e48) + _e50);
            float _e52 = t;
            if ((_e52 > 1e-5)) {
                {
                    float _e55 = t;
                    return _e55;
                }
            }
        }
    }
    return NO_HIT;
}

Intersection ConstructIntersection(float arg0, int3 arg1) {
    Intersection ret = (Intersection)0;
    ret.t = arg0;
    ret.cell = arg1;
    return ret;
}

int3 naga_f2i32(float3 value) {
    return int3(clamp(value, -2147483600.0, 2147483500.0));
}

Intersection hitScene(Ray ray_2)
{
    Ray ray_3 = (Ray)0;
    float3 low = (float3)0;
    float3 high = (float3)0;
    float3 into = (float3)0;
    float3 outOf = (float3)0;
    float enter = (float)0;
    float leave = (float)0;
    Intersection none = ConstructIntersection(1000000.0, (int(-1)).xxx);
    float3 place = (float3)0;
    int3 cell_2 = (int3)0;
    int3 stride = (int3)0;
    float3 next = (float3)0;
    float3 step_ = (float3)0;
    int i = int(0);
    float t_1 = (float)0;

    ray_3 = ray_2;
    Ray _e5 = ray_3;
    Ray _e8 = ray_3;
    low = ((CORNER - _e5.origin) / _e8.direction);
    Ray _e16 = ray_3;
    Ray _e19 = ray_3;
    high = ((float3(4.125, 1.875, -6.0) - _e16.origin) / _e19.direction);
    float3 _e23 = low;
    float3 _e24 = high;
    into = min(_e23, _e24);
    float3 _e27 = low;
    float3 _e28 = high;
    outOf = max(_e27, _e28);
    float3 _e31 = into;
    float3 _e33 = into;
    float3 _e36 = into;
    enter = max(max(_e31.x, _e33.y), max(_e36.z, 0.0));
    float3 _e42 = outOf;
    float3 _e44 = outOf;
    float3 _e46 = outOf;
    leave = min(_e42.x, min(_e44.y, _e46.z));
    float _e56 = enter;
    float _e57 = leave;
    if ((_e56 >= _e57)) {
        {
            Intersection _e59 = none;
            const Intersection intersection = _e59;
            return intersection;
        }
    }
    Ray _e60 = ray_3;
    float _e62 = enter;
    Ray _e63 = ray_3;
    place = (((_e60.origin + (_e62 * _e63.direction)) - CORNER) / (0.75).xxx);
    float3 _e72 = place;
    cell_2 = clamp(naga_f2i32(floor(_e72)), (int(0)).xxx, int3(int(10), int(4), int(9)));
    Ray _e83 = ray_3;
    stride = naga_f2i32(sign(_e83.direction));
    int3 _e88 = cell_2;
    int3 _e89 = stride;
    Ray _e97 = ray_3;
    Ray _e100 = ray_3;
    next = (((CORNER + (SPACING * float3(asint(asuint(_e88) + asuint(max(_e89, (int(0)).xxx)))))) - _e97.origin) / _e100.direction);
    float3 _e104 = next;
    int3 _e107 = stride;
    next = ((_e107 == (int(0)).xxx) ? (1000000.0).xxx : _e104);
    Ray _e112 = ray_3;
    step_ = ((0.75).xxx / abs(_e112.direction));
    while(true) {
        int _e121 = i;
        if (!((_e121 < int(26)))) {
            break;
        }
        {
            Ray _e125 = ray_3;
            int3 _e126 = cell_2;
            const Sphere _e127 = sphereIn(_e126);
            const float _e128 = intersectSphere(_e125, _e127);
            t_1 = _e128;
            float _e130 = t_1;
            if ((_e130 < NO_HIT)) {
                {
                    float _e132 = t_1;
                    int3 _e133 = cell_2;
                    const Intersection intersection_1 = ConstructIntersection(_e132, _e133);
                    return intersection_1;
                }
            }
            float3 _e135 = next;
            float3 _e137 = next;
            float3 _e140 = next;
            float3 _e142 = next;
            if (((_e135.x < _e137.y) && (_e140.x < _e142.z))) {
                {
                    int3 _e147 = cell_2;
                    int3 _e149 = stride;
                    cell_2.x = asint(asuint(_e147.x) + asuint(_e149.x));
                    float3 _e153 = next;
                    float3 _e155 = step_;
                    next.x = (_e153.x + _e155.x);
                    int3 _e158 = cell_2;
                    int3 _e162 = cell_2;
                    if (((_e158.x < int(0)) || (_e162.x >= int(11)))) {
                        {
                            Intersection _e167 = none;
                            const Intersection intersection_2 = _e167;
                            return intersection_2;
                        }
                    }
                }
            } else {
                float3 _e168 = next;
                float3 _e170 = next;
                if ((_e168.y < _e170.z)) {
                    {
                        int3 _e174 = cell_2;
                        int3 _e176 = stride;
                        cell_2.y = asint(asuint(_e174.y) + asuint(_e176.y));
                        float3 _e180 = next;
                        float3 _e182 = step_;
                        next.y = (_e180.y + _e182.y);
                        int3 _e185 = cell_2;
                        int3 _e189 = cell_2;
                        if (((_e185.y < int(0)) || (_e189.y >= int(5)))) {
                            {
                                Intersection _e194 = none;
                                const Intersection intersection_3 = _e194;
                                return intersection_3;
                            }
                        }
                    }
                } else {
                    {
                        int3 _e196 = cell_2;
                        int3 _e198 = stride;
                        cell_2.z = asint(asuint(_e196.z) + asuint(_e198.z));
                        float3 _e202 = next;
                        float3 _e204 = step_;
                        next.z = (_e202.z + _e204.z);
                        int3 _e207 = cell_2;
                        int3 _e211 = cell_2;
                        if (((_e207.z < int(0)) || (_e211.z >= int(10)))) {
                            {
                                Intersection _e216 = none;
                                const Intersection intersection_4 = _e216;
                                return intersection_4;
                            }
                        }
                    }
                }
            }
            int _e217 = i;
            i = asint(asuint(_e217) + asuint(int(1)));
        }
    }
    Intersection _e220 = none;
    const Intersection intersection_5 = _e220;
    return intersection_5;
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
    float x_1 = (float)0;
    float y_1 = (float)0;

    fragCoord_1 = fragCoord;
    float3 _e5 = global.iResolution;
    float3 _e7 = global.iResolution;
    aspect = (_e5.x / _e7.y);
    float2 _e11 = fragCoord_1;
    float3 _e13 = global.iResolution;
    x_1 = (((_e11.x / _e13.x) * 2.0) - 1.0);
    float2 _e21 = fragCoord_1;
    float3 _e23 = global.iResolution;
    float _e30 = aspect;
    y_1 = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x_1;
    float _e36 = y_1;
    const Ray ray_5 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_5;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Ray ray_4 = (Ray)0;
    float3 color = float3(0.7, 0.8, 0.9);
    Intersection hit = (Intersection)0;
    Sphere sphere_2 = (Sphere)0;
    float3 albedo = (float3)0;
    float3 point_ = (float3)0;
    float3 normal = (float3)0;
    float3 sum = AMBIENT;
    float cosine = (float)0;
    float3 origin = (float3)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    float2 _e8 = fragCoord_3;
    const Ray _e9 = cameraRay(_e8);
    ray_4 = _e9;
    Ray _e16 = ray_4;
    const Intersection _e17 = hitScene(_e16);
    hit = _e17;
    Intersection _e19 = hit;
    if ((_e19.t < NO_HIT)) {
        {
            Intersection _e22 = hit;
            const Sphere _e24 = sphereIn(_e22.cell);
            sphere_2 = _e24;
            const float3 _e26 = nextColor();
            albedo = _e26;
            Ray _e28 = ray_4;
            Intersection _e30 = hit;
            Ray _e32 = ray_4;
            point_ = (_e28.origin + (_e30.t * _e32.direction));
            float3 _e37 = point_;
            Sphere _e38 = sphere_2;
            normal = normalize((_e37 - _e38.center_));
            float3 _e44 = normal;
            float3 _e45 = point_;
            cosine = dot(_e44, normalize((LIGHT - _e45)));
            float _e50 = cosine;
            if ((_e50 > 0.0)) {
                {
                    float3 _e53 = point_;
                    float3 _e55 = normal;
                    origin = (_e53 + (0.001 * _e55));
                    float3 _e59 = origin;
                    float3 _e60 = origin;
                    const Intersection _e64 = hitScene(ConstructRay(_e59, normalize((LIGHT - _e60))));
                    if ((_e64.t == NO_HIT)) {
                        {
                            float3 _e67 = sum;
                            float _e70 = cosine;
                            sum = (_e67 + ((0.85).xxx * _e70));
                        }
                    }
                }
            }
            float3 _e73 = albedo;
            float3 _e74 = sum;
            color = (_e73 * _e74);
        }
    }
    float3 _e76 = color;
    fragColor = float4(_e76.x, _e76.y, _e76.z, 1.0);
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
