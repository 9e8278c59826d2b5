vec3 shade(vec3 ray, int depth) {
    if (depth == 0) return vec3(0.0);
    return 0.5 * shade(reflect(ray, vec3(0, 1, 0)), depth - 1);
}
void mainImage(out vec4 c, in vec2 p) { c = vec4(shade(vec3(p, 1.0), 3), 1.0); }
