#version 300 es
// glsl/08-disney.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// The BRDF of B. Burley, "Physically Based Shading at Disney" (2012), on a grid of spheres over the ground.

precision highp float;
precision highp int;

layout(std140) uniform Inputs {
    vec3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    vec4 iChannelTime[4];
    vec3 iChannelResolution[4];
    vec4 iMouse;
    vec4 iDate;
    float iSampleRate;
};
layout(location = 0) out vec4 outputColor;

const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1.0e6;
const float PI = 3.14159265359;
const int SPHERES = 10;
const vec3 AMBIENT = vec3(0.25, 0.27, 0.3);
const vec3 LIGHT = vec3(-3.0, 6.0, 2.0);
const vec3 LIGHT_COLOR = vec3(5.0, 4.8, 4.5);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Material {
    vec3 color;
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

struct Sphere {
    vec3 center;
    float radius;
    Material material;
};

Sphere spheres[10] = Sphere[10](Sphere(vec3(0.0), 0.0,
        Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)));

void makeScene() {
    // Rough plastic.
    spheres[0] = Sphere(vec3(-2.0, 1.3, -7.0), 0.58,
        Material(vec3(0.8, 0.2, 0.15), 0.0, 0.0, 0.5, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Plastic.
    spheres[1] = Sphere(vec3(0.0, 1.3, -7.0), 0.58,
        Material(vec3(0.8, 0.2, 0.15), 0.0, 0.0, 0.8, 0.0, 0.4, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Smooth plastic with a tinted highlight.
    spheres[2] = Sphere(vec3(2.0, 1.3, -7.0), 0.58,
        Material(vec3(0.8, 0.2, 0.15), 0.0, 0.0, 1.0, 0.8, 0.25, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Rough gold.
    spheres[3] = Sphere(vec3(-2.0, 0.0, -7.0), 0.58,
        Material(vec3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Brushed gold.
    spheres[4] = Sphere(vec3(0.0, 0.0, -7.0), 0.58,
        Material(vec3(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.45, 0.8, 0.0, 0.5, 0.0, 0.6));
    // Half metal.
    spheres[5] = Sphere(vec3(2.0, 0.0, -7.0), 0.58,
        Material(vec3(1.0, 0.75, 0.35), 0.5, 0.0, 0.5, 0.0, 0.3, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Cloth.
    spheres[6] = Sphere(vec3(-2.0, -1.3, -7.0), 0.58,
        Material(vec3(0.25, 0.35, 0.8), 0.0, 0.0, 0.1, 0.0, 0.8, 0.0, 1.0, 0.3, 0.0, 0.6));
    // Skin.
    spheres[7] = Sphere(vec3(0.0, -1.3, -7.0), 0.58,
        Material(vec3(0.9, 0.6, 0.5), 0.0, 0.9, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Lacquer.
    spheres[8] = Sphere(vec3(2.0, -1.3, -7.0), 0.58,
        Material(vec3(0.15, 0.5, 0.25), 0.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 1.0, 0.6));
    // Ground.
    spheres[9] = Sphere(vec3(0.0, -52.3, -8.0), 50.0,
        Material(vec3(0.4, 0.4, 0.4), 0.0, 0.0, 0.2, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
}

float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
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

bool inShadow(vec3 point, vec3 normal) {
    vec3 origin = point + 0.001 * normal;
    vec3 toLight = LIGHT - origin;
    float distance = length(toLight);
    Ray ray = Ray(origin, toLight / distance);
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
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

vec3 disney(Material m, vec3 light, vec3 view, vec3 normal) {
    float nL = dot(normal, light);
    float nV = dot(normal, view);
    if (nL <= 0.0 || nV <= 0.0) {
        return vec3(0.0);
    }
    vec3 middle = normalize(light + view);
    float nH = dot(normal, middle);
    float lH = dot(light, middle);
    // The tangents: around the y axis, and toward it.
    vec3 x = normalize(vec3(normal.z, 0.0, -normal.x));
    vec3 y = cross(normal, x);

    float luminance = dot(m.color, vec3(0.3, 0.6, 0.1));
    vec3 tint = m.color / luminance;
    vec3 dielectric = 0.08 * m.specular * mix(vec3(1.0), tint, m.specularTint);
    vec3 specularColor = mix(dielectric, m.color, m.metallic);
    vec3 sheenColor = mix(vec3(1.0), tint, m.sheenTint);

    float fL = schlick(nL);
    float fV = schlick(nV);
    float fH = schlick(lH);
    float retro = lH * lH * m.roughness;
    float grazing = 0.5 + 2.0 * retro;
    float diffuse = mix(1.0, grazing, fL) * mix(1.0, grazing, fV);
    float flatness = mix(1.0, retro, fL) * mix(1.0, retro, fV);
    float subsurface = 1.25 * (flatness * (1.0 / (nL + nV) - 0.5) + 0.5);
    vec3 base = m.color / PI * mix(diffuse, subsurface, m.subsurface);
    vec3 sheen = fH * m.sheen * sheenColor;

    float aspect = sqrt(1.0 - 0.9 * m.anisotropic);
    float ax = max(0.001, square(m.roughness) / aspect);
    float ay = max(0.001, square(m.roughness) * aspect);
    float d = trowbridgeReitz(nH, dot(x, middle), dot(y, middle), ax, ay);
    float alpha = square(0.5 + 0.5 * m.roughness);
    float g = smith(nL, alpha) * smith(nV, alpha);
    vec3 f = mix(specularColor, vec3(1.0), fH);

    float coat = 0.25 * m.clearcoat * berry(nH, mix(0.1, 0.001, m.clearcoatGloss))
        * mix(0.04, 1.0, fH) * smith(nL, 0.25) * smith(nV, 0.25);
    return (base + sheen) * (1.0 - m.metallic) + f * d * g + coat;
}

vec3 shade(vec3 point, vec3 normal, vec3 view, Material material) {
    vec3 radiance = AMBIENT * material.color;
    vec3 toLight = normalize(LIGHT - point);
    float cosine = dot(normal, toLight);
    if (cosine > 0.0) {
        if (!inShadow(point, normal)) {
            radiance += LIGHT_COLOR * disney(material, toLight, view, normal) * cosine;
        }
    }
    return radiance;
}

vec3 toneMap(vec3 color) {
    return color / (color + 1.0);
}

Ray cameraRay(vec2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3(0.0), normalize(vec3(x, y, SCREEN_DEPTH)));
}

void mainImage(out vec4 fragColor, vec2 fragCoord) {
    fragColor = vec4(0.0);
    makeScene();
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.1, 0.12, 0.15);

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
        vec3 point = ray.origin + nearest * ray.direction;
        vec3 normal = normalize(point - spheres[hit].center);
        color = shade(point, normal, -ray.direction, spheres[hit].material);
    }
    fragColor = vec4(pow(toneMap(color), vec3(0.45454544)), 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
