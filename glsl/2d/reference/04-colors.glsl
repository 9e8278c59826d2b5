// One component of a hue at full brightness: 5, 3 and 1 are the offsets of red, green and blue.
float component(float offset, float hue, float saturation) {
    float k = mod(offset + 6.0 * hue, 6.0);
    return 1.0 - saturation * clamp(min(k, 4.0 - k), 0.0, 1.0);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    const float TURN = 2.0 * acos(-1.0);
    vec2 uv = fragCoord / iResolution.xy;
    vec2 fromCenter = fragCoord - vec2(0.5, 0.625) * iResolution.xy;

    float radius = 0.3 * iResolution.y;
    float s = length(fromCenter) / radius;
    float hue = atan(fromCenter.y, fromCenter.x) / TURN + iTime / 10.0;
    vec3 disk = vec3(component(5.0, hue, s), component(3.0, hue, s), component(1.0, hue, s));
    float outside = clamp((s - 1.0) * radius + 0.5, 0.0, 1.0);
    vec3 color = mix(disk, vec3(0.12), outside * outside * (3.0 - 2.0 * outside));

    // The strip: the cosine as a shifted sine, the phases in turns.
    vec3 phase = uv.x * vec3(1.0, 1.0, 0.5) + vec3(0.25, 0.4, 0.55);
    vec3 strip = vec3(0.55, 0.45, 0.5) + vec3(0.4, 0.4, 0.5) * sin(TURN * phase);
    fragColor = vec4(uv.y > 0.08 && uv.y < 0.22 ? strip : color, 1.0);
}
