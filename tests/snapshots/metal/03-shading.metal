// glsl/03-shading.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    metal::float3 position;
    metal::float3 color;
};
struct type_6 {
    Light inner[2];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant metal::float3 AMBIENT = metal::float3(0.1, 0.1, 0.15);

void makeScene(
    thread type_6& lights
) {
    lights.inner[0] = Light {metal::float3(5.0, 5.0, 0.0), metal::float3(0.8, 0.8, 0.7)};
    lights.inner[1] = Light {metal::float3(-6.0, 1.0, -2.0), metal::float3(0.1, 0.1, 0.3)};
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

metal::float3 shade(
    metal::float3 point,
    metal::float3 normal,
    metal::float3 color,
    thread type_6& lights
) {
    metal::float3 point_1 = {};
    metal::float3 normal_1 = {};
    metal::float3 color_1 = {};
    metal::float3 sum = AMBIENT;
    int i = 0;
    metal::float3 toLight = {};
    point_1 = point;
    normal_1 = normal;
    color_1 = color;
    while(true) {
        int _e11 = i;
        if (!((_e11 < 2))) {
            break;
        }
        {
            int _e15 = i;
            Light _e17 = lights.inner[metal::min(unsigned(_e15), 1u)];
            metal::float3 _e19 = point_1;
            toLight = metal::normalize(_e17.position - _e19);
            metal::float3 _e23 = sum;
            int _e24 = i;
            Light _e26 = lights.inner[metal::min(unsigned(_e24), 1u)];
            metal::float3 _e28 = normal_1;
            metal::float3 _e29 = toLight;
            sum = _e23 + (_e26.color * metal::max(metal::dot(_e28, _e29), 0.0));
            int _e35 = i;
            i = as_type<int>(as_type<uint>(_e35) + as_type<uint>(1));
        }
    }
    metal::float3 _e38 = color_1;
    metal::float3 _e39 = sum;
    return _e38 * _e39;
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
    thread type_6& lights
) {
    metal::float2 fragCoord_3 = {};
    Sphere sphere_2 = Sphere {metal::float3(0.0, 0.0, -6.0), 1.5, metal::float3(0.9, 0.6, 0.2)};
    Ray ray_2 = {};
    metal::float3 color_2 = metal::float3(0.02, 0.02, 0.05);
    float t_1 = {};
    metal::float3 hitPoint = {};
    metal::float3 normal_2 = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    makeScene(lights);
    metal::float2 _e17 = fragCoord_3;
    Ray _e18 = cameraRay(_e17, global);
    ray_2 = _e18;
    Ray _e25 = ray_2;
    Sphere _e26 = sphere_2;
    float _e27 = intersectSphere(_e25, _e26);
    t_1 = _e27;
    float _e29 = t_1;
    if (_e29 < NO_HIT) {
        {
            Ray _e31 = ray_2;
            float _e33 = t_1;
            Ray _e34 = ray_2;
            hitPoint = _e31.origin + (_e33 * _e34.direction);
            metal::float3 _e39 = hitPoint;
            Sphere _e40 = sphere_2;
            Sphere _e43 = sphere_2;
            normal_2 = (_e39 - _e40.center) / metal::float3(_e43.radius);
            metal::float3 _e48 = hitPoint;
            metal::float3 _e49 = normal_2;
            Sphere _e50 = sphere_2;
            metal::float3 _e52 = shade(_e48, _e49, _e50.color, lights);
            color_2 = _e52;
        }
    }
    metal::float3 _e53 = color_2;
    fragColor = metal::float4(_e53.x, _e53.y, _e53.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread type_6& lights,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, lights);
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
    type_6 lights = {};
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, lights, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
