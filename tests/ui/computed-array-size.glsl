void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    int n = 3;
    float samples[n];
    fragColor = vec4(samples[0]);
}
