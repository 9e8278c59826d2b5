const int k = 1 << 40, l = -8 >> 33;
void mainImage(out vec4 o, in vec2 p) {
    uint u = uint(p.x); u <<= 32; ivec2 v = ivec2(p) >> ivec2(1, -1);
    o = vec4(u >> 48u, v, k + l);
}
