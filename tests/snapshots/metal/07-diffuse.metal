// glsl/07-diffuse.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
struct Material {
    metal::float3 albedo;
};
struct Sphere {
    metal::packed_float3 center;
    float radius;
    Material material;
};
struct Light {
    metal::float3 position;
    metal::float3 color;
};
struct type_6 {
    Sphere inner[4];
};
struct type_7 {
    Light inner[2];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant float PI = 3.1415927;
constant int SPHERES = 4;
constant int LIGHTS = 2;
constant metal::float3 AMBIENT = metal::float3(0.3, 0.35, 0.45);

void makeScene(
    thread type_6& spheres,
    thread type_7& lights
) {
    spheres.inner[0] = Sphere {metal::float3(0.0, -101.0, -7.0), 100.0, Material {metal::float3(0.5, 0.5, 0.5)}};
    spheres.inner[1] = Sphere {metal::float3(-1.9, 0.0, -7.5), 1.0, Material {metal::float3(0.8, 0.25, 0.2)}};
    spheres.inner[2] = Sphere {metal::float3(0.2, -0.1, -6.5), 0.9, Material {metal::float3(0.75, 0.75, 0.75)}};
    spheres.inner[3] = Sphere {metal::float3(1.9, -0.3, -6.0), 0.7, Material {metal::float3(0.2, 0.45, 0.8)}};
    lights.inner[0] = Light {metal::float3(4.0, 6.0, -2.0), metal::float3(9.0, 8.5, 7.5)};
    lights.inner[1] = Light {metal::float3(-5.0, 3.0, 0.0), metal::float3(2.0, 2.5, 4.0)};
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

bool inShadow(
    metal::float3 point,
    metal::float3 normal,
    Light light,
    thread type_6& spheres
) {
    metal::float3 point_1 = {};
    metal::float3 normal_1 = {};
    Light light_1 = {};
    metal::float3 origin = {};
    metal::float3 toLight = {};
    float distance = {};
    Ray ray_2 = {};
    int i = 0;
    point_1 = point;
    normal_1 = normal;
    light_1 = light;
    metal::float3 _e8 = point_1;
    metal::float3 _e10 = normal_1;
    origin = _e8 + (0.001 * _e10);
    Light _e14 = light_1;
    metal::float3 _e16 = origin;
    toLight = _e14.position - _e16;
    metal::float3 _e19 = toLight;
    distance = metal::length(_e19);
    metal::float3 _e22 = origin;
    metal::float3 _e23 = toLight;
    float _e24 = distance;
    ray_2 = Ray {_e22, _e23 / metal::float3(_e24)};
    while(true) {
        int _e31 = i;
        if (!((_e31 < SPHERES))) {
            break;
        }
        {
            Ray _e34 = ray_2;
            int _e35 = i;
            Sphere _e37 = spheres.inner[metal::min(unsigned(_e35), 3u)];
            float _e38 = intersectSphere(_e34, _e37);
            float _e39 = distance;
            if (_e38 < _e39) {
                {
                    return true;
                }
            }
            int _e42 = i;
            i = as_type<int>(as_type<uint>(_e42) + as_type<uint>(1));
        }
    }
    return false;
}

metal::float3 brdf(
    Material material
) {
    Material material_1 = {};
    material_1 = material;
    Material _e2 = material_1;
    return _e2.albedo / metal::float3(3.1415927);
}

metal::float3 shade(
    metal::float3 point_2,
    metal::float3 normal_2,
    Material material_2,
    thread type_6& spheres,
    thread type_7& lights
) {
    metal::float3 point_3 = {};
    metal::float3 normal_3 = {};
    Material material_3 = {};
    metal::float3 radiance = {};
    int i_1 = 0;
    float cosine = {};
    point_3 = point_2;
    normal_3 = normal_2;
    material_3 = material_2;
    Material _e9 = material_3;
    radiance = AMBIENT * _e9.albedo;
    while(true) {
        int _e15 = i_1;
        if (!((_e15 < LIGHTS))) {
            break;
        }
        {
            metal::float3 _e18 = normal_3;
            int _e19 = i_1;
            Light _e21 = lights.inner[metal::min(unsigned(_e19), 1u)];
            metal::float3 _e23 = point_3;
            cosine = metal::dot(_e18, metal::normalize(_e21.position - _e23));
            float _e28 = cosine;
            if (_e28 > 0.0) {
                {
                    metal::float3 _e31 = point_3;
                    metal::float3 _e32 = normal_3;
                    int _e33 = i_1;
                    Light _e35 = lights.inner[metal::min(unsigned(_e33), 1u)];
                    bool _e36 = inShadow(_e31, _e32, _e35, spheres);
                    if (!(_e36)) {
                        {
                            metal::float3 _e38 = radiance;
                            int _e39 = i_1;
                            Light _e41 = lights.inner[metal::min(unsigned(_e39), 1u)];
                            Material _e43 = material_3;
                            metal::float3 _e44 = brdf(_e43);
                            float _e46 = cosine;
                            radiance = _e38 + ((_e41.color * _e44) * _e46);
                        }
                    }
                }
            }
            int _e49 = i_1;
            i_1 = as_type<int>(as_type<uint>(_e49) + as_type<uint>(1));
        }
    }
    metal::float3 _e52 = radiance;
    return _e52;
}

metal::float3 toneMap(
    metal::float3 color
) {
    metal::float3 color_1 = {};
    color_1 = color;
    metal::float3 _e2 = color_1;
    metal::float3 _e3 = color_1;
    return _e2 / (_e3 + metal::float3(1.0));
}

metal::float3 gammaCorrect(
    metal::float3 color_2
) {
    metal::float3 color_3 = {};
    color_3 = color_2;
    metal::float3 _e2 = color_3;
    return metal::pow(_e2, metal::float3(0.45454544));
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
    thread type_6& spheres,
    thread type_7& lights
) {
    metal::float2 fragCoord_3 = {};
    Ray ray_3 = {};
    metal::float3 color_4 = metal::float3(0.5, 0.6, 0.8);
    float nearest = NO_HIT;
    int hit = -1;
    int i_2 = 0;
    float t_1 = {};
    metal::float3 point_4 = {};
    metal::float3 normal_4 = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    makeScene(spheres, lights);
    metal::float2 _e8 = fragCoord_3;
    Ray _e9 = cameraRay(_e8, global);
    ray_3 = _e9;
    while(true) {
        int _e21 = i_2;
        if (!((_e21 < SPHERES))) {
            break;
        }
        {
            Ray _e24 = ray_3;
            int _e25 = i_2;
            Sphere _e27 = spheres.inner[metal::min(unsigned(_e25), 3u)];
            float _e28 = intersectSphere(_e24, _e27);
            t_1 = _e28;
            float _e30 = t_1;
            float _e31 = nearest;
            if (_e30 < _e31) {
                {
                    float _e33 = t_1;
                    nearest = _e33;
                    int _e34 = i_2;
                    hit = _e34;
                }
            }
            int _e35 = i_2;
            i_2 = as_type<int>(as_type<uint>(_e35) + as_type<uint>(1));
        }
    }
    int _e38 = hit;
    if (_e38 >= 0) {
        {
            Ray _e41 = ray_3;
            float _e43 = nearest;
            Ray _e44 = ray_3;
            point_4 = _e41.origin + (_e43 * _e44.direction);
            metal::float3 _e49 = point_4;
            int _e50 = hit;
            Sphere _e52 = spheres.inner[metal::min(unsigned(_e50), 3u)];
            normal_4 = metal::normalize(_e49 - _e52.center);
            metal::float3 _e57 = point_4;
            metal::float3 _e58 = normal_4;
            int _e59 = hit;
            Sphere _e61 = spheres.inner[metal::min(unsigned(_e59), 3u)];
            metal::float3 _e63 = shade(_e57, _e58, _e61.material, spheres, lights);
            color_4 = _e63;
        }
    }
    metal::float3 _e64 = color_4;
    metal::float3 _e65 = toneMap(_e64);
    metal::float3 _e66 = gammaCorrect(_e65);
    fragColor = metal::float4(_e66.x, _e66.y, _e66.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread type_6& spheres,
    thread type_7& lights,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, spheres, lights);
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
    type_7 lights = {};
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, spheres, lights, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
