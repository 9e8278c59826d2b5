//! Correct and biased shaders by an author who had not seen the code: glass, lamps and stochastic estimators
//! in styles unlike the exercises'.
//!
//! The correct ones were compared with the tracer by other means: double precision pixel by pixel, or the
//! mean of 128 runs on a GPU. Each biased one states in its first line its fault and the error of its
//! converged image.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::program::{command, run};
use crate::requirements::require_driver;

/// Counts the shaders of a folder of `tests/fairness` by verdict, at 160×90.
fn verdicts(kind: &str) -> BTreeMap<String, usize> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let folder = Path::new("tests/fairness").join(kind);
    let run = run(command(&root)
        .arg("check")
        .arg(folder)
        .args(["--size", "160x90", "--format", "json"]));
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let mut counts = BTreeMap::new();
    for shader in report["shaders"].as_array().unwrap() {
        let [name, verdict, reason] =
            ["shader", "verdict", "reason"].map(|field| shader[field].as_str().unwrap_or_default());
        eprintln!("{verdict:<12} {name}: {reason}");
        *counts.entry(verdict.to_owned()).or_default() += 1;
    }
    counts
}

#[test]
#[ignore = "takes minutes; run it in release"]
fn right_shaders_are_accepted_and_biased_ones_are_not() {
    if !require_driver() {
        return;
    }
    let right = verdicts("correct");
    let biased = verdicts("biased");
    eprintln!("right: {right:?}; biased: {biased:?}");
    let count = |counts: &BTreeMap<String, usize>, verdict| counts.get(verdict).copied().unwrap_or_default();
    assert_eq!(count(&right, "wrong"), 0);
    assert!(count(&right, "correct") >= 38, "{right:?}");
    assert_eq!(count(&biased, "correct"), 0);
    assert!(count(&biased, "wrong") >= 46, "{biased:?}");
}
