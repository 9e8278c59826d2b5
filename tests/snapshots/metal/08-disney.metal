// glsl/08-disney.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

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
    metal::packed_float3 color;
    float metallic;
    float subsurface;
    float specular;
    float specularTint;
    float roughness;
    float anisotropic;
    float sheen;
    float sheenTint;
    float clearcoat;
    float clearcoatGloss;
    char _pad11[12];
};
struct Sphere {
    metal::packed_float3 center;
    float radius;
    Material material;
};
struct type_6 {
    Sphere inner[10];
};
struct FragmentOutput {
    metal::float4 toyproof_color;
};
constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1000000.0;
constant float PI = 3.1415927;
constant int SPHERES = 10;
constant metal::float3 AMBIENT = metal::float3(0.25, 0.27, 0.3);
constant metal::float3 LIGHT = metal::float3(-3.0, 6.0, 2.0);
constant metal::float3 LIGHT_COLOR = metal::float3(5.0, 4.8, 4.5);

void makeScene(
    thread type_6& spheres
) {
    spheres.inner[0] = Sphere {metal::float3(-2.0, 1.3, -7.0), 0.58, Material {metal::float3(0.8, 0.2, 0.15), 0.0, 0.0, 0.5, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6}};
    spheres.inner[1] = Sphere {metal::float3(0.0, 1.3, -7.0), 0.58, Material {metal::float3(0.8, 0.2, 0.15), 0.0, 0.0, 0.8, 0.0, 0.4, 0.0, 0.0, 0.5, 0.0, 0.6}};
    spheres.inner[2] = Sphere {metal::float3(2.0, 1.3, -7.0), 0.58, Material {metal::float3(0.8, 0.2, 0.15), 0.0, 0.0, 1.0, 0.8, 0.25, 0.0, 0.0, 0.5, 0.0, 0.6}};
    spheres.inner[3] = Sphere {metal::float3(-2.0, 0.0, -7.0), 0.58, Material {metal::float3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6}};
    spheres.inner[4] = Sphere {metal::float3(0.0, 0.0, -7.0), 0.58, Material {metal::float3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.45, 0.8, 0.0, 0.5, 0.0, 0.6}};
    spheres.inner[5] = Sphere {metal::float3(2.0, 0.0, -7.0), 0.58, Material {metal::float3(1.0, 0.75, 0.35), 0.5, 0.0, 0.5, 0.0, 0.3, 0.0, 0.0, 0.5, 0.0, 0.6}};
    spheres.inner[6] = Sphere {metal::float3(-2.0, -1.3, -7.0), 0.58, Material {metal::float3(0.25, 0.35, 0.8), 0.0, 0.0, 0.1, 0.0, 0.8, 0.0, 1.0, 0.3, 0.0, 0.6}};
    spheres.inner[7] = Sphere {metal::float3(0.0, -1.3, -7.0), 0.58, Material {metal::float3(0.9, 0.6, 0.5), 0.0, 0.9, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6}};
    spheres.inner[8] = Sphere {metal::float3(2.0, -1.3, -7.0), 0.58, Material {metal::float3(0.15, 0.5, 0.25), 0.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 1.0, 0.6}};
    spheres.inner[9] = Sphere {metal::float3(0.0, -52.3, -8.0), 50.0, Material {metal::float3(0.4, 0.4, 0.4), 0.0, 0.0, 0.2, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6}};
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
    thread type_6& spheres
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
    metal::float3 _e13 = origin;
    toLight = LIGHT - _e13;
    metal::float3 _e16 = toLight;
    distance = metal::length(_e16);
    metal::float3 _e19 = origin;
    metal::float3 _e20 = toLight;
    float _e21 = distance;
    ray_2 = Ray {_e19, _e20 / metal::float3(_e21)};
    while(true) {
        int _e28 = i;
        if (!((_e28 < SPHERES))) {
            break;
        }
        {
            Ray _e31 = ray_2;
            int _e32 = i;
            Sphere _e34 = spheres.inner[metal::min(unsigned(_e32), 9u)];
            float _e35 = intersectSphere(_e31, _e34);
            float _e36 = distance;
            if (_e35 < _e36) {
                {
                    return true;
                }
            }
            int _e39 = i;
            i = as_type<int>(as_type<uint>(_e39) + as_type<uint>(1));
        }
    }
    return false;
}

float square(
    float x
) {
    float x_1 = {};
    x_1 = x;
    float _e2 = x_1;
    float _e3 = x_1;
    return _e2 * _e3;
}

float schlick(
    float cosine
) {
    float cosine_1 = {};
    float m = {};
    cosine_1 = cosine;
    float _e3 = cosine_1;
    m = metal::clamp(1.0 - _e3, 0.0, 1.0);
    float _e9 = m;
    float _e10 = square(_e9);
    float _e11 = square(_e10);
    float _e12 = m;
    return _e11 * _e12;
}

float berry(
    float nH,
    float alpha
) {
    float nH_1 = {};
    float alpha_1 = {};
    float a2_ = {};
    nH_1 = nH;
    alpha_1 = alpha;
    float _e5 = alpha_1;
    float _e6 = alpha_1;
    a2_ = _e5 * _e6;
    float _e9 = a2_;
    float _e12 = a2_;
    float _e16 = a2_;
    float _e19 = nH_1;
    float _e21 = nH_1;
    return (_e9 - 1.0) / ((PI * metal::log(_e12)) * (1.0 + (((_e16 - 1.0) * _e19) * _e21)));
}

float trowbridgeReitz(
    float nH_2,
    float xH,
    float yH,
    float ax,
    float ay
) {
    float nH_3 = {};
    float xH_1 = {};
    float yH_1 = {};
    float ax_1 = {};
    float ay_1 = {};
    nH_3 = nH_2;
    xH_1 = xH;
    yH_1 = yH;
    ax_1 = ax;
    ay_1 = ay;
    float _e12 = ax_1;
    float _e14 = ay_1;
    float _e16 = xH_1;
    float _e17 = ax_1;
    float _e19 = square(_e16 / _e17);
    float _e20 = yH_1;
    float _e21 = ay_1;
    float _e23 = square(_e20 / _e21);
    float _e25 = nH_3;
    float _e26 = nH_3;
    float _e29 = square((_e19 + _e23) + (_e25 * _e26));
    return 1.0 / (((PI * _e12) * _e14) * _e29);
}

float smith(
    float cosine_2,
    float alpha_2
) {
    float cosine_3 = {};
    float alpha_3 = {};
    float a2_1 = {};
    float c2_ = {};
    cosine_3 = cosine_2;
    alpha_3 = alpha_2;
    float _e4 = alpha_3;
    float _e5 = alpha_3;
    a2_1 = _e4 * _e5;
    float _e8 = cosine_3;
    float _e9 = cosine_3;
    c2_ = _e8 * _e9;
    float _e13 = cosine_3;
    float _e14 = a2_1;
    float _e15 = c2_;
    float _e17 = a2_1;
    float _e18 = c2_;
    return 1.0 / (_e13 + metal::sqrt((_e14 + _e15) - (_e17 * _e18)));
}

metal::float3 disney(
    Material m_1,
    metal::float3 light,
    metal::float3 view,
    metal::float3 normal_2
) {
    Material m_2 = {};
    metal::float3 light_1 = {};
    metal::float3 view_1 = {};
    metal::float3 normal_3 = {};
    float nL = {};
    float nV = {};
    metal::float3 middle = {};
    float nH_4 = {};
    float lH = {};
    metal::float3 x_2 = {};
    metal::float3 y = {};
    float luminance = {};
    metal::float3 tint = {};
    metal::float3 dielectric = {};
    metal::float3 specularColor = {};
    metal::float3 sheenColor = {};
    float fL = {};
    float fV = {};
    float fH = {};
    float retro = {};
    float grazing = {};
    float diffuse = {};
    float flatness = {};
    float subsurface = {};
    metal::float3 base = {};
    metal::float3 sheen = {};
    float aspect = {};
    float ax_2 = {};
    float ay_2 = {};
    float d = {};
    float alpha_4 = {};
    float g = {};
    metal::float3 f_1 = {};
    float coat = {};
    m_2 = m_1;
    light_1 = light;
    view_1 = view;
    normal_3 = normal_2;
    metal::float3 _e8 = normal_3;
    metal::float3 _e9 = light_1;
    nL = metal::dot(_e8, _e9);
    metal::float3 _e12 = normal_3;
    metal::float3 _e13 = view_1;
    nV = metal::dot(_e12, _e13);
    float _e16 = nL;
    float _e19 = nV;
    if ((_e16 <= 0.0) || (_e19 <= 0.0)) {
        {
            return metal::float3(0.0);
        }
    }
    metal::float3 _e25 = light_1;
    metal::float3 _e26 = view_1;
    middle = metal::normalize(_e25 + _e26);
    metal::float3 _e30 = normal_3;
    metal::float3 _e31 = middle;
    nH_4 = metal::dot(_e30, _e31);
    metal::float3 _e34 = light_1;
    metal::float3 _e35 = middle;
    lH = metal::dot(_e34, _e35);
    metal::float3 _e38 = normal_3;
    metal::float3 _e41 = normal_3;
    x_2 = metal::normalize(metal::float3(_e38.z, 0.0, -(_e41.x)));
    metal::float3 _e47 = normal_3;
    metal::float3 _e48 = x_2;
    y = metal::cross(_e47, _e48);
    Material _e51 = m_2;
    luminance = metal::dot(_e51.color, metal::float3(0.3, 0.6, 0.1));
    Material _e59 = m_2;
    float _e61 = luminance;
    tint = _e59.color / metal::float3(_e61);
    Material _e66 = m_2;
    metal::float3 _e71 = tint;
    Material _e72 = m_2;
    dielectric = (0.08 * _e66.specular) * metal::mix(metal::float3(1.0), _e71, metal::float3(_e72.specularTint));
    metal::float3 _e78 = dielectric;
    Material _e79 = m_2;
    Material _e81 = m_2;
    specularColor = metal::mix(_e78, _e79.color, metal::float3(_e81.metallic));
    metal::float3 _e88 = tint;
    Material _e89 = m_2;
    sheenColor = metal::mix(metal::float3(1.0), _e88, metal::float3(_e89.sheenTint));
    float _e94 = nL;
    float _e95 = schlick(_e94);
    fL = _e95;
    float _e97 = nV;
    float _e98 = schlick(_e97);
    fV = _e98;
    float _e100 = lH;
    float _e101 = schlick(_e100);
    fH = _e101;
    float _e103 = lH;
    float _e104 = lH;
    Material _e106 = m_2;
    retro = (_e103 * _e104) * _e106.roughness;
    float _e112 = retro;
    grazing = 0.5 + (2.0 * _e112);
    float _e117 = grazing;
    float _e118 = fL;
    float _e121 = grazing;
    float _e122 = fV;
    diffuse = metal::mix(1.0, _e117, _e118) * metal::mix(1.0, _e121, _e122);
    float _e127 = retro;
    float _e128 = fL;
    float _e131 = retro;
    float _e132 = fV;
    flatness = metal::mix(1.0, _e127, _e128) * metal::mix(1.0, _e131, _e132);
    float _e137 = flatness;
    float _e139 = nL;
    float _e140 = nV;
    subsurface = 1.25 * ((_e137 * ((1.0 / (_e139 + _e140)) - 0.5)) + 0.5);
    Material _e150 = m_2;
    float _e155 = diffuse;
    float _e156 = subsurface;
    Material _e157 = m_2;
    base = (_e150.color / metal::float3(3.1415927)) * metal::mix(_e155, _e156, _e157.subsurface);
    float _e162 = fH;
    Material _e163 = m_2;
    metal::float3 _e166 = sheenColor;
    sheen = (_e162 * _e163.sheen) * _e166;
    Material _e171 = m_2;
    aspect = metal::sqrt(1.0 - (0.9 * _e171.anisotropic));
    Material _e178 = m_2;
    float _e180 = square(_e178.roughness);
    float _e181 = aspect;
    ax_2 = metal::max(0.001, _e180 / _e181);
    Material _e186 = m_2;
    float _e188 = square(_e186.roughness);
    float _e189 = aspect;
    ay_2 = metal::max(0.001, _e188 * _e189);
    float _e193 = nH_4;
    metal::float3 _e194 = x_2;
    metal::float3 _e195 = middle;
    metal::float3 _e197 = y;
    metal::float3 _e198 = middle;
    float _e200 = ax_2;
    float _e201 = ay_2;
    float _e202 = trowbridgeReitz(_e193, metal::dot(_e194, _e195), metal::dot(_e197, _e198), _e200, _e201);
    d = _e202;
    Material _e206 = m_2;
    float _e210 = square(0.5 + (0.5 * _e206.roughness));
    alpha_4 = _e210;
    float _e212 = nL;
    float _e213 = alpha_4;
    float _e214 = smith(_e212, _e213);
    float _e215 = nV;
    float _e216 = alpha_4;
    float _e217 = smith(_e215, _e216);
    g = _e214 * _e217;
    metal::float3 _e220 = specularColor;
    float _e223 = fH;
    f_1 = metal::mix(_e220, metal::float3(1.0), metal::float3(_e223));
    Material _e228 = m_2;
    float _e231 = nH_4;
    Material _e234 = m_2;
    float _e237 = berry(_e231, metal::mix(0.1, 0.001, _e234.clearcoatGloss));
    float _e241 = fH;
    float _e244 = nL;
    float _e246 = smith(_e244, 0.25);
    float _e248 = nV;
    float _e250 = smith(_e248, 0.25);
    coat = ((((0.25 * _e228.clearcoat) * _e237) * metal::mix(0.04, 1.0, _e241)) * _e246) * _e250;
    metal::float3 _e253 = base;
    metal::float3 _e254 = sheen;
    Material _e257 = m_2;
    metal::float3 _e261 = f_1;
    float _e262 = d;
    float _e264 = g;
    float _e267 = coat;
    return (((_e253 + _e254) * (1.0 - _e257.metallic)) + ((_e261 * _e262) * _e264)) + metal::float3(_e267);
}

metal::float3 shade(
    metal::float3 point_2,
    metal::float3 normal_4,
    metal::float3 view_2,
    Material material,
    thread type_6& spheres
) {
    metal::float3 point_3 = {};
    metal::float3 normal_5 = {};
    metal::float3 view_3 = {};
    Material material_1 = {};
    metal::float3 radiance = {};
    metal::float3 toLight_1 = {};
    float cosine_4 = {};
    point_3 = point_2;
    normal_5 = normal_4;
    view_3 = view_2;
    material_1 = material;
    Material _e11 = material_1;
    radiance = AMBIENT * _e11.color;
    metal::float3 _e15 = point_3;
    toLight_1 = metal::normalize(LIGHT - _e15);
    metal::float3 _e19 = normal_5;
    metal::float3 _e20 = toLight_1;
    cosine_4 = metal::dot(_e19, _e20);
    float _e23 = cosine_4;
    if (_e23 > 0.0) {
        {
            metal::float3 _e26 = point_3;
            metal::float3 _e27 = normal_5;
            bool _e28 = inShadow(_e26, _e27, spheres);
            if (!(_e28)) {
                {
                    metal::float3 _e30 = radiance;
                    Material _e31 = material_1;
                    metal::float3 _e32 = toLight_1;
                    metal::float3 _e33 = view_3;
                    metal::float3 _e34 = normal_5;
                    metal::float3 _e35 = disney(_e31, _e32, _e33, _e34);
                    float _e37 = cosine_4;
                    radiance = _e30 + ((LIGHT_COLOR * _e35) * _e37);
                }
            }
        }
    }
    metal::float3 _e40 = radiance;
    return _e40;
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

Ray cameraRay(
    metal::float2 fragCoord,
    constant ToyproofFrame& global
) {
    metal::float2 fragCoord_1 = {};
    float aspect_1 = {};
    float x_3 = {};
    float y_1 = {};
    fragCoord_1 = fragCoord;
    metal::float3 _e5 = global.iResolution;
    metal::float3 _e7 = global.iResolution;
    aspect_1 = _e5.x / _e7.y;
    metal::float2 _e11 = fragCoord_1;
    metal::float3 _e13 = global.iResolution;
    x_3 = ((_e11.x / _e13.x) * 2.0) - 1.0;
    metal::float2 _e21 = fragCoord_1;
    metal::float3 _e23 = global.iResolution;
    float _e30 = aspect_1;
    y_1 = (((_e21.y / _e23.y) * 2.0) - 1.0) / _e30;
    float _e35 = x_3;
    float _e36 = y_1;
    return Ray {metal::float3(0.0), metal::normalize(metal::float3(_e35, _e36, SCREEN_DEPTH))};
}

void mainImage(
    thread metal::float4& fragColor,
    metal::float2 fragCoord_2,
    constant ToyproofFrame& global,
    thread type_6& spheres
) {
    metal::float2 fragCoord_3 = {};
    Ray ray_3 = {};
    metal::float3 color_2 = metal::float3(0.1, 0.12, 0.15);
    float nearest = NO_HIT;
    int hit = -1;
    int i_1 = 0;
    float t_1 = {};
    metal::float3 point_4 = {};
    metal::float3 normal_6 = {};
    fragCoord_3 = fragCoord_2;
    fragColor = metal::float4(0.0);
    makeScene(spheres);
    metal::float2 _e8 = fragCoord_3;
    Ray _e9 = cameraRay(_e8, global);
    ray_3 = _e9;
    while(true) {
        int _e21 = i_1;
        if (!((_e21 < SPHERES))) {
            break;
        }
        {
            Ray _e24 = ray_3;
            int _e25 = i_1;
            Sphere _e27 = spheres.inner[metal::min(unsigned(_e25), 9u)];
            float _e28 = intersectSphere(_e24, _e27);
            t_1 = _e28;
            float _e30 = t_1;
            float _e31 = nearest;
            if (_e30 < _e31) {
                {
                    float _e33 = t_1;
                    nearest = _e33;
                    int _e34 = i_1;
                    hit = _e34;
                }
            }
            int _e35 = i_1;
            i_1 = as_type<int>(as_type<uint>(_e35) + as_type<uint>(1));
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
            Sphere _e52 = spheres.inner[metal::min(unsigned(_e50), 9u)];
            normal_6 = metal::normalize(_e49 - _e52.center);
            metal::float3 _e57 = point_4;
            metal::float3 _e58 = normal_6;
            Ray _e59 = ray_3;
            int _e62 = hit;
            Sphere _e64 = spheres.inner[metal::min(unsigned(_e62), 9u)];
            metal::float3 _e66 = shade(_e57, _e58, -(_e59.direction), _e64.material, spheres);
            color_2 = _e66;
        }
    }
    metal::float3 _e67 = color_2;
    metal::float3 _e68 = toneMap(_e67);
    metal::float3 _e71 = metal::pow(_e68, metal::float3(0.45454544));
    fragColor = metal::float4(_e71.x, _e71.y, _e71.z, 1.0);
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
