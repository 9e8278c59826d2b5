void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float x = 1;
    fragColor = vec4(x);
}
