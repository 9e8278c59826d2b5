#version 450
// A plasma for Vulkan, without ShaderToy: what naga's command line reads.

layout(location = 0) out vec4 fragColor;

const float TAU = 6.2831853;
const vec3 PHASES = vec3(0.0, 0.33, 0.67);

struct Wave {
    vec2 direction;
    float frequency;
    float weight;
};

float wave(Wave w, vec2 p, float t) {
    return w.weight * sin(dot(p, w.direction) * w.frequency + t);
}

vec2 turn(vec2 p, float angle) {
    mat2 m = mat2(vec4(cos(angle), sin(angle), -sin(angle), cos(angle)));
    return m * p;
}

float plasma(vec2 p, float t) {
    float sum = 0.0;
    for (int i = 0; i < 5; i++) {
        Wave w = Wave(vec2(cos(float(i)), sin(float(i))), 2.0 + float(i), 1.0 / float(i + 1));
        sum += wave(w, p, t * (1.0 + 0.3 * float(i)));
        p = turn(p, 0.4);
        if (sum > 2.5) break;
    }
    return sum;
}

vec3 palette(float x) {
    return 0.5 + 0.5 * cos(TAU * (x + PHASES));
}

void main() {
    vec2 p = gl_FragCoord.xy * 0.01 - 2.0;
    float v = plasma(p, 0.0);
    vec3 color = palette(v * 0.2);
    color *= 1.0 - 0.2 * dot(p, p);
    fragColor = vec4(color, 1.0);
}
