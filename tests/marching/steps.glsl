// A sphere by ray marching, with more steps than it needs.

#define MAX_STEPS 256

const float HIT = 0.002;
const float FAR = 40.0;

float map(vec3 p) {
    return length(p - vec3(0.0, 1.0, 6.0)) - 1.0;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    vec3 origin = vec3(0.0, 1.0, 0.0);
    vec3 direction = normalize(vec3(uv, 1.5));
    float t = 0.0;
    for (int i = 0; i < MAX_STEPS; i++) {
        t += 0.9 * map(origin + t * direction);
    }
    vec3 color = vec3(0.6, 0.8, 1.0);
    if (t < FAR && map(origin + t * direction) < HIT) {
        color = vec3(0.5 + 0.5 * sin(4.0 * (origin + t * direction)));
    }
    fragColor = vec4(color, 1.0);
}
