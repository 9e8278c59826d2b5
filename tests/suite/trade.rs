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
        "trade", "s.toml", "-o", "out", "--on", "cpu", "--budget", "4s", "--size", "64x36",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for error in ["1/255", "0.5/255", "1/1000"] {
        let says = format!("the cheapest way to be within {error} of the truth is ");
        assert!(run.stdout.contains(&says), "{}", run.stdout);
    }
    let out = folder.path().join("out");
    let csv = fs::read_to_string(out.join("trade.csv")).unwrap();
    let head = "way,group,runs,outliers,median_ms,mad_ms,rmse,max,mismatches_8bit,flips,pareto";
    assert_eq!(csv.lines().next(), Some(head));
    assert!(
        csv.contains("\"tracer f64\"") && csv.contains("\"evaluator f32, recentered\""),
        "{csv}"
    );
    let json: Value = serde_json::from_str(&fs::read_to_string(out.join("trade.json")).unwrap()).unwrap();
    let ways = json["ways"].as_array().unwrap();
    assert!(
        ways.len() >= 10 && ways.iter().any(|way| way["best"] == true),
        "{json}"
    );
    let exact = ways.iter().find(|way| way["way"] == "tracer f64").unwrap();
    assert_eq!(
        (exact["error"]["rmse"].as_f64(), exact["error"]["flips"].as_u64()),
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
        "--on",
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
        run.stdout
            .starts_with("the cheapest way to be within 0.01 of the truth is "),
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
        "--on",
        "cpu",
        "--budget",
        "1ms",
        "-o",
        "out",
    ];
    let run = toyproof(folder.path(), &arguments);
    assert_eq!(run.code, 2, "{}", run.stdout);
    assert!(
        run.stderr.contains("nothing was measured") && run.stderr.contains("no time for"),
        "{}",
        run.stderr
    );
    assert!(!folder.path().join("out").exists());
}

#[test]
fn bad_input_is_reported_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.glsl"), "void mainImage(").unwrap();
    for (arguments, code, says) in [
        (&["none.toml", "-o", "out"][..], 2, "none.toml"),
        (&["bad.glsl", "-o", "out"], 1, "error"),
        (&["bad.glsl"], 2, "--output"),
        (&["bad.glsl", "-o", "out", "--max-error", "2"], 2, "from 0 to 1"),
    ] {
        let all = [&["trade", "--on", "cpu"], arguments].concat();
        let run = toyproof(folder.path(), &all);
        assert_eq!(run.code, code, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(says), "{arguments:?}: {}", run.stderr);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
