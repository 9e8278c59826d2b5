float start = iTime * 2, grid[2][3];
float sin(bool b) { return b ? 1 : 2; }
struct P { vec2 a; };
void mainImage(out vec4 o, vec2 p) {
    P q = p.x > 1 ? P(p) : P(vec2(1)); int k = 2; float a[2] = float[2](1, k);
    grid[1][k] = start; grid[0] = grid[1]; float f = k; f += 3 * k;
    vec2 v = max(p, 0); o = vec4(v, grid[0][2], sin(true)) + a[1] + q.a.x;
}
