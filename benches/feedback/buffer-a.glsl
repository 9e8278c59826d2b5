// Two substances react and diffuse (Gray and Scott): x feeds y, and y decays.
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 texel = 1.0 / iResolution.xy;
    vec2 uv = fragCoord * texel;
    if (iFrame == 0) {
        float spot = 1.0 - smoothstep(0.05, 0.06, length(fract(uv * 4.0) - 0.5));
        fragColor = vec4(1.0, spot, 0.0, 1.0);
        return;
    }
    vec2 center = texture(iChannel0, uv).xy;
    vec2 around = texture(iChannel0, uv + vec2(texel.x, 0.0)).xy + texture(iChannel0, uv - vec2(texel.x, 0.0)).xy
        + texture(iChannel0, uv + vec2(0.0, texel.y)).xy + texture(iChannel0, uv - vec2(0.0, texel.y)).xy;
    float reaction = center.x * center.y * center.y;
    vec2 change = vec2(0.2, 0.1) * (around - 4.0 * center)
        + vec2(0.04 * (1.0 - center.x) - reaction, reaction - 0.1 * center.y);
    fragColor = vec4(center + change, 0.0, 1.0);
}
