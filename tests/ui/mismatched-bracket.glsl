void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float light = abs(fragCoord.x];
    fragColor = vec4(light);
}
