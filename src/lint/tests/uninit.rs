//! Uninitialized reads, and functions that end without a `return`.

use super::*;

#[test]
fn uninitialized_reads() {
    check_cases(
        "
        W0003 float a; c.x = a;
        W0003 vec3 sum; for (int i = 0; i < 3; i++) sum += vec3(f, i);  c.xyz = sum;
        W0003 vec3 v; v.x = 1.0; c.x = v.y;
        W0003 vec3 v; v.xy = f; c.xyz = v;
        W0003 struct Ray { vec3 o, d; }; | Ray r; r.o = vec3(0); c.xyz = r.d;
        W0003 struct Ray { vec3 o, d; }; vec3 at(Ray r) { return r.o + r.d; } | Ray r; c.xyz = at(r);
        W0003 mat2 m; m[0] = f; c.xy = m[1];
        W0003 float a[2]; c.x = a[1];
        W0003 void add(out float x) { x += 1.0; } | add(c.x);
        W0003 void add(inout float x) { x += 1.0; } | float a; add(a); c.x = a;
        W0003 float a; if (a > 0.0) c.x = 1.0;
        W0003 struct S { float a; }; S s[2]; | c.x = s[0].a;
        W0022,W0003 float g; void set() { g = 1.0; } | c.x = g;
        W0003 struct S { float a, b; }; S s; | s.a = 1.0; c.x = s.b;
        W0003 float a; for (int i = 0; i < 3; i++) { a += f.x; } a = 2.0; c.x = a;
        W0003 float a; if (f.x > 0.0) c.x = a; else a = 1.0;
        W0004 float pdf; if (f.x > 0.0) pdf = 1.0; c.x = pdf;
        W0004 float a; if (f.x > 0.0) a = 1.0; else if (f.x > -1.0) a = 2.0; c.x = a;
        W0004 float a; for (int i = 0; i < 3; i++) { if (f.x > float(i)) { a = 1.0; break; } } c.x = a;
        W0004 float a; for (int i = 0; i < 3; i++) { if (f.x > float(i)) continue; a = 1.0; } c.x = a;
        W0004 float a; switch (int(f.x)) { case 1: a = 1.0; break; case 2: a = 2.0; } c.x = a;
        W0004 float a; bool b = f.x > 0.0 && (a = 1.0) > 0.5; c.x = a;
        W0004 float a; f.x > 0.0 ? a = 1.0 : 0.0; c.x = a;
        W0004 float a; bool hit = false; if (f.x > 0.0) { a = 1.0; hit = true; } if (!hit) c.x = a;
        W0004 float a; if (f.x > 0.0) a = 1.0; if (f.y > 0.0) c.x = a;
        W0004 bool p = f.x > 1.0, q = f.y > 1.0; float a; if (p && q) a = 1.0; else if (p && !q) a = 2.0; else if (!p && q) a = 3.0; c.x = a;
        W0004 float a, b, t = f.x; if (f.y > 0.0) { a = 1.0; t = 9.0; } if (min(t, f.y) < f.x) c.x = a;
        W0004 vec4 find(vec2 p) { vec2 n; float t = -1.0; for (int i = 0; i < 9; i++) { if (p.x < t) { n = p; break; } t += 1.0; } return vec4(t, n, 0); } | c = find(f);
        W0004 float far; void set() { far = 9.0; } | far = f.y; float a; if (f.x < far) a = 1.0; set(); if (f.x < far) c.x = a;
        -     float a; a = 1.0; c.x = a;
        -     float a; if (f.x > 0.0) a = 1.0; else a = 2.0; c.x = a;
        -     float a; if (f.x > 0.0) { a = 1.0; } else { return; } c.x = a;
        -     vec3 v; v.xy = f; v.z = 1.0; c.xyz = v;
        -     vec3 v; v.xy = f; c.x = v.x;
        -     vec3 v; for (int i = 0; i < 3; i++) v[i] = f.x; c.xyz = v;
        -     float flat_of(vec3 v) { return v.x; } | vec3 v; v.x = f.x; c.x = flat_of(v);
        -     struct Ray { vec3 o, d; float t; }; vec3 at(Ray r) { return r.o + r.d; } | Ray r; r.o = vec3(0); r.d = vec3(1); c.xyz = at(r);
        -     struct Ray { vec3 o, d; float t; }; | Ray r, s; r.o = vec3(0); s = r; c.xyz = s.o;
        -     float a[2]; for (int i = 0; i < 2; i++) a[i] = 1.0; c.x = a[1];
        -     void set(out float x) { x = 1.0; } | float a; set(a); c.x = a;
        -     void set(inout vec3 v) { v = vec3(1); v += 1.0; } | vec3 v; set(v); c.xyz = v;
        W0004 bool find(out float t) { if (iTime > 1.0) return false; t = 1.0; return true; } | float t; if (find(t)) c.x = t;
        -     float a; for (int i = 0; i < 3; i++) a = float(i); c.x = a;
        -     int n = int(f.x); float a; for (int i = 0; i < n; i++) a = float(i); c.x = a;
        -     float a; for (int i = min(iFrame, 0); i < 3; i++) a = float(i); c.x = a;
        W0004 float a; bool hit = false; if (f.x > 0.0) { a = 1.0; hit = true; } if (hit) c.x = a;
        W0004 float a, t = 1e9; for (int i = 0; i < 3; i++) { float d = f.x * float(i); if (d < t) { t = d; a = 1.0; } } if (t < 1e9) c.x = a;
        W0004 float a; int id = -1; if (f.x > 0.0) { a = 1.0; id = 3; } if (id >= 0) c.x = a;
        W0004 float a; if (f.x > 0.0) a = 1.0; if (f.x > 0.0) c.x = a;
        W0004 float a; if (f.x > 0.0) a = 1.0; if (f.x <= 0.0) a = 2.0; c.x = a;
        W0004 float a; if (f.x > 0.0 && f.y > 0.0) a = 1.0; if (f.y > 0.0 && f.x > 0.0) c.x = a;
        W0004 float a; bool hit = f.x > 0.0; if (hit) a = 1.0; c.x = hit ? a : 0.0;
        W0004 float a; bool hit = f.x > 0.0; if (hit) a = 1.0; if (hit && a > 1.0) c.x = 1.0;
        -     float a; switch (int(f.x)) { case 1: a = 1.0; break; default: a = 2.0; } c.x = a;
        -     float a; do { a = f.x; } while (a > 1.0); c.x = a;
        -     float a; int n = 0; while (true) { a = f.x; if (n++ > 3) break; } c.x = a;
        -     struct S { float a; }; S s[2]; void make() { s[0].a = 1.0; } | make(); c.x = s[1].a;
        ",
    );
}

#[test]
fn reads_that_flags_and_calls_guard() {
    check_cases(
        "
        W0022 float never() { float a; return a; } |
        W0004 float a, least = 8.0; for (int i = 0; i < 3; i++) { float d = f.x * float(i); if (d < least) { least = d; a = 1.0; } } c.x = a;
        W0004 float a; int i = int(f.x); if (i == 0) a = 1.0; else if (i == 1) a = 2.0; c.x = a;
        W0004 float a, far = f.y, t = far, s = f.x; if (f.y > 0.0) { a = 1.0; t = 9.0; } if (min(t, s) < far) { if (t < s) c.x = a; }
        W0004 float a, s = f.x, t = f.y; if (min(s, t) < 9.0) { if (s < t) a = 1.0; else if (t < 9.0) a = 2.0; c.x = a; }
        W0004 vec3 s; float h = f.x; if (f.y > 0.0) s = vec3(f, 1.0); else s.y = h; if (abs(s.y) < h) c.x = s.x;
        W0004 float far; void nothing() { } | far = f.y; float a; if (f.x < far) a = 1.0; nothing(); if (f.x < far) c.x = a;
        W0004 vec4 find(vec2 p) { vec2 n; float t = -1.0; if (p.x > 0.0) { n = p; t = 1.0; } return vec4(t, n, 0); } | c = find(f);
        W0004 float at[3]; | float a; for (int i = 0; i < 2; i++) if (f.x >= at[i] && f.x < at[i + 1]) { a = 1.0; break; } c.x = a; at[0] = 1.0;
        W0004 vec3 v; for (int i = 0; i < 2; i++) { if (i == 0) v.xy = f; if (i == 1) v.z = 1.0; } c.xyz = v;
        W0004 float a, id = f.x; if (id < 1.5) a = 1.0; else if (id < 2.5) a = 2.0; c.x = a;
        W0004 | float a; int i = int(f.x); if (i == 0 || i == 2) a = 1.0; else if (i == 1) a = 2.0; c.x = a;
        -     float a; switch (int(f.x)) { case 0: a = 1.0; break; case 1: a = 2.0; break; case 2: a = 3.0; } c.x = a;
        W0004 float a; bool found = false; for (int i = 0; i < 9; i++) { if (f.x > float(i)) { found = true; a = 1.0; } } if (found) c.x = a;
        -     float a; for (int i = 0; i++ < 9 && f.x > float(i);) a = 1.0; c.x = a;
        W0004 bool hit(float x, out float t) { t = x; return x > 1.0; } | float t; if (f.x > 0.0 && hit(f.y, t) && t > 1.0) c.x = 1.0;
        W0004 | bool p = f.x > 1.0, q = f.y > 1.0; if (p || q) { float a; if (p && q) a = 1.0; else if (p && !q) a = 2.0; else if (!p && q) a = 3.0; c.x = a; }
        W0003 struct Hit { bool ok; float t; vec3 n; }; | Hit h; h.ok = f.x > 1.0; if (h.ok) h.t = f.x; if (h.ok) c.xyz = h.n;
        W0003 struct Hit { bool ok; float t; vec3 n; }; | Hit h; h.ok = f.x > 1.0; if (!h.ok) { c.x = h.t; return; } h.t = f.x; c.x = h.t;
        W0003 struct Hit { float t; vec3 n; }; void meet(vec2 p, inout Hit h) { if (p.x < h.t) { h.t = p.x; h.n = vec3(1); } } | Hit h; meet(f, h); c.xyz = h.n;
        -     struct Hit { bool ok; float t; vec3 n; }; Hit find(vec2 p) { Hit h; h.ok = false; if (p.x > 1.0) { h.ok = true; h.t = p.x; h.n = vec3(1); } return h; } | Hit h = find(f); if (h.ok) c.xyz = h.n * h.t;
        W0004 struct Hit { float t; vec3 n; }; void meet(vec2 p, inout Hit h) { if (p.x < h.t) { h.t = p.x; h.n = vec3(1); } } | Hit h; h.t = 9.0; meet(f, h); if (h.t < 9.0) c.xyz = h.n;
        W0003 void nothing(out float x) { } | float a; nothing(a); c.x = a;
        W0003 void some(out vec3 v) { v.xy = vec2(1); } | vec3 v; some(v); c.xyz = v;
        W0003 bool find(out float t) { return t > 1.0; } | float t; find(t); c.x = 1.0;
        W0003 float a; switch (int(f.x)) { case 1: c.x = a; break; default: a = 1.0; } c.y = a;
        W0003 float a; switch (int(f.x)) { case 1: break; default: c.x = a; }
        -     float a; switch (int(f.x)) { case 1: case 2: a = 1.0; break; default: return; } c.x = a;
        -     float a; switch (int(f.x)) { default: a = 2.0; case 1: a = 1.0; } c.x = a;
        W0004 float a; switch (int(f.x)) { case 0: a = 2.0; case 1: c.x = a; break; default: break; }
        W0003 float a; for (int i = 0; i < 3; i++) { if (f.x > float(i)) a += 1.0; } c.x = a;
        W0003 float a; for (int i = 0; i < 3; i++) { for (int j = 0; j < 3; j++) { if (f.x > 2.0) continue; a += 1.0; } }
        W0003 float a; for (int i = 0; i < 3; i++) { if (f.x > a) break; } a = 1.0;
        W0003 float least; for (int i = 0; i < 3; i++) { float d = f.x * float(i); if (d < least) least = d; } c.x = least;
        W0003 float a; while (a < 9.0) a += f.x; c.x = a;
        W0003 float a; do { a += f.x; } while (a < 9.0);
        W0003 for (int i = 0; i < 3; i++) { float a; if (i > 0) c.x = a; a = 1.0; }
        W0003 float a; if (f.x > 1.0) return; c.x = a;
        W0003 const bool ON = false; | float a; if (ON) a = 1.0; c.x = ON ? 1.0 : a;
        W0004 float last; for (int i = 0; i < 3; i++) { if (i > 0) c.x += last; last = f.x * float(i); }
        W0004 float least; bool any = false; for (int i = 0; i < 3; i++) { if (!any || f.x < least) { least = f.x; any = true; } } c.x = least;
        W0004 float a; for (int i = 0; i < 3; i++) { for (int j = 0; j < 3; j++) { if (i > j) { c.x = a; continue; } if (i == j) a = 1.0; } }
        -     const bool ON = false; | float a; if (ON) c.x = a;
        -     float a; if (f.x > 1.0) { discard; } else { a = 1.0; } c.x = a;
        -     float a; while (true) { if (f.x > 1.0) { a = 1.0; break; } return; } c.x = a;
                -     float a = 1.0; c.x = a;
        -     float a; const float b = 1.0; a = b; c.x = a;
        ",
    );
    let color = |body: &str| warned(&format!("void mainImage(out vec4 c, in vec2 f) {{ {body} }}")).join(" ");
    assert_eq!(color(""), "W0003:1");
    assert_eq!(color("if (f.x > 1.0) c = vec4(1.0);"), "");
    assert_eq!(color("if (f.x > 1.0) return;"), "W0003:1");
    assert_eq!(color("c.rgb = vec3(1.0);"), "");
    assert_eq!(
        color("if (f.x > 1.0) { c = vec4(1.0); return; } c.xyz = vec3(0.0);"),
        ""
    );
    assert_eq!(color("c -= c;"), "W0003:1");
    // The image's alpha is always 1, whatever is written.
    assert_eq!(color("float t; if (f.x > 1.0) t = 1.0; c = vec4(f, f.x, t);"), "");
}

#[test]
fn functions_without_final_return() {
    check_cases(
        "
        W0016 float pick(float x) { if (x > 1.0) return 2.0; } | c.x = pick(f.x);
        W0016 float march(float x) { for (int i = 0; i < 9; i++) { if (x > float(i)) return x; } } | c.x = march(f.x);
        W0016 float pick(int i) { switch (i) { case 0: return 1.0; case 1: break; default: return 2.0; } } | c.x = pick(int(f.x));
        W0016 float pick(float x) { if (x > 1.0) { if (x > 2.0) return 2.0; } else return 1.0; } | c.x = pick(f.x);
        -     float pick(float x) { if (x > 1.0) return 2.0; return 1.0; } | c.x = pick(f.x);
        -     float pick(float x) { if (x > 1.0) return 2.0; else return 1.0; } | c.x = pick(f.x);
        -     float pick(float x) { if (x > 1.0) return 2.0; if (x <= 1.0) return 1.0; } | c.x = pick(f.x);
        -     float pick(float x) { if (x == 1.5) return 2.0; else if (x < 1.5) return 1.0; else if (x > 1.5) return 0.0; } | c.x = pick(floor(f.x));
        -     float pick(int i) { if (i == 0) return 2.0; if (i == 1) return 1.0; } | c.x = pick(int(f.x));
        -     float pick(int i) { switch (i) { case 0: return 1.0; default: return 2.0; } } | c.x = pick(int(f.x));
        -     float march(float x) { while (true) { if (x > 9.0) return x; x += 1.0; } } | c.x = march(f.x);
        -     float march(float x) { for (;;) { if (x > 9.0) return x; x += 1.0; } } | c.x = march(f.x);
        -     float pick(float x) { if (x > 1.0) return 2.0; discard; } | c.x = pick(f.x);
        W0022 float pick(float x) { if (x > 1.0) return 2.0; } |
        ",
    );
    assert_eq!(
        message(
            "float pick(float x) { if (x > 1.0) return 2.0; }",
            "c.x = pick(f.x);"
        ),
        "`pick` may reach its end without a `return`"
    );
}

#[test]
fn messages_name_the_unassigned_parts() {
    assert_eq!(
        message("struct Ray { vec3 o, d; };", "Ray r; c.xyz = r.d;"),
        "`r.d` is used uninitialized"
    );
    assert_eq!(
        message("", "vec3 v; v.x = 1.0; c.xyz = v;"),
        "`v.yz` is used uninitialized"
    );
}

#[test]
fn maybe_uninitialized_reads_wait_for_a_run() {
    let text = shader(
        "",
        "float pdf;\nif (f.x > 0.) pdf = 1.0;\nif (f.y > 0.) c.x = pdf; else c.y = pdf;",
    );
    let (lints, files) = lints(&text);
    assert!(lints.warnings.is_empty(), "{:#?}", lints.warnings);
    let [pdf] = &lints.maybe_uninitialized[..] else {
        panic!("{:#?}", lints.maybe_uninitialized);
    };
    assert_eq!(pdf.message, "`pdf` may be used uninitialized");
    assert_eq!(files.position(pdf.span.unwrap()).line, 5);
    let related: Vec<_> = pdf
        .related
        .iter()
        .map(|(span, label)| (files.position(*span).line, &**label))
        .collect();
    assert_eq!(
        related,
        [(3, "declared here without an initializer"), (5, "also here")]
    );
}
