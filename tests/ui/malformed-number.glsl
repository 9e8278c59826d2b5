void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float radius = 1f;
    int count = 09;
    fragColor = vec4(radius * 1.5.0, count, 0, 1);
}
