void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fragColor = vec4(smoothStep(0.0, 1.0, fragCoord.x));
}
