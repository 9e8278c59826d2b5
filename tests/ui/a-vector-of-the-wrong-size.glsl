void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 colour = vec4(1.0);
    fragColor = vec4(colour, 1.0);
}
