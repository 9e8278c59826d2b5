//! `toyproof trade` as users run it; scheduling and comparison of runs are tested without a clock, next to
//! the code.

use std::fs;

use serde_json::Value;

use crate::program::toyproof;
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

#[test]
fn bad_input_is_reported_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.glsl"), "void mainImage(").unwrap();
    for (arguments, code, message) in [
        (&["none.toml", "-o", "out"][..], 2, "none.toml"),
        (&["bad.glsl", "-o", "out"], 1, "error"),
        (&["bad.glsl"], 2, "--output"),
        (&["bad.glsl", "-o", "out", "--max-error", "2"], 2, "from 0 to 1"),
    ] {
        let all = [&["trade", "--device", "cpu"], arguments].concat();
        let run = toyproof(folder.path(), &all);
        assert_eq!(run.code, code, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
