void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 color = vec3(1.0) / 2;
    fragColor = vec4(color, 1.0);
}
