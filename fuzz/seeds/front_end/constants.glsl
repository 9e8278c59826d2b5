const float inf = 1.0 / 0.0, nan = 0.0 / 0.0, tiny = 1e-45, huge = 1e38 * 10.0;
const int n = int(sqrt(9.0)) + ivec2(1, 2).y * 2, shift = 1 << 31;
const vec2 table[n - 4] = vec2[](vec2(0), vec2(1), vec2(sin(1.0), -cos(2.0)));
const mat2 m = inverse(mat2(1, 2, 3, 4)) * 2.0;
float rows[table.length() * 2], zero;
void mainImage(out vec4 o, in vec2 p) {
    const int last = rows.length() - 1;
    rows[last] = table[1].x + m[1][0]; rows[int(p.x) % n] += 1.0;
    o = vec4(rows[last], zero, true ? inf : nan, min(tiny, huge)) + float(shift);
}
