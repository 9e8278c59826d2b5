// glsl/12-whitted.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    int model;
    char _pad3[12];
    metal::float3 color;
};
struct Intersection {
    float t;
    char _pad1[12];
    metal::float3 point;
    metal::packed_float3 normal;
    int model;
    metal::float3 color;
};
struct Branch {
    Ray ray;
    metal::packed_float3 throughput;
    int depth;
};
struct type_6 {
    Sphere inner[4];
};
struct type_8 {
    Branch inner[8];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant float EPSILON = 0.001;
constant int SPHERES = 4;
constant int MAX_DEPTH = 6;
constant metal::float3 AMBIENT = metal::float3(0.15);
constant metal::float3 LIGHT = metal::float3(-4.0, 7.0, 1.0);
constant int MATTE = 0;
constant int MIRROR = 1;
constant int GLASS = 2;
constant float IOR = 1.5;

void makeScene(
    thread type_6& spheres
) {
    spheres.inner[0] = Sphere {metal::float3(-0.5, 0.0, -4.5), 0.9, 2, {}, metal::float3(0.95, 1.0, 0.95)};
    spheres.inner[1] = Sphere {metal::float3(1.3, 0.1, -6.5), 1.1, 1, {}, metal::float3(0.9, 0.9, 0.9)};
    spheres.inner[2] = Sphere {metal::float3(-2.4, -0.4, -7.0), 0.6, 0, {}, metal::float3(0.9, 0.3, 0.2)};
    spheres.inner[3] = Sphere {metal::float3(1.1, -0.7, -4.0), 0.3, 0, {}, metal::float3(0.2, 0.4, 0.9)};
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
    return ((1.0 - _e10) * metal::float3(0.9, 0.9, 0.95)) + (_e17 * metal::float3(0.3, 0.5, 0.9));
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
    Ray _e6 = ray_1;
    Sphere _e8 = sphere_1;
    f = _e6.origin - _e8.center;
    metal::float3 _e12 = f;
    Ray _e13 = ray_1;
    b = metal::dot(_e12, _e13.direction);
    metal::float3 _e17 = f;
    metal::float3 _e18 = f;
    Sphere _e20 = sphere_1;
    Sphere _e22 = sphere_1;
    c = metal::dot(_e17, _e18) - (_e20.radius * _e22.radius);
    float _e27 = b;
    float _e28 = b;
    float _e30 = c;
    disc = (_e27 * _e28) - _e30;
    float _e33 = disc;
    if (_e33 > 0.0) {
        {
            float _e36 = disc;
            root = metal::sqrt(_e36);
            float _e39 = b;
            float _e41 = root;
            t = -(_e39) - _e41;
            float _e44 = t;
            if (_e44 > EPSILON) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b;
            float _e49 = root;
            t = -(_e47) + _e49;
            float _e51 = t;
            if (_e51 > EPSILON) {
                {
                    float _e53 = t;
                    return _e53;
                }
            }
        }
    }
    return NO_HIT;
}

metal::float3 checker(
    metal::float3 point
) {
    metal::float3 point_1 = {};
    float square = {};
    metal::float3 local = {};
    point_1 = point;
    metal::float3 _e2 = point_1;
    metal::float3 _e5 = point_1;
    square = metal::floor(_e2.x) + metal::floor(_e5.z);
    float _e10 = square;
    if ((_e10 - (metal::floor(_e10 / 2.0) * 2.0)) == 0.0) {
        local = metal::float3(0.9, 0.8, 0.3);
    } else {
        local = metal::float3(0.6, 0.15, 0.1);
    }
    metal::float3 _e27 = local;
    return _e27;
}

Intersection nearestHit(
    Ray ray_2,
    thread type_6& spheres
) {
    Ray ray_3 = {};
    Intersection hit = Intersection {1000000.0, {}, metal::float3(0.0), metal::float3(0.0), 0, metal::float3(0.0)};
    int i = 0;
    float t_1 = {};
    metal::float3 point_2 = {};
    metal::float3 normal = {};
    float t_2 = {};
    metal::float3 point_3 = {};
    ray_3 = ray_2;
    while(true) {
        int _e18 = i;
        if (!((_e18 < SPHERES))) {
            break;
        }
        {
            Ray _e21 = ray_3;
            int _e22 = i;
            Sphere _e24 = spheres.inner[metal::min(unsigned(_e22), 3u)];
            float _e25 = intersectSphere(_e21, _e24);
            t_1 = _e25;
            float _e27 = t_1;
            Intersection _e28 = hit;
            if (_e27 < _e28.t) {
                {
                    Ray _e31 = ray_3;
                    float _e33 = t_1;
                    Ray _e34 = ray_3;
                    point_2 = _e31.origin + (_e33 * _e34.direction);
                    metal::float3 _e39 = point_2;
                    int _e40 = i;
                    Sphere _e42 = spheres.inner[metal::min(unsigned(_e40), 3u)];
                    normal = metal::normalize(_e39 - _e42.center);
                    float _e47 = t_1;
                    metal::float3 _e48 = point_2;
                    metal::float3 _e49 = normal;
                    int _e50 = i;
                    Sphere _e52 = spheres.inner[metal::min(unsigned(_e50), 3u)];
                    int _e54 = i;
                    Sphere _e56 = spheres.inner[metal::min(unsigned(_e54), 3u)];
                    hit = Intersection {_e47, {}, _e48, _e49, _e52.model, _e56.color};
                }
            }
            int _e59 = i;
            i = as_type<int>(as_type<uint>(_e59) + as_type<uint>(1));
        }
    }
    Ray _e63 = ray_3;
    Ray _e67 = ray_3;
    t_2 = (-1.02 - _e63.origin.y) / _e67.direction.y;
    float _e72 = t_2;
    float _e74 = t_2;
    Intersection _e75 = hit;
    if ((_e72 > EPSILON) && (_e74 < _e75.t)) {
        {
            Ray _e79 = ray_3;
            float _e81 = t_2;
            Ray _e82 = ray_3;
            point_3 = _e79.origin + (_e81 * _e82.direction);
            float _e87 = t_2;
            metal::float3 _e88 = point_3;
            metal::float3 _e93 = point_3;
            metal::float3 _e94 = checker(_e93);
            hit = Intersection {_e87, {}, _e88, metal::float3(0.0, 1.0, 0.0), MATTE, _e94};
        }
    }
    Intersection _e96 = hit;
    return _e96;
}

metal::float3 shade(
    Intersection hit_1,
    thread type_6& spheres
) {
    Intersection hit_2 = {};
    metal::float3 sum = AMBIENT;
    float cosine = {};
    metal::float3 origin = {};
    metal::float3 toLight = {};
    float distance = {};
    hit_2 = hit_1;
    Intersection _e6 = hit_2;
    Intersection _e8 = hit_2;
    cosine = metal::dot(_e6.normal, metal::normalize(LIGHT - _e8.point));
    float _e14 = cosine;
    if (_e14 > 0.0) {
        {
            Intersection _e17 = hit_2;
            Intersection _e19 = hit_2;
            origin = _e17.point + (EPSILON * _e19.normal);
            metal::float3 _e24 = origin;
            toLight = LIGHT - _e24;
            metal::float3 _e27 = toLight;
            distance = metal::length(_e27);
            metal::float3 _e30 = origin;
            metal::float3 _e31 = toLight;
            float _e32 = distance;
            Intersection _e36 = nearestHit(Ray {_e30, _e31 / metal::float3(_e32)}, spheres);
            float _e38 = distance;
            if (_e36.t > _e38) {
                {
                    metal::float3 _e40 = sum;
                    float _e43 = cosine;
                    sum = _e40 + (metal::float3(0.85) * _e43);
                }
            }
        }
    }
    Intersection _e46 = hit_2;
    metal::float3 _e48 = sum;
    return _e46.color * _e48;
}

float fresnel(
    float eta,
    float cosine_1,
    float beyond
) {
    float eta_1 = {};
    float cosine_2 = {};
    float beyond_1 = {};
    float across = {};
    float along = {};
    eta_1 = eta;
    cosine_2 = cosine_1;
    beyond_1 = beyond;
    float _e6 = eta_1;
    float _e7 = cosine_2;
    float _e9 = beyond_1;
    float _e11 = eta_1;
    float _e12 = cosine_2;
    float _e14 = beyond_1;
    across = ((_e6 * _e7) - _e9) / ((_e11 * _e12) + _e14);
    float _e18 = cosine_2;
    float _e19 = eta_1;
    float _e20 = beyond_1;
    float _e23 = cosine_2;
    float _e24 = eta_1;
    float _e25 = beyond_1;
    along = (_e18 - (_e19 * _e20)) / (_e23 + (_e24 * _e25));
    float _e31 = across;
    float _e32 = across;
    float _e34 = along;
    float _e35 = along;
    return 0.5 * ((_e31 * _e32) + (_e34 * _e35));
}

metal::float3 trace(
    Ray first,
    thread type_6& spheres
) {
    Ray first_1 = {};
    type_8 stack = {};
    int top = 1;
    metal::float3 color = metal::float3(0.0);
    Branch branch = {};
    Ray ray_4 = {};
    Intersection hit_3 = {};
    int depth = {};
    metal::float3 throughput = {};
    Ray mirrored = {};
    bool entering = {};
    metal::float3 local_1 = {};
    metal::float3 normal_1 = {};
    float local_2 = {};
    float eta_2 = {};
    float cosine_3 = {};
    float sine2_ = {};
    float beyond_2 = {};
    float share = {};
    metal::float3 refracted = {};
    first_1 = first;
    Ray _e10 = first_1;
    stack.inner[0] = Branch {_e10, metal::float3(1.0), 0};
    while(true) {
        int _e20 = top;
        if (!((_e20 > 0))) {
            break;
        }
        {
            int _e24 = top;
            top = as_type<int>(as_type<uint>(_e24) - as_type<uint>(1));
            int _e27 = top;
            Branch _e29 = stack.inner[metal::min(unsigned(_e27), 7u)];
            branch = _e29;
            Branch _e31 = branch;
            ray_4 = _e31.ray;
            Ray _e34 = ray_4;
            Intersection _e35 = nearestHit(_e34, spheres);
            hit_3 = _e35;
            Intersection _e37 = hit_3;
            if (_e37.t == NO_HIT) {
                {
                    metal::float3 _e40 = color;
                    Branch _e41 = branch;
                    Ray _e43 = ray_4;
                    metal::float3 _e45 = sky(_e43.direction);
                    color = _e40 + (_e41.throughput * _e45);
                    continue;
                }
            }
            Intersection _e48 = hit_3;
            if (_e48.model == MATTE) {
                {
                    metal::float3 _e51 = color;
                    Branch _e52 = branch;
                    Intersection _e54 = hit_3;
                    metal::float3 _e55 = shade(_e54, spheres);
                    color = _e51 + (_e52.throughput * _e55);
                    continue;
                }
            }
            Branch _e58 = branch;
            depth = as_type<int>(as_type<uint>(_e58.depth) + as_type<uint>(1));
            int _e63 = depth;
            if (_e63 == MAX_DEPTH) {
                {
                    continue;
                }
            }
            Branch _e65 = branch;
            Intersection _e67 = hit_3;
            throughput = _e65.throughput * _e67.color;
            Intersection _e71 = hit_3;
            Ray _e73 = ray_4;
            Intersection _e75 = hit_3;
            mirrored = Ray {_e71.point, metal::reflect(_e73.direction, _e75.normal)};
            Intersection _e80 = hit_3;
            if (_e80.model == MIRROR) {
                {
                    int _e83 = top;
                    top = as_type<int>(as_type<uint>(_e83) + as_type<uint>(1));
                    Ray _e87 = mirrored;
                    metal::float3 _e88 = throughput;
                    int _e89 = depth;
                    stack.inner[metal::min(unsigned(_e83), 7u)] = Branch {_e87, _e88, _e89};
                    continue;
                }
            }
            Ray _e91 = ray_4;
            Intersection _e93 = hit_3;
            entering = metal::dot(_e91.direction, _e93.normal) < 0.0;
            bool _e99 = entering;
            if (_e99) {
                Intersection _e100 = hit_3;
                local_1 = _e100.normal;
            } else {
                Intersection _e102 = hit_3;
                local_1 = -(_e102.normal);
            }
            metal::float3 _e106 = local_1;
            normal_1 = _e106;
            bool _e108 = entering;
            if (_e108) {
                local_2 = 0.6666667;
            } else {
                local_2 = IOR;
            }
            float _e111 = local_2;
            eta_2 = _e111;
            Ray _e113 = ray_4;
            metal::float3 _e115 = normal_1;
            cosine_3 = -(metal::dot(_e113.direction, _e115));
            float _e119 = eta_2;
            float _e120 = eta_2;
            float _e123 = cosine_3;
            float _e124 = cosine_3;
            sine2_ = (_e119 * _e120) * (1.0 - (_e123 * _e124));
            float _e129 = sine2_;
            if (_e129 >= 1.0) {
                {
                    int _e132 = top;
                    top = as_type<int>(as_type<uint>(_e132) + as_type<uint>(1));
                    Ray _e136 = mirrored;
                    metal::float3 _e137 = throughput;
                    int _e138 = depth;
                    stack.inner[metal::min(unsigned(_e132), 7u)] = Branch {_e136, _e137, _e138};
                    continue;
                }
            }
            float _e141 = sine2_;
            beyond_2 = metal::sqrt(1.0 - _e141);
            float _e145 = eta_2;
            float _e146 = cosine_3;
            float _e147 = beyond_2;
            float _e148 = fresnel(_e145, _e146, _e147);
            share = _e148;
            float _e150 = eta_2;
            Ray _e151 = ray_4;
            float _e154 = eta_2;
            float _e155 = cosine_3;
            float _e157 = beyond_2;
            metal::float3 _e159 = normal_1;
            refracted = (_e150 * _e151.direction) + (((_e154 * _e155) - _e157) * _e159);
            int _e163 = top;
            top = as_type<int>(as_type<uint>(_e163) + as_type<uint>(1));
            Ray _e167 = mirrored;
            metal::float3 _e168 = throughput;
            float _e169 = share;
            int _e171 = depth;
            stack.inner[metal::min(unsigned(_e163), 7u)] = Branch {_e167, _e168 * _e169, _e171};
            int _e173 = top;
            top = as_type<int>(as_type<uint>(_e173) + as_type<uint>(1));
            Intersection _e177 = hit_3;
            metal::float3 _e179 = refracted;
            metal::float3 _e181 = throughput;
            float _e183 = share;
            int _e186 = depth;
            stack.inner[metal::min(unsigned(_e173), 7u)] = Branch {Ray {_e177.point, _e179}, _e181 * (1.0 - _e183), _e186};
        }
    }
    metal::float3 _e188 = color;
    return _e188;
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
    fragCoord_3 = fragCoord_2;
    makeScene(spheres);
    metal::float2 _e3 = fragCoord_3;
    Ray _e4 = cameraRay(_e3, global);
    metal::float3 _e5 = trace(_e4, spheres);
    fragColor = metal::float4(_e5.x, _e5.y, _e5.z, 1.0);
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
