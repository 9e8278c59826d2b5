//! Each command does what its help describes.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::program::{command, run, toyproof};
use crate::requirements::{require_driver, require_program};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All commands.
pub(crate) const COMMANDS: [&str; 19] = [
    "check",
    "render",
    "run",
    "convert",
    "debug",
    "dap",
    "explain",
    "fmt",
    "compare",
    "trade",
    "stress",
    "export",
    "new",
    "scenes",
    "doctor",
    "lsp",
    "watch",
    "completions",
    "man",
];

#[test]
fn the_help_of_each_command_shows_an_example() {
    for name in COMMANDS {
        let help = toyproof(root(), &[name, "--help"]).stdout;
        assert!(
            help.contains("Example") && help.contains(&format!("toyproof {name}")),
            "{help}"
        );
    }
}

/// Examples in the help work for an installed user: the scenes that they name are built in.
#[test]
fn scenes_in_help_examples_are_built_in() {
    let listed = toyproof(root(), &["scenes"]).stdout;
    let mut seen = 0;
    for name in COMMANDS {
        let help = toyproof(root(), &[name, "--help"]).stdout;
        assert!(
            !help.contains("glsl/"),
            "{name} names a file of the repository: {help}"
        );
        let words = help.split_whitespace();
        for word in words
            .filter(|word| word.starts_with(['0', '1']) && word.get(2..3) == Some("-") && !word.contains('.'))
        {
            assert!(listed.contains(word.trim_end_matches(',')), "{name}: {word}");
            seen += 1;
        }
    }
    assert!(seen > 5, "{seen}");
}

#[test]
fn the_evaluator_is_chosen_on_request() {
    let run = toyproof(root(), &["doctor", "--device", "cpu"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.starts_with("Selected device: cpu"), "{}", run.stdout);
}

/// With odd sizes, the central pixel's ray is parallel to an axis of the screen.
#[test]
fn the_course_is_correct_at_odd_sizes() {
    let run = toyproof(root(), &["check", "glsl", "--size", "97x55", "--device", "cpu"]);
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
}

#[test]
fn the_course_is_correct_and_its_json_follows_the_schema() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let run = toyproof(
        root(),
        &[
            "check", "glsl", "--size", "160x90", "--out", out, "--format", "json",
        ],
    );
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
    assert_eq!(
        fs::read_to_string(folder.path().join("verdict.json")).unwrap(),
        run.stdout
    );
    let json: Value = serde_json::from_str(&run.stdout).unwrap();
    let schema: Value = serde_json::from_str(toyproof::report::SCHEMA).unwrap();
    jsonschema::validate(&schema, &json).unwrap();
    let shaders = json["shaders"].as_array().unwrap();
    // Those of the course, and the exercises in two dimensions with their assignments.
    assert_eq!(shaders.len(), 16 + 8);
    for shader in shaders {
        assert_eq!(shader["verdict"], "correct", "{shader}");
        let path = Path::new(shader["shader"].as_str().unwrap()).with_extension("");
        let stem = path.strip_prefix("glsl").unwrap().to_str().unwrap();
        for kind in ["reference", "actual", "difference"] {
            assert!(folder.path().join(format!("{stem}-{kind}.png")).is_file());
        }
    }
}

#[test]
fn runtime_warnings_can_be_allowed_and_denied() {
    let folder = tempfile::tempdir().unwrap();
    // Each pixel divides an integer by zero, and is NaN.
    let odd = |divides: &str, is_nan: &str| {
        format!(
            "void mainImage(out vec4 c, in vec2 f) {{\n  int i = int(f.x);\n  int j = 7 / (i - i); {divides}\n  \
             float x = sqrt(-f.x); {is_nan}\n  c = vec4(x + float(j));\n}}\n"
        )
    };
    let allow = ["// toyproof: allow(W0600)", "// toyproof: allow(W0603)"];
    for (name, text) in [
        ("odd.glsl", odd("", "")),
        ("known.glsl", odd(allow[0], allow[1])),
        ("elsewhere.glsl", odd(allow[1], allow[0])),
        (
            "whole.glsl",
            format!("// toyproof: allow(W0600, W0603)\n{}", odd("", "")),
        ),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let check = |arguments: &[&str]| {
        let all = [&["check", "--device", "cpu", "--size", "16x9"], arguments].concat();
        toyproof(folder.path(), &all)
    };
    for (name, is_told) in [
        ("odd.glsl", true),
        ("known.glsl", false),
        ("elsewhere.glsl", true),
        ("whole.glsl", false),
    ] {
        let reported = check(&[name]);
        assert_eq!(reported.code, 0, "{name}: {}", reported.stderr);
        for code in ["W0600", "W0603"] {
            assert_eq!(
                reported.stderr.contains(&format!("warning[{code}]")),
                is_told,
                "{name}: {}",
                reported.stderr
            );
        }
        assert!(!reported.stderr.contains("W0015"), "{name}: {}", reported.stderr);
        let denied = check(&[name, "--deny", "warnings"]);
        assert_eq!(denied.code, i32::from(is_told), "{name}: {}", denied.stderr);
        assert_eq!(denied.stdout.contains("invalid"), is_told, "{}", denied.stdout);
    }
    let denied = check(&["odd.glsl", "--deny", "W0603"]);
    assert!(denied.stderr.contains("error[W0603]") && denied.stderr.contains("warning[W0600]"));
    assert_eq!(check(&["odd.glsl", "--deny", "W0601"]).code, 0);
}

#[test]
fn denied_warnings_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let noise = |words| {
        format!(
            "void mainImage(out vec4 c, in vec2 f) {{\n  c = vec4(fract(sin(f.x) * 43758.5453)); {words}\n}}\n"
        )
    };
    fs::write(folder.path().join("noise.glsl"), noise("")).unwrap();
    fs::write(
        folder.path().join("known.glsl"),
        noise("// toyproof: allow(W0005)"),
    )
    .unwrap();
    let convert = |arguments: &[&str]| {
        let all = [&["convert", "--to", "lowered", "-o", "-"], arguments].concat();
        toyproof(folder.path(), &all)
    };
    let reported = convert(&["noise.glsl"]);
    assert_eq!(reported.code, 0);
    assert!(reported.stderr.contains("warning[W0005]"), "{}", reported.stderr);
    for deny in ["warnings", "W0005"] {
        let denied = convert(&["noise.glsl", "--deny", deny]);
        assert_eq!((denied.code, &*denied.stdout), (1, ""));
        assert!(denied.stderr.contains("error[W0005]"), "{}", denied.stderr);
        let known = convert(&["known.glsl", "--deny", deny]);
        assert_eq!((known.code, &*known.stderr), (0, ""));
    }
    assert_eq!(convert(&["noise.glsl", "--deny", "W0010"]).code, 0);
    assert_eq!(convert(&["noise.glsl", "--deny", "nonsense"]).code, 2);
    let run = toyproof(
        folder.path(),
        &["check", "noise.glsl", "--deny", "warnings", "--format", "json"],
    );
    assert_eq!(run.code, 1, "{}", run.stderr);
    let json: Value = serde_json::from_str(&run.stdout).unwrap();
    let shader = &json["shaders"][0];
    assert_eq!(shader["verdict"], "invalid");
    assert_eq!(shader["diagnostics"][0]["severity"], "error");
    assert!(
        shader["reason"]
            .as_str()
            .unwrap()
            .ends_with("(line 2, column 12)"),
        "{shader}"
    );
}

#[test]
fn repeated_warnings_are_summarized() {
    let folder = tempfile::tempdir().unwrap();
    let lines = "  c += fract(sin(f.x) * 43758.5453);\n".repeat(9);
    let text = format!("void mainImage(out vec4 c, in vec2 f) {{\n  c = vec4(0);\n{lines}}}\n");
    fs::write(folder.path().join("noise.glsl"), text).unwrap();
    let convert = |more: &[&str]| {
        let all = [&["convert", "noise.glsl", "--to", "lowered", "-o", "-"], more].concat();
        toyproof(folder.path(), &all).stderr
    };
    let reported = convert(&[]);
    assert_eq!(reported.matches("warning[W0005]").count(), 3, "{reported}");
    assert!(reported.contains("6 more W0005"), "{reported}");
    assert_eq!(convert(&["--verbose"]).matches("warning[W0005]").count(), 9);
}

#[test]
fn a_shader_without_a_scene_is_ok_and_one_with_the_wrong_scene_is_wrong() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    fs::copy(root().join("glsl/02-sphere.glsl"), folder.path().join("s.glsl")).unwrap();
    assert!(
        toyproof(folder.path(), &["check", "s.glsl"])
            .stdout
            .starts_with("ok  ")
    );
    let other = root().join("glsl/03-shading.toml");
    let run = toyproof(
        folder.path(),
        &["check", "s.glsl", "--scene", other.to_str().unwrap()],
    );
    assert_eq!(run.code, 1);
    assert!(run.stdout.starts_with("wrong"), "{}", run.stdout);
    assert!(run.stdout.contains("differ from the reference"), "{}", run.stdout);
    assert!(run.stdout.contains("help: toyproof "), "{}", run.stdout);
}

#[test]
fn standard_input_is_a_shader() {
    if !require_driver() {
        return;
    }
    let shader = fs::File::open(root().join("glsl/02-sphere.glsl")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let run = run(command(folder.path())
        .args(["run", "-", "-o", "s.png"])
        .stdin(shader));
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(folder.path().join("s.png").is_file());
}

#[test]
fn the_frame_flags_reach_the_shader() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let shader = "void mainImage(out vec4 c, in vec2 p) {
        bool all = iTime == 1.5 && iFrame == 7 && iMouse == vec4(1.0, 2.0, 3.0, -4.0) && iDate == vec4(2026.0, 0.0, 2.0, 3.0);
        all = all && iResolution == vec3(8.0, 4.0, 1.0) && iFrameRate == 60.0 && iSampleRate == 44100.0;
        all = all && iChannelTime[2] == 0.0 && iChannelResolution[1].xy == vec2(256.0) && iChannelResolution[0].x == 0.0;
        bool painted = texture(iChannel0, vec2(0.5)).xyz == vec3(0.0) && texelFetch(iChannel1, ivec2(3), 0).x > 0.0;
        // The lower left pixel is green, the others are white.
        vec3 corner = all && painted ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
        c = vec4(p.x < 1.0 && p.y < 1.0 ? corner : vec3(1.0), 0.0);
    }";
    fs::write(folder.path().join("s.glsl"), shader).unwrap();
    let arguments = "run s.glsl -o s.exr --size 8x4 --time 1.5 --frame 7 --mouse 1,2,3,-4 --date 2026,0,2,3 --channel1 noise";
    let run = toyproof(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let image = toyproof::image::read(&folder.path().join("s.exr")).unwrap();
    assert_eq!(
        image.get(0, 0),
        [0.0, 1.0, 0.0, 1.0],
        "alpha is 1 whatever the shader says"
    );
    assert_eq!(image.get(7, 3), [1.0; 4]);
}

#[test]
fn sequences_are_numbered_and_resume() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "void mainImage(out vec4 c, in vec2 p) {
        c = vec4(float(iFrame) / 4.0, iTime * 15.0, iMouse.x, 1.0);
    }";
    fs::write(folder.path().join("s.glsl"), shader).unwrap();
    let render = |more: &str| {
        let arguments = format!("run s.glsl -o s.exr --size 2x2 --device cpu --frames 0..3{more}");
        toyproof(folder.path(), &arguments.split(' ').collect::<Vec<_>>())
    };
    let file = |name: &str| folder.path().join(name);
    let color = |name: &str| toyproof::image::read(&file(name)).unwrap().get(0, 0);

    // The third frame cannot be written.
    fs::create_dir(file("s-0002.exr")).unwrap();
    let stopped = render("");
    assert_eq!(stopped.code, 2, "{}", stopped.stderr);
    assert!(!file("s-0003.exr").exists() && file("s.sequence").is_file());
    fs::remove_dir(file("s-0002.exr")).unwrap();
    fs::write(file("s-0000.exr"), "kept").unwrap();
    let resumed = render("");
    assert_eq!(resumed.code, 0, "{}", resumed.stderr);
    let words = "2 of 4 frames exist already";
    assert!(resumed.stderr.contains(words), "{}", resumed.stderr);
    assert_eq!(fs::read(file("s-0000.exr")).unwrap(), b"kept");
    assert!(!file("s.sequence").exists());
    for (name, share) in [("s-0001.exr", 0.25), ("s-0002.exr", 0.5), ("s-0003.exr", 0.75)] {
        let [r, g, b, _] = color(name);
        assert_eq!((r, b), (share, 0.0), "{name}");
        assert!((g - share).abs() < 1e-6, "{name}: {g}");
    }

    // A different mouse position is a different sequence.
    fs::remove_file(file("s-0003.exr")).unwrap();
    fs::create_dir(file("s-0003.exr")).unwrap();
    assert_eq!(render("").code, 2);
    fs::remove_dir(file("s-0003.exr")).unwrap();
    let other = render(" --mouse 1,0");
    assert_eq!(other.code, 0, "{}", other.stderr);
    assert!(!other.stderr.contains("already"), "{}", other.stderr);
    assert_eq!(color("s-0000.exr"), [0.0, 0.0, 1.0, 1.0]);

    let nowhere = toyproof(folder.path(), &["run", "s.glsl", "-o", "-", "--frames", "0..3"]);
    assert_eq!(nowhere.code, 2);
    assert!(
        nowhere
            .stderr
            .contains("standard output takes a single image, or frames as --to y4m or rgba"),
        "{}",
        nowhere.stderr
    );
}

#[test]
fn derivatives_point_upward() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(dFdx(p.x), dFdy(p.y), 0.0, 1.0); }";
    fs::write(folder.path().join("s.glsl"), shader).unwrap();
    for device in ["lavapipe", "cpu"] {
        let fixed = [
            "run", "s.glsl", "-o", "s.exr", "--size", "4x4", "--device", device,
        ];
        assert_eq!(toyproof(folder.path(), &fixed).code, 0);
        let image = toyproof::image::read(&folder.path().join("s.exr")).unwrap();
        assert!(
            image.pixels().iter().all(|pixel| *pixel == [1.0, 1.0, 0.0, 1.0]),
            "{device}"
        );
    }
}

#[test]
fn rendering_and_comparing_images() {
    let folder = tempfile::tempdir().unwrap();
    let scene = root().join("glsl/02-sphere.toml");
    let scene = scene.to_str().unwrap();
    let render = |name: &str, size: &str, more: &[&str]| {
        let arguments = [&["render", scene, "-o", name, "--size", size], more].concat();
        let run = toyproof(folder.path(), &arguments);
        assert_eq!(run.code, 0, "{}", run.stderr);
    };
    render("double.exr", "64x36", &[]);
    render("single.exr", "64x36", &["--precision", "f32"]);
    render("double.png", "64x36", &[]);
    let same = toyproof(folder.path(), &["compare", "double.exr", "single.exr"]);
    assert_eq!(same.code, 0, "{}", same.stdout);
    assert!(
        !same.stdout.contains("to 0.0e0"),
        "two precisions are not one: {}",
        same.stdout
    );
    fs::copy(folder.path().join("double.png"), folder.path().join("copy.png")).unwrap();
    assert_eq!(
        toyproof(folder.path(), &["compare", "double.png", "copy.png"]).code,
        0
    );
    let black = root().join("glsl/03-shading.toml");
    let run = toyproof(
        folder.path(),
        &[
            "render",
            black.to_str().unwrap(),
            "-o",
            "b.png",
            "--size",
            "64x36",
        ],
    );
    assert_eq!(run.code, 0);
    let differ = toyproof(
        folder.path(),
        &["compare", "double.png", "b.png", "--diff", "d.png"],
    );
    assert_eq!(differ.code, 1);
    assert!(differ.stdout.contains("worst at ("), "{}", differ.stdout);
    assert!(folder.path().join("d.png").is_file());
    render("small.png", "32x18", &[]);
    let sizes = toyproof(folder.path(), &["compare", "double.png", "small.png"]);
    assert_eq!(sizes.code, 2);
    assert!(sizes.stderr.contains("64×36"), "{}", sizes.stderr);
}

/// Runs a validator on a converted file, if it is installed.
fn judge(program: &str, arguments: &[&str]) {
    if require_program(program) {
        let output = Command::new(program).args(arguments).output().unwrap();
        assert!(
            output.status.success(),
            "{program} {arguments:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}

#[test]
fn validators_accept_conversions() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    // Features that the exercises do not use: textures, derivatives, every input.
    let shader = "void mainImage(out vec4 c, in vec2 p) {
        if (p.x > 9.0) c = texture(iChannel0, p / iResolution.xy) + dFdx(p.xyxy);
        c += textureLod(iChannel3, p, 0.0) + vec4(iChannelTime[1]) + vec4(iChannelResolution[2], iSampleRate);
        c += iDate * iMouse + vec4(iTime, iTimeDelta, float(iFrame), iFrameRate);
    }";
    fs::write(folder.path().join("inputs.glsl"), shader).unwrap();
    let inputs = folder.path().join("inputs.glsl");
    for to in ["wgsl", "spv", "metal", "hlsl", "glsl", "lowered"] {
        let run = toyproof(
            root(),
            &["convert", "glsl", inputs.to_str().unwrap(), "-o", out, "--to", to],
        );
        assert_eq!(run.code, 0, "{to}: {}", run.stderr);
    }
    for stem in [
        "02-sphere",
        "03-shading",
        "04-many-objects",
        "05-complex-scene",
        "06-reflections",
        "inputs",
    ] {
        let file = |extension: &str| {
            folder
                .path()
                .join(format!("{stem}.{extension}"))
                .to_str()
                .unwrap()
                .to_owned()
        };
        judge("naga", &[&file("wgsl")]);
        judge("tint", &["--format", "wgsl", &file("wgsl")]);
        judge("spirv-val", &["--target-env", "vulkan1.1", &file("spv")]);
        judge("glslangValidator", &[&file("frag")]);
        assert!(
            fs::read_to_string(file("metal"))
                .unwrap()
                .contains("metal_stdlib")
        );
        assert!(fs::read_to_string(file("hlsl")).unwrap().contains("SV_Target"));
        assert!(
            fs::read_to_string(file("lowered.glsl"))
                .unwrap()
                .starts_with("#version 450")
        );
    }
    let wgsl = |stem: &str| fs::read_to_string(folder.path().join(format!("{stem}.wgsl"))).unwrap();
    assert!(wgsl("inputs").contains("\ndiagnostic(off, derivative_uniformity);\n"));
    assert!(
        !wgsl("02-sphere").contains("diagnostic("),
        "only where it is needed"
    );
}

#[test]
fn several_shaders_need_a_folder() {
    let run = toyproof(root(), &["convert", "glsl", "-o", "all.wgsl"]);
    assert_eq!(run.code, 2);
    assert!(
        run.stderr
            .contains("several shaders cannot be written to all.wgsl"),
        "{}",
        run.stderr
    );
}

#[test]
fn images_of_several_shaders_need_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let glsl = root().join("glsl");
    for output in ["-", "all.png"] {
        let run = toyproof(folder.path(), &["run", glsl.to_str().unwrap(), "-o", output]);
        assert_eq!(run.code, 2);
        assert!(
            run.stderr.contains("several images cannot be written to"),
            "{}",
            run.stderr
        );
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn written_scenes_pass_the_check() {
    let folder = tempfile::tempdir().unwrap();
    assert!(toyproof(root(), &["scenes"]).stdout.contains("05-complex-scene"));
    let run = toyproof(folder.path(), &["scenes", "--write", "course"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for name in [
        "02-sphere.glsl",
        "06-reflections.toml",
        "2d/reference/08-image.png",
    ] {
        let written = fs::read(folder.path().join("course").join(name)).unwrap();
        assert_eq!(written, fs::read(root().join("glsl").join(name)).unwrap());
    }
    // Files changed since are not overwritten.
    let changed = folder.path().join("course/02-sphere.glsl");
    fs::write(&changed, "mine").unwrap();
    let run = toyproof(folder.path(), &["scenes", "--write", "course"]);
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("02-sphere.glsl"), "{}", run.stderr);
    assert_eq!(fs::read_to_string(&changed).unwrap(), "mine");
}

#[test]
fn colors_are_for_terminals_and_can_be_forced_or_disabled() {
    let folder = tempfile::tempdir().unwrap();
    let plain = toyproof(folder.path(), &["check", "nowhere.glsl"]);
    assert!(!plain.stdout.contains('\u{1b}'));
    let forced = run(command(folder.path())
        .args(["check", "nowhere.glsl"])
        .env("CLICOLOR_FORCE", "1"));
    assert!(forced.stdout.contains('\u{1b}'));
    let refused = run(command(folder.path())
        .args(["check", "nowhere.glsl"])
        .env("NO_COLOR", "1"));
    assert!(!refused.stdout.contains('\u{1b}'));
}
