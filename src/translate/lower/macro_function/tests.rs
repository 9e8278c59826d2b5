use toyproof_diagnostic::{Deadline, File, Files};
use toyproof_glsl::{Options, check};

use crate::c_family::{self, CHost, Title};
use crate::wgsl::{self, Style};

/// Converts a shader to HLSL, without the code around it.
fn hlsl(text: &str) -> String {
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let checked = check(&files, file, &Options::default()).unwrap_or_else(|errors| panic!("{errors:?}"));
    let title = Title::of_shader("shader");
    let written = c_family::write(&checked, &files, CHost::Hlsl, title, &Deadline::default()).unwrap();
    let end = written.find("\nfloat4 main(").unwrap();
    written[..end].to_owned()
}

fn wgsl(text: &str) -> String {
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let checked = check(&files, file, &Options::default()).unwrap_or_else(|errors| panic!("{errors:?}"));
    wgsl::wgsl(&checked, &files, Style::Plain, &Deadline::default()).unwrap()
}

/// A shader whose image function has this body.
fn shader(items: &str, statements: &str) -> String {
    format!("{items}\nvoid mainImage(out vec4 color, in vec2 at) {{\ncolor = vec4(0);\n{statements}\n}}")
}

/// Asserts that lines are part of the HLSL.
#[track_caller]
fn assert_converts(items: &str, statements: &str, lines: &[&str]) {
    let written = hlsl(&shader(items, statements));
    for line in lines {
        assert!(written.contains(line), "{line}\n---\n{written}");
    }
}

/// Asserts that uses of the macro `F` stay expanded, and that this is the last statement.
#[track_caller]
fn assert_expanded(items: &str, statements: &str, last: &str) {
    let written = hlsl(&shader(items, statements));
    assert!(!written.contains("F("), "{written}");
    assert!(
        written.trim_end().ends_with(&format!("{last}\n}}")),
        "{last}\n---\n{written}"
    );
}

#[test]
fn macros_become_functions_with_their_comments() {
    let items = "float two = 2.;\n// Rotates.\n#define turn(a) mat2(cos(a), sin(a), -sin(a), cos(a)) // by an angle\n\n\
        /* Limits\n * to colors. */\n#define SAT(x) clamp((x), 0., 1.)\nfloat three = 3.;";
    assert_converts(
        items,
        "color.xy = turn(at.x + two) * at;\ncolor.z = SAT(color.x) + SAT(.5 * three);",
        &[
            "static float two = 2.0;\n\n// Rotates.\nfloat2x2 turn(float a) {\n    \
             return float2x2(cos(a), sin(a), -sin(a), cos(a)); // by an angle\n}\n",
            "// Limits\n// to colors.\nfloat SAT(float x) {\n    return clamp(x, 0.0, 1.0);\n}\n\nstatic float three = 3.0;",
            "    color.xy = mul(at, turn(at.x + two));\n    color.z = SAT(color.x) + SAT(0.5 * three);\n",
        ],
    );
}

#[test]
fn replacements_name_what_is_global() {
    let items = "#define PI 3.14\n#define look(u) (texture(iChannel0, (u) / iResolution.xy).r * gain * PI)\n\
        float gain = .5;\nfloat wave(float x) { return sin(x); }\n#define TWICE(x) wave(wave(x))";
    assert_converts(
        items,
        "color.x = look(at);\ncolor.y = TWICE(color.x);",
        &[
            "static const float PI = 3.14;",
            "float look(float2 u) {\n    return iChannel0.Sample(iChannel0_sampler, u / iResolution.xy).r * gain * PI;\n}",
            "float TWICE(float x) {\n    return wave(wave(x));\n}",
            "color.x = look(at);\n    color.y = TWICE(color.x);",
        ],
    );
    // A local variable of the place of use.
    assert_expanded(
        "#define F(x) ((x) * k)",
        "float k = 2.;\ncolor.x = F(at.x);",
        "color.x = at.x * k;",
    );
    // A local variable that hides the global one at one of two uses.
    assert_converts(
        "float k = 3.;\n#define F(x) ((x) * k)",
        "color.x = F(at.x);\nfloat k = 2.;\ncolor.y = F(at.y);",
        &["    return x * k;", "color.x = F(at.x);", "color.y = at.y * k"],
    );
}

#[test]
fn only_whole_expressions_are_calls() {
    let square = "#define F(x) x*x";
    assert_converts(
        square,
        "color.x = F(at.x) + F((at.y - 1.));",
        &["return x * x;", "color.x = F(at.x) + F(at.y - 1.0);"],
    );
    assert_expanded(
        square,
        "color.x = F(at.x + 1.);",
        "color.x = at.x + 1.0 * at.x + 1.0;",
    );
    assert_expanded(
        square,
        "color.x = F(at.x + at.x);",
        "color.x = at.x + at.x * at.x + at.x;",
    );
    assert_expanded(
        square,
        "color.x = at.y / F(at.x);",
        "color.x = at.y / at.x * at.x;",
    );
    assert_expanded(
        "#define F(x) * sin(x)",
        "color.x = at.y F(at.x);",
        "color.x = at.y * sin(at.x);",
    );
    assert_expanded(
        "#define F(x) x.",
        "color.x = F(at)x + F(at)y;",
        "color.x = at.x + at.y;",
    );
    assert_expanded("#define F(x) at.x", "color.x = F(y);", "color.x = at.y;");
    assert_expanded(
        "#define F(a) if (a > 0.) color.x = a",
        "F(at.x);",
        "if (at.x > 0.0) {\n        color.x = at.x;\n    }",
    );
    // Parentheses around the use do not matter.
    assert_converts(
        "#define F(x) sin(x)",
        "color.x = 2. / (F(at.x));",
        &["color.x = 2.0 / F(at.x);"],
    );
}

#[test]
fn trivial_macros_stay_expanded() {
    assert_expanded("#define F(x) x", "color.x = F(at.x);", "color.x = at.x;");
    assert_expanded("#define F(x) (x)", "color.x = F(at.x);", "color.x = at.x;");
    assert_expanded(
        "#define F(x, y) (2. * (x))",
        "color.x = F(at.x, at.y);",
        "color.x = 2.0 * at.x;",
    );
}

#[test]
fn arguments_with_side_effects_stay_expanded() {
    let double = "#define F(x) ((x) + (x))\nfloat n = 0.;\nfloat next() { return n++; }\n\
        float half_of(float x) { return x / 2.; }";
    assert_expanded(double, "color.x = F(next());", "color.x = next() + next();");
    assert_converts(
        double,
        "color.x = F(half_of(at.x));",
        &["color.x = F(half_of(at.x));"],
    );
    assert_expanded(
        "#define F(x) ((x) += 1.)",
        "F(at.x);\ncolor.x = at.x;",
        "color.x = at.x;",
    );
}

#[test]
fn arguments_stay_in_their_call() {
    let items = "#define MUL(a, b) ((a) * (b))\nfloat n = 0.;\nfloat next(float x) { return x + 1.; }";
    let written = wgsl(&shader(items, "n += at.y;\ncolor.x = MUL(n, next(at.x));"));
    assert!(written.contains(" = MUL(n, next(at.x));"), "{written}");
}

#[test]
fn arguments_under_a_condition_have_a_value_without_it() {
    let either = "#define F(c, x) ((c) ? (x) : 1.)\nconst float table[2] = float[](.5, .25);";
    assert_expanded(
        either,
        "int i = int(at.x);\ncolor.x = F(i < 2, table[i]);",
        "color.x = i < 2 ? table[i] : 1.0;",
    );
    assert_converts(
        either,
        "color.x = F(at.x < 2., at.y * 3.);",
        &["color.x = F(at.x < 2.0, at.y * 3.0);"],
    );
}

#[test]
fn other_types_are_overloads() {
    let items = "#define SAT(x) clamp(x, 0., 1.)";
    let statements = "color.x = SAT(at.x);\ncolor.yz = SAT(at);\ncolor.w = SAT(at.y);";
    let lines = [
        "float SAT(float x) {",
        "float2 SAT(float2 x) {",
        "color.x = SAT(at.x);\n    color.yz = SAT(at);\n    color.w = SAT(at.y);",
    ];
    assert_converts(items, statements, &lines);
    let written = wgsl(&shader(items, statements));
    for line in [
        "fn SAT(x: f32) -> f32 {",
        "fn SAT_vec2f(x: vec2f) -> vec2f {",
        " SAT_vec2f(at),",
    ] {
        assert!(written.contains(line), "{written}");
    }
}

#[test]
fn lvalues_and_constants_stay_expanded() {
    assert_expanded("#define F(v) v.xy", "F(color) = at;", "color.xy = at;");
    let size = "#define F(n) (n + 1)";
    assert_expanded(
        size,
        "float a[F(1)];\na[0] = at.x;\ncolor.x = a[0];",
        "color.x = a[0];",
    );
    assert_expanded(
        size,
        "const int k = F(2);\ncolor.x = float(k);",
        "color.x = float(k);",
    );
    assert_expanded(size, "color.x = color[F(1)];", "color.x = color[1 + 1];");
    assert_converts(
        "#define F(x) (x * 2.)\n#define G(n) sin(n)",
        "color.x = at.x * (F(3.) + 1.);\ncolor.y = G(F(2.));",
        &["color.x = at.x * (F(3.0) + 1.0);", "color.y = G(F(2.0));"],
    );
}

#[test]
fn uses_in_arguments_are_calls() {
    assert_converts(
        "#define A(x) (x * x)\n#define B(x) sin(x)\n#define TAU (2. * 3.14)",
        "color.x = A(B(at.x));\ncolor.y = A(TAU);\ncolor.z = B(A(at.x) + TAU);",
        &[
            "color.x = A(B(at.x));",
            "color.y = A(2.0 * 3.14);",
            "color.z = B(A(at.x) + 2.0 * 3.14);",
        ],
    );
}

#[test]
fn a_redefined_macro_keeps_its_uses_apart() {
    assert_converts(
        "#define F(x) (x * 2.)\nfloat f(float x) { return F(x); }\n#undef F\n#define F(x) (x * 3.)",
        "color.x = f(at.x) + F(at.y);",
        &[
            "float F(float x) {\n    return x * 2.0;\n}",
            "return F(x);",
            "float F_1(float x) {\n    return x * 3.0;\n}",
        ],
    );
    // A macro that the replacement names.
    assert_converts(
        "#define K 2.\n#define F(x) (x * K)\nfloat f(float x) { return F(x); }\n#undef K\n#define K 3.",
        "color.x = f(at.x) + F(at.y);",
        &[
            "    return x * K;",
            "return F(x);",
            "color.x = f(at.x) + at.y * 3.0;",
        ],
    );
}

#[test]
fn names_that_are_not_free_get_a_number() {
    let written = hlsl(&shader(
        "#define lerp(a, k) (a * k)",
        "float k = 2.;\ncolor.x = lerp(at.x, k);",
    ));
    assert!(written.contains("float lerp_1(float a, float k) {"), "{written}");
}
