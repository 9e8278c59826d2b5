void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 color = vec3(1.0);
    fragColor = vec4(colr, 1.0);
}
