// glsl/09-soft-shadows.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// language: metal2.0
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct type_4 {
    metal::float4 inner[4];
};
struct type_5 {
    metal::float3 inner[4];
};
struct ToyproofFrame {
    metal::packed_float3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    char _pad5[4];
    type_4 iChannelTime;
    type_5 iChannelResolution;
    metal::float4 iMouse;
    metal::float4 iDate;
    float iSampleRate;
    char _pad10[12];
};
struct Ray {
    metal::float3 origin;
    metal::float3 direction;
};
struct Sphere {
    metal::packed_float3 center;
    float radius;
    metal::float3 color;
};
struct Light {
    metal::packed_float3 position;
    float radius;
    metal::float3 color;
};
struct type_6 {
    Sphere inner[4];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant int SAMPLES = 16;
constant int SPHERES = 4;
constant metal::float3 AMBIENT = metal::float3(0.25);

uint pcg(
    uint v
) {
    uint v_1 = {};
    uint s = {};
    uint word = {};
    v_1 = v;
    uint _e2 = v_1;
    s = (_e2 * 747796405u) + 2891336453u;
    uint _e8 = s;
    uint _e9 = s;
    uint _e15 = s;
    word = ((_e8 >> ((_e9 >> 28u) + 4u)) ^ _e15) * 277803737u;
    uint _e20 = word;
    uint _e23 = word;
    return (_e20 >> 22u) ^ _e23;
}

float random(
    thread uint& state
) {
    uint _e1 = state;
    uint _e2 = pcg(_e1);
    state = _e2;
    uint _e3 = state;
    return static_cast<float>(_e3 >> 8u) / 16777216.0;
}

uint naga_f2u32(float value) {
    return static_cast<uint>(metal::clamp(value, 0.0, 4294967000.0));
}

void startSample(
    metal::float2 fragCoord,
    int i,
    thread uint& state
) {
    metal::float2 fragCoord_1 = {};
    int i_1 = {};
    fragCoord_1 = fragCoord;
    i_1 = i;
    metal::float2 _e5 = fragCoord_1;
    metal::float2 _e8 = fragCoord_1;
    int _e11 = i_1;
    uint _e13 = pcg(static_cast<uint>(_e11));
    uint _e15 = pcg(naga_f2u32(_e8.y) + _e13);
    uint _e17 = pcg(naga_f2u32(_e5.x) + _e15);
    state = _e17;
    return;
}

void makeScene(
    thread type_6& spheres,
    thread Light& light
) {
    spheres.inner[0] = Sphere {metal::float3(0.0, -41.0, -8.0), 40.0, metal::float3(0.7, 0.7, 0.65)};
    spheres.inner[1] = Sphere {metal::float3(-1.3, -0.2, -6.5), 0.8, metal::float3(0.9, 0.4, 0.2)};
    spheres.inner[2] = Sphere {metal::float3(0.5, 0.6, -7.0), 0.6, metal::float3(0.3, 0.7, 0.4)};
    spheres.inner[3] = Sphere {metal::float3(1.5, -0.6, -5.5), 0.4, metal::float3(0.3, 0.4, 0.9)};
    light = Light {metal::float3(3.0, 5.0, -5.0), 0.6, metal::float3(0.7)};
    return;
}

float intersectSphere(
    Ray ray,
    Sphere sphere
) {
    Ray ray_1 = {};
    Sphere sphere_1 = {};
    metal::float3 f = {};
    float b = {};
    float c = {};
    float disc = {};
    float root = {};
    float t = {};
    ray_1 = ray;
    sphere_1 = sphere;
    Ray _e5 = ray_1;
    Sphere _e7 = sphere_1;
    f = _e5.origin - _e7.center;
    metal::float3 _e11 = f;
    Ray _e12 = ray_1;
    b = metal::dot(_e11, _e12.direction);
    metal::float3 _e16 = f;
    metal::float3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c = metal::dot(_e16, _e17) - (_e19.radius * _e21.radius);
    float _e26 = b;
    float _e27 = b;
    float _e29 = c;
    disc = (_e26 * _e27) - _e29;
    float _e32 = disc;
    if (_e32 > 0.0) {
        {
            float _e35 = disc;
            root = metal::sqrt(_e35);
            float _e38 = b;
            float _e40 = root;
            t = -(_e38) - _e40;
            float _e43 = t;
            if (_e43 > 0.00001) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b;
            float _e49 = root;
            t = -(_e47) + _e49;
            float _e51 = t;
            if (_e51 > 0.00001) {
                {
                    float _e54 = t;
                    return _e54;
                }
            }
        }
    }
    return NO_HIT;
}

metal::float3 around(
    metal::float3 w,
    float cosine,
    float turn
) {
    metal::float3 w_1 = {};
    float cosine_1 = {};
    float turn_1 = {};
    metal::float3 local = {};
    metal::float3 up = {};
    metal::float3 a = {};
    metal::float3 b_1 = {};
    float sine = {};
    float phi = {};
    w_1 = w;
    cosine_1 = cosine;
    turn_1 = turn;
    metal::float3 _e6 = w_1;
    if (metal::abs(_e6.y) > 0.9) {
        local = metal::float3(1.0, 0.0, 0.0);
    } else {
        local = metal::float3(0.0, 1.0, 0.0);
    }
    metal::float3 _e20 = local;
    up = _e20;
    metal::float3 _e22 = up;
    metal::float3 _e23 = w_1;
    a = metal::normalize(metal::cross(_e22, _e23));
    metal::float3 _e27 = w_1;
    metal::float3 _e28 = a;
    b_1 = metal::cross(_e27, _e28);
    float _e32 = cosine_1;
    float _e33 = cosine_1;
    sine = metal::sqrt(metal::max(1.0 - (_e32 * _e33), 0.0));
    float _e41 = turn_1;
    phi = 6.2831855 * _e41;
    float _e44 = sine;
    float _e45 = phi;
    metal::float3 _e48 = a;
    float _e50 = sine;
    float _e51 = phi;
    metal::float3 _e54 = b_1;
    float _e57 = cosine_1;
    metal::float3 _e58 = w_1;
    return (((_e44 * metal::cos(_e45)) * _e48) + ((_e50 * metal::sin(_e51)) * _e54)) + (_e57 * _e58);
}

metal::float3 sampleLight(
    metal::float3 point,
    thread float& lightDistance,
    thread Light& light,
    thread uint& state
) {
    metal::float3 point_1 = {};
    metal::float3 toLight = {};
    float distance = {};
    float sine2_ = {};
    float depth = {};
    float u = {};
    float v_2 = {};
    float cosine_2 = {};
    float chord = {};
    point_1 = point;
    Light _e4 = light;
    metal::float3 _e6 = point_1;
    toLight = _e4.position - _e6;
    metal::float3 _e9 = toLight;
    distance = metal::length(_e9);
    Light _e12 = light;
    Light _e14 = light;
    float _e17 = distance;
    float _e18 = distance;
    sine2_ = (_e12.radius * _e14.radius) / (_e17 * _e18);
    float _e22 = sine2_;
    float _e25 = sine2_;
    depth = _e22 / (1.0 + metal::sqrt(1.0 - _e25));
    float _e31 = random(state);
    u = _e31;
    float _e33 = random(state);
    v_2 = _e33;
    float _e36 = u;
    float _e37 = depth;
    cosine_2 = 1.0 - (_e36 * _e37);
    float _e41 = sine2_;
    float _e43 = cosine_2;
    float _e44 = cosine_2;
    chord = metal::sqrt(metal::max(_e41 - (1.0 - (_e43 * _e44)), 0.0));
    float _e52 = distance;
    float _e53 = cosine_2;
    float _e54 = chord;
    lightDistance = _e52 * (_e53 - _e54);
    metal::float3 _e57 = toLight;
    float _e58 = distance;
    float _e61 = cosine_2;
    float _e62 = v_2;
    metal::float3 _e63 = around(_e57 / metal::float3(_e58), _e61, _e62);
    return _e63;
}

bool inShadow(
    Ray ray_2,
    float distance_1,
    thread type_6& spheres
) {
    Ray ray_3 = {};
    float distance_2 = {};
    int i_2 = 0;
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
            Sphere _e14 = spheres.inner[metal::min(unsigned(_e12), 3u)];
            float _e15 = intersectSphere(_e11, _e14);
            float _e16 = distance_2;
            if (_e15 < _e16) {
                {
                    return true;
                }
            }
            int _e19 = i_2;
            i_2 = as_type<int>(as_type<uint>(_e19) + as_type<uint>(1));
        }
    }
    return false;
}

metal::float3 trace(
    Ray ray_4,
    thread type_6& spheres,
    thread Light& light,
    thread uint& state
) {
    Ray ray_5 = {};
    float nearest = NO_HIT;
    int hit = -1;
    int i_3 = 0;
    float t_1 = {};
    metal::float3 point_2 = {};
    metal::float3 normal = {};
    float distance_3 = {};
    metal::float3 toLight_1 = {};
    metal::float3 sum = AMBIENT;
    float cosine_3 = {};
    ray_5 = ray_4;
    while(true) {
        int _e12 = i_3;
        if (!((_e12 < SPHERES))) {
            break;
        }
        {
            Ray _e15 = ray_5;
            int _e16 = i_3;
            Sphere _e18 = spheres.inner[metal::min(unsigned(_e16), 3u)];
            float _e19 = intersectSphere(_e15, _e18);
            t_1 = _e19;
            float _e21 = t_1;
            float _e22 = nearest;
            if (_e21 < _e22) {
                {
                    float _e24 = t_1;
                    nearest = _e24;
                    int _e25 = i_3;
                    hit = _e25;
                }
            }
            int _e26 = i_3;
            i_3 = as_type<int>(as_type<uint>(_e26) + as_type<uint>(1));
        }
    }
    int _e29 = hit;
    if (_e29 < 0) {
        {
            return metal::float3(0.4, 0.5, 0.7);
        }
    }
    Ray _e36 = ray_5;
    float _e38 = nearest;
    Ray _e39 = ray_5;
    point_2 = _e36.origin + (_e38 * _e39.direction);
    metal::float3 _e44 = point_2;
    int _e45 = hit;
    Sphere _e47 = spheres.inner[metal::min(unsigned(_e45), 3u)];
    normal = metal::normalize(_e44 - _e47.center);
    metal::float3 _e53 = point_2;
    metal::float3 _e54 = sampleLight(_e53, distance_3, light, state);
    toLight_1 = _e54;
    metal::float3 _e57 = normal;
    metal::float3 _e58 = toLight_1;
    cosine_3 = metal::dot(_e57, _e58);
    float _e61 = cosine_3;
    if (_e61 > 0.0) {
        {
            metal::float3 _e64 = point_2;
            metal::float3 _e66 = normal;
            metal::float3 _e69 = toLight_1;
            float _e71 = distance_3;
            bool _e72 = inShadow(Ray {_e64 + (0.001 * _e66), _e69}, _e71, spheres);
            if (!(_e72)) {
                {
                    metal::float3 _e74 = sum;
                    Light _e75 = light;
                    float _e77 = cosine_3;
                    sum = _e74 + (_e75.color * _e77);
                }
            }
        }
    }
    int _e80 = hit;
    Sphere _e82 = spheres.inner[metal::min(unsigned(_e80), 3u)];
    metal::float3 _e84 = sum;
    return _e82.color * _e84;
}

Ray cameraRay(
    metal::float2 fragCoord_2,
    constant ToyproofFrame& global
) {
    metal::float2 fragCoord_3 = {};
    float aspect = {};
    float x = {};
    float y = {};
    fragCoord_3 = fragCoord_2;
    metal::float3 _e5 = global.iResolution;
    metal::float3 _e7 = global.iResolution;
    aspect = _e5.x / _e7.y;
    metal::float2 _e11 = fragCoord_3;
    metal::float3 _e13 = global.iResolution;
    x = ((_e11.x / _e13.x) * 2.0) - 1.0;
    metal::float2 _e21 = fragCoord_3;
    metal::float3 _e23 = global.iResolution;
    float _e30 = aspect;
    y = (((_e21.y / _e23.y) * 2.0) - 1.0) / _e30;
    float _e35 = x;
    float _e36 = y;
    return Ray {metal::float3(0.0), metal::normalize(metal::float3(_e35, _e36, SCREEN_DEPTH))};
}

void mainImage(
    thread metal::float4& fragColor,
    metal::float2 fragCoord_4,
    constant ToyproofFrame& global,
    thread type_6& spheres,
    thread Light& light,
    thread uint& state
) {
    metal::float2 fragCoord_5 = {};
    metal::float3 color = metal::float3(0.0);
    int i_4 = 0;
    float x_1 = {};
    float y_1 = {};
    fragCoord_5 = fragCoord_4;
    fragColor = metal::float4(0.0);
    makeScene(spheres, light);
    while(true) {
        int _e11 = i_4;
        if (!((_e11 < SAMPLES))) {
            break;
        }
        {
            metal::float2 _e14 = fragCoord_5;
            int _e15 = i_4;
            startSample(_e14, _e15, state);
            metal::float2 _e16 = fragCoord_5;
            float _e18 = random(state);
            x_1 = (_e16.x + _e18) - 0.5;
            metal::float2 _e23 = fragCoord_5;
            float _e25 = random(state);
            y_1 = (_e23.y + _e25) - 0.5;
            metal::float3 _e30 = color;
            float _e31 = x_1;
            float _e32 = y_1;
            Ray _e34 = cameraRay(metal::float2(_e31, _e32), global);
            metal::float3 _e35 = trace(_e34, spheres, light, state);
            color = _e30 + _e35;
            int _e37 = i_4;
            i_4 = as_type<int>(as_type<uint>(_e37) + as_type<uint>(1));
        }
    }
    metal::float3 _e40 = color;
    metal::float3 _e43 = _e40 / metal::float3(16.0);
    fragColor = metal::float4(_e43.x, _e43.y, _e43.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread type_6& spheres,
    thread Light& light,
    thread uint& state,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, spheres, light, state);
    metal::float4 _e10 = toyproof_image_color;
    metal::float3 _e11 = _e10.xyz;
    toyproof_color = metal::float4(_e11.x, _e11.y, _e11.z, 1.0);
    return;
}

struct main_Input {
};
struct main_Output {
    metal::float4 toyproof_color [[color(0)]];
};
fragment main_Output main_(
  metal::float4 gl_FragCoord [[position]]
, constant ToyproofFrame& global [[buffer(0)]]
) {
    metal::float4 toyproof_color = {};
    type_6 spheres = {};
    Light light = {};
    uint state = {};
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, spheres, light, state, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
