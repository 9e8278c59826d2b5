void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec4 sample = texture(iChannel0, fragCoord);
    fragColor = sample;
}
