//! Shaders that are written for other hosts of GLSL render the same images.

use std::fs;

use serde_json::Value;

use crate::program::toyproof;
use crate::requirements::{require_driver, require_program};

/// The results of a conversion by their shaders: the status, and the message.
fn convert(folder: &std::path::Path, inputs: &[&str], style: &str, output: &str) -> Vec<(String, Value)> {
    let options = ["--style", style, "--verify", "--format", "json", "-o", output];
    let run = toyproof(folder, [&["convert"], inputs, &options].concat().as_slice());
    let rows: Vec<Value> = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    let shader = |row: &Value| row["shader"].as_str().unwrap_or_default().to_owned();
    rows.iter().map(|row| (shader(row), row.clone())).collect()
}

#[test]
fn the_course_is_proved_for_other_hosts_and_back() {
    if !require_driver() || !require_program("glslangValidator") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let course = concat!(env!("CARGO_MANIFEST_DIR"), "/glsl");
    for style in ["book-of-shaders", "three", "webgl"] {
        for (shader, row) in convert(folder.path(), &[course], style, style) {
            // Its image reads other passes.
            let expected = if shader.ends_with("16-progressive") {
                "refused"
            } else {
                "proved"
            };
            assert_eq!(row["status"], expected, "{style}: {row}");
        }
        let back = format!("{style}-back");
        for (_, row) in convert(folder.path(), &[style], "shadertoy", &back) {
            assert_eq!(row["status"], "proved", "{style} and back: {row}");
        }
    }
    let path = folder.path().join("three/11-animation.frag");
    let text = fs::read_to_string(path).unwrap();
    assert!(
        text.starts_with("#version 300 es\n// ") && text.contains("glslangValidator"),
        "{text}"
    );
    let path = folder.path().join("three-back/11-animation.glsl");
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains("iTime") && !text.contains("uTime"), "{text}");
}

#[test]
fn what_a_host_does_not_have_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(step(0.0, iMouse.z));\n}\n";
    fs::write(folder.path().join("click.glsl"), text).unwrap();
    let convert = |options: &[&str]| {
        let run = toyproof(
            folder.path(),
            [&["convert", "click.glsl"], options].concat().as_slice(),
        );
        (run.code, run.stderr)
    };
    let (code, stderr) = convert(&["--style", "book-of-shaders"]);
    assert_eq!(code, 2, "{stderr}");
    assert!(
        stderr.contains("`iMouse.z` is not set by The Book of Shaders"),
        "{stderr}"
    );
    assert!(stderr.contains("click.glsl:2:24"), "{stderr}");
    let (code, stderr) = convert(&["--style", "three", "--to", "wgsl"]);
    assert_eq!(code, 2, "{stderr}");
    assert!(stderr.contains("this --style applies to GLSL only"), "{stderr}");
    let (code, stderr) = convert(&["--style", "three", "-o", "x.wgsl"]);
    assert_eq!(code, 2, "{stderr}");
    assert!(
        stderr.contains("the extension of x.wgsl means wgsl, but the --style is of glsl"),
        "{stderr}"
    );
}

#[test]
fn continued_lines_are_accepted_as_browsers_do() {
    if !require_driver() || !require_program("glslangValidator") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let text = "#define COLOR(a) vec4(a, \\\n    fract(iTime), 1.0)\n\
                void mainImage(out vec4 c, in vec2 p) { c = COLOR(p / iResolution.xy); }\n";
    fs::write(folder.path().join("color.glsl"), text).unwrap();
    let rows = convert(folder.path(), &["color.glsl"], "three", "color.frag");
    assert_eq!(rows[0].1["status"], "proved", "{rows:?}");
    let written = fs::read_to_string(folder.path().join("color.frag")).unwrap();
    assert!(
        written.contains(", with continued lines joined, accepts it."),
        "{written}"
    );
}
