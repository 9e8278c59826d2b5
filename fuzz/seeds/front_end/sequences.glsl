void mainImage(out vec4 o, in vec2 p) {
    float a = 1.0, b, c; int i = 0; float t[4]; vec4 v = vec4(1);
    a = b = c = a++ + ++a; t[i++] = t[i] = float(i++); v[i = 1] += (i++, v[i]);
    b += a > 1.0 ? (a -= 1.0, a) : a > 0.5 ? b++ : --b; (v.xy = p, v.zw *= v.xy);
    for (; i < 9 && (a += 1.0) < 20.0; i++, b--) if (i > 4 || b++ < 3.0) c += b; else c--;
    v = -v * +v - -a; bool k = !(a < b) ^^ a == b != (b >= c); v.x = k ? t[0] : t[3];
    o = v * (a, b, c);
}
