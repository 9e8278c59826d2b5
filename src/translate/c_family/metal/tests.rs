use crate::c_family::WriteFailure;
use crate::c_family::host::CHost;
use crate::c_family::tests::{self, assert_lines};

fn converted(text: &str) -> Result<String, WriteFailure> {
    tests::converted(CHost::Metal, text)
}

fn shader(items: &str, statements: &str) -> String {
    format!("{items}\nvoid mainImage(out vec4 color, in vec2 at) {{\ncolor = vec4(0);\n{statements}\n}}")
}

/// The Metal of a shader with these items whose image function has this body, of that body.
fn with_items(items: &str, statements: &str) -> String {
    let written = converted(&shader(items, statements)).unwrap();
    let (_, body) = written
        .split_once("        color = float4(0);\n")
        .unwrap_or_else(|| panic!("{written}"));
    let (body, _) = body
        .split_once("\n    }\n};")
        .unwrap_or_else(|| panic!("{written}"));
    body.to_owned()
}

#[track_caller]
fn assert_refused(items: &str, statements: &str, why: &str) {
    tests::assert_refused(CHost::Metal, &shader(items, statements), why);
}

fn body(statements: &str) -> String {
    with_items("", statements)
}

#[test]
fn only_what_has_state_is_in_the_structure() {
    let items = "// Waves\n\n#define STEPS 8\nconst float SCALE = .5;\nconst vec3 SUN = vec3(1, .9, .8) * 2.;\n\
        float seed; // of all\n// Noise\nfloat noise(vec2 p) { return p.x * SCALE; }\n\
        float noise(vec3 p) { return p.x + iTime; }\nfloat both(vec2 p) { return noise(p); }\n\
        float next() { return seed++; }\nfloat square(float x) { return x * x; }\n";
    let statements = "for (int i = 0; i < STEPS; i++) color += next() + both(at) + noise(color.xyz) + square(at.x);\n\
        color.xyz *= SUN;";
    let written = converted(&shader(items, statements)).unwrap();
    for expected in [
        "// Waves\n\n#include <metal_stdlib>\nusing namespace metal;\n\nconstant int STEPS = 8;\n\n\
         constant float SCALE = 0.5;\n\n",
        // Overloads stay together, and what calls them; the value of `SUN` is computed.
        "float square(float x) {\n    return x * x;\n}\n\nstruct Shader {\n    float iTime;\n\n    \
         float3 SUN = float3(1, 0.9, 0.8) * 2.0;\n    float seed = 0.0; // of all\n\n    // Noise\n    float noise(float2 p) {\n",
        "    void mainImage(thread float4& color, float2 at) {\n",
        "struct Inputs {\n    packed_float3 iResolution;\n    float iTime;\n",
        "fragment float4 main_(\n    constant Inputs& inputs [[buffer(0)]],\n    float4 position [[position]]\n) {\n    \
         Shader shader = {\n        inputs.iTime,\n    };\n    float4 color;\n    \
         // Row 0 of the target is the bottom of the image, as in ShaderToy.\n    shader.mainImage(color, position.xy);\n    \
         return float4(color.xyz, 1.0);\n}\n",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
    assert!(
        !written.contains("gl_FragCoord") && !written.contains("texture2d"),
        "{written}"
    );
}

#[test]
fn a_shader_without_state_has_the_structure_too() {
    let written = converted("void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0, 1); }").unwrap();
    assert!(
        written.contains("struct Shader {\n    void mainImage(thread float4& c, float2 p) {\n"),
        "{written}"
    );
    assert!(
        written
            .contains("fragment float4 main_(\n    float4 position [[position]]\n) {\n    Shader shader;\n"),
        "{written}"
    );
    assert!(!written.contains("Inputs"), "{written}");
}

#[test]
fn matrices_are_those_of_glsl() {
    let written = body(
        "mat2 m = mat2(1, 2, at);\nat *= m;\nat = m * at;\nm *= m * 2.;\nm /= at.x;\nm = m + 1. - mat2(3);\nm += m;\n\
         m = -m;\nif (m == mat2(1) || m != m) color.x = m[1].x;\ncolor.xyz = mat3(m)[0] + mat3(mat4(1))[1];",
    );
    assert_lines(
        &written,
        &[
            "float2x2 m = float2x2(float2(1, 2), at);",
            "at = at * m;",
            "at = m * at;",
            "m = m * (m * 2.0);",
            "m = matrixDivide(m, at.x);",
            "m = matrixAdd(m, 1.0) - float2x2(3);",
            "m = m + m;",
            "m = m * -1.0;",
            "if (matrixEqual(m, float2x2(1)) || !matrixEqual(m, m)) {",
            "color.x = m[1].x;",
            "}",
            "color.xyz = to_float3x3(m)[0] + to_float3x3(float4x4(1))[1];",
        ],
    );
}

#[test]
fn constructors_state_the_parts_of_vectors() {
    let written = body(
        "ivec2 c = ivec2(color);\nvec3 v = vec3(c, at.x);\nvec2 b = vec2(color) + vec2(v) + vec2(lessThan(at, v.xy));\n\
         vec4 d = vec4(at, c);\ncolor = vec4(v, b + float(c) + d.xy);",
    );
    assert_lines(
        &written,
        &[
            "int2 c = int2(color.xy);",
            "float3 v = float3(float2(c), at.x);",
            "float2 b = color.xy + v.xy + float2(at < v.xy);",
            "float4 d = float4(at, float2(c));",
            "color = float4(v, (b + float(c.x) + d.xy).x);",
        ],
    );
}

#[test]
fn structures_and_arrays_are_values() {
    let items = "struct Ray { vec3 o; vec2 d[2]; };\nconst Ray FIRST = Ray(vec3(1), vec2[2](vec2(0), vec2(1)));\n\
        float[2] pair(float x) { return float[2](x, 1.); }";
    let written = with_items(
        items,
        "Ray r = Ray(vec3(at, 1), vec2[2](at, at));\nRay rays[2] = Ray[2](r, FIRST);\nRay none;\nfloat large[99];\n\
         r = rays[1];\ncolor.x = pair(at.x)[1] + float[2](1., at.y)[int(at.x)] + none.o.x + large[3];\n\
         if (rays[0] == r) color.y = float(large.length());",
    );
    assert_lines(
        &written,
        &[
            "Ray r = { float3(at, 1), array<float2, 2>{ at, at } };",
            "array<Ray, 2> rays = { r, FIRST };",
            "Ray none = {};",
            "array<float, 99> large = {};",
            "r = rays[1];",
            "color.x = pair(at.x)[1] + array<float, 2>{ 1.0, at.y }[int(at.x)] + none.o.x + large[3];",
            "if (equal(rays[0], r)) {",
            "color.y = float(99);",
            "}",
        ],
    );
}

#[test]
fn functions_have_the_names_of_metal() {
    let written = body(
        "float a = inversesqrt(at.y) + atan(at.y, at.x) + dFdx(at.x) + roundEven(at.x) + round(at.y) + radians(at.x);\n\
         bvec2 b = lessThan(at, vec2(.5));\nif (all(not(b)) ^^ at == vec2(1)) color = vec4(sign(int(a)));\n\
         color *= mod(a, 2.) + intBitsToFloat(floatBitsToInt(a)) + dot(a, 2.) + length(a) + distance(a, a + 1.);\nat = mix(at, vec2(1), b) + max(at, 0.);",
    );
    assert_lines(
        &written,
        &[
            "float a = rsqrt(at.y) + atan2(at.y, at.x) + dfdx(at.x) + rint(at.x) + rint(at.y) + radians(at.x);",
            "bool2 b = at < float2(0.5);",
            "if (all(!b) != all(at == float2(1))) {",
            "color = float4(signOf(int(a)));",
            "}",
            "color *= mod(a, 2.0) + as_type<float>(as_type<int>(a)) + a * 2.0 + abs(a) + abs(a - (a + 1.0));",
            "at = select(at, float2(1), b) + max(at, 0.0);",
        ],
    );
}

#[test]
fn lookups_are_methods() {
    let written = body(
        "color += texture(iChannel0, at) + texture(iChannel0, at, 1.) + textureLod(iChannel0, at, 2.);\n\
         color += textureGrad(iChannel0, at, at, at) + textureGrad(iChannel1, color.xyz, at.xxy, at.xyx);\n\
         color += texelFetch(iChannel0, ivec2(at), 0) + textureLodOffset(iChannel0, at, 0., ivec2(1, 0));\n\
         color.x += float(textureSize(iChannel0, 0).x);",
    );
    assert_lines(
        &written,
        &[
            "color += iChannel0.sample(iChannel0_sampler, at) + iChannel0.sample(iChannel0_sampler, at, bias(1.0)) \
             + iChannel0.sample(iChannel0_sampler, at, level(2.0));",
            "color += iChannel0.sample(iChannel0_sampler, at, gradient2d(at, at)) \
             + iChannel1.sample(iChannel1_sampler, color.xyz, gradientcube(at.xxy, at.xyx));",
            "color += texelFetch(iChannel0, int2(at), 0) + iChannel0.sample(iChannel0_sampler, at, level(0.0), int2(1, 0));",
            "color.x += float(textureSize(iChannel0, 0).x);",
        ],
    );
}

#[test]
fn references_are_bound_to_variables_members_and_elements() {
    let items = "struct S { vec2 v; float a[2]; };\nfloat g;\nvoid turn(inout vec2 v) { v = v.yx; }\n\
        bool put(out float x) { x = 1.; return true; }\nvoid alias(inout float x) { x = g; g = 2.; }";
    let written = with_items(
        items,
        "S s;\nmat2 m = mat2(1);\nturn(at);\nturn(s.v);\nturn(m[1]);\nput(s.a[1]);\nturn(color.xz);\nalias(g);\n\
         if (at.x > 1. && put(at.y)) color.x = s.a[1] + m[1].x + s.v.x;",
    );
    assert_lines(
        &written,
        &[
            "S s = {};",
            "float2x2 m = float2x2(1);",
            "turn(at);",
            "turn(s.v);",
            "turn(m[1]);",
            "put(s.a[1]);",
            // Swizzles have no address, and a function that names a global variable must not see its own
            // writes.
            "float2 argument_1 = color.xz;",
            "turn(argument_1);",
            "color.xz = argument_1;",
            "float argument_2 = g;",
            "alias(argument_2);",
            "g = argument_2;",
            "bool result = false;",
            "float argument_3 = 0.0;",
            "if (at.x > 1.0 && (result = put(argument_3), at.y = argument_3, result)) {",
            "color.x = s.a[1] + m[1].x + s.v.x;",
            "}",
        ],
    );
}

#[test]
fn conditions_with_effects_stay() {
    let items = "float count = 0.; float next() { return ++count; }";
    let written = with_items(
        items,
        "float a = at.x > 1. ? next() : 2.;\nwhile (at.x > 1. && next() < 3.) at.x -= 1.;\n\
         for (int i = 0; i < 3 || next() > 9.; i++, at.y++) if (a > 1.) break;",
    );
    assert_lines(
        &written,
        &[
            "float a = at.x > 1.0 ? next() : 2.0;",
            "while (at.x > 1.0 && next() < 3.0) {",
            "at.x -= 1.0;",
            "}",
            "for (int i = 0; i < 3 || next() > 9.0; i++, at.y++) {",
            "if (a > 1.0) {",
            "break;",
            "}",
            "}",
        ],
    );
}

#[test]
fn discard_leaves_the_function() {
    let items = "struct S { float a; };\nS make(float x) { if (x < 0.) discard; return S(x); }\n\
        vec2 pair(float x) { if (x < 0.) discard; return vec2(x); }";
    let written = converted(&shader(
        items,
        "if (at.x > 9.) discard;\ncolor.x = make(at.x).a + pair(at.y).x;",
    ))
    .unwrap();
    for expected in [
        "        discard_fragment();\n        return S{};\n",
        "        discard_fragment();\n        return float2(0.0);\n",
        "            discard_fragment();\n            return;\n",
    ] {
        assert!(written.contains(expected), "{written}");
    }
}

#[test]
fn hashes_of_integers_wrap() {
    let written = body(
        "int n = int(at.x);\nn = (n << 13) ^ n;\nn = n * (n * n * 15731 + 789221) - -1376312589;\nn *= 16807;\n\
         ivec2 c = ivec2(at) * 73856093 + 1;\nint k = n * 3 + 7;\nuint u = uint(n) * 15731u;\ncolor.x = float(n + k + c.x + int(u));",
    );
    assert_lines(
        &written,
        &[
            "int n = int(at.x);",
            "n = n << 13 ^ n;",
            "n = int(uint(n) * (uint(n) * uint(n) * 15731u + 789221u) - uint(-1376312589));",
            "n = int(uint(n) * 16807u);",
            "int2 c = int2(uint2(int2(at)) * 73856093u + 1u);",
            "int k = n * 3 + 7;",
            "uint u = uint(n) * 15731u;",
            "color.x = float(n + k + c.x + int(u));",
        ],
    );
}

#[test]
fn names_of_metal_are_free() {
    let items = "struct halfs { float packed_float3; };\nstruct kernel { float a; };\nfloat saturate(float x) { return x; }\nfloat main_(float x) { return x; }\n\
        const float M_PI_F = 3.;\nconst float INFINITY = 9.;\n#define NAN 4.\nfloat Shader = 2.;\nfloat a__b(float x) { return x; }";
    let written = converted(&shader(
        items,
        "halfs h = halfs(kernel(1.).a);\nfloat thread = saturate(h.packed_float3);\nfloat level = main_(M_PI_F) + a__b(INFINITY) + NAN;\n\
         color.x = thread + level + Shader;",
    ))
    .unwrap();
    for expected in [
        "struct halfs {\n    float packed_float3_1;\n};\n\nstruct kernel_1 {",
        "float thread_1 = saturate_1(h.packed_float3_1);",
        "float level_1 = main_1(M_PI_F_1) + a_b(INFINITY_1) + 4.0;",
        "    float Shader_1 = 2.0;\n",
    ] {
        assert!(written.contains(expected), "{expected}\n---\n{written}");
    }
}

#[test]
fn what_metal_evaluates_in_another_order_is_left_to_naga() {
    assert_refused(
        "",
        "int i = 0;\nfloat a[3];\na[i++] = float(i);\ncolor.x = a[0];",
        "sides affect each other",
    );
    assert_refused(
        "",
        "int i = 0;\nint a[3];\na[i] = i++;\ncolor.x = float(a[0]);",
        "sides affect each other",
    );
    assert_lines(
        &body("color.zyx.xz = at.yx.xx;\ncolor.rgb.gr.x = iResolution.xy.y;"),
        &["color.zx = at.yy;", "color.y = iResolution.y;"],
    );
    assert_refused("", "at.yx[int(color.x)] = 1.;", "an element of a swizzle");
    assert_refused("", "color.xy = at++;", "`++` or `--` of a vector");
    assert_lines(
        &body("at++;\ncolor.xy = --at;"),
        &["at += 1.0;", "color.xy = at -= 1.0;"],
    );
    // A call that changes nothing may name the index.
    let items = "float hash(int x) { return float(x); }";
    let written = with_items(items, "int i = 0;\nfloat a[3];\na[i] = hash(i);\ncolor.x = a[0];");
    assert!(written.contains("a[i] = hash(i);"), "{written}");
}

#[test]
fn infinities_have_a_name() {
    let written = body("color.x = 1e40 * at.x;\ncolor.y = -3e38;");
    assert_lines(&written, &["color.x = INFINITY * at.x;", "color.y = -3.0e38;"]);
}

#[test]
fn a_table_of_constants_may_be_long() {
    let values = vec!["1.0"; 300].join(", ");
    let written = with_items(
        &format!("const float w[300] = float[]({values});\nfloat fast(float x) {{ return x; }}"),
        "color.x = w[int(at.x)] + fast(at.y);",
    );
    assert!(
        written.contains("color.x = w[int(at.x)] + fast_1(at.y);"),
        "{written}"
    );
}
