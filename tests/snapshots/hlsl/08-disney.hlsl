// glsl/08-disney.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// The BRDF of B. Burley, "Physically Based Shading at Disney" (2012), on a grid of spheres over the ground.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const float PI = 3.14159265359;
static const int SPHERES = 10;
static const float3 AMBIENT = float3(0.25, 0.27, 0.3);
static const float3 LIGHT = float3(-3.0, 6.0, 2.0);
static const float3 LIGHT_COLOR = float3(5.0, 4.8, 4.5);

struct Ray {
    float3 origin;
    float3 direction;
};

Ray make_Ray(float3 origin, float3 direction) {
    Ray result;
    result.origin = origin;
    result.direction = direction;
    return result;
}

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
};

Material make_Material(float3 color, float metallic, float subsurface, float specular,
        float specularTint, float roughness, float anisotropic, float sheen, float sheenTint,
        float clearcoat, float clearcoatGloss) {
    Material result;
    result.color = color;
    result.metallic = metallic;
    result.subsurface = subsurface;
    result.specular = specular;
    result.specularTint = specularTint;
    result.roughness = roughness;
    result.anisotropic = anisotropic;
    result.sheen = sheen;
    result.sheenTint = sheenTint;
    result.clearcoat = clearcoat;
    result.clearcoatGloss = clearcoatGloss;
    return result;
}

struct Sphere {
    float3 center;
    float radius;
    Material material;
};

Sphere make_Sphere(float3 center, float radius, Material material) {
    Sphere result;
    result.center = center;
    result.radius = radius;
    result.material = material;
    return result;
}

static Sphere spheres[10] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0,
    (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };

void makeScene() {
    // Rough plastic.
    spheres[0] = make_Sphere(float3(-2.0, 1.3, -7.0), 0.58,
        make_Material(float3(0.8, 0.2, 0.15), 0.0, 0.0, 0.5, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Plastic.
    spheres[1] = make_Sphere(float3(0.0, 1.3, -7.0), 0.58,
        make_Material(float3(0.8, 0.2, 0.15), 0.0, 0.0, 0.8, 0.0, 0.4, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Smooth plastic with a tinted highlight.
    spheres[2] = make_Sphere(float3(2.0, 1.3, -7.0), 0.58,
        make_Material(float3(0.8, 0.2, 0.15), 0.0, 0.0, 1.0, 0.8, 0.25, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Rough gold.
    spheres[3] = make_Sphere(float3(-2.0, 0.0, -7.0), 0.58,
        make_Material(float3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Brushed gold.
    spheres[4] = make_Sphere(float3(0.0, 0.0, -7.0), 0.58,
        make_Material(float3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.45, 0.8, 0.0, 0.5, 0.0, 0.6));
    // Half metal.
    spheres[5] = make_Sphere(float3(2.0, 0.0, -7.0), 0.58,
        make_Material(float3(1.0, 0.75, 0.35), 0.5, 0.0, 0.5, 0.0, 0.3, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Cloth.
    spheres[6] = make_Sphere(float3(-2.0, -1.3, -7.0), 0.58,
        make_Material(float3(0.25, 0.35, 0.8), 0.0, 0.0, 0.1, 0.0, 0.8, 0.0, 1.0, 0.3, 0.0, 0.6));
    // Skin.
    spheres[7] = make_Sphere(float3(0.0, -1.3, -7.0), 0.58,
        make_Material(float3(0.9, 0.6, 0.5), 0.0, 0.9, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Lacquer.
    spheres[8] = make_Sphere(float3(2.0, -1.3, -7.0), 0.58,
        make_Material(float3(0.15, 0.5, 0.25), 0.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 1.0, 0.6));
    // Ground.
    spheres[9] = make_Sphere(float3(0.0, -52.3, -8.0), 50.0,
        make_Material(float3(0.4, 0.4, 0.4), 0.0, 0.0, 0.2, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
}

float intersectSphere(Ray ray, Sphere sphere) {
    float3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    float c = dot(f, f) - sphere.radius * sphere.radius;
    float disc = b * b - c;
    if (disc > 0.0) {
        float root = sqrt(disc);
        float t = -b - root;
        if (t > 0.00001) {
            return t;
        }
        t = -b + root;
        if (t > 0.00001) {
            return t;
        }
    }
    return NO_HIT;
}

bool inShadow(float3 point_1, float3 normal) {
    float3 origin = point_1 + 0.001 * normal;
    float3 toLight = LIGHT - origin;
    float distance_1 = length(toLight);
    Ray ray = { origin, toLight / distance_1 };
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance_1) {
            return true;
        }
    }
    return false;
}

float square(float x) {
    return x * x;
}

// The weight (1 - cosine)^5 of Schlick's Fresnel approximation.
float schlick(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return square(square(m)) * m;
}

// Normal distribution of the clear coat: GTR with gamma = 1, which has a long tail.
float berry(float nH, float alpha) {
    float a2 = alpha * alpha;
    return (a2 - 1.0) / (PI * log(a2) * (1.0 + (a2 - 1.0) * nH * nH));
}

// Normal distribution of the specular lobe: anisotropic GTR with gamma = 2 (GGX).
float trowbridgeReitz(float nH, float xH, float yH, float ax, float ay) {
    return 1.0 / (PI * ax * ay * square(square(xH / ax) + square(yH / ay) + nH * nH));
}

// Smith's shadowing factor for one direction, divided by twice the cosine.
float smith(float cosine, float alpha) {
    float a2 = alpha * alpha;
    float c2 = cosine * cosine;
    return 1.0 / (cosine + sqrt(a2 + c2 - a2 * c2));
}

float3 disney(Material m, float3 light, float3 view, float3 normal) {
    float nL = dot(normal, light);
    float nV = dot(normal, view);
    if (nL <= 0.0 || nV <= 0.0) {
        return float3(0.0, 0.0, 0.0);
    }
    float3 middle = normalize(light + view);
    float nH = dot(normal, middle);
    float lH = dot(light, middle);
    // The tangents: around the y axis, and toward it.
    float3 x = normalize(float3(normal.z, 0.0, -normal.x));
    float3 y = cross(normal, x);

    float luminance = dot(m.color, float3(0.3, 0.6, 0.1));
    float3 tint = m.color / luminance;
    float3 dielectric = 0.08 * m.specular * lerp(float3(1.0, 1.0, 1.0), tint, m.specularTint);
    float3 specularColor = lerp(dielectric, m.color, m.metallic);
    float3 sheenColor = lerp(float3(1.0, 1.0, 1.0), tint, m.sheenTint);

    float fL = schlick(nL);
    float fV = schlick(nV);
    float fH = schlick(lH);
    float retro = lH * lH * m.roughness;
    float grazing = 0.5 + 2.0 * retro;
    float diffuse = lerp(1.0, grazing, fL) * lerp(1.0, grazing, fV);
    float flatness = lerp(1.0, retro, fL) * lerp(1.0, retro, fV);
    float subsurface = 1.25 * (flatness * (1.0 / (nL + nV) - 0.5) + 0.5);
    float3 base = m.color / PI * lerp(diffuse, subsurface, m.subsurface);
    float3 sheen = fH * m.sheen * sheenColor;

    float aspect = sqrt(1.0 - 0.9 * m.anisotropic);
    float ax = max(0.001, square(m.roughness) / aspect);
    float ay = max(0.001, square(m.roughness) * aspect);
    float d = trowbridgeReitz(nH, dot(x, middle), dot(y, middle), ax, ay);
    float alpha = square(0.5 + 0.5 * m.roughness);
    float g = smith(nL, alpha) * smith(nV, alpha);
    float3 f = lerp(specularColor, float3(1.0, 1.0, 1.0), fH);

    float coat = 0.25 * m.clearcoat * berry(nH, lerp(0.1, 0.001, m.clearcoatGloss))
        * lerp(0.04, 1.0, fH) * smith(nL, 0.25) * smith(nV, 0.25);
    return (base + sheen) * (1.0 - m.metallic) + f * d * g + coat;
}

float3 shade(float3 point_1, float3 normal, float3 view, Material material) {
    float3 radiance = AMBIENT * material.color;
    float3 toLight = normalize(LIGHT - point_1);
    float cosine = dot(normal, toLight);
    if (cosine > 0.0) {
        if (!inShadow(point_1, normal)) {
            radiance += LIGHT_COLOR * disney(material, toLight, view, normal) * cosine;
        }
    }
    return radiance;
}

float3 toneMap(float3 color) {
    return color / (color + 1.0);
}

Ray cameraRay(float2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return make_Ray(float3(0.0, 0.0, 0.0), normalize(float3(x, y, SCREEN_DEPTH)));
}

void mainImage(out float4 fragColor, float2 fragCoord) {
    fragColor = float4(0.0, 0.0, 0.0, 0.0);
    makeScene();
    Ray ray = cameraRay(fragCoord);
    float3 color = float3(0.1, 0.12, 0.15);

    float nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    if (hit >= 0) {
        float3 point_1 = ray.origin + nearest * ray.direction;
        float3 normal = normalize(point_1 - spheres[hit].center);
        color = shade(point_1, normal, -ray.direction, spheres[hit].material);
    }
    fragColor = float4(pow(toneMap(color), float3(0.45454544, 0.45454544, 0.45454544)), 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
