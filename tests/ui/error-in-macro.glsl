#define SQUARE(x) (x * x * 1)
void mainImage(out vec4 c, in vec2 p) {
    c = vec4(SQUARE(p.x));
}
