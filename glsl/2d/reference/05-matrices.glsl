// Matrices of homogeneous coordinates, which place the letter; `inverse` leads from the image to the letter.
mat3 move(vec2 by) {
    return mat3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, by, 1.0);
}

mat3 scale(vec2 by) {
    return mat3(by.x, 0.0, 0.0, 0.0, by.y, 0.0, 0.0, 0.0, 1.0);
}

mat3 turn(float angle) {
    return mat3(cos(angle), sin(angle), 0.0, -sin(angle), cos(angle), 0.0, 0.0, 0.0, 1.0);
}

// The letter's boxes by their corners.
float box(vec2 p, vec2 low, vec2 high) {
    vec2 d = max(low - p, p - high);
    return max(d.x, d.y);
}

vec3 draw(vec3 below, vec3 color, mat3 matrix, vec2 p, float pixel) {
    vec2 q = (inverse(matrix) * vec3(p, 1.0)).xy;
    float d = min(min(box(q, vec2(-0.3, -0.5), vec2(-0.1, 0.5)), box(q, vec2(-0.3, 0.3), vec2(0.3, 0.5))),
                  box(q, vec2(-0.3, -0.05), vec2(0.2, 0.15)));
    return mix(color, below, smoothstep(-0.5 * pixel, 0.5 * pixel, d));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float pixel = 2.0 / iResolution.y;
    vec2 p = pixel * fragCoord - iResolution.xy / iResolution.y;
    mat3 inner = move(vec2(-0.35, 0.1)) * turn(iTime) * scale(vec2(1.0, 1.25));
    mat3 orbit = turn(0.6 + 0.5 * iTime) * move(vec2(0.6, 0.0)) * scale(vec2(0.5));
    float outside = smoothstep(-0.5, 0.5, (length(p) - 0.9) / pixel);
    vec3 color = mix(vec3(0.95, 0.93, 0.88), vec3(0.75, 0.8, 0.85), outside);
    color = draw(color, vec3(0.9, 0.5, 0.15), inner, p, pixel);
    fragColor = vec4(draw(color, vec3(0.15, 0.35, 0.65), orbit, p, 2.0 * pixel), 1.0);
}
