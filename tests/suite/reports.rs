//! The files that `check --out` writes for other programs, tested through the command line.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{Run, check_homework, run, toyproof};
use crate::support::SPHERE;

const RUBRIC: &str =
    "[compiles]\npoints = 2\n[algorithm]\npoints = 6\npartial_from = 0.0\n[precision]\npoints = 2\n";

/// Creates three submissions: correct, wrong, and one that does not compile.
fn homework() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("hw")).unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("scene.toml", SPHERE.scene);
    write("rubric.toml", RUBRIC);
    write("hw/ann.glsl", SPHERE.shader);
    write(
        "hw/bob.glsl",
        &SPHERE
            .shader
            .replace("sphere.radius * sphere.radius", "sphere.radius"),
    );
    write(
        "hw/<b>cyd & co.glsl",
        &SPHERE.shader.replace("float disc", "flaot disc"),
    );
    folder
}

fn check(folder: &Path, rest: &[&str]) -> Run {
    run(check_homework(folder).args(rest))
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join("out").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_report_lists_every_shader() {
    let folder = homework();
    let run = check(folder.path(), &["--out", "out", "--rubric", "rubric.toml"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    let verdicts: Value = serde_json::from_str(&read(folder.path(), "verdict.json")).unwrap();
    let verdicts = verdicts["shaders"].as_array().unwrap();
    let text = read(folder.path(), "junit.xml");
    let junit = roxmltree::Document::parse(&text).unwrap();
    let cases: Vec<_> = junit
        .descendants()
        .filter(|node| node.has_tag_name("testcase"))
        .collect();
    let rows = read(folder.path(), "report.csv");
    assert_eq!(rows.lines().count(), 1 + 3, "{rows}");
    assert_eq!(cases.len(), 3);
    for (record, case) in verdicts.iter().zip(cases) {
        assert_eq!(case.attribute("name"), record["shader"].as_str());
        assert!(rows.contains(record["shader"].as_str().unwrap()), "{rows}");
    }
    let sarif: Value = serde_json::from_str(&read(folder.path(), "report.sarif")).unwrap();
    let results = sarif["runs"][0]["results"].as_array().unwrap();
    let place = |id: &str| {
        let result = results.iter().find(|result| result["ruleId"] == id);
        result.unwrap_or_else(|| panic!("{id}: {results:?}"))["locations"][0]["physicalLocation"].clone()
    };
    assert_eq!(place("wrong")["artifactLocation"]["uri"], "hw/bob.glsl");
    let reported = &verdicts
        .iter()
        .find(|record| record["verdict"] == "invalid")
        .unwrap()["diagnostics"][0];
    let place = place(reported["code"].as_str().unwrap());
    assert_eq!(place["artifactLocation"]["uri"], "hw/%3Cb%3Ecyd%20%26%20co.glsl");
    assert_eq!(
        (&place["region"]["startLine"], &place["region"]["startColumn"]),
        (&reported["line"], &reported["column"])
    );
    let marks: Value = serde_json::from_str(&read(folder.path(), "results.json")).unwrap();
    let scores: Vec<_> = marks["tests"]
        .as_array()
        .unwrap()
        .iter()
        .map(|test| test["score"].as_f64().unwrap())
        .collect();
    let of = |name: &str| {
        let at = verdicts
            .iter()
            .position(|record| record["shader"].as_str().unwrap().contains(name));
        &scores[3 * at.unwrap()..][..3]
    };
    assert_eq!(
        (of("ann"), of("cyd")),
        ([2.0, 6.0, 2.0].as_slice(), [0.0; 3].as_slice())
    );
    let bob = of("bob");
    assert!(bob[0] == 2.0 && bob[1] > 0.0 && bob[1] < 6.0, "{bob:?}");
}

#[test]
fn marks_need_a_rubric_and_one_submission_needs_no_name() {
    let folder = homework();
    let alone = toyproof(
        folder.path(),
        &[
            "check",
            "hw/ann.glsl",
            "--scene",
            "scene.toml",
            "--device",
            "cpu",
            "--size",
            "64x36",
            "--out",
            "out",
        ],
    );
    assert_eq!(alone.code, 0, "{}", alone.stderr);
    assert!(!folder.path().join("out/results.json").exists());
    let bare = check(folder.path(), &["--rubric", "rubric.toml"]);
    assert!(bare.code == 2 && bare.stderr.contains("--out"), "{}", bare.stderr);
}

#[test]
fn invalid_rubrics_are_reported_before_any_work() {
    let folder = homework();
    fs::write(folder.path().join("rubric.toml"), "[algorithm]\npoints = -3\n").unwrap();
    let run = check(folder.path(), &["--out", "out", "--rubric", "rubric.toml"]);
    assert_eq!(run.code, 2);
    assert!(
        run.stderr.contains("E0504") && run.stderr.contains("rubric.toml:2:10"),
        "{}",
        run.stderr
    );
    assert!(!folder.path().join("out").exists());
    let missing = check(folder.path(), &["--out", "out", "--rubric", "none.toml"]);
    assert!(
        missing.code == 2 && missing.stderr.contains("none.toml"),
        "{}",
        missing.stderr
    );
}
