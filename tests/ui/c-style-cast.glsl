void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    int column = 3;
    fragColor = vec4((float) column);
}
