// Matrices and their order: the orange F turns about itself, since it is rotated before it is moved; the blue
// F orbits the center, since it is moved before it is rotated. Change the order of the steps, and the sizes.

#ifdef GL_ES
precision mediump float;
#endif

uniform vec2 u_resolution;
uniform float u_time;

// The columns of a matrix are the images of the axes.
mat2 rotation(float angle) {
    float c = cos(angle);
    float s = sin(angle);
    return mat2(c, s, -s, c);
}

mat2 scaling(vec2 factors) {
    return mat2(factors.x, 0.0, 0.0, factors.y);
}

float box(vec2 p, vec2 center, vec2 halfSize) {
    vec2 q = abs(p - center) - halfSize;
    return max(q.x, q.y);
}

// The letter F, from -0.5 to 0.5 in y. It has no symmetry, so every mistake in a matrix is visible.
float letter(vec2 p) {
    float stem = box(p, vec2(-0.2, 0.0), vec2(0.1, 0.5));
    float top = box(p, vec2(0.0, 0.4), vec2(0.3, 0.1));
    float middle = box(p, vec2(-0.05, 0.05), vec2(0.25, 0.1));
    return min(stem, min(top, middle));
}

float coverage(float d, float pixel) {
    return 1.0 - smoothstep(-0.5 * pixel, 0.5 * pixel, d);
}

void main() {
    vec2 p = (2.0 * gl_FragCoord.xy - u_resolution) / u_resolution.y;
    float pixel = 2.0 / u_resolution.y;

    // To move a shape, the point takes the inverse steps, and the last one first.
    // Orange: scaled, rotated, moved.
    vec2 inner = scaling(vec2(1.0, 0.8)) * rotation(-u_time) * (p - vec2(-0.35, 0.1));
    // Blue: scaled, moved, rotated.
    vec2 orbit = scaling(vec2(2.0)) * (rotation(-0.5 * u_time - 0.6) * p - vec2(0.6, 0.0));

    vec3 color = mix(vec3(0.75, 0.8, 0.85), vec3(0.95, 0.93, 0.88), coverage(length(p) - 0.9, pixel));
    color = mix(color, vec3(0.9, 0.5, 0.15), coverage(letter(inner), pixel));
    color = mix(color, vec3(0.15, 0.35, 0.65), coverage(letter(orbit), 2.0 * pixel));
    gl_FragColor = vec4(color, 1.0);
}
