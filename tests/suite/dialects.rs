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

#[test]
fn textures_and_arrays_of_another_host_are_bound() {
    let folder = tempfile::tempdir().unwrap();
    let size = "uniform vec3 iChannelResolution[4];\nuniform float iChannelTime[4];\n";
    let files = [
        // A name of the host keeps its channel, wherever it is declared.
        (
            "order.frag",
            "uniform sampler2D other, u_tex0;\nvoid main() { gl_FragColor = texture2D(other, vec2(0.5)) + texture2D(u_tex0, vec2(0.5)); }\n",
        ),
        (
            "same.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel1, vec2(0.5)) + texture(iChannel0, vec2(0.5)); }\n",
        ),
        (
            "five.frag",
            "uniform sampler2D a, b, c, d, e;\nvoid main() { gl_FragColor = texture2D(e, vec2(0)); }\n",
        ),
        (
            "four.frag",
            "uniform sampler2D a, b, c, d, e;\nvoid main() { gl_FragColor = texture2D(d, vec2(0)); }\n",
        ),
        (
            "surface.frag",
            "varying vec2 surfacePosition;\nuniform vec2 surfaceSize;\nvoid main() { gl_FragColor = vec4(surfacePosition / surfaceSize + 0.5, 0.0, 1.0); }\n",
        ),
        (
            "quad.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0.0, 1.0); }\n",
        ),
        (
            "size.frag",
            &format!(
                "{size}void main() {{ gl_FragColor = vec4(iChannelResolution[0].xy / 512.0, iChannelTime[1], 1.0); }}\n"
            ),
        ),
        (
            "size.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(iChannelResolution[0].xy / 512.0, iChannelTime[1], 1.0); }\n",
        ),
    ];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let verdict = |arguments: &[&str]| {
        let common = [
            "--size",
            "32x18",
            "--device",
            "cpu",
            "--format",
            "json",
            "--channel0",
            "noise",
        ];
        record(&toyproof(
            folder.path(),
            &[&["check"], arguments, &common].concat(),
        ))["verdict"]
            .clone()
    };
    for (shader, reference) in [
        ("order.frag", "same.glsl"),
        ("surface.frag", "quad.glsl"),
        ("size.frag", "size.glsl"),
    ] {
        assert_eq!(
            verdict(&[shader, "--reference", reference]),
            "correct",
            "{shader}"
        );
    }
    assert_eq!(
        [verdict(&["five.frag"]), verdict(&["four.frag"])],
        ["invalid", "ok"]
    );
}

#[test]
fn an_input_of_the_host_is_added_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let book = "precision mediump float;\nuniform vec2 u_resolution;\nuniform float u_time;\nvoid main() {\n    \
                vec2 st = gl_FragCoord.xy / u_resolution;\n    gl_FragColor = vec4(st, 0.5 + 0.5 * sin(6.0 * st.x), 1.0);\n}\n";
    let reference = "void mainImage(out vec4 c, in vec2 p) {\n    vec2 st = p / iResolution.xy;\n    \
                     c = vec4(st, 0.5 + 0.5 * sin(6.0 * st.x + iTime), 1.0);\n}\n";
    fs::write(folder.path().join("book.frag"), book).unwrap();
    fs::write(folder.path().join("toy.glsl"), reference).unwrap();
    let arguments = [
        "check",
        "book.frag",
        "--reference",
        "toy.glsl",
        "--size",
        "64x36",
        "--time",
        "1.3",
        "--device",
        "cpu",
        "--format",
        "json",
    ];
    let wrong = record(&toyproof(folder.path(), &arguments));
    let fix = wrong["fix"]["text"].as_str().unwrap_or_default();
    assert!(fix.contains("+ u_time"), "{wrong}");
    let details = wrong["details"].to_string();
    assert!(details.contains("the reference reads `u_time`"), "{details}");
}

#[test]
fn a_function_of_another_host_is_called_and_not_its_image() {
    let folder = tempfile::tempdir().unwrap();
    for version in ["", "#version 300 es\n", "#version 330\n"] {
        let output = if version.is_empty() { "" } else { "out vec4 gl;\n" };
        let shader = format!(
            "{version}precision mediump float;\n{output}// @test twice(2.0) == 4.0\n// @test twice(2.0) == 0.5\n\
             float twice(float x) {{ return 2.0 * x; }}\nvoid main() {{ {} = vec4(0.5); }}\n",
            if version.is_empty() { "gl_FragColor" } else { "gl" }
        );
        fs::write(folder.path().join("twice.frag"), shader).unwrap();
        let run = toyproof(folder.path(), &["test", "twice.frag"]);
        assert!(
            run.stdout.contains("2 tests: 1 passed") || run.stderr.contains("2 tests: 1 passed"),
            "{run:?}"
        );
        assert!(run.stdout.contains("is 4.0, expected 0.5"), "{run:?}");
    }
}

#[test]
fn an_intersection_of_another_host_is_tested() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "precision highp float;
uniform vec2 u_resolution;
float hitSphere(vec3 o, vec3 d, vec3 c, float r) {
    vec3 f = o - c;
    float b = dot(f, d);
    float disc = b * b - dot(f, f) + r * r;
    return disc < 0.0 ? -1.0 : -b - sqrt(disc);
}
void main() {
    gl_FragColor = vec4(hitSphere(vec3(0.0), vec3(gl_FragCoord.xy / u_resolution, -1.0), vec3(0.0, 0.0, -5.0), 1.0));
}
";
    fs::write(folder.path().join("sphere.frag"), shader).unwrap();
    let arguments = [
        "stress",
        "sphere.frag",
        "-o",
        "out",
        "--device",
        "cpu",
        "--cases",
        "200",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert!(run.code < 2 && run.stdout.contains("hitSphere"), "{run:?}");
}

#[test]
fn an_assignment_checks_several_values_of_a_uniform() {
    let folder = tempfile::tempdir().unwrap();
    let assignment = "reference = \"book.frag\"\n\n[uniforms]\nspeed = 2\n\n[[frame]]\nsize = [64, 36]\ntime = 0.3\n\n\
                      [[frame]]\nsize = [64, 36]\ntime = 0.3\nuniforms = { speed = 5.0 }\n";
    let ignoring = BOOK.replace("speed * u_time", "2.0 * u_time");
    let files = [
        ("task.toml", assignment),
        ("book.frag", BOOK),
        ("right.frag", BOOK),
        ("wrong.frag", &ignoring),
    ];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let check = |shader| {
        let options = ["--assignment", "task.toml", "--device", "cpu", "--format", "json"];
        record(&toyproof(
            folder.path(),
            &[&["check", shader][..], &options].concat(),
        ))
    };
    let right = check("right.frag");
    assert_eq!(right["verdict"], "correct", "{right}");
    assert_eq!(right["frames"][1]["uniforms"][0]["name"], "speed");
    let wrong = check("wrong.frag");
    assert_eq!(wrong["verdict"], "wrong", "{wrong}");
    assert_eq!(wrong["frames"][0]["verdict"], "correct", "{wrong}");
    let reason = wrong["reason"].as_str().unwrap();
    assert!(reason.starts_with("at 64x36, time 0.3, speed=5: "), "{wrong}");
    let details = wrong["details"].to_string();
    assert!(
        details.contains("the reference reads `speed`, the shader does not"),
        "{wrong}"
    );
}
