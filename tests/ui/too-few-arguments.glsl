float box(vec3 p, vec3 size) { return length(max(abs(p) - size, 0.0)); }
void mainImage(out vec4 c, in vec2 p) { c = vec4(box(vec3(p, 0.0))); }
