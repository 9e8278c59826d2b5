//! Texts that are composed before they are compiled: included files, headers of ISF, values of uniforms in files,
//! and assignments next to a shader.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{Run, toyproof};

fn write(folder: &Path, files: &[(&str, &str)]) {
    for (name, text) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// Checks with these arguments in a small size without a GPU, and returns the run and its JSON.
fn check(folder: &Path, arguments: &[&str]) -> (Run, Value) {
    let common = ["--size", "32x18", "--device", "cpu", "--format", "json"];
    let run = toyproof(folder, &[&["check"], arguments, &common].concat());
    let json = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    (run, json)
}

const WAVES: &str = "#include \"lib/wave.glsl\"
#include \"lib/wave.glsl\"
void mainImage(out vec4 color, in vec2 position) {
    color = vec4(vec3(wave(position.x)), 1.0);
}
";
const WAVE: &str = "#ifndef WAVE
#define WAVE
#include \"half.glsl\"
float wave(float x) { return HALF + HALF * sin(x); }
#endif
";
/// What the two are together.
const WHOLE: &str = "float wave(float x) { return 0.5 + 0.5 * sin(x); }
void mainImage(out vec4 color, in vec2 position) { color = vec4(vec3(wave(position.x)), 1.0); }
";

#[test]
fn included_files_are_part_of_the_shader() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("waves.glsl", WAVES),
        ("lib/wave.glsl", WAVE),
        ("lib/half.glsl", "#pragma once\n#define HALF 0.5"),
        ("whole.glsl", WHOLE),
    ];
    write(folder.path(), &files);
    let (_, right) = check(folder.path(), &["waves.glsl", "--reference", "whole.glsl"]);
    assert_eq!(right["shaders"][0]["verdict"], "correct", "{right}");
    // One file comes out.
    let convert = ["convert", "waves.glsl", "-o", "waves.wgsl", "--verify"];
    let converted = toyproof(folder.path(), &convert);
    assert!(converted.stdout.contains("proved"), "{converted:?}");
    // A mistake is found in the file in which it is.
    let wrong = WAVE.replace("HALF + HALF", "HALF - HALF");
    write(folder.path(), &[("lib/wave.glsl", &wrong)]);
    let (run, wrong) = check(folder.path(), &["waves.glsl", "--reference", "whole.glsl"]);
    assert_eq!(wrong["shaders"][0]["verdict"], "wrong");
    let fix = &wrong["shaders"][0]["fix"];
    assert_eq!(
        (&fix["line"], &fix["agreeing"]),
        (&4.into(), &576.into()),
        "{run:?}"
    );
    // So is an error, and a missing file.
    write(folder.path(), &[("lib/half.glsl", "\n#define HALF half")]);
    let (_, invalid) = check(folder.path(), &["waves.glsl"]);
    let errors = invalid["shaders"][0]["diagnostics"].to_string();
    assert!(
        errors.contains("half.glsl") || errors.contains("wave.glsl"),
        "{errors}"
    );
    write(folder.path(), &[("lib/wave.glsl", "\n#include \"none.glsl\"")]);
    let short = toyproof(folder.path(), &["check", "waves.glsl", "--format", "short"]);
    let expected =
        "lib/wave.glsl:2:1: error[E0014]: there is no none.glsl in .: name its folder with --include-dir";
    assert!(short.stdout.contains(expected), "{short:?}");
}

#[test]
fn only_named_folders_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "#include \"../secret.glsl\"\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(SECRET); }\n";
    let files = [
        ("student/a.glsl", shader),
        ("secret.glsl", "#define SECRET 1.0\n"),
    ];
    write(folder.path(), &files);
    let (_, refused) = check(folder.path(), &["student/a.glsl"]);
    let errors = refused["shaders"][0]["diagnostics"].to_string();
    assert!(errors.contains("is outside of the shader's folder"), "{errors}");
    let (_, allowed) = check(folder.path(), &["student/a.glsl", "--include-dir", "."]);
    assert_eq!(allowed["shaders"][0]["verdict"], "ok");
}

#[test]
fn a_submission_cannot_include_a_shader_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("hw/solution.glsl", WHOLE),
        ("hw/copy.glsl", "#include \"solution.glsl\"\n"),
    ];
    write(folder.path(), &files);
    let (_, refused) = check(folder.path(), &["hw/copy.glsl"]);
    let errors = refused["shaders"][0]["diagnostics"].to_string();
    assert!(
        errors.contains("solution.glsl is a shader on its own"),
        "{errors}"
    );
    let (_, allowed) = check(folder.path(), &["hw/copy.glsl", "--include-dir", "hw"]);
    assert_eq!(allowed["shaders"][0]["verdict"], "ok");
}

#[test]
fn results_are_not_reused_after_an_included_file_has_changed() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "#include \"level.glsl\"\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(LEVEL); }\n";
    write(
        folder.path(),
        &[("a.glsl", shader), ("level.glsl", "#define LEVEL 1.0\n")],
    );
    let resumed = || {
        let run = toyproof(
            folder.path(),
            &[
                "check", "a.glsl", "--size", "8x8", "--device", "cpu", "--out", "out", "--resume", "-v",
            ],
        );
        format!("{}{}", run.stdout, run.stderr).contains("reused")
    };
    assert!(!resumed());
    assert!(resumed());
    write(folder.path(), &[("level.glsl", "#define LEVEL 0.5\n")]);
    assert!(!resumed());
}

#[test]
fn a_project_includes_files_and_has_uniforms() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("p/common.glsl", "#include \"scale.glsl\"\nuniform float speed;\n"),
        ("p/scale.glsl", "#define SCALE 0.5\n"),
        (
            "p/image.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(SCALE * speed), 1.0); }\n",
        ),
        ("p/project.toml", "[uniforms]\nspeed = 0.5\nsped = [1, 2]\n"),
        (
            "quarter.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(0.25), 1.0); }\n",
        ),
    ];
    write(folder.path(), &files);
    let (_, report) = check(folder.path(), &["p", "--reference", "quarter.glsl"]);
    let shader = &report["shaders"][0];
    assert_eq!(shader["verdict"], "correct", "{shader}");
    let warnings = shader["diagnostics"].to_string();
    assert!(warnings.contains("no uniform `sped`"), "{warnings}");
    let (_, other) = check(
        folder.path(),
        &["p", "--reference", "quarter.glsl", "--uniform", "speed=1"],
    );
    assert_eq!(other["shaders"][0]["verdict"], "wrong");
}

#[test]
fn inputs_of_isf_have_their_defaults() {
    let folder = tempfile::tempdir().unwrap();
    let isf = "/*{ \"ISFVSN\": \"2\", \"INPUTS\": [
    { \"NAME\": \"level\", \"TYPE\": \"float\", \"DEFAULT\": 0.25 },
    { \"NAME\": \"inputImage\", \"TYPE\": \"image\" } ] }*/
void main() {
    vec2 st = gl_FragCoord.xy / RENDERSIZE;
    gl_FragColor = vec4(isf_FragNormCoord - st + level, 0, 1) + IMG_THIS_PIXEL(inputImage);
}
";
    let same = "void mainImage(out vec4 c, in vec2 p) {
    c = vec4(0.25, 0.25, 0.0, 1.0) + texture(iChannel0, p / iResolution.xy);
}
";
    write(folder.path(), &[("a.fs", isf), ("same.glsl", same)]);
    let reference = ["a.fs", "--reference", "same.glsl", "--channel0", "noise"];
    let (_, report) = check(folder.path(), &reference);
    let shader = &report["shaders"][0];
    assert_eq!(
        (&shader["verdict"], &shader["dialect"]["host"]),
        (&"correct".into(), &"isf".into()),
        "{shader}"
    );
    let (_, other) = check(
        folder.path(),
        &[&reference[..], &["--uniform", "level=0.5"]].concat(),
    );
    assert_eq!(other["shaders"][0]["verdict"], "wrong");
}

#[test]
fn an_assignment_next_to_a_shader_is_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "uniform float u_time, level;
void main() { gl_FragColor = vec4(vec3(level * u_time), 1.0); }
";
    let reference = "void mainImage(out vec4 c, in vec2 p) { c = vec4(vec3(0.5 * iTime), 1.0); }\n";
    let assignment =
        "reference = \"reference/a.glsl\"\n[[frame]]\nsize = [8, 8]\ntime = 0.5\n[uniforms]\nlevel = 0.5\n";
    let files = [
        ("a.frag", shader),
        ("b.frag", shader),
        ("a.toml", assignment),
        ("reference/a.glsl", reference),
        ("broken.frag", shader),
        ("broken.toml", "reference = \"none.glsl\"\n"),
    ];
    write(folder.path(), &files);
    let run = toyproof(
        folder.path(),
        &["check", ".", "--device", "cpu", "--format", "json"],
    );
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let shaders = report["shaders"].as_array().unwrap();
    let found = shaders.iter().map(|shader| {
        let reference = shader["reference"].as_str().unwrap_or("none");
        let [name, verdict] = [&shader["shader"], &shader["verdict"]].map(|text| text.as_str().unwrap());
        format!("{name} {verdict} {reference}")
    });
    assert_eq!(
        found.collect::<Vec<_>>(),
        [
            "./a.frag correct ./reference/a.glsl",
            "./b.frag ok none",
            "./broken.frag error none"
        ],
        "{run:?}"
    );
    assert!(
        run.stdout.contains("there is no file \\\"none.glsl\\\""),
        "{run:?}"
    );
}

#[test]
fn a_feature_earns_points_for_the_pixels_that_it_changes() {
    let folder = tempfile::tempdir().unwrap();
    // The feature is the left quarter; the student has the upper half of it.
    let shader = |left: &str| {
        format!(
            "void mainImage(out vec4 c, in vec2 p) {{ c = vec4(0.2, 0.2, 0.2, 1.0); if (p.x < 8.0{left}) c.r = 1.0; }}\n"
        )
    };
    let assignment = "reference = \"solution.glsl\"\n[[frame]]\nsize = [32, 18]\n[[feature]]\nname = \"left part\"\n\
                      without = \"without.glsl\"\npoints = 4\n";
    let [solution, half, without] = ["", " && p.y > 9.0", " && false"].map(shader);
    let files = [
        ("solution.glsl", &*solution),
        ("without.glsl", &*without),
        ("hw/right.glsl", &*solution),
        ("hw/half.glsl", &*half),
        ("hw/none.glsl", &*without),
        ("hw/invalid.glsl", "void mainImage("),
        ("a.toml", assignment),
        ("same.toml", &assignment.replace("without.glsl", "solution.glsl")),
    ];
    write(folder.path(), &files);
    let check = |assignment: &str| {
        let arguments = [
            "check",
            "hw",
            "--assignment",
            assignment,
            "--device",
            "cpu",
            "--out",
            "out",
        ];
        toyproof(folder.path(), &arguments)
    };
    let run = check("a.toml");
    let csv = fs::read_to_string(folder.path().join("out/report.csv")).unwrap();
    let column = csv
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == "points");
    let column = column.unwrap_or_else(|| panic!("{csv}"));
    let points = |name: &str| {
        let line = csv.lines().find(|line| line.contains(name)).unwrap();
        line.split(',').nth(column).unwrap().to_owned()
    };
    let all = ["right", "half", "none", "invalid"].map(points);
    assert_eq!(all, ["4", "2", "0", "0"], "{csv}");
    assert!(
        run.stdout
            .contains("left part: 72 of the 144 pixels that it changes are right"),
        "{run:?}"
    );
    let same = check("same.toml");
    assert!(
        same.code == 2 && same.stderr.contains("changes no pixel"),
        "{same:?}"
    );
}

#[test]
fn passes_of_isf_are_buffers() {
    let folder = tempfile::tempdir().unwrap();
    let isf = "/*{ \"ISFVSN\": \"2\", \"PASSES\": [{ \"TARGET\": \"sum\", \"PERSISTENT\": true, \"FLOAT\": true }, {}] }*/
void main() {
    gl_FragColor = IMG_THIS_PIXEL(sum) * (PASSINDEX == 0 ? 0.5 : 1.0);
    if (PASSINDEX == 0) gl_FragColor += vec4(isf_FragNormCoord, 0.25, 0.0);
}
";
    let buffer = "void mainImage(out vec4 c, in vec2 p) {
    c = texture(iChannel0, p / iResolution.xy) * 0.5 + vec4(p / iResolution.xy, 0.25, 0.0);
}
";
    let image = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p / iResolution.xy); }\n";
    let frames = [
        ("a.fs", isf),
        ("p/buffer-a.glsl", buffer),
        ("p/image.glsl", image),
    ];
    write(folder.path(), &frames);
    let (_, report) = check(folder.path(), &["a.fs", "--reference", "p", "--frame", "3"]);
    let shader = &report["shaders"][0];
    assert_eq!(
        (&shader["verdict"], &shader["dialect"]["host"]),
        (&"correct".into(), &"isf".into()),
        "{shader}"
    );
    let (_, other) = check(
        folder.path(),
        &["a.fs", "--reference", "p/buffer-a.glsl", "--frame", "3"],
    );
    assert_eq!(other["shaders"][0]["verdict"], "wrong");
}
