// glsl/01-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// 2D figures as implicit functions, with f < 0 inside; several samples per pixel smooth their edges.

#include <metal_stdlib>
using namespace metal;

constant int SAMPLES = 10;

float disk(float2 p, float2 center, float radius) {
    float2 d = p - center;
    return dot(d, d) - radius * radius;
}

// Below a sine wave.
float wave(float2 p, float height, float amplitude, float frequency) {
    return p.y - height - amplitude * sin(frequency * p.x);
}

float heart(float2 p, float2 center, float size) {
    float2 q = (p - center) / size;
    float ring = dot(q, q) - 1.0;
    return ring * ring * ring - q.x * q.x * q.y * q.y * q.y;
}

// The figure tested first is on top.
float3 figures(float2 p) {
    if (heart(p, float2(0.35, 0.08), 0.25) < 0.0) {
        return float3(0.85, 0.1, 0.2);
    }
    if (disk(p, float2(-0.45, 0.15), 0.28) < 0.0) {
        return float3(1.0, 0.8, 0.2);
    }
    if (wave(p, -0.2, 0.1, 9.0) < 0.0) {
        return float3(0.1, 0.35, 0.6);
    }
    return float3(0.75, 0.85, 0.95);
}

struct Shader {
    float3 iResolution;

    float seed = 0.0;

    float random() {
        // toyproof: allow(W0005) the scene's sampler uses this hash
        return fract(sin(seed++) * 43758.5453123);
    }

    void mainImage(thread float4& fragColor, float2 fragCoord) {
        fragColor = float4(0.0);
        seed = 0.0;
        float aspect = iResolution.x / iResolution.y;
        float3 color = float3(0.0);
        for (int i = 0; i < SAMPLES; i++) {
            float fx = fragCoord.x + random() - 0.5;
            float fy = fragCoord.y + random() - 0.5;
            float x = fx / iResolution.x * 2.0 - 1.0;
            float y = (fy / iResolution.y * 2.0 - 1.0) / aspect;
            color += figures(float2(x, y));
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
