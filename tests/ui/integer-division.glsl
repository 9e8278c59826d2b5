void mainImage(out vec4 c, in vec2 p) {
    c = vec4(pow(p.x, 1 / 3));
}
