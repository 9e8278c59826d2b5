precision highp float;
float x = 1.0, sine;
struct S { float x; } s;
float S1(float S) { return S + x; }
void mainImage(out vec4 o, in vec2 p) {
    float sin = x; { float x = x + sin, y = x; { vec2 x = vec2(y); s.x = x.y; } sin += x; }
    for (int x = 0; x < 2; x++) { float sin = float(x); s = S(sin); }
    if (p.x > 1.0) { struct S { int k; }; S s = S(3); x = float(s.k); }
    float iTime = cos(sin), texture = S1(s.x), input_ = iTime;
    o = vec4(x, sin, texture, input_);
}
