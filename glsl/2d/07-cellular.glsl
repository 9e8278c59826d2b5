// Cellular noise: each cell of a grid has one point, and the color follows from the distance to the nearest
// point. The points move with the time, and the mouse is one more point. Change the colors, then use the
// distance to the second-nearest point, too.

#ifdef GL_ES
precision highp float;
#endif

uniform vec2 u_resolution;
uniform vec2 u_mouse;
uniform float u_time;

const float TAU = 6.28318530718;
const float ROWS = 5.0;

// The hash of the exercise on noise.
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

// The point of a cell. It is at least 0.2 away from the edges of the cell, so the point nearest to a pixel is
// always in one of the 3x3 cells around it.
vec2 pointOf(vec2 cell) {
    vec2 phase = vec2(hash(cell), hash(cell + vec2(100.0, 50.0)));
    return cell + 0.5 + 0.3 * sin(TAU * phase + u_time);
}

// The distance to the nearest point, and the number of its cell from 0 to 1.
vec2 nearest(vec2 p) {
    vec2 mouse = ROWS * u_mouse / u_resolution.y;
    vec2 best = vec2(distance(p, mouse), 1.0);
    for (int y = -1; y <= 1; y++) {
        for (int x = -1; x <= 1; x++) {
            vec2 cell = floor(p) + vec2(float(x), float(y));
            float d = distance(p, pointOf(cell));
            if (d < best.x) {
                best = vec2(d, hash(cell));
            }
        }
    }
    return best;
}

void main() {
    vec2 p = ROWS * gl_FragCoord.xy / u_resolution.y;
    float pixel = ROWS / u_resolution.y;
    vec2 found = nearest(p);

    vec3 color = mix(vec3(0.1, 0.45, 0.5), vec3(0.95, 0.75, 0.4), found.y);
    color *= 1.0 - 0.8 * found.x;
    color = mix(vec3(1.0), color, smoothstep(-0.5 * pixel, 0.5 * pixel, found.x - 0.06));
    gl_FragColor = vec4(color, 1.0);
}
