float g = 1.0;
float next() { return g += 1.0; }
bool hit(inout float t, out vec2 q, const in int i);
float pick(float a[3], int i) { return a[i]; }
vec2 pick(vec2 a, highp float b) { return a * b; }
bool hit(inout float t, out vec2 q, const in int i) { t += float(i); q = vec2(t); return t > 2.0; }
void mainImage(out vec4 o, in vec2 p) {
    float t = next(), a[3] = float[](1.0, next(), t); vec4 v;
    if (p.x < 4.0 && hit(t, v.zx, 1) || hit(a[int(t) % 3], v.yw, 2)) t = (next(), g--);
    v.xy *= next() > 3.0 ? v.yx : pick(v.zw, g++);
    o = v + pick(a, a.length() - 1) + t;
}
