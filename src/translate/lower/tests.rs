//! Tests of the passes: naga refuses or miscompiles each shader without the pass, and accepts it with the
//! pass.

use std::panic::catch_unwind;

use naga::back::{spv, wgsl};
use naga::front::glsl::{Frontend, Options};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use toyproof_diagnostic::{File, Files};
use toyproof_glsl::{Checked, check};

use super::{Pass, Passes, lower_with};

pub(super) fn checked(text: &str, lenient: bool) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let options = toyproof_glsl::Options {
        lenient,
        ..Default::default()
    };
    check(&files, file, &options).unwrap_or_else(|diagnostics| {
        panic!("{}\n{text}", toyproof_diagnostic::short(&diagnostics[0], &files))
    })
}

/// Returns naga's WGSL for a GLSL text that it can also write as SPIR-V, or its error.
fn naga(text: &str) -> Result<String, String> {
    let text = text.to_owned();
    catch_unwind(move || {
        let options = Options::from(naga::ShaderStage::Fragment);
        let mut module = Frontend::default()
            .parse(&options, &text)
            .map_err(|error| error.emit_to_string(&text))?;
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        let info = Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .map_err(|error| error.emit_to_string(&text))?;
        spv::write_vec(&module, &info, &spv::Options::default(), None).map_err(|error| error.to_string())?;
        wgsl::write_string(&module, &info, wgsl::WriterFlags::empty()).map_err(|error| error.to_string())
    })
    .unwrap_or_else(|_| Err("panic".to_owned()))
}

/// Asserts that naga refuses the shader without the pass and accepts it with the pass. Returns the lowered
/// text.
pub(super) fn fixes_rejection(pass: Pass, text: &str) -> String {
    let checked = checked(text, true);
    let without = lower_with(&checked, Passes::required().without(pass));
    assert!(
        naga(without.text()).is_err(),
        "naga is fixed; {pass:?} can be removed:\n{}",
        without.text()
    );
    accepted(&checked)
}

/// Asserts that naga accepts the shader either way, and that `wrong` holds for its WGSL only without the
/// pass.
pub(super) fn fixes_miscompilation(pass: Pass, text: &str, wrong: impl Fn(&str) -> bool) -> String {
    let checked = checked(text, true);
    let without = lower_with(&checked, Passes::required().without(pass));
    let wgsl = naga(without.text()).unwrap_or_else(|error| panic!("{error}\n{}", without.text()));
    assert!(
        wrong(&wgsl),
        "naga is fixed; {pass:?} can be removed:\n{}\n{wgsl}",
        without.text()
    );
    let lowered = lower_with(&checked, Passes::required());
    let wgsl = naga(lowered.text()).unwrap_or_else(|error| panic!("{error}\n{}", lowered.text()));
    assert!(!wrong(&wgsl), "{}\n{wgsl}", lowered.text());
    lowered.text().to_owned()
}

pub(super) fn accepted(checked: &Checked) -> String {
    let lowered = lower_with(checked, Passes::required());
    if let Err(error) = naga(lowered.text()) {
        panic!("{error}\n{}", lowered.text());
    }
    lowered.text().to_owned()
}

/// A shader with the given `mainImage`.
pub(super) fn main_image(before: &str, body: &str) -> String {
    format!("{before}\nvoid mainImage(out vec4 o, in vec2 p) {{\n    o = vec4(0.0);\n    {body}\n}}\n")
}

/// The lowered lines of the author's functions.
pub(super) fn lines(before: &str, body: &str) -> String {
    let text = accepted(&checked(&main_image(before, body), true));
    let begin = text.find("void mainImage").unwrap_or(0);
    let end = text.find("void main()").unwrap_or(text.len());
    let lines = text[begin..end].lines().map(str::trim);
    lines
        .filter(|line| !matches!(*line, "" | "}" | "o = vec4(0.0);") && !line.contains("mainImage"))
        .collect::<Vec<_>>()
        .join("\n")
}

pub(super) fn position(text: &str, needle: &str) -> usize {
    text.find(needle)
        .unwrap_or_else(|| panic!("{needle} is not in\n{text}"))
}

// Tests of the printed text: constructs that the printer avoids, and the mapping back to the source.

#[test]
fn naga_still_refuses_constructs_that_the_printer_avoids() {
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
        assert!(naga(&text).is_err(), "naga is fixed:\n{text}");
    }
    let text = around("", "float a[2][3]; o.x = a[1][2];");
    assert!(
        naga(&text).is_err_and(|error| !error.is_empty())
            || naga(&text).is_ok_and(|wgsl| wgsl.contains("array<array<f32, 2>, 3>"))
    );
}

#[test]
fn the_printer_avoids_constructs_that_naga_refuses() {
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
fn lowered_text_maps_to_source_spans() {
    let text = main_image(
        "float twice(float x) { return 2.0 * x; }",
        "o.x = p.x > 0.5 && twice(p.y) > 0.25 ? 1.0 : 0.0;",
    );
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let checked = check(&files, file, &toyproof_glsl::Options::default()).expect("valid");
    let lowered = crate::lower(&checked);
    for token in ["twice(p.y)", "0.25", "2.0 * x"] {
        let at = position(lowered.text(), token);
        let span = lowered.origin(at..at + token.len()).expect("the author's");
        assert_eq!(files.text(span), token);
    }
    assert_eq!(lowered.origin(0..10), None);
}

/// Most constructs that passes rewrite, combined and nested.
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
    let mut cx = crate::lower::context::LoweringContext::new(&checked);
    Passes::required()
        .run(&mut cx, &toyproof_diagnostic::Deadline::default())
        .unwrap();
    let mut seen = std::collections::HashSet::new();
    for (_, function) in cx.tree.functions.iter() {
        let roots = function
            .body
            .iter()
            .flat_map(|body| toyproof_glsl::tree::walk::roots(&cx.tree, body));
        for id in roots.flat_map(|root| cx.tree.postorder(root)) {
            assert!(seen.insert(id), "{:?} twice", cx.tree[id]);
            assert_ne!(cx.tree[id].ty, Type::Error);
            if let ExprKind::Assign {
                op: None,
                target,
                value,
            } = cx.tree[id].kind
            {
                assert_eq!(cx.tree[target].ty, cx.tree[value].ty);
            }
        }
    }
}

// Tests of the passes that rewrite statements and declarations.

#[test]
fn global_initializers() {
    fixes_rejection(
        Pass::Globals,
        &main_image("const uint A = packSnorm2x16(vec2(0.5));", "o.x = float(A);"),
    );
    fixes_rejection(
        Pass::Globals,
        &main_image("const float A = true ? 1.0 : 2.0;", "o.x = A;"),
    );
    let text = main_image("float T = iTime * 2.0;", "o.x = T;");
    let dropped = |wgsl: &str| !wgsl.contains("* 2f");
    let lowered = fixes_miscompilation(Pass::Globals, &text, dropped);
    assert!(
        lowered.contains("void toyproof_start() {\n    T = iTime * 2.0;\n}"),
        "{lowered}"
    );
    let text = main_image("const float A[3] = float[](1.0, 2.0, 3.0);", "o.x = A[int(p.x)];");
    fixes_miscompilation(Pass::Globals, &text, |wgsl| !wgsl.contains("var<private> A"));
    let text = main_image(
        "",
        "vec3 c[2] = vec3[](vec3(1.0), vec3(2.0)); o.xyz = c[int(p.x)];",
    );
    fixes_miscompilation(Pass::Globals, &text, |wgsl| !wgsl.contains("var<private> c"));
}

#[test]
fn uninitialized_variables() {
    let text = main_image("", "for (int i = 0; i < 3; i++) { float a; a += p.x; o.x += a; }");
    fixes_miscompilation(Pass::Uninitialized, &text, |wgsl| !wgsl.contains("= 0f;"));
    let text = main_image(
        "void f(out float x) { if (iTime > 1.0) x = 2.0; }",
        "float x = 1.0; f(x); o.x = x;",
    );
    fixes_miscompilation(Pass::Uninitialized, &text, |wgsl| !wgsl.contains("= 0f;"));
    assert!(lines("", "float a; o.x = a;").starts_with("float a;\n"));
}

#[test]
fn loop_heads() {
    fixes_rejection(
        Pass::LoopHeads,
        &main_image("", "int i = 0; while (bool b = i < 3) { i++; o.x += float(b); }"),
    );
    let f = "void f(inout float x) { x += 1.0; }";
    fixes_rejection(
        Pass::LoopVoids,
        &main_image(
            f,
            "vec2 q = p; int i = 0; while (f(q.x), i < 3) { i++; if (i == 2) continue; o.x += q.x; }",
        ),
    );
    fixes_rejection(
        Pass::LoopVoids,
        &main_image(
            f,
            "vec2 q = p; int i; for (i = 0; i < 3; f(q.x), i++) { float i = 2.0; if (q.x > i) continue; o.x += q.x; }",
        ),
    );
    let body = "int i; float x; for (i = 0, x = 1.0; i < 3; i++) o.x += x;";
    assert_eq!(
        lines("", body),
        "int i;\nfloat x;\n{\ni = 0;\nx = 1.0;\nfor (; i < 3;) {\no.x += x;\ni++;"
    );
}

#[test]
fn continue_in_do_while() {
    let text = main_image(
        "",
        "int i = 0; do { i++; if (i == 2) continue; o.x += p.x; } while (i < 5);",
    );
    // The condition must be where `continue` jumps to: in the `continuing` block.
    let skipped =
        |wgsl: &str| !wgsl.contains("continuing") || !wgsl[position(wgsl, "continuing")..].contains("5i");
    fixes_miscompilation(Pass::DoWhile, &text, skipped);
}

#[test]
fn dead_code() {
    let text = "float h(float x) { return x; }\nfloat f(float x) { return x; float y = h(x); return y; }";
    let checked = checked(&main_image(text, "o.x = f(p.x);"), false);
    let compacts = |passes| {
        let lowered = lower_with(&checked, passes);
        let options = Options::from(naga::ShaderStage::Fragment);
        let module = Frontend::default()
            .parse(&options, lowered.text())
            .expect("naga parses it");
        Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .is_ok()
    };
    assert!(!compacts(Passes::required().without(Pass::DeadCode)) && compacts(Passes::required()));
}

#[test]
fn switches() {
    let falls = "switch (int(p.x)) { case 0: o.x = 1.0; case 1: o.y = 1.0; break; default: o.z = 1.0; }";
    fixes_rejection(Pass::Switches, &main_image("", falls));
    fixes_rejection(
        Pass::Switches,
        &main_image(
            "",
            "switch (int(p.x)) { case 0: { o.x = 1.0; break; } default: o.y = 1.0; }",
        ),
    );
    let returns = "float f(int i) { switch (i) { case 0: return 1.0; case 1: return 2.0; } return 3.0; }";
    fixes_rejection(Pass::Switches, &main_image(returns, "o.x = f(int(p.x));"));
    for body in [
        "switch (int(p.x)) { default: o.x = 1.0; case 1: float a = 2.0; if (p.y > 0.0) break; o.y = a; case 2: o.z = 1.0; }",
        "switch (int(p.x)) { case 0: float a = 1.0; o.x = a; break; case 1: a = 2.0; o.y = a; } switch (int(p.y)) { case 0: float a = 3.0; o.z = a; }",
        "for (int i = 0; i < 3; i++) { switch (i) { case 0: continue; case 1: { float a = p.x; o.x = a; break; } default: { { return; } } } }",
        "switch (int(p.x)) { case 0: { return; } break; case 1: { { break; } } o.x = 1.0; }",
        "switch (uint(p.x)) { case 0u: case 7u: o.x = 1.0; break; default: break; }",
    ] {
        accepted(&checked(&main_image("", body), true));
    }
}

#[test]
fn sequences() {
    fixes_rejection(
        Pass::Sequences,
        &main_image("void f(float x) {}", "f(p.x), f(p.y), o.x = 1.0;"),
    );
    assert_eq!(
        lines(
            "float f(float x) { return x; }",
            "float a, b; a = b = f(p.x), o.x = a;"
        ),
        "float a;\nfloat b;\na = b = f(p.x);\no.x = a;"
    );
}

#[test]
fn missing_returns() {
    fixes_rejection(
        Pass::MissingReturns,
        &main_image(
            "bool f(float d) { if (d > 0.0) { return true; } }",
            "o.x = float(f(p.x));",
        ),
    );
    fixes_rejection(
        Pass::MissingReturns,
        &main_image(
            "struct S { float a[20]; }; S f(float d) { for (;;) { if (d > 0.0) { S s; return s; } } }",
            "o.x = f(p.x).a[0];",
        ),
    );
}

#[test]
fn stage_inputs() {
    fixes_rejection(Pass::StageIo, &main_image("", "o.x = iChannelTime[1];"));
    assert_eq!(
        lines("", "if (gl_FrontFacing && gl_MaxDrawBuffers > 3) o.x = 1.0;"),
        "if (true && 4 > 3) {\no.x = 1.0;"
    );
    fixes_rejection(
        Pass::StageIo,
        &main_image(
            "uniform sampler3D tex; uniform float u;",
            "o = texture(tex, p.xyx) * u;",
        ),
    );
    accepted(&checked(
        &main_image(
            "",
            "float t[4] = iChannelTime; o.x = t[int(p.x)] + gl_PointCoord.x;",
        ),
        true,
    ));
}

#[test]
fn chains_of_else_if() {
    let chain: Vec<_> = (0..200)
        .map(|i| format!("if (p.x < {i}.0) {{ o.x = f({i}); }}"))
        .collect();
    let text = main_image(
        "float f(int i) { return float(i); }",
        &(chain.join(" else ") + " else o.y = 1.0;"),
    );
    let deepest = |wgsl: &str| {
        wgsl.lines()
            .map(|line| line.len() - line.trim_start().len())
            .max()
    };
    let checked = checked(&text, true);
    let depth = |passes| deepest(&naga(lower_with(&checked, passes).text()).expect("naga takes it"));
    // The nesting pass would flatten the chain as well.
    let without = Passes::required().without(Pass::Nesting).without(Pass::ElseIfs);
    assert!(depth(without) > Some(4 * 127) && depth(Passes::required()) <= Some(4 * 127));
    let lowered = lower_with(&checked, Passes::required());
    assert_eq!(lowered.text().matches("if (toyproof_open)").count(), 7);
}

#[test]
fn a_sequence_stays_behind_expressions_that_it_affects() {
    let f = "float f(inout float x) { x += 1.0; return x; }";
    assert_eq!(
        lines(
            f,
            "vec2 q = p; float g = 1.0; o.x = (p.x > 0.0 ? q.x : g) + f(q.x);"
        ),
        "vec2 q = p;\nfloat g = 1.0;\nfloat toyproof_argument = q.x;\nfloat toyproof_result = f(toyproof_argument);\n\
         o.x = (p.x > 0.0 ? q.x : g) + (q.x = toyproof_argument, toyproof_result);"
    );
}
