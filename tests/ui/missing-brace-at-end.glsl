float twice(float x) {
    return 2.0 * x;

void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
