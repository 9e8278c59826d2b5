void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 colour = vec3(1.0) / 2;
    fragColor = vec4(colour, 1.0);
}
