void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    for (int i = 0; i < 4; i++) fragColor += i * 0.1;
}
