int walk(int n) {
    int s = 0, i = 0;
    for (int j = 0, k = 5; j < k; j++, k--) { if (j == 1) continue; if (s > 40) break; s += j * k; }
    while (i < n) { i++; if ((i & 1) == 0) continue; s ^= i; }
    do { s--; if (s == 3) return s; } while (s > 9);
    switch (s % 4) { case 0: case 1: s = 7; break; case 2: s += 1; default: s <<= 1; }
    for (;;) { if (++s > 20) break; }
    while (bool more = s < 30) { s += more ? 3 : 0; }
    return s;
}
void mainImage(out vec4 o, in vec2 p) {
    if (p.x < 1.0) discard; else if (p.y < 1.0) { o = vec4(0); return; } else o.x = 1.0;
    o = vec4(walk(int(p.x)), walk(int(p.y)), 0, 1);
}
