// Distances to shapes: negative inside, 0 on the outline, positive outside. The minimum of two distances is
// the union of the shapes, and smoothstep makes edges that are one pixel wide in every resolution. Change the
// sizes, then add a shape of your own.

#ifdef GL_ES
precision mediump float;
#endif

uniform vec2 u_resolution;

float circle(vec2 p, float radius) {
    return length(p) - radius;
}

// A box around the origin, whose corners are arcs of the given radius.
float roundedBox(vec2 p, vec2 halfSize, float radius) {
    vec2 q = abs(p) - halfSize + radius;
    return length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - radius;
}

// The share of a pixel that a shape covers.
float coverage(float d, float pixel) {
    return 1.0 - smoothstep(-0.5 * pixel, 0.5 * pixel, d);
}

void main() {
    // y runs from -1 to 1; x has the same unit, so that circles are round.
    vec2 p = (2.0 * gl_FragCoord.xy - u_resolution) / u_resolution.y;
    float pixel = 2.0 / u_resolution.y;

    float body = roundedBox(p - vec2(0.0, -0.1), vec2(0.85, 0.55), 0.15);
    float viewfinder = roundedBox(p - vec2(-0.1, 0.45), vec2(0.35, 0.2), 0.08);
    float lens = circle(p - vec2(-0.1, -0.1), 0.38);
    float flash = circle(p - vec2(0.6, 0.2), 0.1);

    vec3 color = vec3(0.95, 0.85, 0.7);
    color = mix(color, vec3(0.2, 0.25, 0.35), coverage(min(body, viewfinder), pixel));
    color = mix(color, vec3(0.4, 0.7, 0.8), coverage(lens, pixel));
    // The points at most 0.04 from the outline are a ring.
    color = mix(color, vec3(1.0), coverage(abs(lens) - 0.04, pixel));
    color = mix(color, vec3(0.95, 0.3, 0.2), coverage(flash, pixel));
    gl_FragColor = vec4(color, 1.0);
}
