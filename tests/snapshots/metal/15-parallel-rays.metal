// glsl/15-parallel-rays.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    Sphere inner[5];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float NO_HIT = 1000000.0;
constant float WIDTH = 6.0;
constant int SPHERES = 5;
constant metal::float3 AMBIENT = metal::float3(0.1, 0.1, 0.12);
constant metal::float3 LIGHT = metal::float3(3.0, 5.0, 4.0);

void makeScene(
    thread type_6& spheres
) {
    spheres.inner[0] = Sphere {metal::float3(-2.0, 0.0, -4.0), 0.7, metal::float3(0.9, 0.3, 0.2)};
    spheres.inner[1] = Sphere {metal::float3(-1.0, 0.3, -6.0), 0.7, metal::float3(0.9, 0.6, 0.2)};
    spheres.inner[2] = Sphere {metal::float3(0.0, 0.0, -9.0), 0.7, metal::float3(0.9, 0.9, 0.3)};
    spheres.inner[3] = Sphere {metal::float3(1.0, -0.3, -13.0), 0.7, metal::float3(0.3, 0.8, 0.4)};
    spheres.inner[4] = Sphere {metal::float3(2.0, 0.0, -18.0), 0.7, metal::float3(0.3, 0.5, 0.9)};
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

Ray cameraRay(
    metal::float2 fragCoord,
    constant ToyproofFrame& global
) {
    metal::float2 fragCoord_1 = {};
    float aspect = {};
    float x = {};
    float y = {};
    fragCoord_1 = fragCoord;
    metal::float3 _e4 = global.iResolution;
    metal::float3 _e6 = global.iResolution;
    aspect = _e4.x / _e6.y;
    metal::float2 _e10 = fragCoord_1;
    metal::float3 _e12 = global.iResolution;
    x = ((_e10.x / _e12.x) * 2.0) - 1.0;
    metal::float2 _e20 = fragCoord_1;
    metal::float3 _e22 = global.iResolution;
    float _e29 = aspect;
    y = (((_e20.y / _e22.y) * 2.0) - 1.0) / _e29;
    float _e33 = x;
    float _e34 = y;
    return Ray {3.0 * metal::float3(_e33, _e34, 0.0), metal::float3(0.0, 0.0, -1.0)};
}

void mainImage(
    thread metal::float4& fragColor,
    metal::float2 fragCoord_2,
    constant ToyproofFrame& global,
    thread type_6& spheres
) {
    metal::float2 fragCoord_3 = {};
    Ray ray_2 = {};
    metal::float3 color = metal::float3(0.05, 0.05, 0.08);
    float nearest = NO_HIT;
    int hit = -1;
    int i = 0;
    float t_1 = {};
    metal::float3 point = {};
    metal::float3 normal = {};
    metal::float3 toLight = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    makeScene(spheres);
    metal::float2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10, global);
    ray_2 = _e11;
    while(true) {
        int _e23 = i;
        if (!((_e23 < SPHERES))) {
            break;
        }
        {
            Ray _e26 = ray_2;
            int _e27 = i;
            Sphere _e29 = spheres.inner[metal::min(unsigned(_e27), 4u)];
            float _e30 = intersectSphere(_e26, _e29);
            t_1 = _e30;
            float _e32 = t_1;
            float _e33 = nearest;
            if (_e32 < _e33) {
                {
                    float _e35 = t_1;
                    nearest = _e35;
                    int _e36 = i;
                    hit = _e36;
                }
            }
            int _e37 = i;
            i = as_type<int>(as_type<uint>(_e37) + as_type<uint>(1));
        }
    }
    int _e40 = hit;
    if (_e40 >= 0) {
        {
            Ray _e43 = ray_2;
            float _e45 = nearest;
            Ray _e46 = ray_2;
            point = _e43.origin + (_e45 * _e46.direction);
            metal::float3 _e51 = point;
            int _e52 = hit;
            Sphere _e54 = spheres.inner[metal::min(unsigned(_e52), 4u)];
            normal = metal::normalize(_e51 - _e54.center);
            metal::float3 _e59 = point;
            toLight = metal::normalize(LIGHT - _e59);
            int _e63 = hit;
            Sphere _e65 = spheres.inner[metal::min(unsigned(_e63), 4u)];
            metal::float3 _e69 = normal;
            metal::float3 _e70 = toLight;
            color = _e65.color * (AMBIENT + (metal::float3(0.9) * metal::max(metal::dot(_e69, _e70), 0.0)));
        }
    }
    metal::float3 _e77 = color;
    fragColor = metal::float4(_e77.x, _e77.y, _e77.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread type_6& spheres,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, spheres);
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
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, spheres, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
