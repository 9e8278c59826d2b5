use super::host::CHost;
use super::tests::{self, converted};

/// The file for Godot of a shader with these items and this image function, without its head.
fn for_godot(items: &str, statements: &str) -> String {
    let text = format!("{items}\nvoid mainImage(out vec4 color, in vec2 at) {{\n{statements}\n}}");
    let written = converted(CHost::Godot, &text).unwrap();
    let rest = written.split_once(";\n").map_or("", |(_, rest)| rest);
    assert!(!rest.contains("\n  "), "{rest}");
    rest.replace('\t', "    ")
}

#[track_caller]
fn assert_refused(items: &str, statements: &str, why: &str) {
    let text = format!("{items}\nvoid mainImage(out vec4 color, in vec2 at) {{\n{statements}\n}}");
    tests::assert_refused(CHost::Godot, &text, why);
}

#[test]
fn global_variables_are_parameters_in_godot() {
    let written = for_godot(
        "float glow = 0.5;\nint steps;\nconst float SCALE = 2.0;\n\
         float height(float x) { steps++; return x * SCALE / iResolution.x; }\n\
         float march(float x) { return height(x) + glow; }\nfloat bare(float x) { return x; }",
        "float glow_ = 1.0;\ncolor = vec4(march(at.x) + bare(gl_FragCoord.y), glow_, float(steps), 1.0);",
    );
    for expected in [
        "float height(float x, vec3 iResolution, inout int steps) {\n    steps++;\n",
        "float march(float x, vec3 iResolution, float glow, inout int steps) {\n    \
         return height(x, iResolution, steps) + glow;\n",
        "float bare(float x) {\n",
        "void mainImage(out vec4 color, vec2 at, vec3 iResolution, vec4 position) {\n    \
         float glow = 0.5;\n    int steps = 0;\n    float glow_ = 1.0;\n    \
         color = vec4(march(at.x, iResolution, glow, steps) + bare(position.y), glow_, float(steps),\n            1.0);\n",
        "    vec3 iResolution = vec3(size, 1.0);\n    vec4 position = vec4(fragCoord, FRAGCOORD.zw);\n",
        "    mainImage(color, fragCoord, iResolution, position);\n",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn a_global_variable_shadows_nothing_in_godot() {
    let written = for_godot(
        "float x = 1.0;\nfloat f() { { float x = 2.0; if (x > 3.0) return x; } return x++; }",
        "float y = f() + x;\nfloat x = y;\ncolor = vec4(x);",
    );
    // The parameter `x` of the function and the variable of its block are two; so are those of the image.
    for expected in [
        "float f(inout float x_1) {",
        "        float x = 2.0;",
        "    float x_1 = 1.0;\n    float y = f(x_1) + x_1;\n    float x = y;\n",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn what_would_change_its_meaning_is_refused_for_godot() {
    for (items, statements, why) in [
        (
            "float g;\nvoid f(out float x) { x = 1.0; g += x; }",
            "f(g);\ncolor = vec4(g);",
            "a global variable that is an `out` argument of a function that uses it",
        ),
        (
            "",
            "mat2x3 m = mat2x3(at.x);\ncolor = vec4(m[0], 1.0);",
            "this type",
        ),
    ] {
        assert_refused(items, statements, why);
    }
}

#[test]
fn switches_with_inner_jumps_are_chains_of_if_in_godot() {
    let written = for_godot(
        "float pick(int i) { switch (i + 1) { case 0: case 3: if (i > 2) return 1.0; break; \
         case 1: return 2.0; default: for (;;) { if (i > 4) break; i++; } if (i > 5) break; i = 7; } return float(i); }",
        "switch (int(at.x)) { case 0: color = vec4(1.0); break; default: color = vec4(0.0); }\ncolor += pick(int(at.y));",
    );
    for expected in [
        "    int selector = i + 1;\n    for (int once = 0; once < 1; once++) {\n        \
         if (selector == 0 || selector == 3) {\n            if (i > 2) {\n                return 1.0;\n",
        "        } else if (selector == 1) {\n            return 2.0;\n        } else {\n            for (;;) {\n",
        "            if (i > 5) {\n                break;\n            }\n            i = 7;\n        }\n    }\n    return float(i);",
        // Without jumps in blocks, it stays.
        "    switch (int(at.x)) {\n        case 0:\n            color = vec4(1.0);\n            break;\n        default:\n",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn godot_lacks_some_constructs_of_glsl() {
    let written = for_godot(
        "struct Ray { vec3 o; float t; };",
        "mat2 m = mat2(1, 2, 3, 4);\nmat2 n = -m;\nRay rays[2];\nvec3 b = vec3(at.x > 1.0, 1, at.y > 2.0);\n\
         float f[2] = float[2](1.0, 2.0);\nbool c = at.x > 1.0 ^^ at.y > 1.0;\nfloat s = mix(at.x, at.y, c);\n\
         int i = 0;\nswitch (i) { case 0: i = 3; default: i += 1; }\n\
         ivec3 k = ivec3(at.x);\nk = (k & 1) >> 2u;\nfor (i = 1; float(i) < at.x; i++) s += 1.0;\n\
         color = vec4(b, float(k.x) + rays[0].t + f[i] + s + n[0].x + texelFetch(iChannel0, ivec2(at), 0).x);",
    );
    for expected in [
        "mat2 m = mat2(vec2(1.0, 2.0), vec2(3.0, 4.0));",
        "mat2 n = -1.0 * m;",
        "        rays[index] = Ray(vec3(0.0), 0.0);\n",
        "vec3 b = vec3(float(at.x > 1.0), 1.0, float(at.y > 2.0));",
        "float f[2] = { 1.0, 2.0 };",
        "bool c = at.x > 1.0 != at.y > 1.0;",
        "float s = mixBool(at.x, at.y, c);",
        "k = (k & ivec3(1)) >> int(2u);",
        "    i = 1;\n    for (; (float(i) < at.x); i++) {\n",
        "uniform sampler2D iChannel0 : filter_linear, repeat_enable, hint_default_black;",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn constants_are_not_shadowed_in_godot_and_literals_are_folded() {
    let written = for_godot(
        "const float c = 0.5;\nfloat f(float c) { return c; }",
        "float d = c;\n{ float c = 2.0; d += c; }\nif (int(at.x) > max(35, 46)) d = 1.0;\n\
         mat3 m = mat3(mat2(at, at));\ncolor = vec4(f(d), m[2]);",
    );
    for expected in [
        "float f(float c_1) {\n    return c_1;\n",
        "        float c_1 = 2.0;\n        d += c_1;\n",
        "if (int(at.x) > 46) {",
        "mat3 to_mat3(mat2 x) {\n    return mat3(vec3(x[0], 0.0), vec3(x[1], 0.0), vec3(0.0, 0.0, 1.0));\n}\n",
        "mat3 m = to_mat3(mat2(at, at));",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn reserved_names_are_replaced_in_glsl_and_godot() {
    let text = "float a__b(float gl) { return gl; }\nvoid mainImage(out vec4 color, in vec2 at) { float __ = a__b(at.x); color = vec4(__); }";
    for host in [CHost::Glsl, CHost::Godot] {
        let written = converted(host, text).unwrap();
        assert!(written.contains("float a_b(float gl) {"), "{written}");
        assert!(written.contains("float unused_1 = a_b(at.x);"), "{written}");
    }
}

#[test]
fn godot_keeps_parentheses_of_binary_operators_only() {
    let written = for_godot(
        "",
        "float g = floor(at.x) + 1.0;\nfloat a = (g += 1.0) * 2.0;\nint i = 0;\n\
         while ((i += 1) < 5) a += 1.0;\nvec2 q = -(-at);\nfloat b = -(-a * 2.0) + - - a;\nuint u = 3u;\nu <<= 1;\n\
         mat2 m = mat2(a);\nq = q * -m;\nm = mat2(-m);\n\
         for (int j = 0, k = 5; j < k; j++, k--) b += 1.0;\ncolor = vec4(a, b, q.x, float(u) + (a - b) * 2.0);",
    );
    for expected in [
        "float a = float(g += 1.0) * 2.0;",
        "while (int(i += 1) < 5) {",
        "vec2 q = -vec2(-at);",
        "float b = -float(-a * 2.0) + -float(-a);",
        "u <<= uint(1);",
        "q = q * (-1.0 * m);",
        "m = (-1.0 * m);",
        "for (int j = 0, k = 5; j < k; j++, k--) {",
        "float(u) + (a - b) * 2.0);",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn small_numbers_keep_their_bits_in_godot() {
    let written = for_godot(
        "",
        "color = vec4(1e-20 * at.x, 0.001, 1.2345678e-12 * at.y, at.x);",
    );
    let expected =
        [1e-20_f32, 1.234_567_8e-12].map(|number| format!("uintBitsToFloat({:#010x}u)", number.to_bits()));
    let line = format!(
        "color = vec4({} * at.x, 0.001, {} * at.y,\n            at.x);",
        expected[0], expected[1]
    );
    assert!(written.contains(&line), "{line}\n---\n{written}");
}

#[test]
fn what_godot_would_misread_is_refused() {
    for (items, statements, why) in [
        (
            "int k(int n) { int a = 0; for (int i = 0; i < 5; i++) { switch (n) { case 7: a += 1; if (i > 3) break; \
             if (i > 2) continue; a += 3; break; default: a++; } a += 100; } return a; }",
            "color = vec4(k(int(at.x)));",
            "a `switch` with both `continue` and `break` inside blocks",
        ),
        (
            "struct M { float id; vec3 c[2]; };\nM gm;",
            "gm.id = 1.0;\ncolor = vec4(gm.id, gm.c[1]);",
            "an array in a structure without a value",
        ),
    ] {
        assert_refused(items, statements, why);
    }
}

#[test]
fn a_long_chain_of_calls_passes_globals_in_time() {
    let globals = (0..100).map(|at| format!("float g{at} = 1.0;\n"));
    let functions = (1..1000).map(|at| {
        let (before, global) = (at - 1, at % 100);
        format!("float f{at}() {{ g{global} += 1.0; return f{before}(); }}\n")
    });
    let first = "float f0() { return g0; }\n".to_owned();
    let lines: Vec<String> = globals.chain([first]).chain(functions).collect();
    let mut text = lines.concat();
    text += "void mainImage(out vec4 color, in vec2 at) { color = vec4(f999()); }";
    let written = converted(CHost::Godot, &text).unwrap();
    assert!(written.contains("float f0(float g0) {"));
    // Every function from the hundredth on uses all variables.
    let (_, after) = written.split_once("float f500(").unwrap();
    let (parameters, _) = after.split_once(") {").unwrap();
    assert_eq!(parameters.matches("inout float").count(), 100);
}

#[test]
fn godot_has_its_own_constants() {
    let written = for_godot(
        "#define PI 3.14159265359\n#define TAU 6.3\n",
        "color = vec4(sin(PI * at.x), cos(TAU * at.y), 0.0, 1.0);",
    );
    assert!(
        written.contains("vec4(sin(PI * at.x), cos(6.3 * at.y), 0.0, 1.0)"),
        "{written}"
    );
}
