//! The lowered text: what the printer does by itself, and the way back to the author.

use super::*;

#[test]
fn what_never_leaves_the_printer_is_still_wrong_with_naga() {
    let around = |before: &str, body: &str| {
        format!(
            "#version 450 core\nlayout(location = 0) out vec4 o;\n{before}\nvoid main() {{ o = vec4(0.0); {body} }}"
        )
    };
    for (before, body) in [
        ("float f(const in float a) { return a; }", "o.x = f(1.0);"),
        ("", "float a[] = float[](1.0, 2.0); o.x = a[1];"),
        ("", "const int N = 3; float a[N]; o.x = a[1];"),
        ("precision highp sampler2D;", ""),
        ("float f(highp float x) { return x; }", "o.x = f(1.0);"),
        ("", "float a[2], b; b = 1.0; o.x = b;"),
        (
            "float f(float); float g(float x) { return x; } float h(float x) { return f(x); } float f(float x) { return g(x); }",
            "o.x = h(o.y);",
        ),
        ("struct ray { float x; };", "ray ray; ray.x = 1.0; o.x = ray.x;"),
        ("", "float sample = 1.0; o.x = sample;"),
        ("float f(float) { return 1.0; }", "o.x = f(2.0);"),
        ("uniform float x;", "o.x = x;"),
        ("", "for (int i = 0; float(i) < 2.0; i++) o.x += 1.0;"),
    ] {
        let text = around(before, body);
        assert!(naga(&text).is_err(), "naga is mended:\n{text}");
    }
    let text = around("", "float a[2][3]; o.x = a[1][2];");
    assert!(
        naga(&text).is_err_and(|error| !error.is_empty())
            || naga(&text).is_ok_and(|wgsl| wgsl.contains("array<array<f32, 2>, 3>"))
    );
}

#[test]
fn the_printer_avoids_what_naga_gets_wrong() {
    let before = "struct ray { float x; };
const int N = 3;
float g(float x);
float f(const in float a, float) { return a + g(a); }
float g(float x) { return x; }
float buffer(float shared) { return shared; }";
    let body = "struct Local { float x; } local; o.y = local.x; for (int i = 0; float(i) < 2.0; i++) o.x += 1.0;
float a[] = float[](1.0, 2.0); float b[N], c; ray ray; ray.x = f(1.0, 2.0); c = ray.x; b[0] = c;
float d[2][3]; d[1][2] = 1.0; float buffer = buffer(d[1][2]); lowp float e = - -buffer; o = vec4(a[1], b[0], e, d[int(p.x)][int(p.y)]);";
    let lowered = accepted(&checked(&main_image(before, body), true));
    assert!(lowered.contains("float[3][2] d;"), "{lowered}");
    assert!(naga(&lowered).is_ok_and(|wgsl| wgsl.contains("array<array<f32, 3>, 2>")));
    assert!(
        lowered.contains("ray ray_1;") && !lowered.contains("--"),
        "{lowered}"
    );
}

#[test]
fn long_chains() {
    let sum = "p.x + ".repeat(5_000);
    let both = "f(p.x) && ".repeat(2_000);
    let text = main_image(
        "bool f(float x) { return x > 0.0; }",
        &format!("o.x = {sum} 1.0; if ({both} true) o.y = 1.0;"),
    );
    accepted(&checked(&text, false));
}

#[test]
fn words_of_the_lowered_text_lead_back_to_the_author() {
    let text = main_image(
        "float twice(float x) { return 2.0 * x; }",
        "o.x = p.x > 0.5 && twice(p.y) > 0.25 ? 1.0 : 0.0;",
    );
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let checked = check(&files, file, &toyproof_glsl::Options::default()).expect("valid");
    let lowered = crate::lower(&checked);
    for words in ["twice(p.y)", "0.25", "2.0 * x"] {
        let at = position(lowered.text(), words);
        let span = lowered.origin(at..at + words.len()).expect("the author's");
        assert_eq!(files.text(span), words);
    }
    assert_eq!(lowered.origin(0..10), None);
}

/// Most of what passes rewrite, at once and within each other.
const EVERYTHING: &str = "
struct In { mat2 m; float t[2]; };
struct S { In i; vec3 v; };
float f(inout float x, out float y, vec2 z) { y = x; x += z.x; return y; }
float g(sampler2D s, vec2 p, inout S a) { a.i.t[int(p.x)] += 1.0 > p.y ? 1.0 : 2.0; return texture(s, p).x; }
void test(S a, S b, int i, float x[3]) {
    float y, z = 1. / 0.;
    mat3 m = mat3(1.);
    m[i++].zy[i] = f(x[i++], a.v.x, vec2(1.)) + f(a.i.t[i], x[i--], vec2(f(y, z, vec2(i))));
    if (a == b && f(y, x[0], vec2(z)) > 0. || any(isnan(a.v))) a.i.m *= mat2(vec4(y));
    else if (f(m[1].x, y, vec2(1.)) < g(iChannel1, vec2(i, y), b)) b.i = In(mat2(1.), float[](y, y++));
    for (int k = 0, n = i; f(y, y, vec2(1.)) < 3.; k++, f(x[k], z, vec2(1.))) { S c; if (k > 3) continue; b = c; }
    switch (i++) { case 1: float q = y; case 2: q = z; default: { i = -i % 3; break; } case 4: return; }
    do { if (modf(y, x[i]) > 0.) continue; } while ((y -= 1., f(y, z, vec2(1.))) > 0.);
}
";

#[test]
fn every_lowered_expression_has_one_parent() {
    use toyproof_glsl::tree::{ExprKind, Type};
    let body = "S a, b; float x[3]; test(a, b, int(p.x), x); o.x = g(iChannel0, p, a) + g(iChannel1, p, b);";
    let checked = checked(&main_image(EVERYTHING, body), false);
    accepted(&checked);
    let mut draft = crate::lower::draft::Draft::new(checked.tree, checked.main_image);
    Passes::all()
        .run(&mut draft, &toyproof_diagnostic::Deadline::default())
        .unwrap();
    let mut seen = std::collections::HashSet::new();
    for (_, function) in draft.tree.functions.iter() {
        let roots = function
            .body
            .iter()
            .flat_map(|body| toyproof_glsl::tree::walk::roots(&draft.tree, body));
        for id in roots.flat_map(|root| draft.tree.postorder(root)) {
            assert!(seen.insert(id), "{:?} twice", draft.tree[id]);
            assert_ne!(draft.tree[id].ty, Type::Error);
            if let ExprKind::Assign {
                op: None,
                target,
                value,
            } = draft.tree[id].kind
            {
                assert_eq!(draft.tree[target].ty, draft.tree[value].ty);
            }
        }
    }
}
