// glsl/03-shading.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// One sphere under two point lights: Lambert's cosine law, plus ambient light.

#include <metal_stdlib>
using namespace metal;

constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1.0e6;
constant float3 AMBIENT = float3(0.1, 0.1, 0.15);

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

    array<Light, 2> lights = {};

    void makeScene() {
        lights[0] = Light{ float3(5.0, 5.0, 0.0), float3(0.8, 0.8, 0.7) };
        lights[1] = Light{ float3(-6.0, 1.0, -2.0), float3(0.1, 0.1, 0.3) };
    }

    float3 shade(float3 point, float3 normal, float3 color) {
        float3 sum = AMBIENT;
        for (int i = 0; i < 2; i++) {
            float3 toLight = normalize(lights[i].position - point);
            sum += lights[i].color * max(dot(normal, toLight), 0.0);
        }
        return color * sum;
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
        Sphere sphere = { float3(0.0, 0.0, -6.0), 1.5, float3(0.9, 0.6, 0.2) };
        Ray ray = cameraRay(fragCoord);
        float3 color = float3(0.02, 0.02, 0.05);

        float t = intersectSphere(ray, sphere);
        if (t < NO_HIT) {
            float3 hitPoint = ray.origin + t * ray.direction;
            float3 normal = (hitPoint - sphere.center) / sphere.radius;
            color = shade(hitPoint, normal, sphere.color);
        }
        fragColor = float4(color, 1.0);
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
