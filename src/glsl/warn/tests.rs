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
