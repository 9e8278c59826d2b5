//! Shaders of other hosts than ShaderToy work in the commands, and are compared with those of any host.

use std::fs;

use serde_json::Value;

use crate::program::{Run, toyproof};

const SHADERTOY: &str = "void mainImage(out vec4 color, in vec2 position) {
    vec2 st = position / iResolution.xy;
    color = vec4(st, 0.5 + 0.5 * sin(2.0 * iTime), 1.0);
}
";

/// The same image by The Book of Shaders.
const BOOK: &str = "#ifdef GL_ES
precision mediump float;
#endif
uniform vec2 u_resolution;
uniform float u_time;
uniform float speed;
void main() {
    vec2 st = gl_FragCoord.xy / u_resolution;
    gl_FragColor = vec4(st, 0.5 + 0.5 * sin(speed * u_time), 1.0);
}
";

/// The same image in desktop GLSL.
const DESKTOP: &str = "#version 330 core
in vec2 TexCoords;
out vec4 FragColor;
uniform float iTime;
uniform float speed = 2;
void main() {
    FragColor = vec4(TexCoords, 0.5 + sin(speed * iTime) / 2, 1);
}
";

fn in_folder(arguments: &[&str]) -> Run {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("toy.glsl", SHADERTOY),
        ("book.frag", BOOK),
        ("desktop.frag", DESKTOP),
        ("wrong.frag", &BOOK.replace("0.5 + 0.5", "0.5 - 0.5")),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    toyproof(folder.path(), arguments)
}

fn record(run: &Run) -> Value {
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    report["shaders"][0].clone()
}

fn compared(shader: &str, reference: &str, uniform: &str) -> Value {
    let check = [
        "check",
        shader,
        "--reference",
        reference,
        "--uniform",
        uniform,
        "--time",
        "0.3",
    ];
    let frame = ["--size", "64x36", "--device", "cpu", "--format", "json"];
    record(&in_folder(&[&check[..], &frame].concat()))
}

#[test]
fn a_shader_is_compared_with_a_reference_in_another_dialect() {
    let book = compared("book.frag", "toy.glsl", "speed=2");
    assert_eq!(book["verdict"], "correct", "{book}");
    assert_eq!(book["dialect"]["host"], "book-of-shaders");
    assert_eq!(book["dialect"]["version"], "GLSL ES 1.00");
    let desktop = compared("desktop.frag", "book.frag", "speed=2");
    assert_eq!(
        (&desktop["verdict"], &desktop["dialect"]["version"]),
        (&"correct".into(), &"GLSL 3.30".into())
    );
    assert_eq!(compared("book.frag", "toy.glsl", "speed=3")["verdict"], "wrong");
}

#[test]
fn a_mistake_is_repaired_in_the_shaders_own_dialect() {
    let wrong = compared("wrong.frag", "toy.glsl", "speed=2");
    assert_eq!(wrong["verdict"], "wrong");
    assert_eq!(
        (&wrong["fix"]["line"], &wrong["fix"]["agreeing"]),
        (&9.into(), &2304.into()),
        "{wrong}"
    );
}

#[test]
fn a_uniform_without_a_value_and_another_dialect_are_reported() {
    let unset = record(&in_folder(&[
        "check",
        "book.frag",
        "--size",
        "8x8",
        "--device",
        "cpu",
        "--format",
        "json",
    ]));
    let codes: Vec<&Value> = unset["diagnostics"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| &one["code"])
        .collect();
    assert_eq!(
        (&unset["verdict"], &codes[..]),
        (&"ok".into(), &[&Value::from("W0030")][..])
    );
    let refused = in_folder(&["check", "book.frag", "--dialect", "shadertoy", "--device", "cpu"]);
    assert!(
        refused.stderr.contains("`main` is reserved for ShaderToy"),
        "{refused:?}"
    );
    let unknown = in_folder(&["check", "book.frag", "--dialect", "isadora"]);
    assert_eq!(unknown.code, 2);
    assert!(
        unknown.stderr.contains("expected auto, shadertoy, ghostty"),
        "{unknown:?}"
    );
    let malformed = in_folder(&["run", "book.frag", "--uniform", "speed"]);
    assert!(
        malformed.code == 2 && malformed.stderr.contains("such as color=1,0,0.5"),
        "{malformed:?}"
    );
    let misspelled = in_folder(&[
        "check",
        "book.frag",
        "--uniform",
        "sped=2",
        "--size",
        "8x8",
        "--device",
        "cpu",
    ]);
    let warning = "the shader declares no uniform `sped`, whose value is given";
    assert!(
        misspelled.stderr.contains(warning) && misspelled.stderr.contains("did you mean `speed`?"),
        "{misspelled:?}"
    );
    let verbose = in_folder(&["check", "desktop.frag", "--size", "8x8", "--device", "cpu", "-v"]);
    assert!(
        verbose.stdout.contains("dialect: WebGL, GLSL 3.30"),
        "{verbose:?}"
    );
}

#[test]
fn a_shader_of_another_host_is_converted_with_a_proof() {
    for shader in ["book.frag", "desktop.frag"] {
        let run = in_folder(&[
            "convert",
            shader,
            "-o",
            "out.wgsl",
            "--verify",
            "--uniform",
            "speed=2",
        ]);
        assert!(run.code == 0 && run.stdout.contains("proved"), "{run:?}");
    }
}

#[test]
fn functions_of_another_host_are_tested() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "// @test wave(0.0) == 0.5\nfloat wave(float x) { return 0.5 + 0.5 * sin(x); }\n\
                  void main() { gl_FragColor = vec4(wave(gl_FragCoord.x)); }\n";
    fs::write(folder.path().join("wave.frag"), shader).unwrap();
    let run = toyproof(folder.path(), &["test", "wave.frag"]);
    assert!(
        run.code == 0 && run.stdout.contains("passed  wave.frag:1"),
        "{run:?}"
    );
}
