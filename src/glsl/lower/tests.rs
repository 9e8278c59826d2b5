//! For each pass: naga fails without it, and takes the shader with it.

use std::panic::catch_unwind;

use naga::back::{spv, wgsl};
use naga::front::glsl::{Frontend, Options};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::super::{Checked, check};
use super::{Pass, Passes, lower_with};
use crate::source::{File, Files};

fn checked(text: &str, lenient: bool) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let options = super::super::Options {
        lenient,
        ..Default::default()
    };
    check(&files, file, &options)
        .unwrap_or_else(|diagnostics| panic!("{}\n{text}", crate::diagnostic::short(&diagnostics[0], &files)))
}

/// What naga writes as WGSL for a GLSL text that it can also write as SPIR-V, or why it cannot.
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

/// Without that pass naga refuses the shader; with it, it does not. Gives the lowered text.
fn mends(pass: Pass, text: &str) -> String {
    let checked = checked(text, true);
    let without = lower_with(&checked, Passes::all().without(pass));
    assert!(
        naga(without.text()).is_err(),
        "naga is mended, {pass:?} can go:\n{}",
        without.text()
    );
    accepted(&checked)
}

/// Without that pass naga takes the shader and gets it wrong, as `wrong` tells from the WGSL; with it, it does not.
fn corrects(pass: Pass, text: &str, wrong: impl Fn(&str) -> bool) -> String {
    let checked = checked(text, true);
    let without = lower_with(&checked, Passes::all().without(pass));
    let wgsl = naga(without.text()).unwrap_or_else(|error| panic!("{error}\n{}", without.text()));
    assert!(
        wrong(&wgsl),
        "naga is mended, {pass:?} can go:\n{}\n{wgsl}",
        without.text()
    );
    let lowered = lower_with(&checked, Passes::all());
    let wgsl = naga(lowered.text()).unwrap_or_else(|error| panic!("{error}\n{}", lowered.text()));
    assert!(!wrong(&wgsl), "{}\n{wgsl}", lowered.text());
    lowered.text().to_owned()
}

fn accepted(checked: &Checked) -> String {
    let lowered = lower_with(checked, Passes::all());
    if let Err(error) = naga(lowered.text()) {
        panic!("{error}\n{}", lowered.text());
    }
    lowered.text().to_owned()
}

/// A shader whose `mainImage` is that.
fn main_image(before: &str, body: &str) -> String {
    format!("{before}\nvoid mainImage(out vec4 o, in vec2 p) {{\n    o = vec4(0.0);\n    {body}\n}}\n")
}

/// The lowered lines of the author's functions.
fn lines(before: &str, body: &str) -> String {
    let text = accepted(&checked(&main_image(before, body), true));
    let begin = text.find("void mainImage").unwrap_or(0);
    let end = text.find("void main()").unwrap_or(text.len());
    let lines = text[begin..end].lines().map(str::trim);
    lines
        .filter(|line| !matches!(*line, "" | "}" | "o = vec4(0.0);") && !line.contains("mainImage"))
        .collect::<Vec<_>>()
        .join("\n")
}

fn position(text: &str, needle: &str) -> usize {
    text.find(needle)
        .unwrap_or_else(|| panic!("{needle} is not in\n{text}"))
}

#[test]
fn sampler_parameters() {
    let text = main_image(
        "vec4 f(sampler2D s, vec2 p) { return texture(s, p); }\n\
         vec4 g(vec2 p, sampler2D t) { return f(t, p) + f(t, p.yx); }",
        "o = g(p, iChannel0) + g(p, iChannel2) + f(iChannel0, p);",
    );
    let lowered = mends(Pass::Samplers, &text);
    assert!(
        lowered.contains("vec4 g_iChannel2(vec2 p) {\n    return f_iChannel2(p) + f_iChannel2(p.yx);"),
        "{lowered}"
    );
    assert_eq!(lowered.matches("vec4 f_iChannel0(vec2 p)").count(), 1);
}

#[test]
fn short_circuit() {
    let text = main_image(
        "bool hit(float x, inout float t) { t = x; return x > 0.0; }",
        "float t = 1.0; bool near = p.x > 1.0; if (near && hit(p.y, t)) o.x = t;",
    );
    let early = |wgsl: &str| {
        let body = &wgsl[position(wgsl, "fn mainImage")..];
        position(body, "hit(") < position(body, "if ")
    };
    corrects(Pass::ShortCircuit, &text, early);
    assert_eq!(
        lines(
            "bool f(inout float t) { t += 1.0; return t > 2.0; }",
            "float t = p.x; bool b = p.y > 0.0 || f(t); o.x = float(b) + t;"
        ),
        "float t = p.x;\nbool b = p.y > 0.0 ? true : f(t);\no.x = float(b) + t;"
    );
}

#[test]
fn functions_that_naga_lacks() {
    mends(Pass::Missing, &main_image("", "float i; o.x = modf(p.x, i) + i;"));
    mends(
        Pass::Missing,
        &main_image("", "mat2 m = matrixCompMult(mat2(p, p), mat2(1.0)); o.xy = m[0];"),
    );
    mends(
        Pass::Missing,
        &main_image("", "mat2x3 m = outerProduct(vec3(p, 1.0), p); o.xyz = m[1];"),
    );
}

#[test]
fn inverse_for_every_target() {
    let checked = checked(
        &main_image("", "mat4 m = inverse(mat4(p, p, p, p, p, p, p, p)); o = m[0];"),
        false,
    );
    let metal = |passes| {
        let lowered = lower_with(&checked, passes);
        let options = Options::from(naga::ShaderStage::Fragment);
        let module = Frontend::default()
            .parse(&options, lowered.text())
            .expect("naga parses it");
        let info = Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .expect("valid");
        let (options, pipeline) = (
            naga::back::msl::Options::default(),
            naga::back::msl::PipelineOptions::default(),
        );
        naga::back::msl::write_string(&module, &info, &options, &pipeline).is_ok()
    };
    assert!(!metal(Passes::all().without(Pass::Missing)) && metal(Passes::all()));
}

#[test]
fn geometric_functions_of_floats() {
    for call in [
        "dot(p.x, p.y)",
        "normalize(p.x)",
        "reflect(p.x, p.y)",
        "refract(p.x, p.y, 0.5)",
        "faceforward(p.x, p.y, 1.0)",
    ] {
        mends(Pass::Geometric, &main_image("", &format!("o.x = {call};")));
    }
}

#[test]
fn is_nan_and_is_inf() {
    mends(
        Pass::IsNan,
        &main_image("", "if (isnan(p.x) || any(isinf(p))) o = vec4(1.0);"),
    );
}

#[test]
fn texel_offsets() {
    let text = main_image("", "o = texelFetchOffset(iChannel0, ivec2(p), 0, ivec2(1, 2));");
    let lowered = corrects(Pass::Texels, &text, |wgsl| !wgsl.contains("2i"));
    assert!(
        lowered.contains("texelFetch(sampler2D(iChannel0, iChannel0_sampler), ivec2(p) + ivec2(1, 2), 0)"),
        "{lowered}"
    );
    mends(
        Pass::Texels,
        &main_image(
            "",
            "const ivec2 d = ivec2(1, 2); o = textureOffset(iChannel0, p, d);",
        ),
    );
}

#[test]
fn matrix_constructors() {
    mends(
        Pass::Matrices,
        &main_image("", "mat2 m = mat2(cos(p.x + vec4(0, 33, 11, 0))); o.xy = m * p;"),
    );
    mends(
        Pass::Matrices,
        &main_image("", "mat2 m = mat2(vec3(p, 1.0), vec3(p, 2.0)); o.xy = m * p;"),
    );
}

#[test]
fn numbers_of_booleans() {
    mends(
        Pass::Booleans,
        &main_image("", "vec3 v = vec3(p.x > 1.0); o.xyz = v;"),
    );
    mends(
        Pass::Booleans,
        &main_image("", "bvec4 b = bvec4(p, p); vec2 v = vec2(b); o.xy = v;"),
    );
    mends(
        Pass::Booleans,
        &main_image("", "bvec2 b = bvec2(p); float v = float(b); o.x = v;"),
    );
}

#[test]
fn swizzles_of_columns() {
    mends(
        Pass::Swizzles,
        &main_image("", "mat3 m = mat3(1.0); m[1].x = p.x; o.xyz = m[1];"),
    );
    mends(
        Pass::Swizzles,
        &main_image("", "mat3 m = mat3(1.0); m[1].yz *= p; o.xyz = m[1];"),
    );
    assert_eq!(
        lines(
            "",
            "mat3 m = mat3(1.0); int i = int(p.x); m[i++].yz = p; o.xyz = m[1];"
        ),
        "mat3 m = mat3(1.0);\nint i = int(p.x);\nint toyproof_index = i++;\nvec3 toyproof_vector = m[toyproof_index];\n\
         toyproof_vector.yz = p;\nm[toyproof_index] = toyproof_vector;\no.xyz = m[1];"
    );
    assert_eq!(
        lines("", "vec3 v = vec3(1.0); v.zyx.xy.y = p.x; o.xyz = v;"),
        "vec3 v = vec3(1.0);\nv.y = p.x;\no.xyz = v;"
    );
}

#[test]
fn indices_that_act() {
    let text = main_image(
        "",
        "float a[3] = float[](1.0, 2.0, p.x); int i = 0; a[i++] += 5.0; o.x = a[i];",
    );
    let twice = |wgsl: &str| wgsl.matches("+ 1i").count() > 1;
    let lowered = corrects(Pass::Indices, &text, twice);
    assert!(
        lowered.contains("int toyproof_index = i++;\n    a[toyproof_index] += 5.0;"),
        "{lowered}"
    );
}

#[test]
fn compound_assignments() {
    assert_eq!(
        lines(
            "float g; float next() { return g += 1.0; }",
            "g = 2.0; g += next(); float x = 1.0; x += next(); o.x = x;"
        ),
        "g = 2.0;\nfloat toyproof_value = next();\ng += toyproof_value;\nfloat x = 1.0;\nx += next();\no.x = x;"
    );
}

#[test]
fn inequality_of_floats() {
    let text = main_image(
        "",
        "o.x = float(p.x != p.y); o.y = float(notEqual(p, p.yx).x); o.z = float(p != p.yx);",
    );
    let lowered = corrects(Pass::Inequality, &text, |wgsl| wgsl.contains("!="));
    assert!(
        lowered.contains("!(p.x == p.y)") && lowered.contains("not(equal(p, p.yx))"),
        "{lowered}"
    );
    assert!(lines("", "o.x = float(int(p.x) != 1);").contains("int(p.x) != 1"));
}

#[test]
fn negation_of_unsigned_integers() {
    mends(
        Pass::Negations,
        &main_image("", "uint u = uint(p.x); o.x = float(-u);"),
    );
}

#[test]
fn remainders() {
    mends(
        Pass::Remainders,
        &main_image("", "uvec2 u = uvec2(p) % 3u; o.xy = vec2(u);"),
    );
    let text = main_image("", "int i = int(p.x) - 5; i %= 3; o.x = float(i);");
    corrects(Pass::Remainders, &text, |wgsl| {
        !wgsl.contains("toyproof_remainder")
    });
}

#[test]
fn out_arguments() {
    let f = "void f(inout float x) { x += 1.0; }\nstruct S { float a; vec2 b; };";
    mends(
        Pass::OutArguments,
        &main_image(f, "vec2 q = p; f(q.x); o.xy = q;"),
    );
    mends(
        Pass::OutArguments,
        &main_image(f, "mat2 m = mat2(1.0); f(m[1][0]); o.xy = m[1];"),
    );
    assert_eq!(
        lines(f, "float a[2]; int i = int(p.x); f(a[i]); o.x = a[0];"),
        "float[2] a;\nint i = int(p.x);\nint toyproof_index = i;\nfloat toyproof_argument = a[toyproof_index];\n\
         f(toyproof_argument);\na[toyproof_index] = toyproof_argument;\no.x = a[0];"
    );
    assert_eq!(
        lines(f, "S s; f(s.a); float x = s.a; f(x); o.x = x;")
            .matches("toyproof")
            .count(),
        3
    );
    let g = "float g(float a, out float b) { b = a; return a; }";
    assert_eq!(
        lines(g, "vec2 q = p; float d = g(q.y, q.x) + q.x; o.x = d;"),
        "vec2 q = p;\nfloat toyproof_argument;\nfloat toyproof_result = g(q.y, toyproof_argument);\nq.x = toyproof_argument;\n\
         float d = toyproof_result + q.x;\no.x = d;"
    );
}

#[test]
fn equality_of_structures_and_arrays() {
    let s = "struct In { mat2x3 m; }; struct S { float a; In b[2]; };";
    let text = main_image(s, "S s, t; s.a = p.x; if (s == t || s != t) o.x = 1.0;");
    mends(Pass::Equality, &text);
    mends(
        Pass::Equality,
        &main_image(
            "",
            "float a[2], b[2]; a[0] = p.x; b[0] = p.y; if (a == b) o.x = 1.0;",
        ),
    );
}

#[test]
fn constants_that_naga_cannot_evaluate() {
    for body in [
        "const float INF = 1.0 / 0.0; o.x = INF;",
        "o.x = log(0.0) + p.x;",
        "o.x = sqrt(-1.0) * p.x;",
        "o.x = float(1 << 31) + p.x;",
        "o.x = 1e39 * p.x;",
        "o.x = float(int(p.x) / 0 + 5 / 0);",
        "o.x = clamp(0.5, 1.0, 0.0);",
        "o.x = normalize(vec3(0.0)).x;",
        "int i; o.x = float(1 << (i = 31));",
        "o.x = 1e38 * (o.y, 100.0);",
    ] {
        mends(Pass::Constants, &main_image("", body));
    }
    mends(
        Pass::Constants,
        &main_image("const float INF = 1.0 / 0.0;", "o.x = INF;"),
    );
}

#[test]
fn global_initialisers() {
    mends(
        Pass::Globals,
        &main_image("const vec3 A = mix(vec3(1.0), vec3(2.0), 0.5);", "o.xyz = A;"),
    );
    mends(
        Pass::Globals,
        &main_image("const float A = true ? 1.0 : 2.0;", "o.x = A;"),
    );
    let text = main_image("float T = iTime * 2.0;", "o.x = T;");
    let dropped = |wgsl: &str| !wgsl.contains("* 2f");
    let lowered = corrects(Pass::Globals, &text, dropped);
    assert!(
        lowered.contains("void toyproof_start() {\n    T = iTime * 2.0;\n}"),
        "{lowered}"
    );
    let text = main_image("const float A[3] = float[](1.0, 2.0, 3.0);", "o.x = A[int(p.x)];");
    corrects(Pass::Globals, &text, |wgsl| !wgsl.contains("var<private> A"));
    let text = main_image(
        "",
        "vec3 c[2] = vec3[](vec3(1.0), vec3(2.0)); o.xyz = c[int(p.x)];",
    );
    corrects(Pass::Globals, &text, |wgsl| !wgsl.contains("var<private> c"));
}

#[test]
fn uninitialised_variables() {
    let text = main_image("", "for (int i = 0; i < 3; i++) { float a; a += p.x; o.x += a; }");
    corrects(Pass::Uninitialised, &text, |wgsl| !wgsl.contains("= 0f;"));
    let text = main_image(
        "void f(out float x) { if (iTime > 1.0) x = 2.0; }",
        "float x = 1.0; f(x); o.x = x;",
    );
    corrects(Pass::Uninitialised, &text, |wgsl| !wgsl.contains("= 0f;"));
    assert!(lines("", "float a; o.x = a;").starts_with("float a;\n"));
}

#[test]
fn loop_heads() {
    mends(
        Pass::LoopHeads,
        &main_image("", "int i = 0; while (bool b = i < 3) { i++; o.x += float(b); }"),
    );
    let f = "void f(inout float x) { x += 1.0; }";
    mends(
        Pass::LoopVoids,
        &main_image(
            f,
            "vec2 q = p; int i = 0; while (f(q.x), i < 3) { i++; if (i == 2) continue; o.x += q.x; }",
        ),
    );
    mends(
        Pass::LoopVoids,
        &main_image(
            f,
            "vec2 q = p; int i; for (i = 0; i < 3; f(q.x), i++) { float i = 2.0; if (q.x > i) continue; o.x += q.x; }",
        ),
    );
    let body = "int i; float x; for (i = 0, x = 1.0; i < 3; i++) o.x += x;";
    assert_eq!(
        lines("", body),
        "int i;\nfloat x;\n{\ni = 0;\nx = 1.0;\nfor (; i < 3; i++) {\no.x += x;"
    );
}

#[test]
fn continue_in_do_while() {
    let text = main_image(
        "",
        "int i = 0; do { i++; if (i == 2) continue; o.x += p.x; } while (i < 5);",
    );
    // The condition must stand where `continue` leads: in the `continuing` block.
    let skipped =
        |wgsl: &str| !wgsl.contains("continuing") || !wgsl[position(wgsl, "continuing")..].contains("5i");
    corrects(Pass::DoWhile, &text, skipped);
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
    assert!(!compacts(Passes::all().without(Pass::DeadCode)) && compacts(Passes::all()));
}

#[test]
fn switches() {
    let falls = "switch (int(p.x)) { case 0: o.x = 1.0; case 1: o.y = 1.0; break; default: o.z = 1.0; }";
    mends(Pass::Switches, &main_image("", falls));
    mends(
        Pass::Switches,
        &main_image(
            "",
            "switch (int(p.x)) { case 0: { o.x = 1.0; break; } default: o.y = 1.0; }",
        ),
    );
    let returns = "float f(int i) { switch (i) { case 0: return 1.0; case 1: return 2.0; } return 3.0; }";
    mends(Pass::Switches, &main_image(returns, "o.x = f(int(p.x));"));
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
    mends(
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
    mends(
        Pass::MissingReturns,
        &main_image(
            "bool f(float d) { if (d > 0.0) { return true; } }",
            "o.x = float(f(p.x));",
        ),
    );
    mends(
        Pass::MissingReturns,
        &main_image(
            "struct S { float a[20]; }; S f(float d) { for (;;) { if (d > 0.0) { S s; return s; } } }",
            "o.x = f(p.x).a[0];",
        ),
    );
}

#[test]
fn surroundings() {
    mends(Pass::Surroundings, &main_image("", "o.x = iChannelTime[1];"));
    assert_eq!(
        lines("", "if (gl_FrontFacing && gl_MaxDrawBuffers > 3) o.x = 1.0;"),
        "if (true && 4 > 3) {\no.x = 1.0;"
    );
    mends(
        Pass::Surroundings,
        &main_image(
            "uniform sampler2D tex; uniform float u;",
            "o = texture(tex, p) * u;",
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
fn members_of_structures() {
    let arrays = "struct S { float a[2]; vec2 b; };";
    mends(
        Pass::Members,
        &main_image(arrays, "S s = S(float[](p.x, 2.0), p); o.x = s.a[1];"),
    );
    mends(
        Pass::Members,
        &main_image(
            arrays,
            "S s; s.a = float[](p.x, 2.0); float a[2] = s.a; o.x = a[1];",
        ),
    );
    let matrix =
        "struct M { mat2 m; float x; }; M f(mat2 m) { return M(m, 1.0); } void g(inout mat2 m) { m *= 2.0; }";
    let lowered = mends(
        Pass::Members,
        &main_image(
            matrix,
            "M a = f(mat2(p, p)); a.m *= 3.0; a.m[1].x = 4.0; g(a.m); M b = a; o.xy = a.m * p + f(b.m).m[0]; if (a == b) o.z = 1.0;",
        ),
    );
    assert!(lowered.contains("vec2[2] m;"), "{lowered}");
    accepted(&checked(
        &main_image(arrays, "for (int i = 0; i < 2; i++) { S s; o.x += s.a[i]; }"),
        false,
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
    let lowered = corrects(Pass::ElseIfs, &text, |wgsl| deepest(wgsl) > Some(4 * 127));
    assert_eq!(lowered.matches("if (toyproof_open)").count(), 7);
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
fn a_sequence_stays_where_something_before_it_minds() {
    let f = "float f(inout float x) { x += 1.0; return x; }";
    assert_eq!(
        lines(
            f,
            "vec2 q = p; float g = 1.0; o.x = (p.x > 0.0 ? q.x : g) + f(q.x);"
        ),
        "vec2 q = p;\nfloat g = 1.0;\nfloat toyproof_argument;\nfloat toyproof_result;\n\
         o.x = (p.x > 0.0 ? q.x : g) + (toyproof_argument = q.x, toyproof_result = f(toyproof_argument), \
         q.x = toyproof_argument, toyproof_result);"
    );
}

#[test]
fn words_of_the_lowered_text_lead_back_to_the_author() {
    let text = main_image(
        "float twice(float x) { return 2.0 * x; }",
        "o.x = p.x > 0.5 && twice(p.y) > 0.25 ? 1.0 : 0.0;",
    );
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let checked = check(&files, file, &super::super::Options::default()).expect("valid");
    let lowered = super::lower(&checked);
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
    use super::super::tree::{ExprKind, Type};
    let body = "S a, b; float x[3]; test(a, b, int(p.x), x); o.x = g(iChannel0, p, a) + g(iChannel1, p, b);";
    let checked = checked(&main_image(EVERYTHING, body), false);
    accepted(&checked);
    let mut draft = super::Draft::new(checked.tree, checked.main_image);
    Passes::all().run(&mut draft);
    let mut seen = std::collections::HashSet::new();
    for (_, function) in draft.tree.functions.iter() {
        let roots = function
            .body
            .iter()
            .flat_map(|body| super::walk::roots(&draft.tree, body));
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
