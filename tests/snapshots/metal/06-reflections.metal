// glsl/06-reflections.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    Sphere inner[4];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant float EPSILON = 0.001;
constant int SPHERES = 4;
constant int MAX_DEPTH = 100;

void makeScene(
    thread type_6& spheres
) {
    spheres.inner[0] = Sphere {metal::float3(-1.3, -0.4, -5.2), 0.6, metal::float3(0.9, 0.6, 0.6)};
    spheres.inner[1] = Sphere {metal::float3(0.0, 0.0, -7.0), 1.2, metal::float3(0.95, 0.93, 0.88)};
    spheres.inner[2] = Sphere {metal::float3(0.2, -0.6, -3.6), 0.3, metal::float3(0.7, 0.9, 0.7)};
    spheres.inner[3] = Sphere {metal::float3(1.2, 0.5, -5.0), 0.7, metal::float3(0.6, 0.7, 0.95)};
    return;
}

metal::float3 sky(
    metal::float3 direction
) {
    metal::float3 direction_1 = {};
    float up = {};
    direction_1 = direction;
    metal::float3 _e4 = direction_1;
    up = 0.5 * (1.0 + _e4.y);
    float _e10 = up;
    float _e17 = up;
    return ((1.0 - _e10) * metal::float3(0.9, 0.5, 0.25)) + (_e17 * metal::float3(0.1, 0.2, 0.5));
}

float intersectSphere(
    Ray ray,
    Sphere sphere,
    float tMin
) {
    Ray ray_1 = {};
    Sphere sphere_1 = {};
    float tMin_1 = {};
    metal::float3 f = {};
    float b = {};
    float c = {};
    float disc = {};
    float root = {};
    float t = {};
    ray_1 = ray;
    sphere_1 = sphere;
    tMin_1 = tMin;
    Ray _e7 = ray_1;
    Sphere _e9 = sphere_1;
    f = _e7.origin - _e9.center;
    metal::float3 _e13 = f;
    Ray _e14 = ray_1;
    b = metal::dot(_e13, _e14.direction);
    metal::float3 _e18 = f;
    metal::float3 _e19 = f;
    Sphere _e21 = sphere_1;
    Sphere _e23 = sphere_1;
    c = metal::dot(_e18, _e19) - (_e21.radius * _e23.radius);
    float _e28 = b;
    float _e29 = b;
    float _e31 = c;
    disc = (_e28 * _e29) - _e31;
    float _e34 = disc;
    if (_e34 > 0.0) {
        {
            float _e37 = disc;
            root = metal::sqrt(_e37);
            float _e40 = b;
            float _e42 = root;
            t = -(_e40) - _e42;
            float _e45 = t;
            float _e46 = tMin_1;
            if (_e45 > _e46) {
                {
                    float _e48 = t;
                    return _e48;
                }
            }
            float _e49 = b;
            float _e51 = root;
            t = -(_e49) + _e51;
            float _e53 = t;
            float _e54 = tMin_1;
            if (_e53 > _e54) {
                {
                    float _e56 = t;
                    return _e56;
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
    thread type_6& spheres
) {
    metal::float2 fragCoord_3 = {};
    Ray ray_2 = {};
    metal::float3 color = metal::float3(0.0);
    metal::float3 throughput = metal::float3(1.0);
    int depth = 0;
    float nearest = {};
    int hit = {};
    int i = {};
    float t_1 = {};
    metal::float3 point = {};
    metal::float3 normal = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    makeScene(spheres);
    metal::float2 _e10 = fragCoord_3;
    Ray _e11 = cameraRay(_e10, global);
    ray_2 = _e11;
    while(true) {
        int _e21 = depth;
        if (!((_e21 < MAX_DEPTH))) {
            break;
        }
        {
            nearest = NO_HIT;
            hit = -1;
            i = 0;
            while(true) {
                int _e29 = i;
                if (!((_e29 < SPHERES))) {
                    break;
                }
                {
                    Ray _e32 = ray_2;
                    int _e33 = i;
                    Sphere _e35 = spheres.inner[metal::min(unsigned(_e33), 3u)];
                    float _e36 = intersectSphere(_e32, _e35, EPSILON);
                    t_1 = _e36;
                    float _e38 = t_1;
                    float _e39 = nearest;
                    if (_e38 < _e39) {
                        {
                            float _e41 = t_1;
                            nearest = _e41;
                            int _e42 = i;
                            hit = _e42;
                        }
                    }
                    int _e43 = i;
                    i = as_type<int>(as_type<uint>(_e43) + as_type<uint>(1));
                }
            }
            int _e46 = hit;
            if (_e46 < 0) {
                {
                    metal::float3 _e49 = throughput;
                    Ray _e50 = ray_2;
                    metal::float3 _e52 = sky(_e50.direction);
                    color = _e49 * _e52;
                    break;
                }
            }
            Ray _e54 = ray_2;
            float _e56 = nearest;
            Ray _e57 = ray_2;
            point = _e54.origin + (_e56 * _e57.direction);
            metal::float3 _e62 = point;
            int _e63 = hit;
            Sphere _e65 = spheres.inner[metal::min(unsigned(_e63), 3u)];
            normal = metal::normalize(_e62 - _e65.center);
            metal::float3 _e70 = throughput;
            int _e71 = hit;
            Sphere _e73 = spheres.inner[metal::min(unsigned(_e71), 3u)];
            throughput = _e70 * _e73.color;
            metal::float3 _e76 = point;
            Ray _e77 = ray_2;
            metal::float3 _e79 = normal;
            ray_2 = Ray {_e76, metal::reflect(_e77.direction, _e79)};
            int _e82 = depth;
            depth = as_type<int>(as_type<uint>(_e82) + as_type<uint>(1));
        }
    }
    metal::float3 _e85 = color;
    fragColor = metal::float4(_e85.x, _e85.y, _e85.z, 1.0);
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
