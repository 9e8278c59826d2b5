//! Tests of the dialects: which shader is read as which, and what the rules of its version are.

use super::*;
use crate::tree;
use crate::tree::{ExprKind, Input, VariableKind};
use crate::{Dialect, UniformValue, Version};

fn read(text: &str, options: &Options) -> Result<Checked, Vec<String>> {
    let mut files = Files::default();
    let file = files.add(File::new("a.frag", text));
    check(&files, file, options).map_err(|errors| {
        let code = |error: &Diagnostic| format!("{} {}", error.code, error.message);
        errors.iter().map(code).collect()
    })
}

fn accepted(text: &str) -> Checked {
    read(text, &Options::default()).unwrap_or_else(|errors| panic!("{text}\n{errors:?}"))
}

/// The first error.
fn refused(text: &str) -> String {
    match read(text, &Options::default()) {
        Ok(_) => panic!("accepted: {text}"),
        Err(errors) => errors[0].clone(),
    }
}

#[test]
fn the_function_and_the_inputs_decide_the_dialect() {
    let dialect = |text| accepted(text).dialect;
    assert_eq!(dialect(MAIN), Dialect::ShaderToy);
    assert_eq!(
        dialect("void main() { gl_FragColor = vec4(1.0); }"),
        Dialect::WebGl
    );
    let book = "uniform vec2 u_resolution; void main() { gl_FragColor = vec4(gl_FragCoord.xy / u_resolution, 0.0, 1.0); }";
    assert_eq!(dialect(book), Dialect::BookOfShaders);
    let sandbox = "uniform float time; varying vec2 surfacePosition;
                   void main() { gl_FragColor = vec4(surfacePosition, sin(time), 1.0); }";
    assert_eq!(dialect(sandbox), Dialect::GlslSandbox);
    let terminal =
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(iCurrentCursor.xy / iResolution.xy, 0.0, 1.0); }";
    assert_eq!(dialect(terminal), Dialect::Ghostty);
    // A `main` that is not compiled is no `main`.
    let inactive = format!("#if 0\nvoid main() {{}}\n#endif\n{MAIN}");
    assert_eq!(dialect(&inactive), Dialect::ShaderToy);
    let options = Options {
        dialect: Some(Dialect::ShaderToy),
        ..Options::default()
    };
    assert!(
        read(book, &options)
            .unwrap_err()
            .iter()
            .any(|error| error.contains("ShaderToy"))
    );
}

#[test]
fn inputs_are_expressions_of_shadertoys() {
    let checked = accepted(
        "uniform vec2 u_resolution; uniform float u_time; uniform sampler2D u_tex1;
         void main() { gl_FragColor = texture2D(u_tex1, gl_FragCoord.xy / u_resolution) * u_time; }",
    );
    for input in [Input::Resolution, Input::Time] {
        assert!(checked.reads(input), "{input:?}");
    }
    let tree = &checked.tree;
    let reads = |kind: VariableKind| {
        let mut exprs = tree.exprs.iter();
        exprs.any(|(_, expr)| matches!(expr.kind, ExprKind::Variable(id) if tree[id].kind == kind))
    };
    assert!(reads(VariableKind::Channel(1)) && !reads(VariableKind::Uniform));
    // The names of other types and hosts are the author's own.
    let own = accepted("uniform vec3 u_time; void main() { gl_FragColor = vec4(u_time, 1.0); }");
    assert!(!own.reads(Input::Time));
}

#[test]
fn the_author_sets_other_uniforms() {
    let text = "uniform vec3 tint; uniform int count; uniform bool on; uniform mat2 turn;
                void main() { gl_FragColor = vec4(on ? tint * float(count) : vec3(0.0), turn[1].x); }";
    let value = |name: &str, components: &[f64]| UniformValue {
        name: name.to_owned(),
        components: components.to_vec(),
    };
    let mut options = Options {
        uniforms: vec![
            value("tint", &[1.0, -0.5, 0.0]),
            value("count", &[-3.0]),
            value("on", &[1.0]),
            value("turn", &[1.0, 0.0, 0.0, 1.0]),
        ],
        ..Options::default()
    };
    let checked = read(text, &options).unwrap();
    let mut exprs = checked.tree.exprs.iter();
    assert!(!exprs.any(|(_, expr)| {
        matches!(expr.kind, ExprKind::Variable(id) if checked.tree[id].kind == VariableKind::Uniform)
    }));
    // An edited text is checked alike.
    assert!(read(text, &checked.options()).is_ok());
    options.uniforms[1].components[0] = 1.5;
    let errors = read(text, &options).unwrap_err();
    assert!(errors[0].contains("`count` has the component 1.5"), "{errors:?}");
    options.uniforms[1].components[0] = -3.0;
    options.uniforms[0].components.pop();
    let errors = read(text, &options).unwrap_err();
    assert!(errors[0].contains("`tint` has 2 components"), "{errors:?}");
}

#[test]
fn glsl_es_1_has_its_own_words_functions_and_operators() {
    let body = |body: &str| format!("precision mediump float; {body}");
    let accept = |text: &str| accepted(&body(text));
    accept(
        "varying vec2 vUv; float round(float x) { return floor(x + 0.5); } void main() { gl_FragColor = vec4(round(vUv.x)); }",
    );
    accept(
        "float sample; float cross(vec2 a, vec2 b) { return a.x * b.y; } void main() { gl_FragData[0] = vec4(cross(vec2(1.0), vec2(2.0))); }",
    );
    accept("uniform float u_time; float global = u_time * 2.0; void main() { gl_FragColor = vec4(global); }");
    assert_eq!(accept("void main() {}").version, Version::Es100);
    for (text, wanted) in [
        ("void main() { int a = 5 % 2; }", "operator `%`"),
        ("void main() { float a = 1.0f; }", "suffix"),
        ("void main() { int a = ~1; }", "operator `~`"),
        ("void main() { float a = round(1.5); }", "round"),
        (
            "out vec4 color; void main() { color = vec4(1.0); }",
            "GLSL ES 1.00",
        ),
        ("void main() { float a[2] = float[2](1.0, 2.0); }", "constructor"),
        ("float sin(float x) { return x; } void main() {}", "sin"),
        ("attribute vec2 a; void main() {}", "vertex shader"),
        ("void main(float x) {}", "void main()"),
    ] {
        let error = refused(&body(text));
        assert!(error.contains(wanted), "{text}: {error}");
    }
}

#[test]
fn desktop_glsl_converts_and_has_lists() {
    let at =
        |version: &str, body: &str| format!("#version {version}\nout vec4 color; void main() {{ {body} }}");
    let accept = |version: &str, body: &str| accepted(&at(version, body)).version;
    assert_eq!(
        accept("330 core", "float x = 1; color = vec4(x / 2);"),
        Version::Desktop(330)
    );
    accept("430", "float a[2][2] = {{1, 2}, {3, 4}}; color = vec4(a[0][1]);");
    accept(
        "450",
        "vec3 v = {1.0, 2.0, 3.0}; float w[] = {1.0, 2.0,}; color = vec4(v, w[1]);",
    );
    assert!(refused(&at("300 es", "float x = 1;")).contains("int"));
    assert!(refused(&at("330", "float a[2] = {1.0, 2.0}; color = vec4(a[0]);")).starts_with("E0"));
    assert!(refused(&at("450", "vec3 v = {1.0, 2.0}; color = vec4(v, 1.0);")).contains("3 parts"));
    assert!(refused(&at("123", "")).contains("version"));
    // The constant of a uniform is its value.
    let checked = accepted(
        "#version 330\nuniform float speed = 2; out vec4 color; void main() { color = vec4(speed); }",
    );
    let mut exprs = checked.tree.exprs.iter();
    assert!(exprs.any(|(_, expr)| matches!(&expr.kind, ExprKind::Literal(literal) if literal.value == tree::Value::Float(2.0))));
}
