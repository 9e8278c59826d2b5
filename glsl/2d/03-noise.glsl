// Value noise: a random number in each corner of a grid, and smooth interpolation between the four corners
// around a point. The noise is the height of a map. Change the size of the grid, and the colors of the
// heights.

// The products in `permute` are whole numbers up to 62,500, which mediump does not have on every device.
#ifdef GL_ES
precision highp float;
#endif

uniform vec2 u_resolution;

// The remainder of the whole number n by 251. The 0.5 keeps rounding errors away from whole numbers.
float remainder251(float n) {
    return floor(251.0 * fract((n + 0.5) / 251.0));
}

// The cube of n by the modulus 251, which permutes the numbers from 0 to 250.
float permute(float n) {
    return remainder251(n * remainder251(n * n));
}

// A random number from 0 to 1 for whole coordinates. Every GPU returns the same number, unlike with a hash of
// large sines, because rounding errors do not change the result of `remainder251`.
float hash(vec2 cell) {
    float row = permute(remainder251(cell.y + 40.0));
    return permute(remainder251(cell.x + row)) / 250.0;
}

float noise(vec2 p) {
    vec2 cell = floor(p);
    vec2 f = fract(p);
    // The slope of this curve is 0 at both ends, so the grid leaves no visible edges.
    vec2 w = f * f * (3.0 - 2.0 * f);
    float bottom = mix(hash(cell), hash(cell + vec2(1.0, 0.0)), w.x);
    float top = mix(hash(cell + vec2(0.0, 1.0)), hash(cell + vec2(1.0, 1.0)), w.x);
    return mix(bottom, top, w.y);
}

void main() {
    float height = noise(6.0 * gl_FragCoord.xy / u_resolution.y);
    vec3 color = mix(vec3(0.05, 0.15, 0.4), vec3(0.3, 0.6, 0.8), smoothstep(0.0, 0.45, height));
    color = mix(color, vec3(0.9, 0.85, 0.6), smoothstep(0.44, 0.46, height));
    color = mix(color, vec3(0.3, 0.6, 0.25), smoothstep(0.5, 0.55, height));
    color = mix(color, vec3(0.45, 0.35, 0.3), smoothstep(0.7, 0.85, height));
    gl_FragColor = vec4(color, 1.0);
}
