// glsl/07-diffuse.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A diffuse BRDF conserves energy: color / pi. The result is tone-mapped, then gamma-corrected.

#include <metal_stdlib>
using namespace metal;

constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1.0e6;
constant float PI = 3.14159265359;
constant int SPHERES = 4;
constant int LIGHTS = 2;
constant float3 AMBIENT = float3(0.3, 0.35, 0.45);

struct Ray {
    float3 origin;
    float3 direction;
};

struct Material {
    float3 albedo;
};

struct Sphere {
    float3 center;
    float radius;
    Material material;
};

struct Light {
    float3 position;
    float3 color;
};

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

float3 brdf(Material material) {
    return material.albedo / PI;
}

float3 toneMap(float3 color) {
    return color / (color + 1.0);
}

float3 gammaCorrect(float3 color) {
    return pow(color, float3(0.45454544));
}

struct Shader {
    float3 iResolution;

    array<Sphere, 4> spheres = {};
    array<Light, 2> lights = {};

    void makeScene() {
        spheres[0] = Sphere{ float3(0.0, -101.0, -7.0), 100.0, Material{ float3(0.5, 0.5, 0.5) } };
        spheres[1] = Sphere{ float3(-1.9, 0.0, -7.5), 1.0, Material{ float3(0.8, 0.25, 0.2) } };
        spheres[2] = Sphere{ float3(0.2, -0.1, -6.5), 0.9, Material{ float3(0.75, 0.75, 0.75) } };
        spheres[3] = Sphere{ float3(1.9, -0.3, -6.0), 0.7, Material{ float3(0.2, 0.45, 0.8) } };
        lights[0] = Light{ float3(4.0, 6.0, -2.0), float3(9.0, 8.5, 7.5) };
        lights[1] = Light{ float3(-5.0, 3.0, 0.0), float3(2.0, 2.5, 4.0) };
    }

    bool inShadow(float3 point, float3 normal, Light light) {
        float3 origin = point + 0.001 * normal;
        float3 toLight = light.position - origin;
        float distance_1 = length(toLight);
        Ray ray = { origin, toLight / distance_1 };
        for (int i = 0; i < SPHERES; i++) {
            if (intersectSphere(ray, spheres[i]) < distance_1) {
                return true;
            }
        }
        return false;
    }

    float3 shade(float3 point, float3 normal, Material material) {
        float3 radiance = AMBIENT * material.albedo;
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

    Ray cameraRay(float2 fragCoord) {
        float aspect = iResolution.x / iResolution.y;
        float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
        float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
        return Ray{ float3(0.0), normalize(float3(x, y, SCREEN_DEPTH)) };
    }

    void mainImage(thread float4& fragColor, float2 fragCoord) {
        fragColor = float4(0.0);
        makeScene();
        Ray ray = cameraRay(fragCoord);
        float3 color = float3(0.5, 0.6, 0.8);

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
            float3 point = ray.origin + nearest * ray.direction;
            float3 normal = normalize(point - spheres[hit].center);
            color = shade(point, normal, spheres[hit].material);
        }
        fragColor = float4(gammaCorrect(toneMap(color)), 1.0);
    }
};

struct Inputs {
    packed_float3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    float4 iChannelTime[4];
    float3 iChannelResolution[4];
    float4 iMouse;
    float4 iDate;
    float iSampleRate;
};

fragment float4 main_(
    constant Inputs& inputs [[buffer(0)]],
    float4 position [[position]]
) {
    Shader shader = {
        float3(inputs.iResolution),
    };
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    shader.mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
