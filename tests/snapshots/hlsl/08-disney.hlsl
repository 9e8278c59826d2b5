// glsl/08-disney.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

struct ToyproofFrame {
    float3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    int _pad5_0;
    float4 iChannelTime[4];
    float3 iChannelResolution[4];
    int _pad7_0;
    float4 iMouse;
    float4 iDate;
    float iSampleRate;
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

struct Ray {
    float3 origin;
    int _pad1_0;
    float3 direction;
    int _end_pad_0;
};

struct Material {
    float3 color;
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
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

struct Sphere {
    float3 center_;
    float radius;
    Material material;
};

struct FragmentOutput {
    float4 toyproof_color : SV_Target0;
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1000000.0;
static const float PI = 3.1415927;
static const int SPHERES = int(10);
static const float3 AMBIENT = float3(0.25, 0.27, 0.3);
static const float3 LIGHT = float3(-3.0, 6.0, 2.0);
static const float3 LIGHT_COLOR = float3(5.0, 4.8, 4.5);

static float4 toyproof_color = (float4)0;
cbuffer global : register(b0) { ToyproofFrame global; }
static Sphere spheres[10] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static float4 gl_FragCoord_1 = (float4)0;

struct FragmentInput_main {
    float4 gl_FragCoord_2 : SV_Position;
};

Material ConstructMaterial(float3 arg0, float arg1, float arg2, float arg3, float arg4, float arg5, float arg6, float arg7, float arg8, float arg9, float arg10) {
    Material ret = (Material)0;
    ret.color = arg0;
    ret.metallic = arg1;
    ret.subsurface = arg2;
    ret.specular = arg3;
    ret.specularTint = arg4;
    ret.roughness = arg5;
    ret.anisotropic = arg6;
    ret.sheen = arg7;
    ret.sheenTint = arg8;
    ret.clearcoat = arg9;
    ret.clearcoatGloss = arg10;
    return ret;
}

Sphere ConstructSphere(float3 arg0, float arg1, Material arg2) {
    Sphere ret = (Sphere)0;
    ret.center_ = arg0;
    ret.radius = arg1;
    ret.material = arg2;
    return ret;
}

void makeScene()
{
    spheres[int(0)] = ConstructSphere(float3(-2.0, 1.3, -7.0), 0.58, ConstructMaterial(float3(0.8, 0.2, 0.15), 0.0, 0.0, 0.5, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
    spheres[int(1)] = ConstructSphere(float3(0.0, 1.3, -7.0), 0.58, ConstructMaterial(float3(0.8, 0.2, 0.15), 0.0, 0.0, 0.8, 0.0, 0.4, 0.0, 0.0, 0.5, 0.0, 0.6));
    spheres[int(2)] = ConstructSphere(float3(2.0, 1.3, -7.0), 0.58, ConstructMaterial(float3(0.8, 0.2, 0.15), 0.0, 0.0, 1.0, 0.8, 0.25, 0.0, 0.0, 0.5, 0.0, 0.6));
    spheres[int(3)] = ConstructSphere(float3(-2.0, 0.0, -7.0), 0.58, ConstructMaterial(float3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    spheres[int(4)] = ConstructSphere(float3(0.0, 0.0, -7.0), 0.58, ConstructMaterial(float3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.45, 0.8, 0.0, 0.5, 0.0, 0.6));
    spheres[int(5)] = ConstructSphere(float3(2.0, 0.0, -7.0), 0.58, ConstructMaterial(float3(1.0, 0.75, 0.35), 0.5, 0.0, 0.5, 0.0, 0.3, 0.0, 0.0, 0.5, 0.0, 0.6));
    spheres[int(6)] = ConstructSphere(float3(-2.0, -1.3, -7.0), 0.58, ConstructMaterial(float3(0.25, 0.35, 0.8), 0.0, 0.0, 0.1, 0.0, 0.8, 0.0, 1.0, 0.3, 0.0, 0.6));
    spheres[int(7)] = ConstructSphere(float3(0.0, -1.3, -7.0), 0.58, ConstructMaterial(float3(0.9, 0.6, 0.5), 0.0, 0.9, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    spheres[int(8)] = ConstructSphere(float3(2.0, -1.3, -7.0), 0.58, ConstructMaterial(float3(0.15, 0.5, 0.25), 0.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 1.0, 0.6));
    spheres[int(9)] = ConstructSphere(float3(0.0, -52.3, -8.0), 50.0, ConstructMaterial(float3(0.4, 0.4, 0.4), 0.0, 0.0, 0.2, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
    return;
}

float intersectSphere(Ray ray, Sphere sphere)
{
    Ray ray_1 = (Ray)0;
    Sphere sphere_1 = (Sphere)0;
    float3 f = (float3)0;
    float b = (float)0;
    float c = (float)0;
    float disc = (float)0;
    float root = (float)0;
    float t = (float)0;

    ray_1 = ray;
    sphere_1 = sphere;
    Ray _e5 = ray_1;
    Sphere _e7 = sphere_1;
    f = (_e5.origin - _e7.center_);
    float3 _e11 = f;
    Ray _e12 = ray_1;
    b = dot(_e11, _e12.direction);
    float3 _e16 = f;
    float3 _e17 = f;
    Sphere _e19 = sphere_1;
    Sphere _e21 = sphere_1;
    c = (dot(_e16, _e17) - (_e19.radius * _e21.radius));
    float _e26 = b;
    float _e27 = b;
    float _e29 = c;
    disc = ((_e26 * _e27) - _e29);
    float _e32 = disc;
    if ((_e32 > 0.0)) {
        {
            float _e35 = disc;
            root = sqrt(_e35);
            float _e38 = b;
            float _e40 = root;
            t = (-(_e38) - _e40);
            float _e43 = t;
            if ((_e43 > 1e-5)) {
                {
                    float _e46 = t;
                    return _e46;
                }
            }
            float _e47 = b;
            float _e49 = root;
            t = (-(_e47) + _e49);
            float _e51 = t;
            if ((_e51 > 1e-5)) {
                {
                    float _e54 = t;
                    return _e54;
                }
            }
        }
    }
    return NO_HIT;
}

Ray ConstructRay(float3 arg0, float3 arg1) {
    Ray ret = (Ray)0;
    ret.origin = arg0;
    ret.direction = arg1;
    return ret;
}

bool inShadow(float3 point_, float3 normal)
{
    float3 point_1 = (float3)0;
    float3 normal_1 = (float3)0;
    float3 origin = (float3)0;
    float3 toLight = (float3)0;
    float distance_ = (float)0;
    Ray ray_2 = (Ray)0;
    int i = int(0);

    point_1 = point_;
    normal_1 = normal;
    float3 _e7 = point_1;
    float3 _e9 = normal_1;
    origin = (_e7 + (0.001 * _e9));
    float3 _e13 = origin;
    toLight = (LIGHT - _e13);
    float3 _e16 = toLight;
    distance_ = length(_e16);
    float3 _e19 = origin;
    float3 _e20 = toLight;
    float _e21 = distance_;
    ray_2 = ConstructRay(_e19, (_e20 / (_e21).xxx));
    while(true) {
        int _e28 = i;
        if (!((_e28 < SPHERES))) {
            break;
        }
        {
            Ray _e31 = ray_2;
            int _e32 = i;
            Sphere _e34 = spheres[min(uint(_e32), 9u)];
            const float _e35 = intersectSphere(_e31, _e34);
            float _e36 = distance_;
            if ((_e35 < _e36)) {
                {
                    return true;
                }
            }
            int _e39 = i;
            i = asint(asuint(_e39) + asuint(int(1)));
        }
    }
    return false;
}

float square(float x)
{
    float x_1 = (float)0;

    x_1 = x;
    float _e2 = x_1;
    float _e3 = x_1;
    return (_e2 * _e3);
}

float schlick(float cosine)
{
    float cosine_1 = (float)0;
    float m = (float)0;

    cosine_1 = cosine;
    float _e3 = cosine_1;
    m = clamp((1.0 - _e3), 0.0, 1.0);
    float _e9 = m;
    const float _e10 = square(_e9);
    const float _e11 = square(_e10);
    float _e12 = m;
    return (_e11 * _e12);
}

float berry(float nH, float alpha)
{
    float nH_1 = (float)0;
    float alpha_1 = (float)0;
    float a2_ = (float)0;

    nH_1 = nH;
    alpha_1 = alpha;
    float _e5 = alpha_1;
    float _e6 = alpha_1;
    a2_ = (_e5 * _e6);
    float _e9 = a2_;
    float _e12 = a2_;
    float _e16 = a2_;
    float _e19 = nH_1;
    float _e21 = nH_1;
    return ((_e9 - 1.0) / ((PI * log(_e12)) * (1.0 + (((_e16 - 1.0) * _e19) * _e21))));
}

float trowbridgeReitz(float nH_2, float xH, float yH, float ax, float ay)
{
    float nH_3 = (float)0;
    float xH_1 = (float)0;
    float yH_1 = (float)0;
    float ax_1 = (float)0;
    float ay_1 = (float)0;

    nH_3 = nH_2;
    xH_1 = xH;
    yH_1 = yH;
    ax_1 = ax;
    ay_1 = ay;
    float _e12 = ax_1;
    float _e14 = ay_1;
    float _e16 = xH_1;
    float _e17 = ax_1;
    const float _e19 = square((_e16 / _e17));
    float _e20 = yH_1;
    float _e21 = ay_1;
    const float _e23 = square((_e20 / _e21));
    float _e25 = nH_3;
    float _e26 = nH_3;
    const float _e29 = square(((_e19 + _e23) + (_e25 * _e26)));
    return (1.0 / (((PI * _e12) * _e14) * _e29));
}

float smith(float cosine_2, float alpha_2)
{
    float cosine_3 = (float)0;
    float alpha_3 = (float)0;
    float a2_1 = (float)0;
    float c2_ = (float)0;

    cosine_3 = cosine_2;
    alpha_3 = alpha_2;
    float _e4 = alpha_3;
    float _e5 = alpha_3;
    a2_1 = (_e4 * _e5);
    float _e8 = cosine_3;
    float _e9 = cosine_3;
    c2_ = (_e8 * _e9);
    float _e13 = cosine_3;
    float _e14 = a2_1;
    float _e15 = c2_;
    float _e17 = a2_1;
    float _e18 = c2_;
    return (1.0 / (_e13 + sqrt(((_e14 + _e15) - (_e17 * _e18)))));
}

float3 disney(Material m_1, float3 light, float3 view, float3 normal_2)
{
    Material m_2 = (Material)0;
    float3 light_1 = (float3)0;
    float3 view_1 = (float3)0;
    float3 normal_3 = (float3)0;
    float nL = (float)0;
    float nV = (float)0;
    float3 middle = (float3)0;
    float nH_4 = (float)0;
    float lH = (float)0;
    float3 x_2 = (float3)0;
    float3 y = (float3)0;
    float luminance = (float)0;
    float3 tint = (float3)0;
    float3 dielectric = (float3)0;
    float3 specularColor = (float3)0;
    float3 sheenColor = (float3)0;
    float fL = (float)0;
    float fV = (float)0;
    float fH = (float)0;
    float retro = (float)0;
    float grazing = (float)0;
    float diffuse = (float)0;
    float flatness = (float)0;
    float subsurface = (float)0;
    float3 base = (float3)0;
    float3 sheen = (float3)0;
    float aspect = (float)0;
    float ax_2 = (float)0;
    float ay_2 = (float)0;
    float d = (float)0;
    float alpha_4 = (float)0;
    float g = (float)0;
    float3 f_1 = (float3)0;
    float coat = (float)0;

    m_2 = m_1;
    light_1 = light;
    view_1 = view;
    normal_3 = normal_2;
    float3 _e8 = normal_3;
    float3 _e9 = light_1;
    nL = dot(_e8, _e9);
    float3 _e12 = normal_3;
    float3 _e13 = view_1;
    nV = dot(_e12, _e13);
    float _e16 = nL;
    float _e19 = nV;
    if (((_e16 <= 0.0) || (_e19 <= 0.0))) {
        {
            return (0.0).xxx;
        }
    }
    float3 _e25 = light_1;
    float3 _e26 = view_1;
    middle = normalize((_e25 + _e26));
    float3 _e30 = normal_3;
    float3 _e31 = middle;
    nH_4 = dot(_e30, _e31);
    float3 _e34 = light_1;
    float3 _e35 = middle;
    lH = dot(_e34, _e35);
    float3 _e38 = normal_3;
    float3 _e41 = normal_3;
    x_2 = normalize(float3(_e38.z, 0.0, -(_e41.x)));
    float3 _e47 = normal_3;
    float3 _e48 = x_2;
    y = cross(_e47, _e48);
    Material _e51 = m_2;
    luminance = dot(_e51.color, float3(0.3, 0.6, 0.1));
    Material _e59 = m_2;
    float _e61 = luminance;
    tint = (_e59.color / (_e61).xxx);
    Material _e66 = m_2;
    float3 _e71 = tint;
    Material _e72 = m_2;
    dielectric = ((0.08 * _e66.specular) * lerp((1.0).xxx, _e71, (_e72.specularTint).xxx));
    float3 _e78 = dielectric;
    Material _e79 = m_2;
    Material _e81 = m_2;
    specularColor = lerp(_e78, _e79.color, (_e81.metallic).xxx);
    float3 _e88 = tint;
    Material _e89 = m_2;
    sheenColor = lerp((1.0).xxx, _e88, (_e89.sheenTint).xxx);
    float _e94 = nL;
    const float _e95 = schlick(_e94);
    fL = _e95;
    float _e97 = nV;
    const float _e98 = schlick(_e97);
    fV = _e98;
    float _e100 = lH;
    const float _e101 = schlick(_e100);
    fH = _e101;
    float _e103 = lH;
    float _e104 = lH;
    Material _e106 = m_2;
    retro = ((_e103 * _e104) * _e106.roughness);
    float _e112 = retro;
    grazing = (0.5 + (2.0 * _e112));
    float _e117 = grazing;
    float _e118 = fL;
    float _e121 = grazing;
    float _e122 = fV;
    diffuse = (lerp(1.0, _e117, _e118) * lerp(1.0, _e121, _e122));
    float _e127 = retro;
    float _e128 = fL;
    float _e131 = retro;
    float _e132 = fV;
    flatness = (lerp(1.0, _e127, _e128) * lerp(1.0, _e131, _e132));
    float _e137 = flatness;
    float _e139 = nL;
    float _e140 = nV;
    subsurface = (1.25 * ((_e137 * ((1.0 / (_e139 + _e140)) - 0.5)) + 0.5));
    Material _e150 = m_2;
    float _e155 = diffuse;
    float _e156 = subsurface;
    Material _e157 = m_2;
    base = ((_e150.color / (3.1415927).xxx) * lerp(_e155, _e156, _e157.subsurface));
    float _e162 = fH;
    Material _e163 = m_2;
    float3 _e166 = sheenColor;
    sheen = ((_e162 * _e163.sheen) * _e166);
    Material _e171 = m_2;
    aspect = sqrt((1.0 - (0.9 * _e171.anisotropic)));
    Material _e178 = m_2;
    const float _e180 = square(_e178.roughness);
    float _e181 = aspect;
    ax_2 = max(0.001, (_e180 / _e181));
    Material _e186 = m_2;
    const float _e188 = square(_e186.roughness);
    float _e189 = aspect;
    ay_2 = max(0.001, (_e188 * _e189));
    float _e193 = nH_4;
    float3 _e194 = x_2;
    float3 _e195 = middle;
    float3 _e197 = y;
    float3 _e198 = middle;
    float _e200 = ax_2;
    float _e201 = ay_2;
    const float _e202 = trowbridgeReitz(_e193, dot(_e194, _e195), dot(_e197, _e198), _e200, _e201);
    d = _e202;
    Material _e206 = m_2;
    const float _e210 = square((0.5 + (0.5 * _e206.roughness)));
    alpha_4 = _e210;
    float _e212 = nL;
    float _e213 = alpha_4;
    const float _e214 = smith(_e212, _e213);
    float _e215 = nV;
    float _e216 = alpha_4;
    const float _e217 = smith(_e215, _e216);
    g = (_e214 * _e217);
    float3 _e220 = specularColor;
    float _e223 = fH;
    f_1 = lerp(_e220, (1.0).xxx, (_e223).xxx);
    Material _e228 = m_2;
    float _e231 = nH_4;
    Material _e234 = m_2;
    const float _e237 = berry(_e231, lerp(0.1, 0.001, _e234.clearcoatGloss));
    float _e241 = fH;
    float _e244 = nL;
    const float _e246 = smith(_e244, 0.25);
    float _e248 = nV;
    const float _e250 = smith(_e248, 0.25);
    coat = (((((0.25 * _e228.clearcoat) * _e237) * lerp(0.04, 1.0, _e241)) * _e246) * _e250);
    float3 _e253 = base;
    float3 _e254 = sheen;
    Material _e257 = m_2;
    float3 _e261 = f_1;
    float _e262 = d;
    float _e264 = g;
    float _e267 = coat;
    return ((((_e253 + _e254) * (1.0 - _e257.metallic)) + ((_e261 * _e262) * _e264)) + (_e267).xxx);
}

float3 shade(float3 point_2, float3 normal_4, float3 view_2, Material material)
{
    float3 point_3 = (float3)0;
    float3 normal_5 = (float3)0;
    float3 view_3 = (float3)0;
    Material material_1 = (Material)0;
    float3 radiance = (float3)0;
    float3 toLight_1 = (float3)0;
    float cosine_4 = (float)0;

    point_3 = point_2;
    normal_5 = normal_4;
    view_3 = view_2;
    material_1 = material;
    Material _e11 = material_1;
    radiance = (AMBIENT * _e11.color);
    float3 _e15 = point_3;
    toLight_1 = normalize((LIGHT - _e15));
    float3 _e19 = normal_5;
    float3 _e20 = toLight_1;
    cosine_4 = dot(_e19, _e20);
    float _e23 = cosine_4;
    if ((_e23 > 0.0)) {
        {
            float3 _e26 = point_3;
            float3 _e27 = normal_5;
            const bool _e28 = inShadow(_e26, _e27);
            if (!(_e28)) {
                {
                    float3 _e30 = radiance;
                    Material _e31 = material_1;
                    float3 _e32 = toLight_1;
                    float3 _e33 = view_3;
                    float3 _e34 = normal_5;
                    const float3 _e35 = disney(_e31, _e32, _e33, _e34);
                    float _e37 = cosine_4;
                    radiance = (_e30 + ((LIGHT_COLOR * _e35) * _e37));
                }
            }
        }
    }
    float3 _e40 = radiance;
    return _e40;
}

float3 toneMap(float3 color)
{
    float3 color_1 = (float3)0;

    color_1 = color;
    float3 _e2 = color_1;
    float3 _e3 = color_1;
    return (_e2 / (_e3 + (1.0).xxx));
}

Ray cameraRay(float2 fragCoord)
{
    float2 fragCoord_1 = (float2)0;
    float aspect_1 = (float)0;
    float x_3 = (float)0;
    float y_1 = (float)0;

    fragCoord_1 = fragCoord;
    float3 _e5 = global.iResolution;
    float3 _e7 = global.iResolution;
    aspect_1 = (_e5.x / _e7.y);
    float2 _e11 = fragCoord_1;
    float3 _e13 = global.iResolution;
    x_3 = (((_e11.x / _e13.x) * 2.0) - 1.0);
    float2 _e21 = fragCoord_1;
    float3 _e23 = global.iResolution;
    float _e30 = aspect_1;
    y_1 = ((((_e21.y / _e23.y) * 2.0) - 1.0) / _e30);
    float _e35 = x_3;
    float _e36 = y_1;
    const Ray ray_4 = ConstructRay((0.0).xxx, normalize(float3(_e35, _e36, SCREEN_DEPTH)));
    return ray_4;
}

void mainImage(inout float4 fragColor, float2 fragCoord_2)
{
    float2 fragCoord_3 = (float2)0;
    Ray ray_3 = (Ray)0;
    float3 color_2 = float3(0.1, 0.12, 0.15);
    float nearest = NO_HIT;
    int hit = int(-1);
    int i_1 = int(0);
    float t_1 = (float)0;
    float3 point_4 = (float3)0;
    float3 normal_6 = (float3)0;

    fragCoord_3 = fragCoord_2;
    fragColor = (0.0).xxxx;
    makeScene();
    float2 _e8 = fragCoord_3;
    const Ray _e9 = cameraRay(_e8);
    ray_3 = _e9;
    while(true) {
        int _e21 = i_1;
        if (!((_e21 < SPHERES))) {
            break;
        }
        {
            Ray _e24 = ray_3;
            int _e25 = i_1;
            Sphere _e27 = spheres[min(uint(_e25), 9u)];
            const float _e28 = intersectSphere(_e24, _e27);
            t_1 = _e28;
            float _e30 = t_1;
            float _e31 = nearest;
            if ((_e30 < _e31)) {
                {
                    float _e33 = t_1;
                    nearest = _e33;
                    int _e34 = i_1;
                    hit = _e34;
                }
            }
            int _e35 = i_1;
            i_1 = asint(asuint(_e35) + asuint(int(1)));
        }
    }
    int _e38 = hit;
    if ((_e38 >= int(0))) {
        {
            Ray _e41 = ray_3;
            float _e43 = nearest;
            Ray _e44 = ray_3;
            point_4 = (_e41.origin + (_e43 * _e44.direction));
            float3 _e49 = point_4;
            int _e50 = hit;
            Sphere _e52 = spheres[min(uint(_e50), 9u)];
            normal_6 = normalize((_e49 - _e52.center_));
            float3 _e57 = point_4;
            float3 _e58 = normal_6;
            Ray _e59 = ray_3;
            int _e62 = hit;
            Sphere _e64 = spheres[min(uint(_e62), 9u)];
            const float3 _e66 = shade(_e57, _e58, -(_e59.direction), _e64.material);
            color_2 = _e66;
        }
    }
    float3 _e67 = color_2;
    const float3 _e68 = toneMap(_e67);
    float3 _e71 = pow(_e68, (0.45454544).xxx);
    fragColor = float4(_e71.x, _e71.y, _e71.z, 1.0);
    return;
}

void main_1()
{
    float4 toyproof_image_color = float4(0.0, 0.0, 0.0, 1.0);

    float4 _e8 = gl_FragCoord_1;
    mainImage(toyproof_image_color, _e8.xy);
    float4 _e10 = toyproof_image_color;
    float3 _e11 = _e10.xyz;
    toyproof_color = float4(_e11.x, _e11.y, _e11.z, 1.0);
    return;
}

FragmentOutput ConstructFragmentOutput(float4 arg0) {
    FragmentOutput ret = (FragmentOutput)0;
    ret.toyproof_color = arg0;
    return ret;
}

FragmentOutput main(FragmentInput_main fragmentinput_main)
{
    float4 gl_FragCoord = fragmentinput_main.gl_FragCoord_2;
    gl_FragCoord_1 = gl_FragCoord;
    main_1();
    float4 _e3 = toyproof_color;
    const FragmentOutput fragmentoutput = ConstructFragmentOutput(_e3);
    return fragmentoutput;
}
