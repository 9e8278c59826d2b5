//! Each warning, and what comes near to it and is not told.

use crate::diagnostic::Diagnostic;
use crate::glsl::{Options, check};
use crate::source::{File, Files};

/// The warnings about a text, as `W0005:3` with the line.
fn warned(text: &str) -> Vec<String> {
    let (found, files) = diagnostics(text);
    found
        .iter()
        .map(|told| {
            format!(
                "{}:{}",
                told.code,
                told.span.map_or(0, |span| files.position(span).line)
            )
        })
        .collect()
}

fn diagnostics(text: &str) -> (Vec<Diagnostic>, Files) {
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    let checked = check(&files, file, &Options::default());
    let checked = checked.unwrap_or_else(|errors| panic!("{text}\n{errors:#?}"));
    (checked.warnings, files)
}

/// A shader of these functions and these statements of `mainImage`; they begin on line 2.
fn shader(functions: &str, statements: &str) -> String {
    format!(
        "{}\nvoid mainImage(out vec4 c, in vec2 f) {{ c = vec4(0.0);\n{statements}\n}}\n",
        functions.replace('\n', " ")
    )
}

/// Cases line by line: the codes that are told, `-` for none, then functions, `|`, and the statements of `mainImage`.
fn cases(table: &str) {
    let mut wrong = Vec::new();
    for line in table.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (wanted, text) = line.split_once(' ').unwrap();
        let (functions, statements) = text.split_once('|').unwrap_or(("", text));
        let mut told: Vec<_> = diagnostics(&shader(functions, statements))
            .0
            .iter()
            .map(|told| told.code.to_string())
            .collect();
        told.dedup();
        let told = if told.is_empty() {
            "-".to_owned()
        } else {
            told.join(",")
        };
        if told != wanted {
            wrong.push(format!("{told} {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn randomness() {
    cases(
        "
        W0005 c.x = fract(sin(f.x) * 43758.5453);
        W0005 c.x = fract(sin(dot(f, vec2(12.9898, 78.233))) * 43758.5453);
        W0005 c.xy = fract(vec2(sin(f.x), cos(f.y)) * 4375.8);
        W0005 c.x = fract(4375.8 * -sin(f.x) + 0.5);
        W0005 float s = sin(f.x), h = s * 1e4; c.x = fract(h);
        W0005 vec2 p = f; p = sin(p) * 43758.5; c.xy = fract(p);
        W0005 c.x = mod(cos(f.x) * 1e5, 1.0);
        W0005 const float K = 43758.5; | c.x = fract(sin(f.x) * K);
        W0005 float h(float x) { return fract(sin(x) * 43758.5); } | c.x = h(f.x);
        -     float h(float x) { return fract(sin(x) * 43758.5); } |
        -     c.x = fract(sin(f.x) * 3.0);
        -     c.x = fract(f.x * 43758.5);
        -     c.x = mod(sin(f.x) * 1e5, 3.0);
        -     c.x = sin(f.x) * 43758.5;
        ",
    );
}

#[test]
fn unused_results() {
    cases(
        "
        W0010 vec3 d = vec3(f, 1.0); normalize(d);
        W0010 f.x == 1.0;
        W0010 f.x + 1.0;
        W0010 float twice(float x) { return 2.0 * x; } | twice(f.x);
        W0010 for (int i = 0; i < 3; i + 1) { if (f.x > 1.0) break; }
        -     float n; float count() { return n++; } | count(); c.x = n;
        -     float set(out float x) { x = 1.0; return x; } | float y; set(y); c.x = y;
        -     float stop(float x) { if (x < 0.0) discard; return x; } | stop(f.x);
        -     void nothing() { } | nothing();
        -     int i = 0; for (i; i < 3; i++) c.x += 1.0;
        -     c.x = 1.0, c.y = 2.0;
        ",
    );
    assert!(
        warned("#define SHOW(x) (x)\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(0.0); SHOW(f.x); }")
            .is_empty()
    );
}

#[test]
fn a_macro_used_often_is_told_once() {
    let text = "#define R(x) fract(sin(x) * 43758.5)\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(R(f.x), R(f.y), 0, 1); }";
    assert_eq!(warned(text), ["W0005:2"]);
}

#[test]
fn what_is_allowed_is_not_told() {
    let hash = "fract(sin(f.x) * 43758.5)";
    let main = |before: &str, line: &str| {
        format!("{before}void mainImage(out vec4 c, in vec2 f) {{\n{line}\nc.y = {hash};\n}}\n")
    };
    let warned = |before: &str, line: &str| warned(&main(before, line)).join(" ");
    let set = format!("c = vec4({hash});");
    assert_eq!(warned("", &set), "W0005:2 W0005:3");
    // At the end of a line, for that line.
    assert_eq!(
        warned("", &format!("{set} // toyproof: allow(W0005) it is only noise")),
        "W0005:3"
    );
    // On its own line, for the next statement, with all that is in it.
    assert_eq!(
        warned("", &format!("// toyproof: allow(W0005)\n\n// words\n{set}")),
        "W0005:6"
    );
    assert_eq!(
        warned(
            "",
            &format!("  //toyproof: allow( W0010 , W0005 )\n{{ {set}\n f.x; }}")
        ),
        "W0005:5"
    );
    // For the next declaration: here the whole function.
    assert_eq!(warned("const int N = 3;\n// toyproof: allow(W0005)\n", &set), "");
    // Before all else, for the whole file.
    assert_eq!(
        warned(
            "/* a */ // b\n\n// toyproof: allow(W0005)\nconst int N = 3;\n",
            &set
        ),
        ""
    );
    // What was not read does not count.
    assert_eq!(
        warned(
            "",
            &format!("{set}\n#if 0\n// toyproof: allow(W0005, W9)\n#endif")
        ),
        "W0005:2 W0005:6"
    );
    // Unused, unknown, not to be allowed, not understood.
    assert_eq!(
        warned("", &format!("{set}\nf; // toyproof: allow(W0010, W0005)")),
        "W0005:2 W0015:3 W0005:4"
    );
    assert_eq!(
        warned("", &format!("{set} // toyproof: allow(W1234)")),
        "W0005:2 W0014:2 W0005:3"
    );
    assert_eq!(
        warned("", &format!("{set} // toyproof: allow(E0001,)")),
        "W0005:2 W0014:2 W0014:2 W0005:3"
    );
    assert_eq!(
        warned("", &format!("{set} // toyproof: please")),
        "W0005:2 W0014:2 W0005:3"
    );
    // A macro may be allowed where it is written.
    let text = "#define R fract(sin(f.x) * 43758.5) // toyproof: allow(W0005)\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(R); }";
    assert!(super::tests::warned(text).is_empty());
    let text = "int a;\n// toyproof: allow(W0001)\n#define a__b 1\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(a__b); }";
    assert!(super::tests::warned(text).is_empty());
}

#[test]
fn equality_of_floats() {
    cases(
        "
        W0011 vec2 p = f / iResolution.xy; float b = dot(p, p), disc = b * b - 4.0; if (disc == 0.0) c.x = 1.0;
        W0011 for (float i = 0.0; i != 1.0; i += 0.1) c.x += i;
        W0011 if (length(f) == 0.3) c.x = 1.0;
        W0011 if (0.3 != f.x / iResolution.x) c.x = 1.0;
        W0011 float a = length(f), b = length(f.yx); if (a == b) c.x = 1.0;
        W0011 float half_of(float x) { return x / 3.0; } | if (half_of(f.x) == 0.3) c.x = 1.0;
        W0011 if (sin(iTime) == 0.0) c.x = 1.0;
        W0011 vec3 p = vec3(f, 1.0) * iTime + 0.1; if (p.y == 0.0) c.x = 1.0;
        W0011 if (any(notEqual(f * iTime + 0.1, vec2(1.0)))) c.x = 1.0;
        W0011 if (mod(iTime, 2.0) == 0.0) c.x = 1.0;
        -     if (iTime == 0.0) c.x = 1.0;
        -     if (mod(floor(f.x), 2.0) == 1.0) c.x = 1.0;
        -     if (mod(f.x - 0.5, 2.0) == 0.0) c.x = 1.0;
        -     for (float i = 0.0; i < 4.0; i++) { if (i == 2.0) c.x += i; }
        -     for (float i = 0.0; i != 4.0; i += 0.25) c.x += i;
        -     float t = 1e9; if (f.x > 1.0) t = length(f); if (t == 1e9) c.x = 1.0;
        -     float t = -1.0; for (int i = 0; i < 3; i++) t = min(t, f.x * 0.1); if (t != -1.0) c.x = t;
        -     float a = length(f), b = length(f - 1.0), d = min(a, b); if (d == a) c.x = 1.0;
        -     vec2 near(vec2 a, vec2 b) { return a.x < b.x ? a : b; } | vec2 h = near(vec2(length(f), 1.0), vec2(2.0)); if (h.y == 1.0) c.x = 1.0;
        -     vec2 p = f / iResolution.xy; float d = p.x - p.y; if (d == 0.0) d = 1.0; c.x = p.x / d;
        -     vec2 p = f / iResolution.xy; p = floor(p); if (p.x + p.y == 1.0) c.x = 1.0;
        -     float least(float a, float b) { return a < b ? a : b + 0.0; } | if (least(length(f), 0.3) == length(f)) c.x = 1.0;
        -     float ease(float t) { return t == 1.0 ? t : t * 2.0; } | c.x = ease(iTime * 0.1);
        -     float a = length(f), b = mix(a, 1.0, iTime); if (a == b) c.x = 1.0;
        -     vec2 p = f / iResolution.xy - 1.0; if (dot(p, p) == 0.0) c.x = 1.0;
        -     if (length(f) == 0.0) c.x = 1.0;
        -     if (max(f.x * 0.1 - 2.0, 0.0) == 0.0) c.x = 1.0;
        -     struct Hit { float t; }; | Hit h = Hit(-1.0); h.t = length(f); if (h.t == -1.0) c.x = 1.0;
        -     if (texture(iChannel0, f).x == 1.0) c.x = 1.0;
        -     if (float(int(f.x) * 3) == 9.0) c.x = 1.0;
        -     int i = int(f.x); if (i == 3) c.x = 1.0;
        ",
    );
}

#[test]
fn reads_of_what_was_not_written() {
    cases(
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
        W0003 float g; void set() { g = 1.0; } | c.x = g;
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
        -     bool find(out float t) { if (iTime > 1.0) return false; t = 1.0; return true; } | float t; if (find(t)) c.x = t;
        -     float a; for (int i = 0; i < 3; i++) a = float(i); c.x = a;
        -     int n = int(f.x); float a; for (int i = 0; i < n; i++) a = float(i); c.x = a;
        -     float a; for (int i = min(iFrame, 0); i < 3; i++) a = float(i); c.x = a;
        -     float a; bool hit = false; if (f.x > 0.0) { a = 1.0; hit = true; } if (hit) c.x = a;
        -     float a, t = 1e9; for (int i = 0; i < 3; i++) { float d = f.x * float(i); if (d < t) { t = d; a = 1.0; } } if (t < 1e9) c.x = a;
        -     float a; int id = -1; if (f.x > 0.0) { a = 1.0; id = 3; } if (id >= 0) c.x = a;
        -     float a; if (f.x > 0.0) a = 1.0; if (f.x > 0.0) c.x = a;
        -     float a; if (f.x > 0.0) a = 1.0; if (f.x <= 0.0) a = 2.0; c.x = a;
        -     float a; if (f.x > 0.0 && f.y > 0.0) a = 1.0; if (f.y > 0.0 && f.x > 0.0) c.x = a;
        -     float a; bool hit = f.x > 0.0; if (hit) a = 1.0; c.x = hit ? a : 0.0;
        -     float a; bool hit = f.x > 0.0; if (hit) a = 1.0; if (hit && a > 1.0) c.x = 1.0;
        -     float a; switch (int(f.x)) { case 1: a = 1.0; break; default: a = 2.0; } c.x = a;
        -     float a; do { a = f.x; } while (a > 1.0); c.x = a;
        -     float a; int n = 0; while (true) { a = f.x; if (n++ > 3) break; } c.x = a;
        -     struct S { float a; }; S s[2]; void make() { s[0].a = 1.0; } | make(); c.x = s[1].a;
        -     float never() { float a; return a; } |
        -     float a, least = 8.0; for (int i = 0; i < 3; i++) { float d = f.x * float(i); if (d < least) { least = d; a = 1.0; } } c.x = a;
        -     float a; int i = int(f.x); if (i == 0) a = 1.0; else if (i == 1) a = 2.0; c.x = a;
        -     float a = 1.0; c.x = a;
        -     float a; const float b = 1.0; a = b; c.x = a;
        ",
    );
    let colour =
        |body: &str| warned(&format!("void mainImage(out vec4 c, in vec2 f) {{ {body} }}")).join(" ");
    assert_eq!(colour(""), "W0003:1");
    assert_eq!(colour("if (f.x > 1.0) c = vec4(1.0);"), "W0004:1");
    assert_eq!(colour("c.rgb = vec3(1.0);"), "");
    assert_eq!(
        colour("if (f.x > 1.0) { c = vec4(1.0); return; } c.xyz = vec3(0.0);"),
        ""
    );
    assert_eq!(colour("c -= c;"), "W0003:1");
}

#[test]
fn derivatives_where_control_differs() {
    cases(
        "
        W0006 if (f.x > 9.0) c.x = fwidth(f.y);
        W0006 if (f.x > 9.0) return; c.x = dFdx(f.y);
        W0006 for (int i = 0; i < 9; i++) { c.x += dFdx(f.y); if (f.x > float(i)) break; }
        W0006 for (int i = 0; i < int(f.x); i++) c.x += dFdx(f.y);
        W0006 float w(float x) { return fwidth(x); } | if (f.x > 9.0) c.x = w(f.y);
        W0006 bool near; void find(vec2 p) { near = p.x > 1.0; } | find(f); if (near) c.x = fwidth(f.y);
        W0006 c.x = f.x > 9.0 ? fwidth(f.y) : 0.0;
        W0006 if (f.x > 9.0 && fwidth(f.y) > 0.1) c.x = 1.0;
        W0006 int n = 0; if (f.x > 1.0) n = 1; if (n == 1) c.x = fwidth(f.y);
        W0006 switch (int(f.x)) { case 1: c.x = fwidth(f.y); }
        W0006 bool hit(out float t, vec2 p) { t = p.x; return true; } | float t; hit(t, f); if (t > 1.0) c.x = fwidth(f.y);
        W0007 if (f.x > 9.0) c = texture(iChannel0, f);
        -     c.x = fwidth(f.y); if (f.x > 9.0) c.x = 1.0;
        -     if (iTime > 9.0) c.x = fwidth(f.y);
        -     if (iTime > 9.0) return; c.x = dFdx(f.y);
        -     for (int i = 0; i < 9; i++) { c.x += dFdx(f.y); if (iTime > float(i)) break; }
        -     for (int i = 0; i < 9; i++) { if (f.x > float(i)) continue; c.y = 1.0; } c.x = fwidth(f.y);
        -     for (int i = 0; i < 9; i++) { if (f.x > float(i)) break; } c.x = fwidth(f.y);
        -     if (f.x > 9.0) c = textureLod(iChannel0, f, 0.0); c += texelFetch(iChannel0, ivec2(f), 0);
        -     float twice(float x) { if (x > 1.0) return 1.0; return 2.0; } | c.x = twice(f.x) + fwidth(f.y);
        -     float kind(float x) { float y = 1.0; y += x; return y; } | if (f.x > 1.0) c.y = kind(1.0); if (kind(iTime) > 3.0) c.x = fwidth(f.y);
        -     float w(float x) { return fwidth(x); } | c.x = w(f.y);
        ",
    );
}

#[test]
fn loops() {
    cases(
        "
        W0008 for (int i = 0; i < 70000; i++) c.x += f.x;
        W0008 for (int i = 0; i < 300; i++) for (int j = 0; j < 300; j++) c.x += f.x;
        W0008 const int N = 400; | for (int i = 0; i < N; ++i) for (int j = N; j >= 0; j -= 2) c.x += f.x;
        W0008 float far(vec2 p) { float d = 0.0; for (int i = 0; i < 300; i++) d += p.x; return d; } | for (int i = min(iFrame, 0); i < 300; i++) c.x += far(f);
        W0008 for (int i = 0; i < 40000; i++) c.x += f.x; for (int i = 0; i < 40000; i++) c.x += f.x;
        W0008 for (int i = 0; i < 9; i--) c.x += f.x;
        W0008 for (float x = 0.0; x <= 100.0; x += 0.001) c.x += f.x;
        W0009 while (true) c.x += f.x;
        W0009 for (;;) { c.x += 1.0; }
        W0009 do c.x += 1.0; while (1 < 2);
        W0009 while (true) { for (int i = 0; i < 3; i++) { if (c.x > 1.0) break; } }
        W0009 while (true) { switch (int(f.x)) { case 1: break; } }
        W0009 float x = f.x; while (x < 9.0) { c.x += 1.0; }
        W0009 for (int i = 0; i < int(f.x);) { c.x += 1.0; }
        -     for (int i = 0; i < 65000; i++) c.x += f.x;
        -     for (int i = 0; i < 300; i++) { if (i < 1) continue; } for (int j = 0; j < 300; j++) c.x += f.x;
        -     if (f.x > 1.0) { for (int i = 0; i < 40000; i++) c.x += 1.0; } else { for (int i = 0; i < 40000; i++) c.x += 2.0; }
        -     int n = int(f.x); for (int i = 0; i < n; i++) for (int j = 0; j < n; j++) c.x += 1.0;
        -     while (true) { if (c.x > 1.0) break; c.x += f.x; }
        -     while (true) { if (c.x > 1.0) return; c.x += f.x; }
        -     float x = f.x; while (x < 9.0) { x += 1.0; }
        -     bool more; void next() { more = false; } | while (more) { next(); }
        -     while (false) c.x += 1.0;
        ",
    );
}

#[test]
fn directions_that_are_never_normalised() {
    let ray = "struct Ray { vec3 o, d; }; struct Ball { vec3 c; float r; };";
    let half = "float hit(Ray ray, Ball ball) { vec3 f = ray.o - ball.c; float b = dot(f, ray.d); \
                float c = dot(f, f) - ball.r * ball.r; float disc = b * b - c; return disc > 0.0 ? -b - sqrt(disc) : -1.0; }";
    let full = "float hit(Ray ray, Ball ball) { vec3 f = ray.o - ball.c; float b = 2.0 * dot(ray.d, f); \
                float c = dot(f, f) - ball.r * ball.r; float disc = b * b - 4.0 * c; return disc > 0.0 ? -b - sqrt(disc) : -1.0; }";
    let inline = "float hit(Ray ray, Ball ball) { float b = dot(ray.d, ray.o - ball.c); \
                  return b * b - dot(ray.o - ball.c, ray.o - ball.c) + ball.r * ball.r; }";
    let general = "float hit(Ray ray, Ball ball) { vec3 f = ray.o - ball.c; float a = dot(ray.d, ray.d); float b = dot(f, ray.d); \
                   float c = dot(f, f) - ball.r * ball.r; float disc = b * b - a * c; return disc > 0.0 ? (-b - sqrt(disc)) / a : -1.0; }";
    let told = |formula: &str, direction: &str| {
        let paint = format!("c.x = hit(Ray(vec3(0), {direction}), Ball(vec3(0, 0, -6), 1.5));");
        warned(&shader(&format!("{ray} {formula}"), &paint)).join(" ")
    };
    for formula in [half, full, inline] {
        for direction in [
            "vec3(f / iResolution.xy - 0.5, -2.0)",
            "mat3(2.0) * vec3(f, -2.0)",
            "-vec3(f.x, f.y, 1.0)",
            "f.x * normalize(vec3(1, 2, 3)) + f.y * vec3(0, 1, 0)",
            "iMouse.x > 1.0 ? vec3(f, 1) : vec3(f, 2)",
        ] {
            assert_eq!(told(formula, direction), "W0012:1", "{formula} {direction}");
        }
        for direction in [
            "normalize(vec3(f, -2.0))",
            "vec3(0.0, 0.0, -1.0)",
            "vec3(f, -2.0) / length(vec3(f, -2.0))",
            "vec3(sin(f.x), 0.0, cos(f.x))",
            "iMouse.x > 1.0 ? normalize(vec3(f, 1)) : vec3(f, 2)",
            "reflect(normalize(vec3(f, -2.0)), vec3(0, 1, 0))",
        ] {
            assert_eq!(told(formula, direction), "", "{formula} {direction}");
        }
    }
    assert_eq!(told(general, "vec3(f, -2.0)"), "");
    // Normalised on one of two ways into the structure.
    let paint =
        "Ray r = Ray(vec3(0), vec3(f, -2)); r.d = normalize(r.d); c.x = hit(r, Ball(vec3(0, 0, -6), 1.5));";
    assert!(warned(&shader(&format!("{ray} {half}"), paint)).is_empty());
    let paint = "vec3 d = vec3(f, -2); d.xy *= mat2(0, 1, -1, 0); d /= length(d); c.x = hit(Ray(vec3(0), d), Ball(vec3(0, 0, -6), 1.5));";
    assert!(warned(&shader(&format!("{ray} {half}"), paint)).is_empty());
    // Quaternions, and what else looks like it.
    assert!(
        warned(&shader(
            "",
            "vec4 q = vec4(f, f); c.x = q.x * q.x - q.y * q.y - dot(f, f);"
        ))
        .is_empty()
    );
}

/// The message of the only warning.
fn message(functions: &str, statements: &str) -> String {
    let (found, _) = diagnostics(&shader(functions, statements));
    assert_eq!(found.len(), 1, "{found:#?}");
    found[0].message.clone()
}

#[test]
fn the_way_to_a_read_is_told() {
    assert_eq!(
        message("", "float pdf;\nif (f.x > 0.) pdf = 1.0;\nc.x = pdf;"),
        "`pdf` is read here but never written when `f.x > 0.` is false (line 4)"
    );
    assert_eq!(
        message("", "vec3 v; v.x = 1.0;\nif (f.x > 0.) v.yz = f;\nc.xyz = v;"),
        "`v.yz` is read here but never written when `f.x > 0.` is false (line 4)"
    );
    assert_eq!(
        message(
            "",
            "float a; float b = 1.0;\nif (f.x > 0.) a = b;\nif (f.y > 3.) b = 2.0;\nif (f.y > 0.) a = b;\nc.x = a;"
        ),
        "`a` is read here but never written when `f.x > 0.` is false (line 4) and `f.y > 0.` is false (line 6)"
    );
    assert_eq!(
        message("struct Ray { vec3 o, d; };", "Ray r; c.xyz = r.d;"),
        "`r.d` is read here before it is written"
    );
}

#[test]
fn analyses_are_linear_in_the_size_of_a_shader() {
    let lines = |line: fn(usize) -> String| (0..5_000).map(line).collect::<String>();
    let texts = [
        lines(|i| format!("float a{i}; if (f.x > {i}.0) a{i} = 1.0; c.x += a{i};\n")),
        lines(|i| format!("float a{i};\n"))
            + &lines(|i| format!("if (f.x > {i}.0) a{i} = 1.0;\n"))
            + &lines(|i| format!("c.x += a{i};\n")),
        "float a; if (f.x < 1.0) a = 2.0;".to_owned()
            + &" else if (f.x == c.y * 0.1) a = 2.0;".repeat(5_000)
            + "c.x = a;",
        format!("float a; c.x = {} a;", "f.x + ".repeat(20_000)),
        format!(
            "float a; c.x = float({} a > 1.0);",
            "f.x > 1.0 || ".repeat(20_000)
        ),
        lines(|i| format!("for (int i = 0; i < {i}; i++) {{ if (f.x == 0.1 * c.y) break; }}\n")),
    ];
    for text in texts {
        let start = std::time::Instant::now();
        let builder = std::thread::Builder::new().stack_size(2 << 20);
        let told = std::thread::scope(|scope| {
            let text = shader("", &text);
            builder
                .spawn_scoped(scope, move || warned(&text).len())
                .unwrap()
                .join()
                .unwrap()
        });
        assert!(
            told <= 50 && start.elapsed().as_secs() < 20,
            "{:?} {}",
            start.elapsed(),
            &text[..60]
        );
    }
}

#[test]
fn the_course_has_nothing_to_be_warned_of() {
    let mut told = Vec::new();
    for entry in std::fs::read_dir("glsl").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "glsl") {
            let (found, files) = diagnostics(&std::fs::read_to_string(&path).unwrap());
            let lines = found.iter().map(|found| crate::diagnostic::short(found, &files));
            told.extend(lines.map(|line| format!("{}: {line}", path.display())));
        }
    }
    assert!(told.is_empty(), "{}", told.join("\n"));
}
