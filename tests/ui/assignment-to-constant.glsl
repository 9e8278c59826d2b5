void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    const float gain = 2.0;
    gain = 3.0;
    fragColor = vec4(gain);
}
