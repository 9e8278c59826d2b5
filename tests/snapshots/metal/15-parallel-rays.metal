// glsl/15-parallel-rays.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Parallel projection: all rays have the same direction and different origins, so distant objects look no smaller.

#include <metal_stdlib>
using namespace metal;

constant float NO_HIT = 1.0e6;
constant float WIDTH = 6.0;
constant int SPHERES = 5;
constant float3 AMBIENT = float3(0.1, 0.1, 0.12);
constant float3 LIGHT = float3(3.0, 5.0, 4.0);

struct Ray {
    float3 origin;
    float3 direction;
};

struct Sphere {
    float3 center;
    float radius;
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

    array<Sphere, 5> spheres = {};

    void makeScene() {
        spheres[0] = Sphere{ float3(-2.0, 0.0, -4.0), 0.7, float3(0.9, 0.3, 0.2) };
        spheres[1] = Sphere{ float3(-1.0, 0.3, -6.0), 0.7, float3(0.9, 0.6, 0.2) };
        spheres[2] = Sphere{ float3(0.0, 0.0, -9.0), 0.7, float3(0.9, 0.9, 0.3) };
        spheres[3] = Sphere{ float3(1.0, -0.3, -13.0), 0.7, float3(0.3, 0.8, 0.4) };
        spheres[4] = Sphere{ float3(2.0, 0.0, -18.0), 0.7, float3(0.3, 0.5, 0.9) };
    }

    Ray cameraRay(float2 fragCoord) {
        float aspect = iResolution.x / iResolution.y;
        float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
        float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
        return Ray{ 0.5 * WIDTH * float3(x, y, 0.0), float3(0.0, 0.0, -1.0) };
    }

    void mainImage(thread float4& fragColor, float2 fragCoord) {
        fragColor = float4(0.0);
        makeScene();
        Ray ray = cameraRay(fragCoord);
        float3 color = float3(0.05, 0.05, 0.08);

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
            float3 toLight = normalize(LIGHT - point);
            color = spheres[hit].color * (AMBIENT + float3(0.9) * max(dot(normal, toLight), 0.0));
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
