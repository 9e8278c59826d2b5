float brightness(vec3 color) {
    return color;
}
void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
