// Clouds with a hash of integers, and with matrices and vectors written as components.
int permute(int n) {
    n = (n % 251 + 251) % 251;
    return n * n % 251 * n % 251;
}

float corner(ivec2 cell) {
    return float(permute(cell.x + permute(cell.y + 40))) / 250.0;
}

float noise(vec2 p) {
    ivec2 cell = ivec2(floor(p));
    vec2 w = smoothstep(0.0, 1.0, p - floor(p));
    vec2 left = vec2(corner(cell), corner(cell + ivec2(0, 1)));
    vec2 right = vec2(corner(cell + ivec2(1, 0)), corner(cell + 1));
    return dot(left + w.x * (right - left), vec2(1.0 - w.y, w.y));
}

// The weights of the octaves are 1/2, 1/4, and so on.
float clouds(vec2 p) {
    float weighted = 0.0;
    for (int i = 1; i <= 5; i++) {
        weighted += exp2(-float(i)) * noise(p);
        p = vec2(1.6 * p.x - 1.2 * p.y + 7.0, 1.2 * p.x + 1.6 * p.y + 3.0);
    }
    return weighted;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = fragCoord / iResolution.y;
    float bend = 0.8 * clouds(6.0 * uv);
    float cloud = clouds(vec2(3.0 * uv.x + iTime / 5.0 + bend, 3.0 * uv.y + bend));
    float white = smoothstep(0.4, 0.75, cloud);
    vec3 blue = vec3(0.65, 0.8, 0.95) - uv.y * vec3(0.5, 0.45, 0.25);
    fragColor = vec4(white + (1.0 - white) * blue, 1.0);
}
