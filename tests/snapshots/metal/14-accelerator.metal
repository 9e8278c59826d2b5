// glsl/14-accelerator.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
};
struct Intersection {
    float t;
    char _pad1[12];
    metal::int3 cell;
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant metal::int3 CELLS = metal::int3(11, 5, 10);
constant metal::float3 CORNER = metal::float3(-4.125, -1.875, -13.5);
constant float SPACING = 0.75;
constant uint SEED = 7u;
constant metal::float3 AMBIENT = metal::float3(0.15);
constant metal::float3 LIGHT = metal::float3(6.0, 8.0, -2.0);

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

Sphere sphereIn(
    metal::int3 cell,
    thread uint& state
) {
    metal::int3 cell_1 = {};
    float radius = {};
    float room = {};
    float x = {};
    float y = {};
    float z = {};
    cell_1 = cell;
    metal::int3 _e6 = cell_1;
    metal::int3 _e9 = cell_1;
    metal::int3 _e12 = cell_1;
    state = SEED + static_cast<uint>(as_type<int>(as_type<uint>(_e6.x) + as_type<uint>(as_type<int>(as_type<uint>(11) * as_type<uint>(as_type<int>(as_type<uint>(_e9.y) + as_type<uint>(as_type<int>(as_type<uint>(5) * as_type<uint>(_e12.z)))))))));
    float _e22 = random(state);
    radius = metal::mix(0.1, 0.3, _e22);
    float _e26 = radius;
    room = SPACING - (2.0 * _e26);
    float _e30 = random(state);
    x = _e30;
    float _e32 = random(state);
    y = _e32;
    float _e34 = random(state);
    z = _e34;
    metal::int3 _e36 = cell_1;
    float _e40 = radius;
    float _e43 = room;
    float _e44 = x;
    float _e45 = y;
    float _e46 = z;
    float _e50 = radius;
    return Sphere {((CORNER + (SPACING * static_cast<metal::float3>(_e36))) + metal::float3(_e40)) + (_e43 * metal::float3(_e44, _e45, _e46)), _e50};
}

metal::float3 nextColor(
    thread uint& state
) {
    float r = {};
    float g = {};
    float b = {};
    float _e0 = random(state);
    r = _e0;
    float _e2 = random(state);
    g = _e2;
    float _e4 = random(state);
    b = _e4;
    float _e9 = r;
    float _e10 = g;
    float _e11 = b;
    return 0.95 * (metal::float3(0.2) + (0.8 * metal::float3(_e9, _e10, _e11)));
}

float intersectSphere(
    Ray ray,
    Sphere sphere
) {
    Ray ray_1 = {};
    Sphere sphere_1 = {};
    metal::float3 f = {};
    float b_1 = {};
    metal::float3 closest = {};
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
    b_1 = metal::dot(_e11, _e12.direction);
    metal::float3 _e16 = f;
    float _e17 = b_1;
    Ray _e18 = ray_1;
    closest = _e16 - (_e17 * _e18.direction);
    Sphere _e23 = sphere_1;
    Sphere _e25 = sphere_1;
    metal::float3 _e28 = closest;
    metal::float3 _e29 = closest;
    disc = (_e23.radius * _e25.radius) - metal::dot(_e28, _e29);
    float _e33 = disc;
    if (_e33 > 0.0) {
        {
            float _e36 = disc;
            root = metal::sqrt(_e36);
            float _e39 = b_1;
            float _e41 = root;
            t = -(_e39) - _e41;
            float _e44 = t;
            if (_e44 > 0.00001) {
                {
                    float _e47 = t;
                    return _e47;
                }
            }
            float _e48 = b_1;
            float _e50 = root;
            t = -(_e48) + _e50;
            float _e52 = t;
            if (_e52 > 0.00001) {
                {
                    float _e55 = t;
                    return _e55;
                }
            }
        }
    }
    return NO_HIT;
}

metal::int3 naga_f2i32(metal::float3 value) {
    return static_cast<metal::int3>(metal::clamp(value, -2147483600.0, 2147483500.0));
}

Intersection hitScene(
    Ray ray_2,
    thread uint& state
) {
    Ray ray_3 = {};
    metal::float3 low = {};
    metal::float3 high = {};
    metal::float3 into = {};
    metal::float3 outOf = {};
    float enter = {};
    float leave = {};
    Intersection none = Intersection {1000000.0, {}, metal::int3(-1)};
    metal::float3 place = {};
    metal::int3 cell_2 = {};
    metal::int3 stride = {};
    metal::float3 next = {};
    metal::float3 step = {};
    int i = 0;
    float t_1 = {};
    ray_3 = ray_2;
    Ray _e5 = ray_3;
    Ray _e8 = ray_3;
    low = (CORNER - _e5.origin) / _e8.direction;
    Ray _e16 = ray_3;
    Ray _e19 = ray_3;
    high = (metal::float3(4.125, 1.875, -6.0) - _e16.origin) / _e19.direction;
    metal::float3 _e23 = low;
    metal::float3 _e24 = high;
    into = metal::min(_e23, _e24);
    metal::float3 _e27 = low;
    metal::float3 _e28 = high;
    outOf = metal::max(_e27, _e28);
    metal::float3 _e31 = into;
    metal::float3 _e33 = into;
    metal::float3 _e36 = into;
    enter = metal::max(metal::max(_e31.x, _e33.y), metal::max(_e36.z, 0.0));
    metal::float3 _e42 = outOf;
    metal::float3 _e44 = outOf;
    metal::float3 _e46 = outOf;
    leave = metal::min(_e42.x, metal::min(_e44.y, _e46.z));
    float _e56 = enter;
    float _e57 = leave;
    if (_e56 >= _e57) {
        {
            Intersection _e59 = none;
            return _e59;
        }
    }
    Ray _e60 = ray_3;
    float _e62 = enter;
    Ray _e63 = ray_3;
    place = ((_e60.origin + (_e62 * _e63.direction)) - CORNER) / metal::float3(0.75);
    metal::float3 _e72 = place;
    cell_2 = metal::clamp(naga_f2i32(metal::floor(_e72)), metal::int3(0), metal::int3(10, 4, 9));
    Ray _e83 = ray_3;
    stride = naga_f2i32(metal::sign(_e83.direction));
    metal::int3 _e88 = cell_2;
    metal::int3 _e89 = stride;
    Ray _e97 = ray_3;
    Ray _e100 = ray_3;
    next = ((CORNER + (SPACING * static_cast<metal::float3>(as_type<metal::int3>(as_type<metal::uint3>(_e88) + as_type<metal::uint3>(metal::max(_e89, metal::int3(0))))))) - _e97.origin) / _e100.direction;
    metal::float3 _e104 = next;
    metal::int3 _e107 = stride;
    next = metal::select(_e104, metal::float3(1000000.0), _e107 == metal::int3(0));
    Ray _e112 = ray_3;
    step = metal::float3(0.75) / metal::abs(_e112.direction);
    while(true) {
        int _e121 = i;
        if (!((_e121 < 26))) {
            break;
        }
        {
            Ray _e125 = ray_3;
            metal::int3 _e126 = cell_2;
            Sphere _e127 = sphereIn(_e126, state);
            float _e128 = intersectSphere(_e125, _e127);
            t_1 = _e128;
            float _e130 = t_1;
            if (_e130 < NO_HIT) {
                {
                    float _e132 = t_1;
                    metal::int3 _e133 = cell_2;
                    return Intersection {_e132, {}, _e133};
                }
            }
            metal::float3 _e135 = next;
            metal::float3 _e137 = next;
            metal::float3 _e140 = next;
            metal::float3 _e142 = next;
            if ((_e135.x < _e137.y) && (_e140.x < _e142.z)) {
                {
                    metal::int3 _e147 = cell_2;
                    metal::int3 _e149 = stride;
                    cell_2.x = as_type<int>(as_type<uint>(_e147.x) + as_type<uint>(_e149.x));
                    metal::float3 _e153 = next;
                    metal::float3 _e155 = step;
                    next.x = _e153.x + _e155.x;
                    metal::int3 _e158 = cell_2;
                    metal::int3 _e162 = cell_2;
                    if ((_e158.x < 0) || (_e162.x >= 11)) {
                        {
                            Intersection _e167 = none;
                            return _e167;
                        }
                    }
                }
            } else {
                metal::float3 _e168 = next;
                metal::float3 _e170 = next;
                if (_e168.y < _e170.z) {
                    {
                        metal::int3 _e174 = cell_2;
                        metal::int3 _e176 = stride;
                        cell_2.y = as_type<int>(as_type<uint>(_e174.y) + as_type<uint>(_e176.y));
                        metal::float3 _e180 = next;
                        metal::float3 _e182 = step;
                        next.y = _e180.y + _e182.y;
                        metal::int3 _e185 = cell_2;
                        metal::int3 _e189 = cell_2;
                        if ((_e185.y < 0) || (_e189.y >= 5)) {
                            {
                                Intersection _e194 = none;
                                return _e194;
                            }
                        }
                    }
                } else {
                    {
                        metal::int3 _e196 = cell_2;
                        metal::int3 _e198 = stride;
                        cell_2.z = as_type<int>(as_type<uint>(_e196.z) + as_type<uint>(_e198.z));
                        metal::float3 _e202 = next;
                        metal::float3 _e204 = step;
                        next.z = _e202.z + _e204.z;
                        metal::int3 _e207 = cell_2;
                        metal::int3 _e211 = cell_2;
                        if ((_e207.z < 0) || (_e211.z >= 10)) {
                            {
                                Intersection _e216 = none;
                                return _e216;
                            }
                        }
                    }
                }
            }
            int _e217 = i;
            i = as_type<int>(as_type<uint>(_e217) + as_type<uint>(1));
        }
    }
    Intersection _e220 = none;
    return _e220;
}

Ray cameraRay(
    metal::float2 fragCoord,
    constant ToyproofFrame& global
) {
    metal::float2 fragCoord_1 = {};
    float aspect = {};
    float x_1 = {};
    float y_1 = {};
    fragCoord_1 = fragCoord;
    metal::float3 _e5 = global.iResolution;
    metal::float3 _e7 = global.iResolution;
    aspect = _e5.x / _e7.y;
    metal::float2 _e11 = fragCoord_1;
    metal::float3 _e13 = global.iResolution;
    x_1 = ((_e11.x / _e13.x) * 2.0) - 1.0;
    metal::float2 _e21 = fragCoord_1;
    metal::float3 _e23 = global.iResolution;
    float _e30 = aspect;
    y_1 = (((_e21.y / _e23.y) * 2.0) - 1.0) / _e30;
    float _e35 = x_1;
    float _e36 = y_1;
    return Ray {metal::float3(0.0), metal::normalize(metal::float3(_e35, _e36, SCREEN_DEPTH))};
}

void mainImage(
    thread metal::float4& fragColor,
    metal::float2 fragCoord_2,
    constant ToyproofFrame& global,
    thread uint& state
) {
    metal::float2 fragCoord_3 = {};
    Ray ray_4 = {};
    metal::float3 color = metal::float3(0.7, 0.8, 0.9);
    Intersection hit = {};
    Sphere sphere_2 = {};
    metal::float3 albedo = {};
    metal::float3 point = {};
    metal::float3 normal = {};
    metal::float3 sum = AMBIENT;
    float cosine = {};
    metal::float3 origin = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    metal::float2 _e8 = fragCoord_3;
    Ray _e9 = cameraRay(_e8, global);
    ray_4 = _e9;
    Ray _e16 = ray_4;
    Intersection _e17 = hitScene(_e16, state);
    hit = _e17;
    Intersection _e19 = hit;
    if (_e19.t < NO_HIT) {
        {
            Intersection _e22 = hit;
            Sphere _e24 = sphereIn(_e22.cell, state);
            sphere_2 = _e24;
            metal::float3 _e26 = nextColor(state);
            albedo = _e26;
            Ray _e28 = ray_4;
            Intersection _e30 = hit;
            Ray _e32 = ray_4;
            point = _e28.origin + (_e30.t * _e32.direction);
            metal::float3 _e37 = point;
            Sphere _e38 = sphere_2;
            normal = metal::normalize(_e37 - _e38.center);
            metal::float3 _e44 = normal;
            metal::float3 _e45 = point;
            cosine = metal::dot(_e44, metal::normalize(LIGHT - _e45));
            float _e50 = cosine;
            if (_e50 > 0.0) {
                {
                    metal::float3 _e53 = point;
                    metal::float3 _e55 = normal;
                    origin = _e53 + (0.001 * _e55);
                    metal::float3 _e59 = origin;
                    metal::float3 _e60 = origin;
                    Intersection _e64 = hitScene(Ray {_e59, metal::normalize(LIGHT - _e60)}, state);
                    if (_e64.t == NO_HIT) {
                        {
                            metal::float3 _e67 = sum;
                            float _e70 = cosine;
                            sum = _e67 + (metal::float3(0.85) * _e70);
                        }
                    }
                }
            }
            metal::float3 _e73 = albedo;
            metal::float3 _e74 = sum;
            color = _e73 * _e74;
        }
    }
    metal::float3 _e76 = color;
    fragColor = metal::float4(_e76.x, _e76.y, _e76.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread uint& state,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, state);
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
    uint state = {};
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, state, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
