// A trail of the second substance.
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    ivec2 at = ivec2(fragCoord);
    float now = texelFetch(iChannel0, at, 0).y;
    vec3 before = iFrame == 0 ? vec3(0.0) : texelFetch(iChannel1, at, 0).rgb;
    vec3 hue = 0.5 + 0.5 * cos(iTime + vec3(0.0, 2.0, 4.0));
    fragColor = vec4(max(0.97 * before, now * hue), 1.0);
}
