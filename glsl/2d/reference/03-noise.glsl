// Value noise as a weighted sum of the corners, with integers.
int permute(int n) {
    return n * n % 251 * n % 251;
}

float noise(vec2 p) {
    float sum = 0.0;
    for (int corner = 0; corner < 4; corner++) {
        ivec2 cell = ivec2(p) + ivec2(corner & 1, corner >> 1);
        vec2 weight = 1.0 - smoothstep(0.0, 1.0, abs(p - vec2(cell)));
        sum += weight.x * weight.y * float(permute((cell.x + permute((cell.y + 40) % 251)) % 251)) / 250.0;
    }
    return sum;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float height = noise(fragCoord * 6.0 / iResolution.y);
    vec3 water = mix(vec3(0.05, 0.15, 0.4), vec3(0.3, 0.6, 0.8), smoothstep(0.0, 0.45, height));
    vec3 grass = mix(vec3(0.9, 0.85, 0.6), vec3(0.3, 0.6, 0.25), smoothstep(0.5, 0.55, height));
    vec3 land = mix(grass, vec3(0.45, 0.35, 0.3), smoothstep(0.7, 0.85, height));
    fragColor = vec4(mix(water, land, smoothstep(0.44, 0.46, height)), 1.0);
}
