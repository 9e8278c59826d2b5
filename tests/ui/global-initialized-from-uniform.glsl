void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fragColor = vec4(1.0);
}
float speed = 2.0 * iTime;
void f() {
}
