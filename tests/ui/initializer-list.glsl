void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float weights[3] = { 1.0, 2.0, 1.0 };
    fragColor = vec4(weights[0]);
}
