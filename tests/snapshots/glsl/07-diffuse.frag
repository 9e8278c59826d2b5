#version 300 es
// glsl/07-diffuse.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A diffuse BRDF conserves energy: color / pi. The result is tone-mapped, then gamma-corrected.

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
const int SPHERES = 4;
const int LIGHTS = 2;
const vec3 AMBIENT = vec3(0.3, 0.35, 0.45);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Material {
    vec3 albedo;
};

struct Sphere {
    vec3 center;
    float radius;
    Material material;
};

struct Light {
    vec3 position;
    vec3 color;
};

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, Material(vec3(0.0))),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0))), Sphere(vec3(0.0), 0.0, Material(vec3(0.0))),
    Sphere(vec3(0.0), 0.0, Material(vec3(0.0))));
Light lights[2] = Light[2](Light(vec3(0.0), vec3(0.0)), Light(vec3(0.0), vec3(0.0)));

void makeScene() {
    spheres[0] = Sphere(vec3(0.0, -101.0, -7.0), 100.0, Material(vec3(0.5, 0.5, 0.5)));
    spheres[1] = Sphere(vec3(-1.9, 0.0, -7.5), 1.0, Material(vec3(0.8, 0.25, 0.2)));
    spheres[2] = Sphere(vec3(0.2, -0.1, -6.5), 0.9, Material(vec3(0.75, 0.75, 0.75)));
    spheres[3] = Sphere(vec3(1.9, -0.3, -6.0), 0.7, Material(vec3(0.2, 0.45, 0.8)));
    lights[0] = Light(vec3(4.0, 6.0, -2.0), vec3(9.0, 8.5, 7.5));
    lights[1] = Light(vec3(-5.0, 3.0, 0.0), vec3(2.0, 2.5, 4.0));
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

bool inShadow(vec3 point, vec3 normal, Light light) {
    vec3 origin = point + 0.001 * normal;
    vec3 toLight = light.position - origin;
    float distance = length(toLight);
    Ray ray = Ray(origin, toLight / distance);
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    return false;
}

vec3 brdf(Material material) {
    return material.albedo / PI;
}

vec3 shade(vec3 point, vec3 normal, Material material) {
    vec3 radiance = AMBIENT * material.albedo;
    for (int i = 0; i < LIGHTS; i++) {
        float cosine = dot(normal, normalize(lights[i].position - point));
        if (cosine > 0.0) {
            if (!inShadow(point, normal, lights[i])) {
                radiance += lights[i].color * brdf(material) * cosine;
            }
        }
    }
    return radiance;
}

vec3 toneMap(vec3 color) {
    return color / (color + 1.0);
}

vec3 gammaCorrect(vec3 color) {
    return pow(color, vec3(0.45454544));
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
    vec3 color = vec3(0.5, 0.6, 0.8);

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
        color = shade(point, normal, spheres[hit].material);
    }
    fragColor = vec4(gammaCorrect(toneMap(color)), 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
