// Octaves of noise: each has twice the frequency and half the amplitude of the one before, so that the clouds
// have large forms with small details. They move with the time. Change the number of octaves, and the factor
// of the amplitude.

#ifdef GL_ES
precision highp float;
#endif

uniform vec2 u_resolution;
uniform float u_time;

const int OCTAVES = 5;

// The hash of the exercise on noise, and the noise.
float remainder251(float n) {
    return floor(251.0 * fract((n + 0.5) / 251.0));
}

float permute(float n) {
    return remainder251(n * remainder251(n * n));
}

float hash(vec2 cell) {
    float row = permute(remainder251(cell.y + 40.0));
    return permute(remainder251(cell.x + row)) / 250.0;
}

float noise(vec2 p) {
    vec2 cell = floor(p);
    vec2 f = fract(p);
    vec2 w = f * f * (3.0 - 2.0 * f);
    float bottom = mix(hash(cell), hash(cell + vec2(1.0, 0.0)), w.x);
    float top = mix(hash(cell + vec2(0.0, 1.0)), hash(cell + vec2(1.0, 1.0)), w.x);
    return mix(bottom, top, w.y);
}

// The sum of the octaves, from 0 to 1. Each octave is rotated, which hides the directions of the grid.
float fbm(vec2 p) {
    mat2 next = 2.0 * mat2(0.8, 0.6, -0.6, 0.8);
    float sum = 0.0;
    float amplitude = 0.5;
    for (int i = 0; i < OCTAVES; i++) {
        sum += amplitude * noise(p);
        p = next * p + vec2(7.0, 3.0);
        amplitude *= 0.5;
    }
    return sum;
}

void main() {
    vec2 p = 3.0 * gl_FragCoord.xy / u_resolution.y;
    vec2 wind = vec2(0.2 * u_time, 0.0);
    // Coordinates that are moved by noise curl the clouds.
    float cloud = fbm(p + wind + 0.8 * fbm(2.0 * p));
    vec3 sky = mix(vec3(0.65, 0.8, 0.95), vec3(0.15, 0.35, 0.7), gl_FragCoord.y / u_resolution.y);
    vec3 color = mix(sky, vec3(1.0), smoothstep(0.4, 0.75, cloud));
    gl_FragColor = vec4(color, 1.0);
}
