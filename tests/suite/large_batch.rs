//! Batches whose report has several pages.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{Run, toyproof};

/// More than the 500 shaders of one page.
const SHADERS: usize = 620;

/// Shaders that take no time: nearly all do not compile.
fn shaders() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("hw")).unwrap();
    for at in 0..SHADERS {
        let body = if at % 100 == 7 {
            format!("c = vec4({at}.0 / 1000.0);")
        } else {
            format!("c = missing{at};")
        };
        fs::write(
            folder.path().join(format!("hw/{at:03}.glsl")),
            format!("void mainImage(out vec4 c, in vec2 p) {{ {body} }}\n"),
        )
        .unwrap();
    }
    folder
}

fn check(folder: &Path, rest: &[&str]) -> Run {
    let common = ["check", "hw", "--device", "cpu", "--size", "16x9", "-q", "--out"];
    toyproof(folder, &[&common[..], rest].concat())
}

/// Every report of a folder apart from times and the date of the pages.
fn reports(folder: &Path) -> BTreeMap<&'static str, String> {
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let mut verdict: Value = serde_json::from_str(&read("verdict.json")).unwrap();
    for shader in verdict["shaders"].as_array_mut().unwrap() {
        shader["seconds"] = Value::Null;
    }
    let csv = read("report.csv");
    // The time is the 24th of 28 cells; no cell of these shaders has a comma.
    let csv = csv.lines().map(|line| {
        let cells: Vec<_> = line.split(',').collect();
        [&cells[..23], &cells[24..]].concat().join(",") + "\n"
    });
    BTreeMap::from([
        ("verdict.json", verdict.to_string()),
        ("report.csv", csv.collect()),
        ("report.sarif", read("report.sarif")),
    ])
}

#[test]
fn every_report_has_every_shader_also_after_a_resumed_and_a_merged_run() {
    let folder = shaders();
    let folder = folder.path();
    let run = check(folder, &["one"]);
    assert_eq!((run.code, run.stdout.lines().count()), (1, SHADERS));
    let one = reports(&folder.join("one"));
    let verdict: Value = serde_json::from_str(&one["verdict.json"]).unwrap();
    let names = verdict["shaders"].as_array().unwrap().iter();
    let names: Vec<_> = names.map(|record| record["shader"].as_str().unwrap()).collect();
    let expected: Vec<_> = (0..SHADERS).map(|at| format!("hw/{at:03}.glsl")).collect();
    assert_eq!(names, expected);
    assert_eq!(one["report.csv"].lines().count(), SHADERS + 1);
    for at in [0, 499, 500, SHADERS - 1] {
        let (row, name) = (one["report.csv"].lines().nth(at + 1).unwrap(), &expected[at]);
        assert!(row.starts_with(&format!("{name},,,invalid,")), "{row}");
    }
    let sarif: Value = serde_json::from_str(&one["report.sarif"]).unwrap();
    let results = sarif["runs"][0]["results"].as_array().unwrap();
    let invalid = SHADERS - SHADERS.div_ceil(100);
    assert!(results.len() >= invalid, "{}", results.len());
    let junit = fs::read_to_string(folder.join("one/junit.xml")).unwrap();
    let junit = roxmltree::Document::parse(&junit).unwrap();
    let suite = junit
        .descendants()
        .find(|node| node.has_tag_name("testsuite"))
        .unwrap();
    assert_eq!(suite.attribute("tests"), Some(&*SHADERS.to_string()));
    assert_eq!(suite.attribute("failures"), Some(&*invalid.to_string()));
    assert_eq!(
        suite
            .descendants()
            .filter(|node| node.has_tag_name("testcase"))
            .count(),
        SHADERS
    );
    let index = fs::read_to_string(folder.join("one/report.html")).unwrap();
    assert_eq!(index.matches("<tr data-verdict=").count(), SHADERS);
    let last = fs::read_to_string(folder.join("one/report/0002.html")).unwrap();
    assert_eq!(last.matches("<article id=").count(), SHADERS - 500);

    // The results of an interrupted run, with half a line at its end.
    let results = fs::read_to_string(folder.join("one/results.jsonl")).unwrap();
    let (half, _) = results.split_at(results.len() / 2);
    fs::create_dir(folder.join("resumed")).unwrap();
    fs::write(folder.join("resumed/results.jsonl"), half).unwrap();
    let run = check(folder, &["resumed", "--resume"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert_eq!(reports(&folder.join("resumed")), one);
    let resumed = fs::read_to_string(folder.join("resumed/results.jsonl")).unwrap();
    assert_eq!(resumed.lines().count(), SHADERS);

    for shard in ["1/2", "2/2"] {
        let out = format!("shards/{}", &shard[..1]);
        assert_eq!(check(folder, &[&out, "--shard", shard]).code, 0);
    }
    let merged = toyproof(
        folder,
        &["merge", "shards/2", "shards/1", "--out", "merged", "-q"],
    );
    assert_eq!(merged.code, 1, "{}", merged.stderr);
    assert_eq!(reports(&folder.join("merged")), one);
}
