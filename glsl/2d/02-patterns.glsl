// A pattern of tiles: floor gives the tile of a point, and fract the position in the tile. Every second row
// is shifted by half a tile, like bricks, and the figure in each tile is turned by an angle of its own.
// Change the figure, then the rule for the angle.

#ifdef GL_ES
precision mediump float;
#endif

uniform vec2 u_resolution;

const float PI = 3.14159265359;
const float ROWS = 6.0;

// Turns p counterclockwise about the origin.
vec2 rotate(vec2 p, float angle) {
    float c = cos(angle);
    float s = sin(angle);
    return vec2(c * p.x - s * p.y, s * p.x + c * p.y);
}

vec2 shiftOddRows(vec2 p) {
    return vec2(p.x + 0.5 * mod(floor(p.y), 2.0), p.y);
}

float halfDisk(vec2 p, float radius) {
    return max(length(p) - radius, p.y);
}

float coverage(float d, float pixel) {
    return 1.0 - smoothstep(-0.5 * pixel, 0.5 * pixel, d);
}

void main() {
    vec2 p = shiftOddRows(ROWS * gl_FragCoord.xy / u_resolution.y);
    float pixel = ROWS / u_resolution.y;
    vec2 tile = floor(p);
    vec2 center = fract(p) - 0.5;

    // The figure is turned by an angle if its points are turned back.
    float angle = PI / 4.0 * (tile.x + 2.0 * tile.y);
    vec2 q = rotate(center, -angle);

    vec3 warm = mix(vec3(0.95, 0.6, 0.2), vec3(0.85, 0.25, 0.2), mod(tile.x + tile.y, 2.0));
    vec3 color = vec3(0.1, 0.15, 0.25);
    color = mix(color, warm, coverage(halfDisk(q, 0.4), pixel));
    color = mix(color, vec3(0.4, 0.75, 0.7), coverage(length(q - vec2(0.0, 0.18)) - 0.12, pixel));
    gl_FragColor = vec4(color, 1.0);
}
