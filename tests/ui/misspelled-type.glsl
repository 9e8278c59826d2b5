vec5 palette(flaot t) { return vec3(t); }
void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }
