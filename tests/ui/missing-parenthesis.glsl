void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float x = sin(cos(iTime);
    fragColor = vec4(x);
}
