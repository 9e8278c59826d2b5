void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float x = 1.0;
    if (x = 2.0) x = 3.0;
    fragColor = vec4(x);
}
