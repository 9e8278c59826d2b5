varying vec2 uv;
void mainImage(out vec4 c, in vec2 p) { c = vec4(uv, 0.0, 1.0); }
