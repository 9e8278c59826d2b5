// glsl/05-complex-scene.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
struct Intersection {
    float t;
    char _pad1[12];
    Sphere sphere;
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant float SHRINK = 2.8;
constant metal::float3 AMBIENT = metal::float3(0.15);
constant metal::float3 LIGHT = metal::float3(4.0, 5.0, 2.0);

int naga_mod(int lhs, int rhs) {
    int divisor = metal::select(rhs, 1, (lhs == (-2147483647 - 1) & rhs == -1) | (rhs == 0));
    return lhs - (lhs / divisor) * divisor;
}

int toyproof_remainder(
    int a,
    int b
) {
    int a_1 = {};
    int b_1 = {};
    int r = {};
    int local = {};
    a_1 = a;
    b_1 = b;
    int _e4 = a_1;
    int _e5 = b_1;
    r = naga_mod(_e4, _e5);
    int _e8 = r;
    int _e11 = r;
    int _e12 = b_1;
    if ((_e8 != 0) && ((_e11 ^ _e12) < 0)) {
        int _e17 = r;
        int _e18 = b_1;
        local = as_type<int>(as_type<uint>(_e17) + as_type<uint>(_e18));
    } else {
        int _e20 = r;
        local = _e20;
    }
    int _e22 = local;
    return _e22;
}

int naga_div(int lhs, int rhs) {
    return lhs / metal::select(rhs, 1, (lhs == (-2147483647 - 1) & rhs == -1) | (rhs == 0));
}

metal::float3 side(
    int i
) {
    int i_1 = {};
    metal::float3 axis = {};
    metal::float3 local_1 = {};
    i_1 = i;
    int _e2 = i_1;
    int _e7 = i_1;
    int _e12 = i_1;
    axis = metal::float3(static_cast<float>(naga_div(_e2, 2) == 0), static_cast<float>(naga_div(_e7, 2) == 1), static_cast<float>(naga_div(_e12, 2) == 2));
    int _e22 = i_1;
    int _e24 = toyproof_remainder(_e22, 2);
    if (_e24 == 0) {
        metal::float3 _e27 = axis;
        local_1 = _e27;
    } else {
        metal::float3 _e28 = axis;
        local_1 = -(_e28);
    }
    metal::float3 _e31 = local_1;
    return _e31;
}

metal::float3 sideColor(
    int i_2
) {
    int i_3 = {};
    i_3 = i_2;
    int _e4 = i_3;
    metal::float3 _e5 = side(_e4);
    return metal::float3(0.5) + (0.4 * _e5);
}

metal::float3 turn(
    metal::float3 v,
    int frame
) {
    metal::float3 v_1 = {};
    int frame_1 = {};
    float angle = {};
    float c = {};
    float s = {};
    v_1 = v;
    frame_1 = frame;
    int _e5 = frame_1;
    angle = (6.2831855 * static_cast<float>(_e5)) / 240.0;
    float _e11 = angle;
    c = metal::cos(_e11);
    float _e14 = angle;
    s = metal::sin(_e14);
    float _e17 = c;
    metal::float3 _e18 = v_1;
    float _e21 = s;
    metal::float3 _e22 = v_1;
    metal::float3 _e26 = v_1;
    float _e28 = c;
    metal::float3 _e29 = v_1;
    float _e32 = s;
    metal::float3 _e33 = v_1;
    return metal::float3((_e17 * _e18.x) + (_e21 * _e22.z), _e26.y, (_e28 * _e29.z) - (_e32 * _e33.x));
}

Sphere childOf(
    Sphere parent,
    int i_4,
    int frame_2
) {
    Sphere parent_1 = {};
    int i_5 = {};
    int frame_3 = {};
    float radius = {};
    metal::float3 center = {};
    parent_1 = parent;
    i_5 = i_4;
    frame_3 = frame_2;
    Sphere _e7 = parent_1;
    radius = _e7.radius / SHRINK;
    Sphere _e11 = parent_1;
    Sphere _e13 = parent_1;
    float _e15 = radius;
    int _e17 = i_5;
    metal::float3 _e18 = side(_e17);
    int _e19 = frame_3;
    metal::float3 _e20 = turn(_e18, _e19);
    center = _e11.center + ((_e13.radius + _e15) * _e20);
    metal::float3 _e24 = center;
    float _e25 = radius;
    Sphere _e27 = parent_1;
    int _e29 = i_5;
    metal::float3 _e30 = sideColor(_e29);
    return Sphere {_e24, _e25, 0.5 * (_e27.color + _e30)};
}

float intersectSphere(
    Ray ray,
    Sphere sphere
) {
    Ray ray_1 = {};
    Sphere sphere_1 = {};
    metal::float3 f = {};
    float b_2 = {};
    float c_1 = {};
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
    b_2 = metal::dot(_e11, _e12.direction);
    metal::float3 _e16 = f;
    metal::float3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c_1 = metal::dot(_e16, _e17) - (_e19.radius * _e21.radius);
    float _e26 = b_2;
    float _e27 = b_2;
    float _e29 = c_1;
    disc = (_e26 * _e27) - _e29;
    float _e32 = disc;
    if (_e32 > 0.0) {
        {
            float _e35 = disc;
            root = metal::sqrt(_e35);
            float _e38 = b_2;
            float _e40 = root;
            t = -(_e38) - _e40;
            float _e43 = t;
            if (_e43 > 0.00001) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b_2;
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

void keepNearest(
    Ray ray_2,
    Sphere sphere_2,
    thread Intersection& hit
) {
    Ray ray_3 = {};
    Sphere sphere_3 = {};
    float t_1 = {};
    ray_3 = ray_2;
    sphere_3 = sphere_2;
    Ray _e5 = ray_3;
    Sphere _e6 = sphere_3;
    float _e7 = intersectSphere(_e5, _e6);
    t_1 = _e7;
    float _e9 = t_1;
    Intersection _e10 = hit;
    if (_e9 < _e10.t) {
        {
            float _e14 = t_1;
            hit.t = _e14;
            Sphere _e16 = sphere_3;
            hit.sphere = _e16;
            return;
        }
    } else {
        return;
    }
}

Intersection hitScene(
    Ray ray_4,
    int frame_4
) {
    Ray ray_5 = {};
    int frame_5 = {};
    Sphere parent_2 = Sphere {metal::float3(0.0, 0.0, -7.5), 1.0, metal::float3(0.9, 0.9, 0.8)};
    Intersection hit_1 = {};
    int i_6 = 0;
    Sphere child = {};
    int j = {};
    ray_5 = ray_4;
    frame_5 = frame_4;
    Sphere _e16 = parent_2;
    hit_1 = Intersection {NO_HIT, {}, _e16};
    Ray _e19 = ray_5;
    Sphere _e20 = parent_2;
    keepNearest(_e19, _e20, hit_1);
    while(true) {
        int _e23 = i_6;
        if (!((_e23 < 6))) {
            break;
        }
        {
            Sphere _e27 = parent_2;
            int _e28 = i_6;
            int _e29 = frame_5;
            Sphere _e30 = childOf(_e27, _e28, _e29);
            child = _e30;
            Ray _e32 = ray_5;
            Sphere _e33 = child;
            keepNearest(_e32, _e33, hit_1);
            j = 0;
            while(true) {
                int _e36 = j;
                if (!((_e36 < 6))) {
                    break;
                }
                {
                    Ray _e40 = ray_5;
                    Sphere _e41 = child;
                    int _e42 = j;
                    int _e43 = frame_5;
                    Sphere _e44 = childOf(_e41, _e42, _e43);
                    keepNearest(_e40, _e44, hit_1);
                    int _e45 = j;
                    j = as_type<int>(as_type<uint>(_e45) + as_type<uint>(1));
                }
            }
            int _e48 = i_6;
            i_6 = as_type<int>(as_type<uint>(_e48) + as_type<uint>(1));
        }
    }
    Intersection _e51 = hit_1;
    return _e51;
}

Ray cameraRay(
    metal::float2 fragCoord,
    constant ToyproofFrame& global
) {
    metal::float2 fragCoord_1 = {};
    float aspect = {};
    float x = {};
    float y = {};
    fragCoord_1 = fragCoord;
    metal::float3 _e5 = global.iResolution;
    metal::float3 _e7 = global.iResolution;
    aspect = _e5.x / _e7.y;
    metal::float2 _e11 = fragCoord_1;
    metal::float3 _e13 = global.iResolution;
    x = ((_e11.x / _e13.x) * 2.0) - 1.0;
    metal::float2 _e21 = fragCoord_1;
    metal::float3 _e23 = global.iResolution;
    float _e30 = aspect;
    y = (((_e21.y / _e23.y) * 2.0) - 1.0) / _e30;
    float _e35 = x;
    float _e36 = y;
    return Ray {metal::float3(0.0), metal::normalize(metal::float3(_e35, _e36, SCREEN_DEPTH))};
}

void mainImage(
    thread metal::float4& fragColor,
    metal::float2 fragCoord_2,
    constant ToyproofFrame& global
) {
    metal::float2 fragCoord_3 = {};
    Ray ray_6 = {};
    metal::float3 color = metal::float3(0.05, 0.05, 0.1);
    Intersection hit_2 = {};
    metal::float3 point = {};
    metal::float3 normal = {};
    metal::float3 toLight = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    metal::float2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10, global);
    ray_6 = _e11;
    Ray _e18 = ray_6;
    int _e19 = global.iFrame;
    Intersection _e20 = hitScene(_e18, _e19);
    hit_2 = _e20;
    Intersection _e22 = hit_2;
    if (_e22.t < NO_HIT) {
        {
            Ray _e25 = ray_6;
            Intersection _e27 = hit_2;
            Ray _e29 = ray_6;
            point = _e25.origin + (_e27.t * _e29.direction);
            metal::float3 _e34 = point;
            Intersection _e35 = hit_2;
            normal = metal::normalize(_e34 - _e35.sphere.center);
            metal::float3 _e41 = point;
            toLight = metal::normalize(LIGHT - _e41);
            Intersection _e45 = hit_2;
            metal::float3 _e50 = normal;
            metal::float3 _e51 = toLight;
            color = _e45.sphere.color * (AMBIENT + (metal::float3(0.85) * metal::max(metal::dot(_e50, _e51), 0.0)));
        }
    }
    metal::float3 _e58 = color;
    fragColor = metal::float4(_e58.x, _e58.y, _e58.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global);
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
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
