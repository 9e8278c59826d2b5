//! `toyproof trade` as users run it; scheduling and comparison of runs are tested without a clock, next to
//! the code.

use std::fs;

use serde_json::Value;
use toyproof::gpu::lavapipe_manifest;

use crate::program::toyproof;
use crate::requirements::require_driver;
use crate::support::{REFLECTIONS, SPHERE};

#[test]
fn a_scene_and_its_shader_are_measured() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), SPHERE.scene).unwrap();
    fs::write(folder.path().join("s.glsl"), SPHERE.shader).unwrap();
    let arguments = [
        "trade", "s.toml", "-o", "out", "--device", "cpu", "--budget", "4s", "--size", "64x36",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for text in [
        "Speed against accuracy: s, 64×36 pixels\n",
        "time per frame  configuration",
        "below 1/1000",
        "most accurate",
        "f64 takes ",
    ] {
        assert!(run.stdout.contains(text), "{text}: {}", run.stdout);
    }
    let out = folder.path().join("out");
    let csv = fs::read_to_string(out.join("trade.csv")).unwrap();
    let head = csv.lines().next().unwrap();
    assert!(
        head.starts_with("renderer,precision,sampler,samples_per_pixel,") && head.contains(",rmse,"),
        "{head}"
    );
    assert!(
        csv.contains("\r\ntracer,f64,,,,,") && csv.contains("\r\nevaluator,f32,,,,recentered,"),
        "{csv}"
    );
    let json: Value = serde_json::from_str(&fs::read_to_string(out.join("trade.json")).unwrap()).unwrap();
    let configurations = json["configurations"].as_array().unwrap();
    assert!(
        configurations.len() >= 10 && configurations.iter().any(|one| one["on_pareto_front"] == true),
        "{json}"
    );
    let is_reference = |one: &&Value| one["renderer"] == "tracer" && one["precision"] == "f64";
    let exact = configurations.iter().find(is_reference).unwrap();
    assert_eq!(
        (
            exact["error"]["rmse"].as_f64(),
            exact["error"]["silhouette_flips"].as_u64()
        ),
        (Some(0.0), Some(0))
    );
    assert!(
        fs::read_to_string(out.join("trade.svg"))
            .unwrap()
            .contains("</svg>")
    );
    assert!(out.join("trade.png").is_file());
}

#[test]
fn each_feature_of_a_scene_has_a_price() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), REFLECTIONS.scene).unwrap();
    let arguments = [
        "trade",
        "s.toml",
        "--features",
        "-o",
        "out",
        "--device",
        "cpu",
        "--budget",
        "3s",
        "--size",
        "32x18",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for text in [
        "Price of each feature: s, 32×18 pixels\n",
        "tracer f32",
        "evaluator f32",
        "  secondary rays",
    ] {
        assert!(run.stdout.contains(text), "{text}: {}", run.stdout);
    }
    let json = fs::read_to_string(folder.path().join("out/features.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    let features = json["features"].as_array().unwrap();
    let rays = features
        .iter()
        .find(|feature| feature["name"] == "secondary rays")
        .unwrap();
    assert!(rays["changed_pixels"].as_u64().unwrap() > 0, "{rays}");
    assert_eq!(rays["prices"].as_array().unwrap().len(), 2, "{rays}");
    let shader = toyproof(folder.path(), &["trade", "x.glsl", "--features"]);
    assert!(
        shader.code == 2 && shader.stderr.contains("--features takes a scene"),
        "{}",
        shader.stderr
    );
}

#[test]
fn a_maximum_error_prints_one_line() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), REFLECTIONS.scene).unwrap();
    let arguments = [
        "trade",
        "s.toml",
        "--max-error",
        "0.01",
        "--device",
        "cpu",
        "--budget",
        "2s",
        "--size",
        "32x18",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert_eq!(run.stdout.lines().count(), 1, "{}", run.stdout);
    assert!(
        run.stdout.starts_with("fastest configuration with RMSE ≤ 0.01: "),
        "{}",
        run.stdout
    );
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        1,
        "nothing is written"
    );
}

#[test]
fn skipped_methods_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), REFLECTIONS.scene).unwrap();
    let arguments = [
        "trade",
        "s.toml",
        "--max-error",
        "0.01",
        "--device",
        "cpu",
        "--budget",
        "1ms",
        "-o",
        "out",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 2, "{}", run.stdout);
    assert!(
        run.stderr.contains("nothing was measured") && run.stderr.contains("did not fit in the time budget"),
        "{}",
        run.stderr
    );
    assert!(!folder.path().join("out").exists());
}

/// A march with many more steps than its image needs.
const MARCH: &str = include_str!("../marching/steps.glsl");

/// Measures the settings of a shader, and returns the standard output and the results.
fn settings_of(files: &[(&str, &str)], arguments: &[&str]) -> (String, Value) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
        fs::write(folder.path().join(name), text).unwrap();
    }
    let common = ["trade", "-o", "out", "--device", "cpu", "--budget", "8s"];
    let run = toyproof(folder.path(), &[&common, arguments].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let json = fs::read_to_string(folder.path().join("out/trade.json")).unwrap();
    (run.stdout, serde_json::from_str(&json).unwrap())
}

/// The results whose only setting is of this parameter, by its value.
fn values_of(json: &Value, parameter: &str) -> Vec<(f64, Value)> {
    let configurations = json["configurations"].as_array().unwrap().iter();
    let of_one = configurations.filter_map(|one| match &one["settings"].as_array().unwrap()[..] {
        [setting] if setting["parameter"] == parameter => {
            Some((setting["value"].as_f64().unwrap(), one.clone()))
        }
        _ => None,
    });
    of_one.collect()
}

#[test]
fn parameters_of_loops_are_proposed() {
    // So many steps that no noise hides what they cost.
    let many = MARCH.replace("256", "4096");
    let (stdout, json) = settings_of(&[("march.glsl", &many)], &["march.glsl", "--size", "96x54"]);
    let steps = values_of(&json, "MAX_STEPS");
    let pixels = 96 * 54;
    let is_free = |(value, one): &(f64, Value)| {
        *value < 3000.0 && one["changed_pixels"].as_u64().unwrap() * 1000 <= pixels
    };
    assert!(steps.iter().any(is_free), "{json:#}");
    // A part of the steps is that part of the work.
    assert!(
        stdout.contains("`MAX_STEPS` ") && stdout.contains(" instead of 4096: times as fast: "),
        "{stdout}"
    );
}

#[test]
fn named_parameters_are_varied() {
    let uniform = MARCH
        .replace("#define MAX_STEPS 256", "uniform float steps;")
        .replace("MAX_STEPS", "int(steps)");
    let (common, image) = MARCH.split_once("const float HIT").unwrap();
    let image = format!("const float HIT{image}");
    let line = MARCH.lines().position(|line| line.contains("0.9 * map")).unwrap() + 1;
    let with_line = format!("{line}=0.25,1");
    for (files, arguments, parameter, values) in [
        (
            &[("a.glsl", MARCH)][..],
            &["a.glsl", "--vary", "MAX_STEPS=64,128"][..],
            "MAX_STEPS",
            [64.0, 128.0],
        ),
        (
            &[("a.glsl", MARCH)],
            &["a.glsl", "--vary", "FAR=10,20"],
            "FAR",
            [10.0, 20.0],
        ),
        (
            &[("a.glsl", &uniform)],
            &["a.glsl", "--uniform", "steps=256", "--vary", "steps=8,16"],
            "steps",
            [8.0, 16.0],
        ),
        (
            &[("a.glsl", MARCH)],
            &["a.glsl", "--vary", &with_line],
            &format!("step in line {line}"),
            [0.25, 1.0],
        ),
        (
            &[("p/common.glsl", common), ("p/image.glsl", &image)],
            &["p", "--vary", "MAX_STEPS=8,16"],
            "MAX_STEPS",
            [8.0, 16.0],
        ),
    ] {
        let (_, json) = settings_of(files, &[arguments, &["--size", "32x18"]].concat());
        let mut found: Vec<f64> = values_of(&json, parameter)
            .iter()
            .map(|(value, _)| *value)
            .collect();
        found.sort_by(f64::total_cmp);
        assert_eq!(found, values, "{arguments:?}: {json:#}");
    }
}

#[test]
fn parameters_in_included_files_change_the_image() {
    let (included, image) = MARCH.split_once("const float HIT").unwrap();
    let image = format!("#include \"march.h\"\nconst float HIT{image}");
    let project = [
        ("p/march.h", included),
        ("p/common.glsl", "const float SCALE = 1.0;\n"),
        ("p/image.glsl", &image),
    ];
    let shader = [("march.h", included), ("a.glsl", &image)];
    for (files, subject) in [(&project[..], "p"), (&shader, "a.glsl")] {
        let (_, json) = settings_of(files, &[subject, "--vary", "MAX_STEPS=1,2", "--size", "32x18"]);
        let values = values_of(&json, "MAX_STEPS");
        assert!(!values.is_empty(), "{subject}: {json:#}");
        for (value, one) in values {
            assert!(
                one["error"]["differing_pixels_8bit"].as_u64() > Some(0),
                "{subject}, {value}: {one:#}"
            );
        }
    }
}

#[test]
fn a_shader_or_a_scene_is_the_reference() {
    let few = MARCH.replace("256", "4");
    let files = [("few.glsl", few.as_str()), ("many.glsl", MARCH)];
    let arguments = [
        "few.glsl",
        "--reference",
        "many.glsl",
        "--vary",
        "MAX_STEPS=256",
        "--size",
        "64x36",
    ];
    let (_, json) = settings_of(&files, &arguments);
    let error = |one: &Value| one["error"]["visible_pixels"].as_u64().unwrap();
    let own = json["configurations"].as_array().unwrap().iter();
    let own = own.filter(|one| one["settings"].as_array().unwrap().is_empty());
    assert!(
        own.clone().count() > 0 && own.clone().all(|one| error(one) > 20),
        "{json:#}"
    );
    assert_eq!(error(&values_of(&json, "MAX_STEPS")[0].1), 0);
}

/// Roots of a quadratic whose terms cancel: a small sphere far away.
const FAR_SPHERE: &str = "\
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = (fragCoord - 0.5 * iResolution.xy) / iResolution.y;
    vec3 direction = normalize(vec3(0.002 * uv, -1.0));
    vec3 oc = vec3(0.0, 0.0, 2000.0);
    float b = dot(oc, direction);
    float disc = b * b - (dot(oc, oc) - 1.0);
    fragColor = vec4(vec3(disc > 0.0 ? sqrt(disc) : 0.0), 1.0);
}
";

#[test]
fn cancellations_are_rewritten() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.glsl"), FAR_SPHERE).unwrap();
    fs::write(
        folder.path().join("flat.glsl"),
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.5); }",
    )
    .unwrap();
    let common = ["trade", "--rewrite", "--size", "96x54", "-o", "out"];
    let run = toyproof(folder.path(), &[&common[..], &["a.glsl"]].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout
            .contains("the distance of the center from the ray as a vector")
            && run.stdout.contains(" → 0 pixels"),
        "{}",
        run.stdout
    );
    // The rewritten shader is precise.
    let run = toyproof(folder.path(), &[&common[..], &["out/rewritten.glsl"]].concat());
    assert!(
        run.stdout.contains("precise enough in all pixels"),
        "{}",
        run.stdout
    );
    let run = toyproof(folder.path(), &[&common[..], &["flat.glsl"]].concat());
    assert!(
        run.stdout.contains("precise enough in all pixels"),
        "{}",
        run.stdout
    );
    // `check` offers the edit, too.
    let run = toyproof(
        folder.path(),
        &["check", "a.glsl", "--device", "cpu", "--size", "96x54"],
    );
    assert!(
        run.stderr.contains("W0602") && run.stderr.contains("as a vector"),
        "{}\n{}",
        run.stdout,
        run.stderr
    );
}

#[test]
fn variables_of_sixteen_bits_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let text = "\
float grid(float x) { return fract(x * 1000.0); }
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float fine = fragCoord.x / iResolution.x;
    vec3 coarse = vec3(0.25, 0.5, 0.75);
    fragColor = vec4(coarse * grid(fine), 1.0);
}
";
    fs::write(folder.path().join("a.glsl"), text).unwrap();
    let run = toyproof(
        folder.path(),
        &["trade", "a.glsl", "--mediump", "--size", "96x54", "-o", "out"],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    if require_driver() && lavapipe_manifest().is_some() {
        let line = "lavapipe in 16 bits: 0 visible pixels, 0 unlike the emulation; ";
        assert!(run.stdout.contains(line), "{}", run.stdout);
    }
    let changed = fs::read_to_string(folder.path().join("out/mediump.glsl")).unwrap();
    // A thousandth of the width needs more than 11 bits; colors do not.
    assert!(
        changed.contains("    float fine") && changed.contains("    mediump vec3 coarse"),
        "{changed}"
    );
}

#[test]
fn bad_input_is_reported_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.glsl"), "void mainImage(").unwrap();
    let good = "const int STEPS = 4; void mainImage(out vec4 c, in vec2 p) { c = vec4(STEPS); }";
    fs::write(folder.path().join("good.glsl"), good).unwrap();
    for (arguments, code, message) in [
        (&["none.toml", "-o", "out"][..], 2, "none.toml"),
        (&["bad.glsl", "-o", "out"], 1, "error"),
        (&["bad.glsl"], 2, "--output"),
        (&["bad.glsl", "-o", "out", "--max-error", "2"], 2, "from 0 to 1"),
        (
            &["bad.glsl", "-o", "out", "--vary", "N"],
            2,
            "such as MAX_STEPS=16..256",
        ),
        (
            &["good.glsl", "-o", "out", "--vary", "STEP=1..2"],
            2,
            "did you mean `STEPS`?",
        ),
        (
            &["none.toml", "-o", "out", "--rewrite"],
            2,
            "--rewrite and --mediump take a shader",
        ),
    ] {
        let all = [&["trade", "--device", "cpu"], arguments].concat();
        let run = toyproof(folder.path(), &all);
        assert_eq!(run.code, code, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}
