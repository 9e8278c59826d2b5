// Cellular noise with integers, and with one loop over the 9 cells, which compares squares of distances.
int permute(int n) {
    n = (n % 251 + 251) % 251;
    return n * n % 251 * n % 251;
}

float random(ivec2 cell) {
    return float(permute(cell.x + permute(cell.y + 40))) / 250.0;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 p = 5.0 * fragCoord / iResolution.y;
    vec2 toMouse = p - 5.0 * iMouse.xy / iResolution.y;
    float smallest = dot(toMouse, toMouse);
    float number = 1.0;
    for (int i = 0; i < 9; i++) {
        ivec2 cell = ivec2(floor(p)) + ivec2(i % 3, i / 3) - 1;
        vec2 angle = iTime + radians(360.0) * vec2(random(cell), random(cell + ivec2(100, 50)));
        vec2 d = vec2(cell) + 0.5 + 0.3 * sin(angle) - p;
        if (dot(d, d) < smallest) {
            smallest = dot(d, d);
            number = random(cell);
        }
    }
    float d = sqrt(smallest);
    vec3 color = (1.0 - 0.8 * d) * (vec3(0.1, 0.45, 0.5) + number * vec3(0.85, 0.3, -0.1));
    float white = clamp((0.06 - d) * iResolution.y / 5.0 + 0.5, 0.0, 1.0);
    fragColor = vec4(mix(color, vec3(1.0), white * white * (3.0 - 2.0 * white)), 1.0);
}
