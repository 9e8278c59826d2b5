// glsl/04-many-objects.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
struct Intersection {
    float t;
    int sphere;
    char _pad2[8];
    metal::float3 point;
    metal::float3 normal;
};
struct type_6 {
    Sphere inner[7];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant int SAMPLES = 4;
constant int SPHERES = 7;
constant metal::float3 AMBIENT = metal::float3(0.08);

float random(
    thread float& seed
) {
    float _e1 = seed;
    seed = _e1 + 1.0;
    return metal::fract(metal::sin(_e1) * 43758.547);
}

void makeScene(
    thread type_6& spheres,
    thread Light& light
) {
    spheres.inner[0] = Sphere {metal::float3(0.0, -31.0, -8.0), 30.0, metal::float3(0.5, 0.5, 0.45)};
    spheres.inner[1] = Sphere {metal::float3(0.5, -0.7, -4.0), 0.3, metal::float3(0.2, 0.8, 0.3)};
    spheres.inner[2] = Sphere {metal::float3(0.0, 0.0, -6.0), 1.0, metal::float3(0.9, 0.8, 0.1)};
    spheres.inner[3] = Sphere {metal::float3(-1.5, -0.4, -5.0), 0.6, metal::float3(0.9, 0.2, 0.15)};
    spheres.inner[4] = Sphere {metal::float3(1.4, -0.5, -4.8), 0.5, metal::float3(0.15, 0.3, 0.9)};
    spheres.inner[5] = Sphere {metal::float3(-0.6, 1.1, -5.5), 0.35, metal::float3(0.8, 0.4, 0.8)};
    spheres.inner[6] = Sphere {metal::float3(6.8, 10.2, 5.9), 3.0, metal::float3(0.6, 0.6, 0.6)};
    light = Light {metal::float3(4.0, 6.0, 1.0), metal::float3(0.9)};
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

Intersection nearestHit(
    Ray ray_2,
    thread type_6& spheres
) {
    Ray ray_3 = {};
    Intersection hit = {};
    int i = 0;
    float t_1 = {};
    int i_1 = 0;
    ray_3 = ray_2;
    hit.t = NO_HIT;
    hit.sphere = -1;
    while(true) {
        int _e11 = i;
        if (!((_e11 < SPHERES))) {
            break;
        }
        {
            Ray _e14 = ray_3;
            int _e15 = i;
            Sphere _e17 = spheres.inner[metal::min(unsigned(_e15), 6u)];
            float _e18 = intersectSphere(_e14, _e17);
            t_1 = _e18;
            float _e20 = t_1;
            Intersection _e21 = hit;
            if (_e20 < _e21.t) {
                {
                    float _e25 = t_1;
                    hit.t = _e25;
                    int _e27 = i;
                    hit.sphere = _e27;
                }
            }
            int _e28 = i;
            i = as_type<int>(as_type<uint>(_e28) + as_type<uint>(1));
        }
    }
    while(true) {
        int _e33 = i_1;
        if (!((_e33 < SPHERES))) {
            break;
        }
        {
            int _e36 = i_1;
            Intersection _e37 = hit;
            if (_e36 == _e37.sphere) {
                {
                    Ray _e41 = ray_3;
                    Intersection _e43 = hit;
                    Ray _e45 = ray_3;
                    hit.point = _e41.origin + (_e43.t * _e45.direction);
                    Intersection _e50 = hit;
                    int _e52 = i_1;
                    Sphere _e54 = spheres.inner[metal::min(unsigned(_e52), 6u)];
                    int _e57 = i_1;
                    Sphere _e59 = spheres.inner[metal::min(unsigned(_e57), 6u)];
                    hit.normal = (_e50.point - _e54.center) / metal::float3(_e59.radius);
                }
            }
            int _e63 = i_1;
            i_1 = as_type<int>(as_type<uint>(_e63) + as_type<uint>(1));
        }
    }
    Intersection _e66 = hit;
    return _e66;
}

bool inShadow(
    metal::float3 point,
    metal::float3 normal,
    thread type_6& spheres,
    thread Light& light
) {
    metal::float3 point_1 = {};
    metal::float3 normal_1 = {};
    metal::float3 origin = {};
    metal::float3 toLight = {};
    float distance = {};
    Ray ray_4 = {};
    int i_2 = 0;
    point_1 = point;
    normal_1 = normal;
    metal::float3 _e7 = point_1;
    metal::float3 _e9 = normal_1;
    origin = _e7 + (0.001 * _e9);
    Light _e13 = light;
    metal::float3 _e15 = origin;
    toLight = _e13.position - _e15;
    metal::float3 _e18 = toLight;
    distance = metal::length(_e18);
    metal::float3 _e21 = origin;
    metal::float3 _e22 = toLight;
    float _e23 = distance;
    ray_4 = Ray {_e21, _e22 / metal::float3(_e23)};
    while(true) {
        int _e30 = i_2;
        if (!((_e30 < SPHERES))) {
            break;
        }
        {
            Ray _e33 = ray_4;
            int _e34 = i_2;
            Sphere _e36 = spheres.inner[metal::min(unsigned(_e34), 6u)];
            float _e37 = intersectSphere(_e33, _e36);
            float _e38 = distance;
            if (_e37 < _e38) {
                {
                    return true;
                }
            }
            int _e41 = i_2;
            i_2 = as_type<int>(as_type<uint>(_e41) + as_type<uint>(1));
        }
    }
    return false;
}

metal::float3 trace(
    Ray ray_5,
    thread type_6& spheres,
    thread Light& light
) {
    Ray ray_6 = {};
    Intersection hit_1 = {};
    metal::float3 sum = AMBIENT;
    float cosine = {};
    ray_6 = ray_5;
    Ray _e5 = ray_6;
    Intersection _e6 = nearestHit(_e5, spheres);
    hit_1 = _e6;
    Intersection _e8 = hit_1;
    if (_e8.sphere < 0) {
        {
            return metal::float3(0.3, 0.4, 0.6);
        }
    }
    Intersection _e17 = hit_1;
    Light _e19 = light;
    Intersection _e21 = hit_1;
    cosine = metal::dot(_e17.normal, metal::normalize(_e19.position - _e21.point));
    float _e27 = cosine;
    if (_e27 > 0.0) {
        {
            Intersection _e30 = hit_1;
            Intersection _e32 = hit_1;
            bool _e34 = inShadow(_e30.point, _e32.normal, spheres, light);
            if (!(_e34)) {
                {
                    metal::float3 _e36 = sum;
                    Light _e37 = light;
                    float _e39 = cosine;
                    sum = _e36 + (_e37.color * _e39);
                }
            }
        }
    }
    Intersection _e42 = hit_1;
    Sphere _e45 = spheres.inner[metal::min(unsigned(_e42.sphere), 6u)];
    metal::float3 _e47 = sum;
    return _e45.color * _e47;
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
    thread Light& light,
    thread float& seed
) {
    metal::float2 fragCoord_3 = {};
    metal::float3 color = metal::float3(0.0);
    int i_3 = 0;
    float x_1 = {};
    float y_1 = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    makeScene(spheres, light);
    seed = 0.0;
    while(true) {
        int _e13 = i_3;
        if (!((_e13 < SAMPLES))) {
            break;
        }
        {
            metal::float2 _e16 = fragCoord_3;
            float _e18 = random(seed);
            x_1 = (_e16.x + _e18) - 0.5;
            metal::float2 _e23 = fragCoord_3;
            float _e25 = random(seed);
            y_1 = (_e23.y + _e25) - 0.5;
            metal::float3 _e30 = color;
            float _e31 = x_1;
            float _e32 = y_1;
            Ray _e34 = cameraRay(metal::float2(_e31, _e32), global);
            metal::float3 _e35 = trace(_e34, spheres, light);
            color = _e30 + _e35;
            int _e37 = i_3;
            i_3 = as_type<int>(as_type<uint>(_e37) + as_type<uint>(1));
        }
    }
    metal::float3 _e40 = color;
    metal::float3 _e43 = _e40 / metal::float3(4.0);
    fragColor = metal::float4(_e43.x, _e43.y, _e43.z, 1.0);
    return;
}

void main_1(
    thread metal::float4& toyproof_color,
    constant ToyproofFrame& global,
    thread type_6& spheres,
    thread Light& light,
    thread float& seed,
    thread metal::float4& gl_FragCoord_1
) {
    metal::float4 toyproof_image_color = metal::float4(0.0, 0.0, 0.0, 1.0);
    metal::float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy, global, spheres, light, seed);
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
    float seed = {};
    metal::float4 gl_FragCoord_1 = {};
    gl_FragCoord_1 = gl_FragCoord;
    main_1(toyproof_color, global, spheres, light, seed, gl_FragCoord_1);
    metal::float4 _e3 = toyproof_color;
    const auto _tmp = FragmentOutput {_e3};
    return main_Output { _tmp.toyproof_color };
}
