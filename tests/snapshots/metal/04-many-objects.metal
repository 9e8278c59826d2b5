// glsl/04-many-objects.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Seven spheres: the nearest hit is visible, and spheres cast shadows on each other.

#include <metal_stdlib>
using namespace metal;

constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1.0e6;
constant int SAMPLES = 4;
constant int SPHERES = 7;
constant float3 AMBIENT = float3(0.08);

struct Ray {
    float3 origin;
    float3 direction;
};

struct Sphere {
    float3 center;
    float radius;
    float3 color;
};

struct Light {
    float3 position;
    float3 color;
};

struct Intersection {
    float t;
    int sphere;
    float3 point;
    float3 normal;
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

struct Shader {
    float3 iResolution;

    array<Sphere, 7> spheres = {};
    Light light = {};
    float seed = 0.0;

    float random() {
        // toyproof: allow(W0005) the scene's sampler uses this hash
        return fract(sin(seed++) * 43758.5453123);
    }

    void makeScene() {
        spheres[0] = Sphere{ float3(0.0, -31.0, -8.0), 30.0, float3(0.5, 0.5, 0.45) };
        spheres[1] = Sphere{ float3(0.5, -0.7, -4.0), 0.3, float3(0.2, 0.8, 0.3) };
        spheres[2] = Sphere{ float3(0.0, 0.0, -6.0), 1.0, float3(0.9, 0.8, 0.1) };
        spheres[3] = Sphere{ float3(-1.5, -0.4, -5.0), 0.6, float3(0.9, 0.2, 0.15) };
        spheres[4] = Sphere{ float3(1.4, -0.5, -4.8), 0.5, float3(0.15, 0.3, 0.9) };
        spheres[5] = Sphere{ float3(-0.6, 1.1, -5.5), 0.35, float3(0.8, 0.4, 0.8) };
        // Behind the light, so it casts no shadow.
        spheres[6] = Sphere{ float3(6.8, 10.2, 5.9), 3.0, float3(0.6, 0.6, 0.6) };
        light = Light{ float3(4.0, 6.0, 1.0), float3(0.9) };
    }

    Intersection nearestHit(Ray ray) {
        Intersection hit = {};
        hit.t = NO_HIT;
        hit.sphere = -1;
        for (int i = 0; i < SPHERES; i++) {
            float t = intersectSphere(ray, spheres[i]);
            if (t < hit.t) {
                hit.t = t;
                hit.sphere = i;
            }
        }
        for (int i = 0; i < SPHERES; i++) {
            if (i == hit.sphere) {
                hit.point = ray.origin + hit.t * ray.direction;
                hit.normal = (hit.point - spheres[i].center) / spheres[i].radius;
            }
        }
        return hit;
    }

    bool inShadow(float3 point, float3 normal) {
        // Start slightly above the surface, so that the shadow ray does not hit the same sphere.
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

    float3 trace(Ray ray) {
        Intersection hit = nearestHit(ray);
        if (hit.sphere < 0) {
            return float3(0.3, 0.4, 0.6);
        }
        float3 sum = AMBIENT;
        float cosine = dot(hit.normal, normalize(light.position - hit.point));
        if (cosine > 0.0) {
            if (!inShadow(hit.point, hit.normal)) {
                sum += light.color * cosine;
            }
        }
        return spheres[hit.sphere].color * sum;
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
        seed = 0.0;
        float3 color = float3(0.0);
        for (int i = 0; i < SAMPLES; i++) {
            float x = fragCoord.x + random() - 0.5;
            float y = fragCoord.y + random() - 0.5;
            color += trace(cameraRay(float2(x, y)));
        }
        fragColor = float4(color / float(SAMPLES), 1.0);
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
