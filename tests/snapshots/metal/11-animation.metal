// glsl/11-animation.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
struct type_6 {
    Sphere inner[6];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant float TAU = 6.2831855;
constant int BODIES = 6;
constant metal::float3 AMBIENT = metal::float3(0.12);
constant metal::float3 SUN = metal::float3(0.0, 0.2, -7.0);

metal::float3 rotate(
    metal::float3 v,
    metal::float3 axis,
    float angle
) {
    metal::float3 v_1 = {};
    metal::float3 axis_1 = {};
    float angle_1 = {};
    float c = {};
    float s = {};
    v_1 = v;
    axis_1 = axis;
    angle_1 = angle;
    float _e6 = angle_1;
    c = metal::cos(_e6);
    float _e9 = angle_1;
    s = metal::sin(_e9);
    float _e12 = c;
    metal::float3 _e13 = v_1;
    float _e15 = s;
    metal::float3 _e16 = axis_1;
    metal::float3 _e17 = v_1;
    float _e22 = c;
    metal::float3 _e24 = axis_1;
    metal::float3 _e25 = v_1;
    metal::float3 _e28 = axis_1;
    return ((_e12 * _e13) + (_e15 * metal::cross(_e16, _e17))) + (((1.0 - _e22) * metal::dot(_e24, _e25)) * _e28);
}

metal::float3 rotateAbout(
    metal::float3 p,
    metal::float3 pivot,
    metal::float3 axis_2,
    float turns
) {
    metal::float3 p_1 = {};
    metal::float3 pivot_1 = {};
    metal::float3 axis_3 = {};
    float turns_1 = {};
    p_1 = p;
    pivot_1 = pivot;
    axis_3 = axis_2;
    turns_1 = turns;
    metal::float3 _e9 = pivot_1;
    metal::float3 _e10 = p_1;
    metal::float3 _e11 = pivot_1;
    metal::float3 _e13 = axis_3;
    float _e14 = turns_1;
    metal::float3 _e17 = rotate(_e10 - _e11, _e13, TAU * metal::fract(_e14));
    return _e9 + _e17;
}

metal::float3 year(
    metal::float3 p_2,
    constant ToyproofFrame& global
) {
    metal::float3 p_3 = {};
    p_3 = p_2;
    metal::float3 _e5 = p_3;
    float _e10 = global.iTime;
    metal::float3 _e13 = rotateAbout(_e5, SUN, metal::float3(0.0, 1.0, 0.0), _e10 / 8.0);
    return _e13;
}

metal::float3 month(
    metal::float3 p_4,
    constant ToyproofFrame& global
) {
    metal::float3 p_5 = {};
    p_5 = p_4;
    metal::float3 _e4 = p_5;
    float _e13 = global.iTime;
    metal::float3 _e16 = rotateAbout(_e4, metal::float3(2.0, 0.2, -7.0), metal::float3(0.0, 0.8, 0.6), _e13 / 2.0);
    metal::float3 _e17 = year(_e16, global);
    return _e17;
}

metal::float3 orbit(
    metal::float3 p_6,
    constant ToyproofFrame& global
) {
    metal::float3 p_7 = {};
    p_7 = p_6;
    metal::float3 _e4 = p_7;
    int _e13 = global.iFrame;
    metal::float3 _e17 = rotateAbout(_e4, metal::float3(2.75, 0.2, -7.0), metal::float3(1.0, 0.0, 0.0), static_cast<float>(_e13) / 60.0);
    metal::float3 _e18 = month(_e17, global);
    return _e18;
}

metal::float3 retrograde(
    metal::float3 p_8,
    constant ToyproofFrame& global
) {
    metal::float3 p_9 = {};
    p_9 = p_8;
    metal::float3 _e5 = p_9;
    float _e10 = global.iTime;
    metal::float3 _e14 = rotateAbout(_e5, SUN, metal::float3(0.0, 0.96, -0.28), -(_e10) / 5.0);
    return _e14;
}

void makeScene(
    constant ToyproofFrame& global,
    thread type_6& bodies,
    thread metal::float3& lamp
) {
    bodies.inner[0] = Sphere {metal::float3(0.0, 0.2, -7.0), 0.8, metal::float3(1.0, 0.8, 0.3)};
    metal::float3 _e20 = year(metal::float3(2.0, 0.2, -7.0), global);
    bodies.inner[1] = Sphere {_e20, 0.35, metal::float3(0.3, 0.5, 0.9)};
    metal::float3 _e33 = month(metal::float3(2.75, 0.2, -7.0), global);
    bodies.inner[2] = Sphere {_e33, 0.15, metal::float3(0.8, 0.8, 0.8)};
    metal::float3 _e46 = orbit(metal::float3(2.75, 0.45, -7.0), global);
    bodies.inner[3] = Sphere {_e46, 0.06, metal::float3(0.9, 0.3, 0.9)};
    metal::float3 _e59 = retrograde(metal::float3(-1.4, 0.2, -7.0), global);
    bodies.inner[4] = Sphere {_e59, 0.22, metal::float3(0.9, 0.4, 0.2)};
    bodies.inner[5] = Sphere {metal::float3(0.0, -52.0, -8.0), 50.0, metal::float3(0.4, 0.4, 0.5)};
    metal::float3 _e82 = retrograde(metal::float3(3.0, 5.0, -4.0), global);
    lamp = _e82;
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
    b = metal::dot(_e11, _e12.direction);
    metal::float3 _e16 = f;
    metal::float3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c_1 = metal::dot(_e16, _e17) - (_e19.radius * _e21.radius);
    float _e26 = b;
    float _e27 = b;
    float _e29 = c_1;
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

bool inShadow(
    metal::float3 point,
    metal::float3 normal,
    thread type_6& bodies,
    thread metal::float3& lamp
) {
    metal::float3 point_1 = {};
    metal::float3 normal_1 = {};
    metal::float3 origin = {};
    metal::float3 toLight = {};
    float distance = {};
    Ray ray_2 = {};
    int i = 0;
    point_1 = point;
    normal_1 = normal;
    metal::float3 _e7 = point_1;
    metal::float3 _e9 = normal_1;
    origin = _e7 + (0.001 * _e9);
    metal::float3 _e13 = lamp;
    metal::float3 _e14 = origin;
    toLight = _e13 - _e14;
    metal::float3 _e17 = toLight;
    distance = metal::length(_e17);
    metal::float3 _e20 = origin;
    metal::float3 _e21 = toLight;
    float _e22 = distance;
    ray_2 = Ray {_e20, _e21 / metal::float3(_e22)};
    while(true) {
        int _e29 = i;
        if (!((_e29 < BODIES))) {
            break;
        }
        {
            Ray _e32 = ray_2;
            int _e33 = i;
            Sphere _e35 = bodies.inner[metal::min(unsigned(_e33), 5u)];
            float _e36 = intersectSphere(_e32, _e35);
            float _e37 = distance;
            if (_e36 < _e37) {
                {
                    return true;
                }
            }
            int _e40 = i;
            i = as_type<int>(as_type<uint>(_e40) + as_type<uint>(1));
        }
    }
    return false;
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
    constant ToyproofFrame& global,
    thread type_6& bodies,
    thread metal::float3& lamp
) {
    metal::float2 fragCoord_3 = {};
    Ray ray_3 = {};
    metal::float3 color = metal::float3(0.02, 0.02, 0.06);
    float nearest = NO_HIT;
    int hit = -1;
    int i_1 = 0;
    float t_1 = {};
    metal::float3 point_2 = {};
    metal::float3 normal_2 = {};
    float cosine = {};
    metal::float3 sum = AMBIENT;
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    makeScene(global, bodies, lamp);
    metal::float2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10, global);
    ray_3 = _e11;
    while(true) {
        int _e23 = i_1;
        if (!((_e23 < BODIES))) {
            break;
        }
        {
            Ray _e26 = ray_3;
            int _e27 = i_1;
            Sphere _e29 = bodies.inner[metal::min(unsigned(_e27), 5u)];
            float _e30 = intersectSphere(_e26, _e29);
            t_1 = _e30;
            float _e32 = t_1;
            float _e33 = nearest;
            if (_e32 < _e33) {
                {
                    float _e35 = t_1;
                    nearest = _e35;
                    int _e36 = i_1;
                    hit = _e36;
                }
            }
            int _e37 = i_1;
            i_1 = as_type<int>(as_type<uint>(_e37) + as_type<uint>(1));
        }
    }
    int _e40 = hit;
    if (_e40 >= 0) {
        {
            Ray _e43 = ray_3;
            float _e45 = nearest;
            Ray _e46 = ray_3;
            point_2 = _e43.origin + (_e45 * _e46.direction);
            metal::float3 _e51 = point_2;
            int _e52 = hit;
            Sphere _e54 = bodies.inner[metal::min(unsigned(_e52), 5u)];
            normal_2 = metal::normalize(_e51 - _e54.center);
            metal::float3 _e59 = normal_2;
            metal::float3 _e60 = lamp;
            metal::float3 _e61 = point_2;
            cosine = metal::dot(_e59, metal::normalize(_e60 - _e61));
            float _e67 = cosine;
            if (_e67 > 0.0) {
                {
                    metal::float3 _e70 = point_2;
                    metal::float3 _e71 = normal_2;
                    bool _e72 = inShadow(_e70, _e71, bodies, lamp);
                    if (!(_e72)) {
                        {
                            metal::float3 _e74 = sum;
                            float _e77 = cosine;
                            sum = _e74 + (metal::float3(0.88) * _e77);
                        }
                    }
                }
            }
            int _e80 = hit;
            Sphere _e82 = bodies.inner[metal::min(unsigned(_e80), 5u)];
            metal::float3 _e84 = sum;
            color = _e82.color * _e84;
        }
    }
    metal::float3 _e86 = color;
    fragColor = metal::float4(_e86.x, _e86.y, _e86.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread type_6& bodies,
    thread metal::float3& lamp,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, bodies, lamp);
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
    type_6 bodies = {};
    metal::float3 lamp = {};
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, bodies, lamp, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
