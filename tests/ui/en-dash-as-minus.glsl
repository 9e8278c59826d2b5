void mainImage(out vec4 c, in vec2 p) {
    float x = 1.0 – 0.5;
    c = vec4(x);
}
