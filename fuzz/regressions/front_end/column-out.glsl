mat4 m;
void f(out vec2 a, inout vec2 b) { a = b++; }
void mainImage(out vec4 o, in vec2 p) {
    f(m[1].ag, m[iFrame & 3].xz);
    p = modf(p, m[2].yx);
    o = m[1] + m[2];
}
