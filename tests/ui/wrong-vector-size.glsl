void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 color = vec4(1.0);
    fragColor = vec4(color, 1.0);
}
