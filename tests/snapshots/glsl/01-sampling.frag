#version 300 es
// glsl/01-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// 2D figures as implicit functions, with f < 0 inside; several samples per pixel smooth their edges.

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

const int SAMPLES = 10;

float seed = 0.0;

float random() {
    // toyproof: allow(W0005) the scene's sampler uses this hash
    return fract(sin(seed++) * 43758.5453123);
}

float disk(vec2 p, vec2 center, float radius) {
    vec2 d = p - center;
    return dot(d, d) - radius * radius;
}

// Below a sine wave.
float wave(vec2 p, float height, float amplitude, float frequency) {
    return p.y - height - amplitude * sin(frequency * p.x);
}

float heart(vec2 p, vec2 center, float size) {
    vec2 q = (p - center) / size;
    float ring = dot(q, q) - 1.0;
    return ring * ring * ring - q.x * q.x * q.y * q.y * q.y;
}

// The figure tested first is on top.
vec3 figures(vec2 p) {
    if (heart(p, vec2(0.35, 0.08), 0.25) < 0.0) {
        return vec3(0.85, 0.1, 0.2);
    }
    if (disk(p, vec2(-0.45, 0.15), 0.28) < 0.0) {
        return vec3(1.0, 0.8, 0.2);
    }
    if (wave(p, -0.2, 0.1, 9.0) < 0.0) {
        return vec3(0.1, 0.35, 0.6);
    }
    return vec3(0.75, 0.85, 0.95);
}

void mainImage(out vec4 fragColor, vec2 fragCoord) {
    fragColor = vec4(0.0);
    seed = 0.0;
    float aspect = iResolution.x / iResolution.y;
    vec3 color = vec3(0.0);
    for (int i = 0; i < SAMPLES; i++) {
        float fx = fragCoord.x + random() - 0.5;
        float fy = fragCoord.y + random() - 0.5;
        float x = fx / iResolution.x * 2.0 - 1.0;
        float y = (fy / iResolution.y * 2.0 - 1.0) / aspect;
        color += figures(vec2(x, y));
    }
    fragColor = vec4(color / float(SAMPLES), 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
