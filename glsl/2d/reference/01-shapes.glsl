// The shapes in pixels: a layer covers a pixel as far as its distance d is below half a pixel.
vec3 layer(vec3 below, vec3 color, float d) {
    float t = clamp(0.5 - d, 0.0, 1.0);
    return mix(below, color, t * t * (3.0 - 2.0 * t));
}

// The distance to a box without its corners, less their radius.
float box(vec2 p, vec2 size, float radius) {
    return distance(p, clamp(p, radius - size, size - radius)) - radius;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float unit = 0.5 * iResolution.y;
    vec2 p = fragCoord - 0.5 * iResolution.xy;
    float lens = distance(p, unit * vec2(-0.1)) - 0.38 * unit;

    vec3 color = vec3(0.95, 0.85, 0.7);
    color = layer(color, vec3(0.2, 0.25, 0.35), min(
        box(p + unit * vec2(0.0, 0.1), unit * vec2(0.85, 0.55), 0.15 * unit),
        box(p + unit * vec2(0.1, -0.45), unit * vec2(0.35, 0.2), 0.08 * unit)));
    color = layer(color, vec3(0.4, 0.7, 0.8), lens);
    color = layer(color, vec3(1.0), max(lens, -lens) - 0.04 * unit);
    color = layer(color, vec3(0.95, 0.3, 0.2), distance(p, unit * vec2(0.6, 0.2)) - 0.1 * unit);
    fragColor = vec4(color, 1.0);
}
