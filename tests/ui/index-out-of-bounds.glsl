void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float weights[3];
    fragColor = vec4(weights[3]);
}
