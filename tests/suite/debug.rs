//! Traces of a pixel: the trace ends with the rendered color, and the first difference is named.

use std::fs;
use std::path::Path;

use serde_json::Value;
use toyproof::eval::{ForcedPrefix, Number, Program, Settings};
use toyproof::image::Frame;

use crate::program::toyproof;
use crate::support::{self, EVERY_EXERCISE, Exercise};

fn program(shader: &str) -> Program {
    Program::new(&support::checked(shader)).unwrap()
}

fn frame(exercise: &Exercise) -> Frame {
    support::frame(exercise, [33, 21])
}

/// Pixels in the interior, and at the image's edge, where the last tile is truncated.
const PIXELS: [[u32; 2]; 4] = [[16, 10], [12, 7], [32, 20], [0, 0]];

fn assert_trace_ends_with_color<N: Number>(exercise: &Exercise) {
    let (program, frame) = (program(exercise.shader), frame(exercise));
    let painting = program
        .render::<N>(&frame, &Settings::default())
        .unwrap()
        .framebuffer;
    let pixel_debugger = program.pixel_debugger::<N>(&frame, Settings::default()).unwrap();
    for pixel @ [x, y] in PIXELS {
        let trace = pixel_debugger.trace(pixel, None).unwrap();
        let rendered = painting.get(x, y).map(|part| part.to_f64().to_bits());
        let reported = trace.color.unwrap().map(f64::to_bits);
        assert_eq!(reported, rendered, "{} at {pixel:?}", exercise.name);
        assert!(trace.is_cut || !trace.events.is_empty());
        let with_steps = program.step_debugger::<N>(&frame, Settings::default()).unwrap();
        let with_steps = with_steps.trace(pixel, None).unwrap();
        let stepped = with_steps.color.unwrap().map(f64::to_bits);
        assert_eq!(stepped, rendered, "{} at {pixel:?} with all steps", exercise.name);
        assert!(with_steps.events.len() > trace.events.len() || with_steps.is_cut);
    }
}

#[test]
fn traces_end_with_the_rendered_color() {
    for exercise in EVERY_EXERCISE {
        assert_trace_ends_with_color::<f32>(exercise);
        assert_trace_ends_with_color::<f64>(exercise);
    }
}

/// Forced to follow every step of f32, f64 computes the same.
#[test]
fn fully_forced_traces_end_with_the_same_color() {
    for exercise in EVERY_EXERCISE {
        let (program, frame) = (program(exercise.shader), frame(exercise));
        let singles = program
            .pixel_debugger::<f32>(&frame, Settings::default())
            .unwrap();
        let doubles = program
            .pixel_debugger::<f64>(&frame, Settings::default())
            .unwrap();
        for pixel in PIXELS {
            let single = singles.trace(pixel, None).unwrap();
            let lead = ForcedPrefix {
                trace: &single,
                length: single.events.len(),
            };
            let led = doubles.trace(pixel, Some(lead)).unwrap();
            if single.is_cut {
                continue;
            }
            assert_eq!(
                led.events.len(),
                single.events.len(),
                "{} at {pixel:?}",
                exercise.name
            );
            assert_eq!(
                led.color.map(|color| color.map(|part| part as f32)),
                single.color.map(|color| color.map(|part| part as f32)),
                "{} at {pixel:?}",
                exercise.name
            );
        }
    }
}

/// A sphere of radius 2.5 at a distance of 20,000: b² and c are the same f32.
const FAR: &str = "\
bool hit(vec3 d, vec3 center, float radius) {
    float b = dot(-center, d);
    float c = dot(center, center) - radius * radius;
    float disc = b * b - c;
    return disc > 0.0;
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec3 color = vec3(0.0);
    float seed = fract(sin(fragCoord.x) * 437585.453); // toyproof: allow(W0005)
    float shift = 0.0001 * seed;
    for (int i = 0; i < 2; i++) {
        if (hit(vec3(shift * float(i), 0.0, -1.0), vec3(0.0, 0.0, -20000.0), 2.5)) color += 0.5;
    }
    fragColor = vec4(color, 1.0);
}
";

#[test]
fn explain_names_the_line_that_loses_digits() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("far.glsl"), FAR).unwrap();
    let explain = |rest: &[&str]| {
        let arguments = [
            &["debug", "far.glsl", "--size", "64x36", "--pixel", "30,18"],
            rest,
        ]
        .concat();
        let run = toyproof(folder.path(), &arguments);
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stdout
    };
    let human = explain(&[]);
    assert!(human.contains("first difference   line 10, column 18"), "{human}");
    assert!(
        human.contains("visible cause      line 4, column 18: `b * b - c` is 0 in f32"),
        "{human}"
    );
    assert!(human.contains("hit() at line 13"), "{human}");
    assert!(
        human.contains("for (int i = 0; i < 2; i++) {   (iteration 2)"),
        "{human}"
    );
    let json: Value = serde_json::from_str(&explain(&["--format", "json"])).unwrap();
    let step = |name: &str| &json["steps"][json[name].as_u64().unwrap() as usize];
    assert_eq!(step("divergence_at")["line"], 10);
    let cause = step("cause_at");
    assert_eq!(cause["line"], 4);
    assert_eq!(cause["function"], "hit");
    assert_eq!(cause["f32"][0], 0.0);
    assert!(cause["f64"][0].as_f64().unwrap() > 1.0, "{cause}");
    assert_eq!(cause["calls"], serde_json::json!([13]));
}

#[test]
fn the_expected_color_is_shown_with_a_scene() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let debug = |rest: &[&str]| {
        let arguments = [&["debug", "glsl/02-sphere.glsl", "--pixel", "320,180"], rest].concat();
        toyproof(root, &arguments).stdout
    };
    let human = debug(&[]);
    assert!(human.contains("\n  expected color     (0.99999"), "{human}");
    let json: Value = serde_json::from_str(&debug(&["--format", "json"])).unwrap();
    let [expected, actual] = ["expected", "f64"].map(|name| json[name][0].as_f64().unwrap());
    assert!((expected - actual).abs() < 1e-9, "{expected} {actual}");
}

#[test]
fn a_wrong_value_is_shown_beside_that_of_the_reference_of_an_assignment() {
    let shader = |op: &str| {
        format!(
            "void mainImage(out vec4 c, in vec2 p) {{
    vec2 uv = p / iResolution.y;
    float wave = sin(7.0 * uv.x {op} iTime);
    c = vec4(vec3(0.5 + 0.4 * wave), 1.0);
}}
"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    fs::create_dir(folder.path().join("waves")).unwrap();
    let assignment = "reference = \"solution.glsl\"\n[[frame]]\nsize = [32, 18]\ntime = 1.0\n";
    write("waves/assignment.toml", assignment);
    write("waves/solution.glsl", &shader("+"));
    write("mine.glsl", &shader("-"));
    let debug = |rest: &[&str]| {
        let arguments = ["debug", "mine.glsl", "--pixel", "20,9", "--assignment", "waves"];
        let run = toyproof(folder.path(), &[&arguments[..], rest].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stdout
    };
    let human = debug(&[]);
    assert!(human.contains("pixel (20, 9) of 32×18"), "{human}");
    let wrong = "  wrong value        line 3: `7.0 * uv.x - iTime` is 6.972 at (20, 9)";
    assert!(human.contains(wrong), "{human}");
    let missing = "`7.0 * uv.x + iTime` is 8.972 at (20, 9) in line 3 of the reference";
    assert!(human.contains(missing), "{human}");
    let json: Value = serde_json::from_str(&debug(&["--format", "json"])).unwrap();
    let value = json["departure"]["missing"]["value"][0].as_f64().unwrap();
    assert!((value - 8.9722).abs() < 1e-4, "{value}");
    // Another frame, in which both are equal.
    let human = debug(&["--size", "32x18", "--time", "0"]);
    assert!(
        human.contains("expected color") && !human.contains("wrong value"),
        "{human}"
    );
    let both = ["--scene", "02-sphere"];
    let arguments = ["debug", "mine.glsl", "--pixel", "2,2", "--assignment", "waves"];
    assert_eq!(toyproof(folder.path(), &[&arguments[..], &both].concat()).code, 2);
}

#[test]
fn explain_follows_uniform_and_shared_values() {
    let folder = tempfile::tempdir().unwrap();
    let causes = [
        (
            "float t = iTime * 1000.0;\n float s = sin(t);\n float u = s * 0.5 + 0.5;\n c = vec4(u);",
            3,
        ),
        (
            "float a = (1e8 + p.x) - 1e8;\n float u = a * 0.0;\n float b = (1e8 + p.x) - 1e8;\n c = vec4(b * 0.1, u, 0, 1);",
            4,
        ),
        (
            "float s = 0.0;\n for (int i = 0; i < 3; i++) {\n float a = (1e8 + fract(iTime)) - 1e8;\n if (i == 2) s = a; }\n c = vec4(s);",
            4,
        ),
    ];
    for (body, line) in causes {
        let text = format!("void mainImage(out vec4 c, in vec2 p) {{\n{body}\n}}\n");
        fs::write(folder.path().join("a.glsl"), text).unwrap();
        let arguments = [
            "debug",
            "a.glsl",
            "--pixel",
            "20,5",
            "--time",
            "12345.678",
            "--format",
            "json",
        ];
        let run = toyproof(folder.path(), &arguments);
        let trace: Value = serde_json::from_str(&run.stdout).unwrap();
        let cause = &trace["steps"][trace["cause_at"].as_u64().unwrap() as usize];
        assert_eq!(cause["line"], line, "{body}\n{cause}");
    }
}

#[test]
fn explain_locates_the_origin_of_a_nan() {
    let folder = tempfile::tempdir().unwrap();
    let shader =
        "void mainImage(out vec4 c, in vec2 p) {\n    float x = sqrt(-p.x);\n    c = vec4(x * 0.5);\n}\n";
    fs::write(folder.path().join("nan.glsl"), shader).unwrap();
    let run = toyproof(folder.path(), &["debug", "nan.glsl", "--pixel", "1,1"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout
            .contains("first not finite   line 2, column 15: `sqrt(-p.x)`"),
        "{}",
        run.stdout
    );
    let run = toyproof(
        folder.path(),
        &["check", "nan.glsl", "--device", "cpu", "--size", "8x8"],
    );
    assert!(
        run.stderr.contains("W0603")
            && run
                .stderr
                .contains("of 64 pixels NaN or infinite, first at (0, 0)"),
        "{}",
        run.stderr
    );
}

#[test]
fn explain_reports_its_limits() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let run = |arguments: &[&str]| {
        let run = toyproof(root, arguments);
        (run.code, run.stderr)
    };
    let (code, words) = run(&["debug", "glsl/02-sphere.glsl", "--pixel", "640,0"]);
    assert!(
        code == 2 && words.contains("pixel (640, 0) is outside the image of 640x360 pixels"),
        "{words}"
    );
    let (code, words) = run(&["debug", "glsl", "--pixel", "1,1"]);
    assert!(code == 2 && words.contains("`debug` takes one"), "{words}");
    let (code, words) = run(&["debug", "glsl/02-sphere.glsl", "--pixel", "1"]);
    assert!(code == 2 && words.contains("X,Y"), "{words}");
    let (code, words) = run(&[
        "debug",
        "glsl/02-sphere.glsl",
        "--pixel",
        "1,1",
        "--timeout",
        "0s",
    ]);
    assert!(code == 0 || words.contains("time"), "{words}");
}
