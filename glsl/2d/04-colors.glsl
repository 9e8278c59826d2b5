// Colors by formulas: the disk shows hue and saturation (HSB), and the strip below it a palette of cosines.
// The hues turn with the time. Change the four vectors of the palette.

#ifdef GL_ES
precision mediump float;
#endif

uniform vec2 u_resolution;
uniform float u_time;

const float TAU = 6.28318530718;

// The red, green and blue of a hue; hue, saturation and brightness run from 0 to 1.
vec3 hsb(float hue, float saturation, float brightness) {
    vec3 sector = mod(6.0 * hue + vec3(0.0, 4.0, 2.0), 6.0);
    vec3 rgb = clamp(abs(sector - 3.0) - 1.0, 0.0, 1.0);
    return brightness * mix(vec3(1.0), rgb, saturation);
}

// A color for t from 0 to 1: each component oscillates with its own frequency and phase.
vec3 palette(float t) {
    vec3 mean = vec3(0.55, 0.45, 0.5);
    vec3 amplitude = vec3(0.4, 0.4, 0.5);
    vec3 frequency = vec3(1.0, 1.0, 0.5);
    vec3 phase = vec3(0.0, 0.15, 0.3);
    return mean + amplitude * cos(TAU * (frequency * t + phase));
}

void main() {
    vec2 p = (2.0 * gl_FragCoord.xy - u_resolution) / u_resolution.y;
    float pixel = 2.0 / u_resolution.y;

    // The angle about the center of the disk is the hue, the distance from it the saturation.
    vec2 q = p - vec2(0.0, 0.25);
    float hue = fract(atan(q.y, q.x) / TAU + 0.1 * u_time);
    float radius = length(q) / 0.6;

    vec3 color = vec3(0.12);
    color = mix(hsb(hue, radius, 1.0), color, smoothstep(-0.5 * pixel, 0.5 * pixel, length(q) - 0.6));
    if (abs(p.y + 0.7) < 0.14) {
        color = palette(gl_FragCoord.x / u_resolution.x);
    }
    gl_FragColor = vec4(color, 1.0);
}
