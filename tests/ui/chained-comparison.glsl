void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    if (0.0 < fragCoord.x < 10.0) fragColor = vec4(1.0);
}
