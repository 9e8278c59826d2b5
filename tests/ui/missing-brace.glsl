float clamped(float x) {
    if (x > 1.0) {
        x = 1.0;
    return x;
}

void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
