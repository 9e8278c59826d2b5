//! Passes that mend statements and what comes before them.

use super::*;

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
        "int i;\nfloat x;\n{\ni = 0;\nx = 1.0;\nfor (; i < 3;) {\no.x += x;\ni++;"
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
    // What is nested deeper than drivers count is laid side by side anyway.
    let without = Passes::all().without(Pass::Nesting).without(Pass::ElseIfs);
    assert!(depth(without) > Some(4 * 127) && depth(Passes::all()) <= Some(4 * 127));
    let lowered = lower_with(&checked, Passes::all());
    assert_eq!(lowered.text().matches("if (toyproof_open)").count(), 7);
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
