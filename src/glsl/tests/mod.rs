//! Tests of the specification's rules: for each, code that keeps it and code that breaks it.

mod analysis;
mod dialects;
mod fixes;
mod limits;
mod recovery;

use toyproof_diagnostic::File;

use super::*;

const MAIN: &str = "void mainImage(out vec4 c, in vec2 f) { c = vec4(0.0); }\n";

fn check_text(text: &str, options: &Options) -> Result<Checked, Diagnostics> {
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    check(&files, file, options)
}

/// `ok`, or the code of the first error. Text that is not a function or declaration is wrapped as a
/// statement.
fn outcome(text: &str, options: &Options) -> String {
    let text = match text.strip_prefix("{") {
        Some(_) => format!("void test() {text}\n{MAIN}"),
        None if text.contains("mainImage") => text.to_owned(),
        None => format!("{text}\n{MAIN}"),
    };
    match check_text(&text, options) {
        Ok(_) => "ok".to_owned(),
        Err(all) => {
            let first = all
                .iter()
                .find(|diagnostic| diagnostic.severity == Severity::Error);
            first.map_or_else(|| "warnings only".to_owned(), |first| first.code.to_string())
        }
    }
}

/// Checks one case per line: the expected result, then the text. Two results as in `E0306/ok` are those of
/// `strict` and `lenient`.
fn cases(table: &str) {
    let strict = Options {
        dialect: Some(Dialect::ShaderToy),
        ..Options::default()
    };
    let lenient = Options {
        lenient: true,
        ..strict.clone()
    };
    let mut wrong = Vec::new();
    for line in table.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (wanted, text) = line.split_once(' ').unwrap();
        let both = wanted.split_once('/').unwrap_or((wanted, wanted));
        let text = text.trim_start();
        let found = (outcome(text, &strict), outcome(text, &lenient));
        if (found.0.as_str(), found.1.as_str()) != both {
            wrong.push(format!("{}/{} {text}", found.0, found.1));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn common_alone_is_compiled_but_not_linked_and_has_no_macro_of_the_site() {
    // The idiom of authors who name inputs in functions of Common.
    let text = "
        #ifndef HW_PERFORMANCE
        uniform float iTime;
        float defined_in_each_tab(vec2 p);
        #endif
        float scaled(vec2 p) { return iTime * defined_in_each_tab(p); }";
    let mut files = Files::default();
    let file = files.add(File::new("common.glsl", text));
    let options = Options {
        stage: Stage::Common,
        ..Options::default()
    };
    assert!(check_declarations(&files, file, &options).is_ok());
    let linked = format!("{text}\nvoid mainImage(out vec4 c, in vec2 p) {{ c = vec4(scaled(p)); }}");
    let file = files.add(File::new("image.glsl", linked));
    let errors = check(&files, file, &Options::default()).unwrap_err();
    assert!(errors.first().unwrap().message.contains("defined_in_each_tab"));
}

#[test]
fn grammar() {
    cases(
        "
        ok    { float a = 1., b; ; { } if (a < 1.) b = 2.; else { b = 3.; } }
        ok    { for (;;) { break; } for (int i = 0, j = 1; i < j; i++, j--) continue; while (bool b = false) { } do { } while (false); }
        ok    struct S { float a; }, s; float , x; void f() { vec2 , v = vec2(s.a, x); }
        ok    { highp float a; const mediump int b = 1; precision highp float; }
        ok    precision mediump float; precision lowp sampler2D;
        ok    const vec2 a = vec2(1), b = a.yx;
        ok    void f(void) { } void g() { f(void); f(); }
        ok    float f(highp vec2, const in float x, inout vec3 p[2]);
        ok    layout(location = 0) out vec4 color;
        ok    flat in int i; centroid in vec2 v; uniform float u; invariant out vec4 w;
        E0100 { float a = 1. }
        E0100 { if (true) else ; }
        E0105 { (1.; }
        E0105 void f( { }
        E0100 { float g(); }
        E0100/ok ;
        E0104 { float half = 1.; }
        E0104 { goto end; }
        E0100 { float float = 1.; }
        ok    struct A { int a; }; struct B { A a; }; struct C { B b; }; struct D { C c; }; D d;
        E0101/ok struct A { int a; }; struct B { A a; }; struct C { B b; }; struct D { C c; }; struct E { D d; };
        E0100 struct S { };
        E0100 struct S { struct T { int a; } t; };
        E0102 { float a = 1f; }
        E0102 { int a = 09; }
        E0103 { int a = 4294967296; }
        E0403 { highp const float a = 1.; }
        E0403 void f(in const float a) { }
        E0403 { uniform float a; }
        E0403 { in float a; }
        E0403 void f(uniform float a) { }
        E0403 const float f() { return 1.; }
        E0307 precision highp vec2;
        ok    invariant gl_FragDepth; out vec4 colors[2]; in mat3 m;
        E0307 in bool b;
        E0307 out mat3 m;
        E0403 { highp bool b; }
        E0403 struct S { int a; }; void f(lowp S s) { }
        E0403 uniform Block { float a; };
        E0100 void f(struct S { int a; } s) { }
        ",
    );
}

#[test]
fn scopes() {
    cases(
        "
        ok    { float a; { float a; } for (int a = 0; a < 1; a++) { } }
        ok    { float sin = 1.; float x = cos(sin); }
        ok    float f(float f) { return f; }
        ok    { float iTime = 1.; iTime += 1.; }
        ok    struct ray { vec3 o; }; void f() { ray ray; ray.o = vec3(0); }
        ok    { int x = 1; { int x = x; } }
        ok    { struct S { int a; }; S s = S(1); }
        ok    struct { float a; } s; void f() { s.a = 1.; }
        E0200 { a = 1.; }
        E0200 { { float a; } a = 1.; }
        E0200 { f(1.); }
        E0200 void f() { g(); } void g() { }
        E0200 { for (int i = 0; i < 1; i++) { } i = 0; }
        E0201 { float a; float a; }
        E0201 void f(float a) { float a; }
        E0201 void f(float a, float a) { }
        E0201 { for (int i = 0; i < 1; i++) { int i; } }
        E0201 float iTime;
        ok    float sin; struct cos { int a; };
        E0202 float sin; float f() { return sin(1.); }
        E0201/ok float sin(bool x) { return 1.; } void f() { sin(true); sin(1.); }
        E0201 void main() { }
        E0201 float f; void f() { }
        E0201 struct S { int a; }; float S(int a) { return 1.; }
        E0201 struct S { int a; int a; };
        E0201 { float gl_x; }
        E0202 { float x = test; }
        E0202 struct S { int a; }; void f() { S S; S(1); }
        E0202 { float a; a(); }
        ",
    );
}

#[test]
fn operators() {
    cases(
        "
        ok    { vec3 v = 2. * vec3(1) + vec3(1) / 2. - -vec3(1); mat3 m = mat3(1) * 2.; v = m * v; v = v * m; v *= m; }
        ok    { mat2x3 a; mat4x2 b; mat4x3 c = a * b; vec3 d = a * vec2(1); vec2 e = vec3(1) * a; }
        ok    { int a = 7 % 3 & 1 | 2 ^ 4; uvec2 b = uvec2(1) << 2; b >>= 1u; a = ~a; ivec2 c = ivec2(1) % 2; }
        ok    { bool a = 1 < 2 && 1u >= 2u || 1. > 2. ^^ !true; a = vec2(1) == vec2(2); a = mat2(1) != mat2(2); }
        ok    { int a[2]; int b[2]; bool c = a == b; a = b; }
        ok    struct S { vec2 a; }; bool f(S x, S y) { return x == y ? x != y : true; }
        ok    { float x = (1., 2.); int i; i++; --i; vec2 v; v++; v.x--; }
        E0300 { vec2 a = vec2(1) + vec3(1); }
        E0300/ok { float a = 1. + 1; }
        E0300/ok { vec2 a = vec2(1) * 2; }
        E0300 { bool a = true + false; }
        E0300 { float a = 1. % 2.; }
        E0300 { bool a = vec2(1) < vec2(2); }
        E0300/ok { bool a = 1 < 2.; }
        E0300/ok { bool a = 1 == 1.; }
        E0300 { bool a = 1 && true; }
        E0300 { bool a = !1; }
        E0300 { int a = 1 << ivec2(1); }
        E0300 { vec3 v; v *= mat2(1); }
        E0300 { float a; a += vec2(1); }
        E0300 { bool a = iChannel0 == iChannel1; }
        E0300 { mat2x3 a; mat2x3 b = a * a; }
        E0300 { bool b; b++; }
        E0301/ok { float a = 1; }
        E0301/ok { float a; a = 1; }
        E0301 { int a = 1.; }
        E0301 { vec2 a = vec3(1); }
        E0301 { if (1) { } }
        E0301 { while (1.) { } }
        E0301/ok { float a = true ? 1. : 1; }
        E0301 { float a = true ? 1. : vec2(1).xy; }
        E0301 { float a = 1. ? 1. : 2.; }
        E0307 { true ? test() : test(); }
        E0307/ok struct S { vec2 a; }; S f(bool b, S x, S y) { return b ? x : y; }
        E0307/ok { float a[2], b[2]; a = true ? a : b; }
        E0307 { texture(true ? iChannel0 : iChannel1, vec2(0)); }
        E0403 struct S { const int a; };
        E0307 void f(void a) { }
        E0307 { void a; }
        E0307 { sampler2D s; }
        E0307 void f(out sampler2D s) { }
        E0307 struct S { void a; };
        ",
    );
}

#[test]
fn access() {
    cases(
        "
        ok    { vec4 v; v.xyz = v.bgr; v.st = vec2(1); v.w = 1.; float a = v[3] + vec2(1).yx.x; int i; a = v[i]; }
        ok    { mat2x3 m; m[1] = vec3(1); m[1].x = m[0][2]; float a[3]; a[2] = 1.; int n = a.length(); }
        ok    struct S { float a[2]; vec2 b; }; void f(S s) { s.a[1] = s.b.x; }
        ok    { float a[iChannelTime.length()]; a[3] = 1.; }
        E0203 { vec2 v; v.z; }
        E0203 { vec2 v; v.xg; }
        E0203 { vec4 v; v.xyzwx; }
        E0203 { float a; a.x; }
        E0203 struct S { float a; }; void f(S s) { s.b; }
        E0203 { vec2 v; v.length(); }
        ok    uniform sampler2D s[2]; void f() { texture(s[1], vec2(0)); }
        E0401 uniform sampler2D s[2]; void f(int i) { texture(s[i], vec2(0)); }
        E0304 { float a[2]; a[2]; }
        E0304 { const int n = 3; vec3 v; v[n]; }
        E0304 { vec2 v; v[-1]; }
        E0304 { vec2 v; v[1.]; }
        E0304 { float a; a[0]; }
        E0304 { mat2 m; m[0][2]; }
        E0400 { 1. = 2.; }
        E0400 { vec2 v; v.xx = vec2(1); }
        E0400 { iTime = 1.; }
        E0400 { const float a = 1.; a = 2.; }
        E0400 void f(const in float a) { a = 1.; }
        E0400 { gl_FragCoord = vec4(1); }
        E0400 { float a; (a + 1.)++; }
        E0400 { test() = 1.; }
        ok    { gl_FragDepth = gl_FragCoord.z; bool b = gl_FrontFacing; vec2 p = gl_PointCoord; int n = gl_MaxDrawBuffers; }
        ok    void f(float a) { a = 1.; }
        ",
    );
}

#[test]
fn constants_and_arrays() {
    cases(
        "
        ok    const int n = 2; float a[n], b[n * 2 + int(2.5)], c[vec2(3, 4).y > 3. ? 1 : 2];
        ok    { const int n = 3; float a[n]; float b[] = float[](1., 2.); float[2] c = b; float[n] d = float[n](1., 2., 3.); }
        ok    const float a = sin(1.) + vec2(1, 2).y; const mat2 m = inverse(mat2(1, 2, 3, 4)); float b = a;
        ok    const float inf = 1. / 0.; const float a[2] = float[2](1., 2.); const float b = a[1];
        ok    struct S { int a; vec2 b; }; const S s = S(2, vec2(1)); float a[s.a];
        ok    float[3] f(float a[3]) { return a; }
        E0305 { float a[0]; }
        E0305 { float a[-1]; }
        E0305 { float a[1.]; }
        E0305 { int n = 1; float a[n]; }
        E0305 { float a[]; }
        E0305 { float a[65537]; }
        E0305 { float a[1 / 0]; }
        E0306/ok { float a[2][3]; }
        E0306/ok float[2] a[3];
        E0306/ok { float a[2][3]; float b[3] = a[1]; float c[2][2] = float[2][2](float[2](1., 2.), float[](3., 4.)); }
        E0306/E0301 { float a[2][3]; float b[2] = a[1]; }
        E0306/ok { float[3] a[2]; float b[3] = a[1]; }
        E0301 { float a[2] = float[](1., 2., 3.); }
        E0301/E0301 { float a[2] = float[2](1., true); }
        E0303 { float a[2] = float[2](1.); }
        E0303 { float a[2] = float[](); }
        E0401/ok float a = iTime;
        E0401/ok float f() { return 1.; } float a = f();
        E0401/ok float a = 1.; float b = a;
        E0401/ok { float a = iTime; const float b = a; }
        E0401/ok void f(const in float a) { const float b = a; }
        E0401/ok const float a = (1., 2.);
        E0402 const float a;
        E0402 { const float a; }
        E0403 uniform float a = 1.;
        E0307 void a[2];
        ",
    );
}

#[test]
fn constructors() {
    cases(
        "
        ok    { vec3 a = vec3(1); vec4 b = vec4(a, 1); b = vec4(vec2(1), vec2(2)); vec2 c = vec2(b); float d = float(b); int e = int(1.5); }
        ok    { mat2 a = mat2(1); a = mat2(1, 2, 3, 4); a = mat2(vec4(1)); a = mat2(vec2(1), vec2(2)); mat3 b = mat3(a); a = mat2(b); }
        ok    { vec4 a = vec4(mat2(1)); bvec2 b = bvec2(a); ivec3 c = ivec3(true, 1u, 2.); float d = float(mat2(1)); }
        ok    struct S { float a; vec2 b; }; S s = S(1., vec2(1));
        E0303 { vec3 a = vec3(1, 2); }
        E0303 { vec2 a = vec2(1, 2, 3); }
        E0303 { vec2 a = vec2(vec2(1), 1); }
        E0303 { vec2 a = vec2(); }
        E0303 { float a = float(1, 2); }
        E0303 { mat2 a = mat2(1, 2, 3); }
        E0303 { mat2 a = mat2(mat2(1), 1); }
        E0303 { vec2 a = vec2(iChannel0); }
        E0303 { void(1); }
        E0303 { sampler2D(1); }
        E0303 struct S { float a; }; S s = S();
        E0301/ok struct S { float a; }; S s = S(1);
        E0301 struct S { float a; }; S s = S(vec2(1));
        E0100 { float a = float; }
        ",
    );
}

#[test]
fn functions() {
    cases(
        "
        ok    float f(float a); float f(int a) { return 1.; } float f(float a) { return f(1); }
        ok    float f(float a) { if (a > 0.) return 1.; }
        ok    void f(out float a, inout vec2 b) { } void g() { vec3 v; float a[2]; f(v.x, v.yz); f(a[1], v.zx); }
        ok    float f(); float g(float x) { return x; }
        ok    void f() { return; }
        ok    void f(float) { } void g() { f(1.); }
        ok    { vec3 v; v = mod(vec3(1), 2.) + max(vec3(1), 0.) + mix(vec3(0), vec3(1), .5) + normalize(cross(v, v)); }
        ok    { float w; float f = modf(1.5, w); ivec2 a = abs(ivec2(1)); bvec2 b = lessThan(a, a); bool c = any(b); }
        ok    { uint a = packHalf2x16(vec2(1)); int b = floatBitsToInt(1.); float c = dFdx(1.) + outerProduct(vec2(1), vec3(1))[2].y; }
        ok    vec4 f(sampler2D s, vec2 p) { return texture(s, p) + textureLod(s, p, 0.) + texelFetch(s, ivec2(p), 0); } void g() { f(iChannel0, vec2(0)); }
        ok    { vec4 a = textureOffset(iChannel0, vec2(0), ivec2(1)) + textureGrad(iChannel0, vec2(0), vec2(0), vec2(0)); ivec2 b = textureSize(iChannel0, 0); }
        E0302/ok float f(float a) { return a; } void g() { f(1); }
        E0302 float f(float a) { return a; } void g() { f(); }
        E0302 float f(float a) { return a; } void g() { f(vec2(1)); }
        E0302 float f(float a) { return a; } float f(vec2 a) { return 1.; } void g() { f(vec3(1)); }
        E0302/ok { float a = sin(1); }
        E0302/ok { float a = max(1., 0); }
        E0302 { vec3 a = cross(vec2(1), vec2(1)); }
        E0302 { float a = dot(vec2(1), vec3(1)); }
        E0302 { int a = texture(iChannel0, 1.); }
        E0302 { bool a = lessThan(1., 2.); }
        E0308 float f() { }
        E0308 float f() { return; }
        E0308 void f() { return 1.; }
        E0308/ok float f() { return 1; }
        E0308 float f() { return vec2(1); }
        E0400 void f(out float a) { } void g() { f(1.); }
        E0400 void f(inout float a) { } void g() { f(iTime); }
        E0400 { modf(1.5, 1.); }
        E0400 void f(out vec2 a) { } void g() { vec2 v; f(v.xx); }
        E0401 { ivec2 o; textureOffset(iChannel0, vec2(0), o); }
        E0201 float f() { return 1.; } float f() { return 1.; }
        E0404 void f() { f(); }
        E0404 void g(); void f() { g(); } void g() { f(); }
        E0404 void a(); void b() { a(); } void c() { b(); } void a() { c(); } void d() { a(); c(); }
        ok    void a() { } void b() { a(); a(); } void c() { a(); b(); }
        E0405 void f(); void g() { f(); }
        E0406 float f(); int f() { return 1; }
        E0406 void f(in float a); void f(out float a) { }
        E0307 sampler2D f() { return iChannel0; }
        ",
    );
}

#[test]
fn jumps_and_switches() {
    cases(
        "
        ok    { switch (1) { case 0: case 1: break; default: discard; } switch (1u) { } }
        ok    { for (;;) { switch (1) { default: continue; } } }
        ok    { switch (1) { case 1: int a = 1; a++; case 2: a = 2; } }
        E0407 { switch (1.) { default: break; } }
        E0407 { switch (1) { discard; } }
        E0407 { switch (1) { case 1: break; case 1: break; } }
        E0407 { switch (1) { case -1: break; case 0xFFFFFFFF: break; } }
        E0407 { switch (1) { default: break; default: break; } }
        E0407 { switch (1) { case 1: } }
        E0407 { switch (1) { case 1: { case 2: break; } } }
        E0407 { case 1: ; }
        E0301 { switch (1) { case 1u: break; } }
        E0401 { int a; switch (1) { case a: break; } }
        E0408 { break; }
        E0408 { continue; }
        E0408 { switch (1) { default: continue; } }
        E0408 { if (true) break; }
        ",
    );
}

#[test]
fn main_image() {
    cases(
        "
        ok    void mainImage(out vec4 c, in vec2 f) { }
        ok    void mainImage(out vec4 c, vec2 f) { } void mainImage(float a) { }
        ok    void mainImage(inout vec4 c, const in vec2 f) { }
        E0409 void mainImage(out vec4 c, inout vec2 f) { }
        E0409 void mainImage(vec4 c, vec2 f) { }
        E0409 void mainImage(out vec3 c, in vec2 f) { }
        E0409 void mainImage(out vec4 c, in vec2 f);
        E0409 float f() { return 1.; } // mainImage
        E0409 float mainImage(out vec4 c, in vec2 f) { return 1.; }
        ",
    );
}

#[test]
fn channel_shapes_are_inferred_from_use() {
    let text = format!(
        "vec4 f(samplerCube s) {{ return textureLod(s, vec3(1), 0.); }}
         void g() {{ texture(iChannel1, vec3(1)); f(iChannel2); texture(iChannel3, vec3(1)); texelFetch(iChannel3, ivec3(1), 0); }} {MAIN}"
    );
    let checked = check_text(&text, &Options::default()).unwrap();
    let shapes = [
        SamplerShape::D2,
        SamplerShape::Cube,
        SamplerShape::Cube,
        SamplerShape::D3,
    ];
    assert_eq!(checked.channels, shapes);
    let reported = Options {
        channels: [Some(SamplerShape::D2); 4],
        ..Options::default()
    };
    assert!(check_text(&text, &reported).is_err());
    cases("E0302 { texture(iChannel0, vec3(1)); texture(iChannel0, vec2(1)); }");
}

#[test]
fn errors_have_their_line_and_their_macro() {
    let text =
        "#define BAD(x) (x + oops)\nvoid mainImage(out vec4 c, in vec2 f) {\n    c = vec4(BAD(1.));\n}\n";
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    let errors = check(&files, file, &Options::default()).unwrap_err();
    assert_eq!(
        toyproof_diagnostic::short(&errors[0], &files),
        "a:3:14: error[E0200]: `oops` is not declared"
    );
    assert_eq!(files.text(errors[0].related[0].0), "oops");
}

#[test]
fn each_error_is_reported_once() {
    let text = format!("void test() {{ float a = b.x + 1.; a = a * 2.; c = 1.; }} {MAIN}");
    let errors = check_text(&text, &Options::default()).unwrap_err();
    let reported: Vec<_> = errors.iter().map(|error| error.message.as_str()).collect();
    assert_eq!(reported, ["`b` is not declared", "`c` is not declared"]);
}

#[test]
fn lenient_conversions_and_initializers_are_explicit_in_the_tree() {
    use tree::{Constructor, ExprKind, VariableKind};
    let options = Options {
        lenient: true,
        ..Options::default()
    };
    let checked = check_text(&format!("float t = 2 * iTime; {MAIN}"), &options).unwrap();
    let tree = &checked.tree;
    let (_, t) = tree
        .variables
        .iter()
        .find(|(_, variable)| variable.name == "t")
        .unwrap();
    let initializer = t.initializer.unwrap();
    assert_eq!(t.kind, VariableKind::Global);
    assert!(!tree[initializer].constant);
    let ExprKind::Binary { left, .. } = tree[initializer].kind else {
        panic!("no product");
    };
    let scalar = Constructor::Scalar;
    assert!(matches!(tree[left].kind, ExprKind::Construct { constructor, .. } if constructor == scalar));
}

/// The notes of the errors of two tabs, Common first.
fn notes_of_tabs(common: &str, image: &str) -> Vec<Vec<String>> {
    let mut files = Files::default();
    let common = files.add(File::new("p/common.glsl", common));
    let image = files.add(File::new("p/image.glsl", image));
    let joined = files.join("image.glsl", &[common, image]);
    let errors = check(&files, joined, &Options::default()).unwrap_err();
    errors.iter().map(|error| error.notes.clone()).collect()
}

#[test]
fn an_error_in_a_macro_names_the_macro_and_its_definition() {
    let main = |statement: &str| format!("void mainImage(out vec4 c, in vec2 p) {{ {statement} }}");
    let in_common = |definition: &str, statement: &str| {
        notes_of_tabs(&format!("// library\n\n{definition}\n"), &main(statement))
    };
    let note = |name: &str, line: u32| {
        format!("in the expansion of the macro `{name}`, defined at p/common.glsl:{line}")
    };
    for (definition, statement) in [
        // In the text of the macro.
        ("#define F(v) bad(v)", "c = vec4(F(p.x));"),
        ("#define F vec3(1.0, 2.0)", "c = vec4(F, 1.0);"),
        // An operator of the macro joins an argument with its text.
        ("#define F(v) (v + vec3(1.0))", "c = vec4(F(p), 1.0);"),
        ("#define F(v) v.xyz", "c = vec4(F(p), 1.0);"),
        // The grammar.
        ("#define F(v) (v * )", "c = vec4(F(p.x));"),
    ] {
        let notes = in_common(definition, statement);
        assert!(notes[0].contains(&note("F", 3)), "{definition}: {notes:?}");
    }
    // The macro that contains the error, not the one that is used.
    let notes = in_common("#define G bad\n#define F(v) (v * G)", "c = vec4(F(p.x));");
    assert_eq!(notes[0].first(), Some(&note("G", 3)));
    // The definition in force.
    let notes = in_common("#define F 1.0\n#undef F\n#define F bad", "c = vec4(F);");
    assert_eq!(notes[0].first(), Some(&note("F", 5)));
    // One error for all uses.
    let twice = in_common("#define F(v) (v + vec3(1.0))", "c = vec4(F(p), F(p));");
    assert_eq!(twice.len(), 1, "{twice:?}");
    // An error outside of macros, and in an argument.
    for statement in ["c = vec4(bad);", "c = vec4(F(bad));", "c = vec4(bad * F(p.x));"] {
        let notes = in_common("#define F(v) (v)", statement);
        assert!(
            !notes.concat().concat().contains("the macro"),
            "{statement}: {notes:?}"
        );
    }
}
