void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    iTime += 1.0;
    fragColor = vec4(iTime);
}
