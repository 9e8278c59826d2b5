use toyproof_diagnostic::{Deadline, File, Files};
use toyproof_glsl::{self as glsl, Options, Stage};

use super::host::CHost;
use super::{Title, Unprintable, WriteFailure, write};

/// Converts a shader for a host.
pub(super) fn converted(host: CHost, text: &str) -> Result<String, WriteFailure> {
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    let checked =
        glsl::check(&files, file, &Options::default()).unwrap_or_else(|errors| panic!("{errors:?}"));
    write(
        &checked,
        &files,
        host,
        Title::of_shader("shader"),
        &Deadline::default(),
    )
}

/// The HLSL of a shader whose image function has this body, from that function on.
fn body(statements: &str) -> String {
    with_items("", statements)
}

fn with_items(items: &str, statements: &str) -> String {
    let text =
        format!("{items}\nvoid mainImage(out vec4 color, in vec2 at) {{\ncolor = vec4(0);\n{statements}\n}}");
    let written = converted(CHost::Hlsl, &text).unwrap();
    let start = written
        .find("    color = ")
        .unwrap_or_else(|| panic!("{written}"));
    let end = written
        .find("\n}\n\nfloat4 main(")
        .unwrap_or_else(|| panic!("{written}"));
    written[start..end]
        .trim_start()
        .split_once(";\n")
        .map_or("", |(_, rest)| rest)
        .to_owned()
}

/// Asserts that a shader cannot be written for a host, for this reason.
#[track_caller]
pub(super) fn assert_refused(host: CHost, text: &str, why: &str) {
    match converted(host, text) {
        Err(WriteFailure::Unprintable(error)) => assert!(error.to_string().contains(why), "{error}"),
        other => panic!("{other:?}"),
    }
}

/// Checks the lines of a text, in which long ones are broken.
#[track_caller]
pub(super) fn assert_lines(written: &str, lines: &[&str]) {
    let mut own: Vec<String> = Vec::new();
    for line in written.lines().map(str::trim) {
        match own.last_mut() {
            Some(last) if !last.ends_with([';', ':', '{', '}']) && !last.contains("//") => {
                last.push(' ');
                last.push_str(line);
            }
            _ => own.push(line.to_owned()),
        }
    }
    assert_eq!(own, lines, "{written}");
}

#[test]
fn names_comments_macros_and_loops_stay() {
    let text = "// Waves\n\n#define STEPS 8\n#define SCALE .5 // of all\n\n\
        struct Ray { vec3 origin; float t; }; \n// Height\nfloat height(vec3 p) { return p.y - SCALE; }\n\
        void mainImage(out vec4 color, in vec2 at) {\n    Ray ray = Ray(vec3(at, 1), 0.);\n    // March\n    \
        for (int i = 0; i < STEPS; i++) ray.t += height(ray.origin); // on\n    color = vec4(ray.t);\n}";
    let written = converted(CHost::Hlsl, text).unwrap();
    for expected in [
        "// Waves\n\nstatic const int STEPS = 8;\nstatic const float SCALE = 0.5; // of all\n\nstruct Ray {",
        "// Height\nfloat height(float3 p) {\n    return p.y - SCALE;\n}\n",
        "    Ray ray = { float3(at, 1), 0.0 };\n    // March\n    for (int i = 0; i < STEPS; i++) {\n",
        "float4 main(float4 position : SV_Position) : SV_Target0 {\n    float4 color;\n    \
         // Row 0 of the target is the bottom of the image, as in ShaderToy.\n    mainImage(color, position.xy);\n",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
    // Nothing is declared that is not used.
    assert!(
        !written.contains("cbuffer") && !written.contains("gl_FragCoord"),
        "{written}"
    );
}

#[test]
fn products_of_matrices_exchange_their_sides() {
    let written =
        body("mat2 m = mat2(1, 2, 3, 4);\nat *= m;\nat = m * at;\nm = m * m * 2.;\ncolor.xy = at + m[1];");
    assert_lines(
        &written,
        &[
            "float2x2 m = float2x2(1, 2, 3, 4);",
            "at = mul(m, at);",
            "at = mul(at, m);",
            "m = mul(m, m) * 2.0;",
            "color.xy = at + m[1];",
        ],
    );
}

#[test]
fn constructors_become_casts_and_lists() {
    let written = body(
        "vec3 a = vec3(.1) + vec3(at.x * 2.);\nvec2 b = vec2(color);\nivec2 c = ivec2(color);\n\
         mat3 m = mat3(1);\nmat2 s = mat2(m);\nmat2 p = mat2(at, 1, at.x);\ncolor = vec4(a, b + vec2(c) + s[0] + p[1]);",
    );
    assert_lines(
        &written,
        &[
            "float3 a = float3(0.1, 0.1, 0.1) + (float3)(at.x * 2.0);",
            "float2 b = color.xy;",
            "int2 c = int2(color.xy);",
            "float3x3 m = float3x3(1, 0.0, 0.0, 0.0, 1, 0.0, 0.0, 0.0, 1);",
            "float2x2 s = (float2x2)m;",
            "float2x2 p = float2x2(at, float2(1, at.x));",
            "color = float4(a, (b + float2(c) + s[0] + p[1]).x);",
        ],
    );
}

#[test]
fn functions_have_the_names_of_hlsl() {
    let written = body(
        "float a = mix(fract(at.x), inversesqrt(at.y), .5) + atan(at.y, at.x) + dFdx(at.x);\n\
         bvec2 b = lessThan(at, vec2(.5));\nif (all(not(b)) ^^ at == vec2(1)) discard;\ncolor *= sign(a) * mod(a, 2.);",
    );
    assert_lines(
        &written,
        &[
            "float a = lerp(frac(at.x), rsqrt(at.y), 0.5) + atan2(at.y, at.x) + ddx(at.x);",
            "bool2 b = at < float2(0.5, 0.5);",
            "if (all(!b) != all(at == float2(1, 1))) {",
            "discard;",
            "}",
            "color *= float(sign(a)) * mod(a, 2.0);",
        ],
    );
}

#[test]
fn constants_are_folded_where_their_precision_matters() {
    // Both precisions round the first to the same float.
    let written = body("color.x = at.x * (1. / 4.);\ncolor.y = at.x * (0.1 * 0.3);\ncolor.z = sin(1.);");
    assert_ne!((0.1_f64 * 0.3) as f32, 0.1_f32 * 0.3);
    assert_lines(
        &written,
        &[
            "color.x = at.x * (1.0 / 4.0);",
            &format!("color.y = at.x * {:?};", 0.1_f32 * 0.3),
            "color.z = 0.84147096;",
        ],
    );
}

#[test]
fn both_sides_of_a_condition_may_have_effects() {
    let items = "float count = 0.; float next() { return ++count; }";
    let written = with_items(
        items,
        "float a = at.x > 1. ? next() : 2.;\nif (at.y > 1. && next() > 2.) color.x = a;",
    );
    assert_lines(
        &written,
        &[
            "float value_1 = 0.0;",
            "if (at.x > 1.0) {",
            "value_1 = next();",
            "} else {",
            "value_1 = 2.0;",
            "}",
            "float a = value_1;",
            "bool value_2 = false;",
            "if (at.y > 1.0) {",
            "value_2 = next() > 2.0;",
            "} else {",
            "value_2 = false;",
            "}",
            "if (value_2) {",
            "color.x = a;",
            "}",
        ],
    );
}

#[test]
fn conditions_with_effects_move_to_the_body() {
    let items = "float count = 0.; float next() { return ++count; }";
    let written = with_items(
        items,
        "while (at.x > 1. && next() < 3.) at.x -= 1.;\nif (at.y > 2.) at.y = 0.; else if (at.x > 0. || next() > 1.) color.x = 1.;",
    );
    assert_lines(
        &written,
        &[
            "while (true) {",
            "bool value_1 = false;",
            "if (at.x > 1.0) {",
            "value_1 = next() < 3.0;",
            "} else {",
            "value_1 = false;",
            "}",
            "if (!value_1) {",
            "break;",
            "}",
            "at.x -= 1.0;",
            "}",
            "if (at.y > 2.0) {",
            "at.y = 0.0;",
            "} else {",
            "bool value_2 = false;",
            "if (at.x > 0.0) {",
            "value_2 = true;",
            "} else {",
            "value_2 = next() > 1.0;",
            "}",
            "if (value_2) {",
            "color.x = 1.0;",
            "}",
            "}",
        ],
    );
}

#[test]
fn arrays_have_names() {
    let written = body(
        "color.x = float[2](at.x, 1.)[int(at.y)];\nfloat large[99];\nlarge[int(at.x)] = 1.;\ncolor.y = large[3];",
    );
    assert_lines(
        &written,
        &[
            "float array[2] = { at.x, 1.0 };",
            "color.x = array[int(at.y)];",
            "float large[99];",
            "for (int index = 0; index < 99; index++) {",
            "large[index] = 0.0;",
            "}",
            "large[int(at.x)] = 1.0;",
            "color.y = large[3];",
        ],
    );
}

#[test]
fn variables_are_zero_where_a_value_may_be_read() {
    let items = "struct Hit { float t; vec3 n; };";
    let written = with_items(
        items,
        "Hit hit;\nfloat set;\nset = 1.;\nfloat sum;\nif (set > at.x) sum = 1.;\ncolor.x = hit.t + sum + set;",
    );
    assert_lines(
        &written,
        &[
            "Hit hit = (Hit)0;",
            "float set;",
            "set = 1.0;",
            "float sum = 0.0;",
            "if (set > at.x) {",
            "sum = 1.0;",
            "}",
            "color.x = hit.t + sum + set;",
        ],
    );
}

#[test]
fn names_do_not_hide_what_their_declaration_calls() {
    let items = "float map(float x) { return x; } float lerp(float x) { return x; }";
    let written = with_items(
        items,
        "float map = map(at.x);\nfloat line = lerp(map);\n{ float line = line + 1.; color.x = line; }",
    );
    assert_lines(
        &written,
        &[
            "float map_1 = map(at.x);",
            "float line_1 = lerp_1(map_1);",
            "{",
            "float line_2 = line_1 + 1.0;",
            "color.x = line_2;",
            "}",
        ],
    );
}

#[test]
fn cases_are_blocks_if_they_declare_variables() {
    let written = body(
        "switch (int(at.x)) {\ncase 0: { color.x = 1.; break; }\ncase 1: float a = at.y; color.x = a; break;\ndefault: break;\n}",
    );
    assert!(
        written.contains("case 1: {\n            float a = at.y;\n"),
        "{written}"
    );
    let shared = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0); switch (int(p.x)) { case 0: float a = 1.; c.x = a; break; default: a = 2.; c.x = a; } }";
    let refused = converted(CHost::Hlsl, shared);
    assert!(matches!(
        refused,
        Err(WriteFailure::Unprintable(
            Unprintable::Construct(_) | Unprintable::Host(_)
        ))
    ));
}

#[test]
fn hosts_refuse_inputs_that_they_lack() {
    let text = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel1, p) * iDate; }";
    let Err(WriteFailure::Unprintable(Unprintable::Host(error))) = converted(CHost::WindowsTerminal, text)
    else {
        panic!("it is not refused");
    };
    assert!(
        error.message.contains("in the style `windows-terminal`"),
        "{error:?}"
    );
    assert!(converted(CHost::Unity, text).is_ok());
}

#[test]
fn hosts_code_is_complete() {
    let text = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p / iResolution.xy) + iMouse + dFdy(p.y); }";
    for (host, expected) in [
        (
            CHost::Slang,
            "[[vk::binding(1, 0)]] Texture2D iChannel0 : register(t1);",
        ),
        (
            CHost::Unity,
            "                c = iChannel0.Sample(iChannel0_sampler, p / iResolution.xy) + iMouse\n                    \
             + upward * ddy(p.y);",
        ),
    ] {
        let written = converted(host, text).unwrap();
        assert!(written.contains(expected), "{written}");
        assert!(!written.contains("//?") && !written.contains('$'), "{written}");
        assert!(written.lines().all(|line| line.trim_end() == line), "{written}");
        let hosted = host.hosted(&written, Stage::Image);
        assert!(
            !hosted.text.contains("#pragma") && !hosted.text.contains('$'),
            "{}",
            hosted.text
        );
        assert_eq!(hosted.upside_down, host == CHost::Unity);
    }
}

#[test]
fn adaptations_are_of_the_templates() {
    for host in CHost::ALL {
        for (code, _) in host.adaptations() {
            assert!(
                host.template().replace("$texture", "Texture2D").contains(code),
                "{code}"
            );
        }
        assert!(host.template().lines().all(|line| line.len() <= 130));
    }
}

#[test]
fn names_of_functions_and_macros_are_free() {
    let items = "struct S { float iTime; };";
    let written = with_items(
        items,
        "vec2 frac = fract(at);\nfloat mul = 2.;\nS s = S(mul);\ncolor.xy = frac * mul * s.iTime;",
    );
    assert_lines(
        &written,
        &[
            "float2 frac_1 = frac(at);",
            "float mul_1 = 2.0;",
            "S s = { mul_1 };",
            "color.xy = frac_1 * mul_1 * s.iTime_1;",
        ],
    );
}

#[test]
fn comments_do_not_continue() {
    let written = body("/* ascii\n \\o/ \\\n*/\ncolor.x = 1.; // C:\\ \ncolor.y = 2.;");
    assert!(written.lines().all(|line| !line.ends_with('\\')), "{written}");
    assert!(written.contains("color.x = 1.0; // C:\n"), "{written}");
}

#[test]
fn sides_of_products_are_evaluated_in_their_order() {
    let text = "float n = 0.; mat2 m() { n += 1.; return mat2(n); } vec2 v() { n *= 5.; return vec2(n); }\n\
        void mainImage(out vec4 c, in vec2 p) { c = vec4(m() * v(), p); }";
    assert!(converted(CHost::Hlsl, text).is_err());
}

#[test]
fn matrices_are_divided_column_by_column() {
    let written = body("mat2 m = mat2(at, at) / at.x;\nm /= at.y;\ncolor.xy = m[0];");
    assert_lines(
        &written,
        &[
            "float2x2 m = divide(float2x2(at, at), at.x);",
            "m = divide(m, at.y);",
            "color.xy = m[0];",
        ],
    );
}

/// The deadline is checked, and no step takes time beyond proportion: 20,000 terms of a constant.
#[test]
fn long_constants_are_folded_in_one_pass() {
    let text = format!(
        "void mainImage(out vec4 c, in vec2 p) {{ c = vec4({}); }}",
        vec!["1.0"; 20_000].join(" + ")
    );
    let written = converted(CHost::Hlsl, &text).unwrap();
    assert!(written.contains("1.0 + 1.0 + 1.0"), "{}", written.len());
}

#[test]
fn deep_statements_are_refused() {
    let arms = "else if (p.x > 3. && f() > 3.) c.x = 2.;\n".repeat(300);
    let text = format!(
        "float n = 0.; float f() {{ return ++n; }}\n\
         void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0); if (p.x > 9.) c.x = 1.;\n{arms} }}"
    );
    assert!(converted(CHost::Hlsl, &text).is_err());
}

#[test]
fn a_file_is_named_after_its_shader() {
    let mut files = Files::default();
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }";
    let file = files.add(File::new("shader", text));
    let checked = glsl::check(&files, file, &Options::default()).unwrap();
    let name = "class/a \"$texture0\".glsl";
    let written = write(
        &checked,
        &files,
        CHost::Unity,
        Title::of_shader(name),
        &Deadline::default(),
    )
    .unwrap();
    assert!(
        written.starts_with("Shader \"ShaderToy/a _$texture0_\" {\n"),
        "{written}"
    );
}

#[test]
fn glsl_stays_as_its_author_wrote_it() {
    let text = "// Waves\n#define COUNT 3\nfloat sum = 0.0;\nconst float W[2] = float[2](1., 2.);\n\
        vec4 tap(sampler2D image, vec2 uv) { return textureLod(image, uv, 0.); } // A tap\n\
        float size(vec2 color) { return color.x; }\n\
        void mainImage(out vec4 color, in vec2 at) {\n    mat2x3 m = mat2x3(1);\n    \
        for (int i = 0, j = 1; i < COUNT; i++, j += 2) sum += W[i & 1];\n    \
        color = tap(iChannel0, at / iResolution.xy) * (sum += 1., sum) + vec4(m[0] * size(at), dFdy(at.y));\n}";
    let written = converted(CHost::Glsl, text).unwrap();
    for expected in [
        "#version 300 es\n// Waves\n\nprecision highp float;\nprecision highp int;\n\nlayout(std140) uniform Inputs {\n",
        "    vec3 iResolution;\n    float iTime;\n",
        "uniform highp sampler2D iChannel0;\nlayout(location = 0) out vec4 outputColor;\n\nconst int COUNT = 3;\n",
        "float sum = 0.0;\nconst float W[2] = float[2](1.0, 2.0);\n",
        "vec4 tap(sampler2D image, vec2 uv) {\n    return textureLod(image, uv, 0.0);\n} // A tap\n",
        "    mat2x3 m = mat2x3(1);\n",
        "    for (int i = 0, j = 1; i < COUNT; i++, j += 2) {\n        sum += W[i & 1];\n    }\n",
        "    color = tap(iChannel0, at / iResolution.xy) * (sum += 1.0, sum)\n        + vec4(m[0] * size(at), dFdy(at.y));\n",
        "void main() {\n    vec4 color;\n    mainImage(color, gl_FragCoord.xy);\n    outputColor = vec4(color.rgb, 1.0);\n}\n",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn no_local_hides_a_generated_function_in_glsl() {
    let text = "void mainImage(out vec4 color, in vec2 at) { int remainder = int(at.x) % 3; float distance = at.x; \
        color = vec4(remainder) * distance; }";
    let written = converted(CHost::Glsl, text).unwrap();
    assert!(
        written.contains("int remainder = toyproof_remainder(int(at.x), 3);"),
        "{written}"
    );
    // GLSL allows names of built-in functions.
    assert!(written.contains("float distance = at.x;"), "{written}");
}

#[test]
fn glsl_is_read_again_with_bindings() {
    let text = "void mainImage(out vec4 color, in vec2 at) { color = texture(iChannel2, at) * iTime; }";
    let written = converted(CHost::Glsl, text).unwrap();
    let hosted = CHost::Glsl.hosted(&written, Stage::Image).text;
    for expected in [
        "#version 310 es\n",
        "layout(std140, set = 0, binding = 0) uniform Inputs {\n",
        "layout(set = 0, binding = 5) uniform highp texture2D toyproof_texture2;\n",
        "layout(set = 0, binding = 6) uniform highp sampler toyproof_sampler2;\n",
        "#define iChannel2 sampler2D(toyproof_texture2, toyproof_sampler2)\n",
    ] {
        assert!(hosted.contains(expected), "{expected}\n---\n{hosted}");
    }
}

#[test]
fn a_case_that_ends_in_a_jump_stays_as_it_is() {
    let text = "float f(int n) {\n    switch (n) {\n        case 1: return 0.1;\n        \
                case 2: { float x = float(n); return x; }\n        case 3: discard;\n        default: break;\n    }\n    \
                return 0.5;\n}\nvoid mainImage(out vec4 color, in vec2 at) { color = vec4(f(int(at.x))); }";
    let written = converted(CHost::Hlsl, text).unwrap();
    // Execution goes on after `discard` in HLSL.
    let expected = "        case 1:\n            return 0.1;\n        case 2: {\n            float x = float(n);\n            \
                    return x;\n        }\n        case 3:\n            discard;\n            break;\n";
    assert!(written.contains(expected), "{written}");
    let written = converted(CHost::Godot, text).unwrap().replace('\t', "    ");
    assert!(
        written.contains("switch (n) {\n        case 1:\n            return 0.1;\n"),
        "{written}"
    );
}
