//! Tests of the passes that rewrite expressions.

use naga::front::glsl::{Frontend, Options};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::tests::{accepted, checked, fixes_miscompilation, fixes_rejection, lines, main_image, position};
use super::{Pass, Passes, lower_with};

#[test]
fn sampler_parameters() {
    let text = main_image(
        "vec4 f(sampler2D s, vec2 p) { return texture(s, p); }\n\
         vec4 g(vec2 p, sampler2D t) { return f(t, p) + f(t, p.yx); }",
        "o = g(p, iChannel0) + g(p, iChannel2) + f(iChannel0, p);",
    );
    let lowered = fixes_rejection(Pass::Samplers, &text);
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
    fixes_miscompilation(Pass::ShortCircuit, &text, early);
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
    fixes_rejection(
        Pass::MissingBuiltIns,
        &main_image("", "float i; o.x = modf(p.x, i) + i;"),
    );
    fixes_rejection(
        Pass::MissingBuiltIns,
        &main_image("", "mat2 m = matrixCompMult(mat2(p, p), mat2(1.0)); o.xy = m[0];"),
    );
    fixes_rejection(
        Pass::MissingBuiltIns,
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
    assert!(!metal(Passes::required().without(Pass::MissingBuiltIns)) && metal(Passes::required()));
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
        fixes_rejection(Pass::Geometric, &main_image("", &format!("o.x = {call};")));
    }
}

#[test]
fn is_nan_and_is_inf() {
    fixes_rejection(
        Pass::IsNan,
        &main_image("", "if (isnan(p.x) || any(isinf(p))) o = vec4(1.0);"),
    );
}

#[test]
fn texel_offsets() {
    let text = main_image("", "o = texelFetchOffset(iChannel0, ivec2(p), 0, ivec2(1, 2));");
    let lowered = fixes_miscompilation(Pass::Texels, &text, |wgsl| !wgsl.contains("2i"));
    assert!(
        lowered.contains("texelFetch(sampler2D(iChannel0, iChannel0_sampler), ivec2(p) + ivec2(1, 2), 0)"),
        "{lowered}"
    );
    fixes_rejection(
        Pass::Texels,
        &main_image(
            "",
            "const ivec2 d = ivec2(1, 2); o = textureOffset(iChannel0, p, d);",
        ),
    );
}

#[test]
fn matrix_constructors() {
    fixes_rejection(
        Pass::Matrices,
        &main_image("", "mat2 m = mat2(cos(p.x + vec4(0, 33, 11, 0))); o.xy = m * p;"),
    );
    fixes_rejection(
        Pass::Matrices,
        &main_image("", "mat2 m = mat2(vec3(p, 1.0), vec3(p, 2.0)); o.xy = m * p;"),
    );
}

#[test]
fn numbers_from_booleans() {
    fixes_rejection(
        Pass::Booleans,
        &main_image("", "vec3 v = vec3(p.x > 1.0); o.xyz = v;"),
    );
    fixes_rejection(
        Pass::Booleans,
        &main_image("", "bvec4 b = bvec4(p, p); vec2 v = vec2(b); o.xy = v;"),
    );
    fixes_rejection(
        Pass::Booleans,
        &main_image("", "bvec2 b = bvec2(p); float v = float(b); o.x = v;"),
    );
}

#[test]
fn swizzles_of_columns() {
    fixes_rejection(
        Pass::Swizzles,
        &main_image("", "mat3 m = mat3(1.0); m[1].x = p.x; o.xyz = m[1];"),
    );
    fixes_rejection(
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
fn indices_with_side_effects() {
    let text = main_image(
        "",
        "float a[3] = float[](1.0, 2.0, p.x); int i = 0; a[i++] += 5.0; o.x = a[i];",
    );
    let twice = |wgsl: &str| wgsl.matches("+ 1i").count() > 1;
    let lowered = fixes_miscompilation(Pass::Indices, &text, twice);
    assert!(
        lowered.contains("int toyproof_index = i++;\n    a[toyproof_index] += 5.0;"),
        "{lowered}"
    );
}

#[test]
fn indices_of_values_that_are_not_variables() {
    for body in [
        "o.x = (p.x > 3.0 ? p : p.yx)[int(p.y)];",
        "o.x = (p.x > 3.0 ? p : p.yx)[1];",
        "mat2 m = mat2(p, p), n; o.xy = (p.x > 3.0 ? m : n)[int(p.y)];",
        "mat2 m = mat2(p, p), n; o.x = (p.x > 3.0 ? m : n)[1][int(p.y)];",
        "mat2 m = mat2(p, p); o.x = m[0].yx[int(p.x)];",
        "mat2 m = mat2(p, p); o.x = m[int(p.y)].yx[int(p.x)];",
    ] {
        fixes_rejection(Pass::Indices, &main_image("", body));
    }
    fixes_rejection(
        Pass::Indices,
        &main_image(
            "float h(const in float x) { return x; }",
            "o.x = h((p.x > 3.0 ? p : p.yx)[1]);",
        ),
    );
    for body in [
        "o.x = f(p)[int(p.y)] + f(p).yx[int(p.y)] + g(p).a[int(p.y)] + g(p).v[int(p.y)] + g(p).v.yx[1];",
        "S s; o.x = (s = g(p)).a[int(p.y)] + (p, s).a[1] + (p.x, p.yx)[int(p.y)] + S(float[2](1.0, p.x), p).a[int(p.y)];",
        "o.x = (o.y, p.x > 3.0 ? p : p.yx)[int(p.y)];",
        "mat2 m[2]; m[1] = mat2(p, p); int i = 1; o.x = m[i--][0].yx[i];",
        "vec2 q = p; o.x = (q = p.yx)[int(p.y)] + (q += p).yx[int(p.y)] + (++q)[int(p.y)] + (-q)[int(p.y)] + (q * 2.0)[1];",
        "while ((p.x > 3.0 ? p : p.yx)[int(p.y)] > o.x) o.x += 1.0; o.y = p.x > 1.0 && p.yx[int(o.x) & 1] > 2.0 ? p.yx[int(o.x) & 1] : 0.0;",
    ] {
        let before = "struct S { float a[2]; vec2 v; }; vec2 f(vec2 p) { return p; } S g(vec2 p) { return S(float[2](p.x, p.y), p); }";
        accepted(&checked(&main_image(before, body), false));
    }
}

#[test]
fn compound_assignments() {
    // The indices are evaluated before the right side.
    assert_eq!(
        lines("", "int a[2]; int i = int(p.x); a[i] += i++; o.x = float(a[0]);"),
        "int[2] a;\nint i = int(p.x);\nint toyproof_index = i;\nint toyproof_value = i++;\na[toyproof_index] += toyproof_value;\n\
         o.x = float(a[0]);"
    );
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
    let lowered = fixes_miscompilation(Pass::Inequality, &text, |wgsl| wgsl.contains("!="));
    assert!(
        lowered.contains("!(p.x == p.y)") && lowered.contains("not(equal(p, p.yx))"),
        "{lowered}"
    );
    assert!(lines("", "o.x = float(int(p.x) != 1);").contains("int(p.x) != 1"));
}

#[test]
fn negation_of_unsigned_integers() {
    fixes_rejection(
        Pass::Negations,
        &main_image("", "uint u = uint(p.x); o.x = float(-u);"),
    );
}

#[test]
fn remainders() {
    fixes_rejection(
        Pass::Remainders,
        &main_image("", "uvec2 u = uvec2(p) % 3u; o.xy = vec2(u);"),
    );
    let text = main_image("", "int i = int(p.x) - 5; i %= 3; o.x = float(i);");
    fixes_miscompilation(Pass::Remainders, &text, |wgsl| {
        !wgsl.contains("toyproof_remainder")
    });
}

#[test]
fn out_arguments() {
    let f = "void f(inout float x) { x += 1.0; }\nstruct S { float a; vec2 b; };";
    fixes_rejection(
        Pass::OutArguments,
        &main_image(f, "vec2 q = p; f(q.x); o.xy = q;"),
    );
    fixes_rejection(
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
    fixes_rejection(Pass::Equality, &text);
    fixes_rejection(
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
        "o.x = length(vec3(1e20));",
        "o.x = 1.0 / (1e-30 * 1e-10);",
        "int i; o.x = float(1 << (i = 31));",
        "o.x = 1e38 * (o.y, 100.0);",
        "o.x = float(((o.y, uvec2(15) << 16).yx << 27).x);",
        "o = vec4(uvec4(2147483648u) << uvec4(vec4(-7.5, 0.5, 1.0, 8388608.5)));",
    ] {
        fixes_rejection(Pass::Constants, &main_image("", body));
    }
    fixes_rejection(
        Pass::Constants,
        &main_image("const float INF = 1.0 / 0.0;", "o.x = INF;"),
    );
}

#[test]
fn functions_of_constants_have_the_evaluators_values() {
    let quarter = main_image("", "o.x = sin(3.14159265 / 4.0);");
    fixes_miscompilation(Pass::Folding, &quarter, |wgsl| !wgsl.contains("0.7071068f"));
    let literals = lines(
        "",
        "o.xy = vec2(cos(3.14159265 / 4.0), -sin(0.5) + p.x) + normalize(vec2(3.0, -4.0)) * float(int(p.x));",
    );
    assert_eq!(
        literals,
        "o.xy = vec2(0.70710677, -0.47942555 + p.x) + vec2(0.6, -0.8) * float(int(p.x));"
    );
}

#[test]
fn members_of_structures() {
    let arrays = "struct S { float a[2]; vec2 b; };";
    fixes_rejection(
        Pass::Members,
        &main_image(arrays, "S s = S(float[](p.x, 2.0), p); o.x = s.a[1];"),
    );
    fixes_rejection(
        Pass::Members,
        &main_image(
            arrays,
            "S s; s.a = float[](p.x, 2.0); float a[2] = s.a; o.x = a[1];",
        ),
    );
    let matrix =
        "struct M { mat2 m; float x; }; M f(mat2 m) { return M(m, 1.0); } void g(inout mat2 m) { m *= 2.0; }";
    let lowered = fixes_rejection(
        Pass::Members,
        &main_image(
            matrix,
            "M a = f(mat2(p, p)); a.m *= 3.0; a.m[1].x = 4.0; g(a.m); M b = a; o.xy = a.m * p + f(b.m).m[0]; if (a == b) o.z = 1.0;",
        ),
    );
    assert!(lowered.contains("vec2[2] m;"), "{lowered}");
    for body in [
        "S s; s.m[2] = mat2(p, p); o = s.m[2][0].xyxy;",
        "S s = S(mat2[3](mat2(p, p), mat2(1.0), mat2(2.0)), bvec4[2](bvec4(true), bvec4(false)), bvec3[2](bvec3(true), bvec3(false)), \
         mat3x2[1](mat3x2(1.0))); o.x = s.m[1][int(p.x)].y + float(s.b[1].x);",
        "S s, t; bool e = s == t || s.m == t.m || s.b == t.b || s.b != bvec4[2](bvec4(true), bvec4(false)); o.x = float(e);",
        "S s[2]; int i = int(p.x) & 1; s[i].m[i] *= 2.0; s[i].m[i + 1][i] = p; s[i].m[i][1].x += p.y; mat2 m[3] = s[i].m; s[1].m = m; \
         f(s[0].m); g(s[i].m[1]); mat2 old = s[0].m[1]++; o.xy = old[0] + (s[0].m[2]--)[1] + s[0].m[0] * p + s[i].n[0] * vec3(p, 1.0);",
        "for (int i = 0; i < 2; i++) { N n; o.x += n.s[i].m[i][0].x; n.s[i] = n.s[0]; N k = N(n.s); o.y += k.s[1].m[0][1].y; }",
    ] {
        let before = "struct S { mat2 m[3]; bvec4 b[2]; bvec3 c[2]; mat3x2 n[1]; }; struct N { S s[2]; }; \
                      void f(inout mat2 m[3]) { m[1][0] = vec2(3.0); } void g(inout mat2 m) { m *= 2.0; }";
        fixes_rejection(Pass::Members, &main_image(before, body));
    }
    accepted(&checked(
        &main_image(arrays, "for (int i = 0; i < 2; i++) { S s; o.x += s.a[i]; }"),
        false,
    ));
}
