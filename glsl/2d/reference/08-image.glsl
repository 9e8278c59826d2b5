// The Sobel filter, written out: eight texels, and the differences of opposite sides.
float gray(vec2 fragCoord, int x, int y) {
    vec2 uv = fragCoord / iResolution.xy + vec2(x, y) / iChannelResolution[0].xy;
    vec3 c = texture(iChannel0, uv).rgb;
    return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float nw = gray(fragCoord, -1, 1), n = gray(fragCoord, 0, 1), ne = gray(fragCoord, 1, 1);
    float w = gray(fragCoord, -1, 0), e = gray(fragCoord, 1, 0);
    float sw = gray(fragCoord, -1, -1), s = gray(fragCoord, 0, -1), se = gray(fragCoord, 1, -1);
    float gx = (ne - nw) + 2.0 * (e - w) + (se - sw);
    float gy = (nw - sw) + 2.0 * (n - s) + (ne - se);

    vec3 pale = 0.4 + 0.6 * texture(iChannel0, fragCoord / iResolution.xy).rgb;
    float t = clamp((sqrt(gx * gx + gy * gy) - 0.15) / 0.45, 0.0, 1.0);
    float line = t * t * (3.0 - 2.0 * t);
    fragColor = vec4((1.0 - line) * pale + line * vec3(0.1, 0.1, 0.2), 1.0);
}
