// glsl/10-quadrics.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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

struct Quadric {
    float3 origin;
    int _pad1_0;
    float3 axis;
    int _pad2_0;
    float3 q;
    float g;
    float k;
    float low;
    float high;
    int _pad7_0;
    float3 color;
    int _end_pad_0;
};

struct Intersection {
    float t;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float3 normal;
    int _pad2_0;
    float3 color;
    int _end_pad_0;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const int QUADRICS = int(5);
static const float3 AMBIENT = (0.15).xxx;
static const float3 LIGHT = float3(4.0, 6.0, 2.0);
static const float3 LIGHT_COLOR = (0.85).xxx;

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Quadric quadrics[5] = { (Quadric)0, (Quadric)0, (Quadric)0, (Quadric)0, (Quadric)0 };
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

Quadric ConstructQuadric(float3 arg0, float3 arg1, float3 arg2, float arg3, float arg4, float arg5, float arg6, float3 arg7) {
    Quadric ret = (Quadric)0;
    ret.origin = arg0;
    ret.axis = arg1;
    ret.q = arg2;
    ret.g = arg3;
    ret.k = arg4;
    ret.low = arg5;
    ret.high = arg6;
    ret.color = arg7;
    return ret;
}

Quadric ellipsoid(float3 center_, float3 radii, float3 color)
{
    float3 center_1 = (float3)0;
    float3 radii_1 = (float3)0;
    float3 color_1 = (float3)0;

    center_1 = center_;
    radii_1 = radii;
    color_1 = color;
    float3 _e6 = center_1;
    float3 _e12 = radii_1;
    float3 _e13 = radii_1;
    float3 _e19 = radii_1;
    float3 _e22 = radii_1;
    float3 _e24 = color_1;
    const Quadric quadric_4 = ConstructQuadric(_e6, float3(0.0, 0.0, 1.0), ((1.0).xxx / (_e12 * _e13)), 0.0, -1.0, -(_e19.z), _e22.z, _e24);
    return quadric_4;
}

Quadric cylinder(float3 base, float3 axis, float radius, float height, float3 color_2)
{
    float3 base_1 = (float3)0;
    float3 axis_1 = (float3)0;
    float radius_1 = (float)0;
    float height_1 = (float)0;
    float3 color_3 = (float3)0;

    base_1 = base;
    axis_1 = axis;
    radius_1 = radius;
    height_1 = height;
    color_3 = color_2;
    float3 _e10 = base_1;
    float3 _e11 = axis_1;
    float _e17 = radius_1;
    float _e19 = radius_1;
    float _e22 = height_1;
    float3 _e23 = color_3;
    const Quadric quadric_5 = ConstructQuadric(_e10, _e11, float3(1.0, 1.0, 0.0), 0.0, (-(_e17) * _e19), 0.0, _e22, _e23);
    return quadric_5;
}

Quadric cone(float3 apex, float3 axis_2, float radius_2, float height_2, float3 color_4)
{
    float3 apex_1 = (float3)0;
    float3 axis_3 = (float3)0;
    float radius_3 = (float)0;
    float height_3 = (float)0;
    float3 color_5 = (float3)0;
    float slope = (float)0;

    apex_1 = apex;
    axis_3 = axis_2;
    radius_3 = radius_2;
    height_3 = height_2;
    color_5 = color_4;
    float _e10 = radius_3;
    float _e11 = height_3;
    slope = (_e10 / _e11);
    float3 _e14 = apex_1;
    float3 _e15 = axis_3;
    float _e18 = slope;
    float _e20 = slope;
    float _e26 = height_3;
    float3 _e27 = color_5;
    const Quadric quadric_6 = ConstructQuadric(_e14, _e15, float3(1.0, 1.0, (-(_e18) * _e20)), 0.0, 0.0, 0.0, _e26, _e27);
    return quadric_6;
}

Quadric paraboloid(float3 apex_2, float3 axis_4, float radius_4, float height_4, float3 color_6)
{
    float3 apex_3 = (float3)0;
    float3 axis_5 = (float3)0;
    float radius_5 = (float)0;
    float height_5 = (float)0;
    float3 color_7 = (float3)0;

    apex_3 = apex_2;
    axis_5 = axis_4;
    radius_5 = radius_4;
    height_5 = height_4;
    color_7 = color_6;
    float3 _e10 = apex_3;
    float3 _e11 = axis_5;
    float _e17 = radius_5;
    float _e19 = radius_5;
    float _e21 = height_5;
    float _e25 = height_5;
    float3 _e26 = color_7;
    const Quadric quadric_7 = ConstructQuadric(_e10, _e11, float3(1.0, 1.0, 0.0), (((-0.5 * _e17) * _e19) / _e21), 0.0, 0.0, _e25, _e26);
    return quadric_7;
}

Quadric hyperboloid(float3 center_2, float3 axis_6, float waist, float radius_6, float height_6, float3 color_8)
{
    float3 center_3 = (float3)0;
    float3 axis_7 = (float3)0;
    float waist_1 = (float)0;
    float radius_7 = (float)0;
    float height_7 = (float)0;
    float3 color_9 = (float3)0;
    float z = (float)0;
    float slope2_ = (float)0;

    center_3 = center_2;
    axis_7 = axis_6;
    waist_1 = waist;
    radius_7 = radius_6;
    height_7 = height_6;
    color_9 = color_8;
    float _e13 = height_7;
    z = (0.5 * _e13);
    float _e16 = radius_7;
    float _e17 = radius_7;
    float _e19 = waist_1;
    float _e20 = waist_1;
    float _e23 = z;
    float _e24 = z;
    slope2_ = (((_e16 * _e17) - (_e19 * _e20)) / (_e23 * _e24));
    float3 _e28 = center_3;
    float3 _e29 = axis_7;
    float _e32 = slope2_;
    float _e36 = waist_1;
    float _e38 = waist_1;
    float _e40 = z;
    float _e42 = z;
    float3 _e43 = color_9;
    const Quadric quadric_8 = ConstructQuadric(_e28, _e29, float3(1.0, 1.0, -(_e32)), 0.0, (-(_e36) * _e38), -(_e40), _e42, _e43);
    return quadric_8;
}

void makeScene()
{
    const Quadric _e15 = ellipsoid(float3(-2.0, 0.5, -7.0), float3(0.9, 0.5, 0.6), float3(0.9, 0.3, 0.3));
    quadrics[int(0)] = _e15;
    const Quadric _e32 = cylinder(float3(-0.9, -1.0, -5.2), float3(0.0, 1.0, 0.0), 0.4, 0.8, float3(0.3, 0.7, 0.9));
    quadrics[int(1)] = _e32;
    const Quadric _e49 = cone(float3(0.3, 0.9, -6.5), float3(0.0, -1.0, 0.0), 0.7, 1.9, float3(0.9, 0.7, 0.2));
    quadrics[int(2)] = _e49;
    const Quadric _e66 = paraboloid(float3(1.1, -0.9, -5.0), float3(0.28, 0.96, 0.0), 0.5, 0.7, float3(0.5, 0.9, 0.4));
    quadrics[int(3)] = _e66;
    const Quadric _e84 = hyperboloid(float3(2.3, 0.0, -7.5), float3(0.0, 1.0, 0.0), 0.4, 0.8, 2.0, float3(0.7, 0.5, 0.9));
    quadrics[int(4)] = _e84;
    return;
}

float3x3 frame(float3 axis_8)
{
    float3 axis_9 = (float3)0;
    float3 local = (float3)0;
    float3 x = (float3)0;

    axis_9 = axis_8;
    float3 _e2 = axis_9;
    if ((abs(_e2.z) > 0.9)) {
        local = float3(1.0, 0.0, 0.0);
    } else {
        float3 _e11 = axis_9;
        local = normalize(cross(_e11, float3(0.0, 0.0, 1.0)));
    }
    float3 _e19 = local;
    x = _e19;
    float3 _e21 = x;
    float3 _e22 = axis_9;
    float3 _e23 = x;
    float3 _e24 = cross(_e22, _e23);
    float3 _e25 = axis_9;
    return float3x3(float3(_e21.x, _e21.y, _e21.z), float3(_e24.x, _e24.y, _e24.z), float3(_e25.x, _e25.y, _e25.z));
}

float intersectQuadric(Ray ray, Quadric quadric, float3x3 frame_1)
{
    Ray ray_1 = (Ray)0;
    Quadric quadric_1 = (Quadric)0;
    float3x3 frame_2 = (float3x3)0;
    float3 d = (float3)0;
    float3 far = (float3)0;
    float ahead = (float)0;
    float3 o = (float3)0;
    float a = (float)0;
    float b = (float)0;
    float c = (float)0;
    float disc = (float)0;
    float local_1 = (float)0;
    float q = (float)0;
    float local_2 = (float)0;
    float t0_ = (float)0;
    float local_3 = (float)0;
    float t1_ = (float)0;
    float t = (float)0;
    float z0_ = (float)0;
    float z1_ = (float)0;

    ray_1 = ray;
    quadric_1 = quadric;
    frame_2 = frame_1;
    Ray _e7 = ray_1;
    float3x3 _e9 = frame_2;
    d = mul(_e9, _e7.direction);
    Ray _e12 = ray_1;
    Quadric _e14 = quadric_1;
    float3x3 _e17 = frame_2;
    far = mul(_e17, (_e12.origin - _e14.origin));
    float3 _e20 = far;
    float3 _e21 = d;
    ahead = -(dot(_e20, _e21));
    float3 _e25 = far;
    float _e26 = ahead;
    float3 _e27 = d;
    o = (_e25 + (_e26 * _e27));
    Quadric _e31 = quadric_1;
    float3 _e33 = d;
    float3 _e35 = d;
    a = dot((_e31.q * _e33), _e35);
    Quadric _e38 = quadric_1;
    float3 _e40 = d;
    float3 _e42 = o;
    Quadric _e44 = quadric_1;
    float3 _e46 = d;
    b = (dot((_e38.q * _e40), _e42) + (_e44.g * _e46.z));
    Quadric _e51 = quadric_1;
    float3 _e53 = o;
    float3 _e55 = o;
    Quadric _e58 = quadric_1;
    float3 _e61 = o;
    Quadric _e65 = quadric_1;
    c = ((dot((_e51.q * _e53), _e55) + ((2.0 * _e58.g) * _e61.z)) + _e65.k);
    float _e69 = b;
    float _e70 = b;
    float _e72 = a;
    float _e73 = c;
    disc = ((_e69 * _e70) - (_e72 * _e73));
    float _e77 = disc;
    if ((_e77 < 0.0)) {
        {
            return NO_HIT;
        }
    }
    float _e80 = b;
    if ((_e80 > 0.0)) {
        float _e83 = b;
        float _e85 = disc;
        local_1 = (-(_e83) - sqrt(_e85));
    } else {
        float _e88 = b;
        float _e90 = disc;
        local_1 = (-(_e88) + sqrt(_e90));
    }
    float _e94 = local_1;
    q = _e94;
    float _e96 = q;
    if ((_e96 == 0.0)) {
        local_2 = NO_HIT;
    } else {
        float _e99 = c;
        float _e100 = q;
        local_2 = (_e99 / _e100);
    }
    float _e103 = local_2;
    t0_ = _e103;
    float _e105 = a;
    if ((_e105 == 0.0)) {
        local_3 = NO_HIT;
    } else {
        float _e108 = q;
        float _e109 = a;
        local_3 = (_e108 / _e109);
    }
    float _e112 = local_3;
    t1_ = _e112;
    float _e114 = t0_;
    float _e115 = t1_;
    if ((_e114 > _e115)) {
        {
            float _e117 = t0_;
            t = _e117;
            float _e119 = t1_;
            t0_ = _e119;
            float _e120 = t;
            t1_ = _e120;
        }
    }
    float3 _e121 = o;
    float _e123 = t0_;
    float3 _e124 = d;
    z0_ = (_e121.z + (_e123 * _e124.z));
    float _e129 = ahead;
    float _e130 = t0_;
    float _e134 = z0_;
    Quadric _e135 = quadric_1;
    float _e139 = z0_;
    Quadric _e140 = quadric_1;
    if (((((_e129 + _e130) > 0.001) && (_e134 >= _e135.low)) && (_e139 <= _e140.high))) {
        {
            float _e144 = ahead;
            float _e145 = t0_;
            return (_e144 + _e145);
        }
    }
    float3 _e147 = o;
    float _e149 = t1_;
    float3 _e150 = d;
    z1_ = (_e147.z + (_e149 * _e150.z));
    float _e155 = ahead;
    float _e156 = t1_;
    float _e160 = z1_;
    Quadric _e161 = quadric_1;
    float _e165 = z1_;
    Quadric _e166 = quadric_1;
    if (((((_e155 + _e156) > 0.001) && (_e160 >= _e161.low)) && (_e165 <= _e166.high))) {
        {
            float _e170 = ahead;
            float _e171 = t1_;
            return (_e170 + _e171);
        }
    }
    return NO_HIT;
}

float3 normalOf(float3 point_, Quadric quadric_2, float3x3 frame_3)
{
    float3 point_1 = (float3)0;
    Quadric quadric_3 = (Quadric)0;
    float3x3 frame_4 = (float3x3)0;
    float3 p = (float3)0;

    point_1 = point_;
    quadric_3 = quadric_2;
    frame_4 = frame_3;
    float3 _e6 = point_1;
    Quadric _e7 = quadric_3;
    float3x3 _e10 = frame_4;
    p = mul(_e10, (_e6 - _e7.origin));
    float3x3 _e13 = frame_4;
    Quadric _e14 = quadric_3;
    float3 _e16 = p;
    Quadric _e20 = quadric_3;
    return normalize(mul(((_e14.q * _e16) + float3(0.0, 0.0, _e20.g)), _e13));
}

Intersection ConstructIntersection(float arg0, float3 arg1, float3 arg2) {
    Intersection ret = (Intersection)0;
    ret.t = arg0;
    ret.normal = arg1;
    ret.color = arg2;
    return ret;
}

Intersection nearestHit(Ray ray_2)
{
    Ray ray_3 = (Ray)0;
    Intersection hit = ConstructIntersection(1000000.0, (0.0).xxx, (0.0).xxx);
    int i = int(0);
    float3x3 f = (float3x3)0;
    float t_1 = (float)0;
    float t_2 = (float)0;

    ray_3 = ray_2;
    while(true) {
        int _e13 = i;
        if (!((_e13 < QUADRICS))) {
            break;
        }
        {
            int _e16 = i;
            Quadric _e18 = quadrics[min(uint(_e16), 4u)];
            const float3x3 _e20 = frame(_e18.axis);
            f = _e20;
            Ray _e22 = ray_3;
            int _e23 = i;
            Quadric _e25 = quadrics[min(uint(_e23), 4u)];
            float3x3 _e26 = f;
            const float _e27 = intersectQuadric(_e22, _e25, _e26);
            t_1 = _e27;
            float _e29 = t_1;
            Intersection _e30 = hit;
            if ((_e29 < _e30.t)) {
                {
                    float _e34 = t_1;
                    hit.t = _e34;
                    Ray _e36 = ray_3;
                    float _e38 = t_1;
                    Ray _e39 = ray_3;
                    int _e43 = i;
                    Quadric _e45 = quadrics[min(uint(_e43), 4u)];
                    float3x3 _e46 = f;
                    const float3 _e47 = normalOf((_e36.origin + (_e38 * _e39.direction)), _e45, _e46);
                    hit.normal = _e47;
                    int _e49 = i;
                    Quadric _e51 = quadrics[min(uint(_e49), 4u)];
                    hit.color = _e51.color;
                }
            }
            int _e53 = i;
            i = asint(asuint(_e53) + asuint(int(1)));
        }
    }
    Ray _e57 = ray_3;
    Ray _e61 = ray_3;
    t_2 = ((-1.0 - _e57.origin.y) / _e61.direction.y);
    float _e66 = t_2;
    float _e69 = t_2;
    Intersection _e70 = hit;
    if (((_e66 > 0.001) && (_e69 < _e70.t))) {
        {
            float _e74 = t_2;
            hit = ConstructIntersection(_e74, float3(0.0, 1.0, 0.0), (0.5).xxx);
        }
    }
    Intersection _e82 = hit;
    Ray _e84 = ray_3;
    if ((dot(_e82.normal, _e84.direction) > 0.0)) {
        {
            Intersection _e90 = hit;
            hit.normal = -(_e90.normal);
        }
    }
    Intersection _e93 = hit;
    const Intersection intersection = _e93;
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
    float x_1 = (float)0;
    float y = (float)0;

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
    y = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x_1;
    float _e36 = y;
    const Ray ray_5 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_5;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Ray ray_4 = (Ray)0;
    float3 color_10 = float3(0.6, 0.7, 0.9);
    Intersection hit_1 = (Intersection)0;
    float3 point_2 = (float3)0;
    float3 toLight = (float3)0;
    float distance_ = (float)0;
    float cosine = (float)0;
    float3 sum = AMBIENT;
    Ray shadow = (Ray)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    float2 _e9 = fragCoord_3;
    const Ray _e10 = cameraRay(_e9);
    ray_4 = _e10;
    Ray _e17 = ray_4;
    const Intersection _e18 = nearestHit(_e17);
    hit_1 = _e18;
    Intersection _e20 = hit_1;
    if ((_e20.t < NO_HIT)) {
        {
            Ray _e23 = ray_4;
            Intersection _e25 = hit_1;
            Ray _e27 = ray_4;
            point_2 = (_e23.origin + (_e25.t * _e27.direction));
            float3 _e32 = point_2;
            Intersection _e34 = hit_1;
            toLight = (LIGHT - (_e32 + (0.001 * _e34.normal)));
            float3 _e40 = toLight;
            distance_ = length(_e40);
            Intersection _e43 = hit_1;
            float3 _e45 = point_2;
            cosine = dot(_e43.normal, normalize((LIGHT - _e45)));
            float _e51 = cosine;
            if ((_e51 > 0.0)) {
                {
                    float3 _e54 = point_2;
                    Intersection _e56 = hit_1;
                    float3 _e60 = toLight;
                    float _e61 = distance_;
                    shadow = ConstructRay((_e54 + (0.001 * _e56.normal)), (_e60 / (_e61).xxx));
                    Ray _e66 = shadow;
                    const Intersection _e67 = nearestHit(_e66);
                    float _e69 = distance_;
                    if ((_e67.t > _e69)) {
                        {
                            float3 _e71 = sum;
                            float _e72 = cosine;
                            sum = (_e71 + (LIGHT_COLOR * _e72));
                        }
                    }
                }
            }
            Intersection _e75 = hit_1;
            float3 _e77 = sum;
            color_10 = (_e75.color * _e77);
        }
    }
    float3 _e79 = color_10;
    fragColor = float4(_e79.x, _e79.y, _e79.z, 1.0);
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
