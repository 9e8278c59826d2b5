//! Every number of every exercise, changed by a tenth: each variant gets a verdict, and toyproof never fails.

use std::fs;
use std::ops::Range;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::program::{command, run};
use crate::requirements::require_driver;
use crate::support::{EVERY_EXERCISE, setting};

/// The byte ranges of the numbers in a text, outside of comments and names.
fn literals(text: &str) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let length = |of: &dyn Fn(u8) -> bool| bytes[at..].iter().take_while(|&&byte| of(byte)).count();
        if text[at..].starts_with("//") {
            at += length(&|byte| byte != b'\n');
        } else if bytes[at].is_ascii_alphabetic() || bytes[at] == b'_' {
            at += length(&|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        } else if bytes[at].is_ascii_digit() || (bytes[at] == b'.' && bytes[at + 1].is_ascii_digit()) {
            let is_exponent = |end: usize| bytes[end - 1].eq_ignore_ascii_case(&b'e');
            let mut end = at + 1;
            while bytes[end].is_ascii_alphanumeric()
                || bytes[end] == b'.'
                || (matches!(bytes[end], b'+' | b'-') && is_exponent(end))
            {
                end += 1;
            }
            found.push(at..end);
            at = end;
        } else {
            at += 1;
        }
    }
    found
}

/// The number increased by a tenth, or by one if it is a small integer.
fn changed(literal: &str) -> Option<String> {
    let digits = literal.trim_end_matches(['u', 'U']);
    let suffix = &literal[digits.len()..];
    if let Ok(integer) = digits.parse::<u32>() {
        let changed = integer.checked_add((integer / 10).max(1))?;
        return Some(format!("{changed}{suffix}"));
    }
    let float: f64 = literal.parse().ok()?;
    Some(format!("{:?}", if float == 0.0 { 0.1 } else { float * 1.1 }))
}

#[test]
fn numbers_are_found_and_changed() {
    let text = "vec3 a1 = vec3(.0, 2.5e-1, 7); // 8\nuint b = 0xffu + 3u;";
    let changes: Vec<_> = literals(text).into_iter().map(|at| changed(&text[at])).collect();
    let expected = [Some("0.1"), Some("0.275"), Some("8"), None, Some("4u")];
    assert_eq!(changes, expected.map(|change| change.map(str::to_owned)));
}

/// Checks all exercises, each with its numbers changed: `TOYPROOF_LITERALS` skips all but every nth.
fn sweep(step: usize) {
    let (mut variants, mut slowest) = (0, (Duration::ZERO, String::new()));
    let mut tally = std::collections::BTreeMap::<String, usize>::new();
    for exercise in EVERY_EXERCISE {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), exercise.scene).unwrap();
        for at in literals(exercise.shader) {
            let Some(number) = changed(&exercise.shader[at.clone()]) else {
                continue;
            };
            variants += 1;
            if variants % step != 0 {
                continue;
            }
            let mut shader = exercise.shader.to_owned();
            shader.replace_range(at.clone(), &number);
            fs::write(folder.path().join("a.glsl"), shader).unwrap();
            let start = Instant::now();
            let (size, frame, time) = (
                format!("{}x{}", exercise.size[0], exercise.size[1]),
                exercise.frame.to_string(),
                exercise.time.to_string(),
            );
            let run = run(command(folder.path())
                .args(["check", "a.glsl", "--scene", "scene.toml"])
                .args([
                    "--size", &size, "--frame", &frame, "--time", &time, "--format", "json",
                ]));
            let case = format!("{}: byte {}, {number}", exercise.name, at.start);
            let report: Value =
                serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{case}: {error}"));
            let verdict = report["shaders"][0]["verdict"].as_str().unwrap().to_owned();
            assert_ne!(verdict, "error", "{case}: {}", run.stdout);
            assert_ne!(run.code, 2, "{case}: {}", run.stderr);
            *tally.entry(verdict).or_default() += 1;
            slowest = slowest.max((start.elapsed(), case));
        }
    }
    eprintln!(
        "{tally:?}; slowest {:.1} s: {}",
        slowest.0.as_secs_f64(),
        slowest.1
    );
}

#[test]
fn some_changed_numbers_get_verdicts() {
    if require_driver() {
        sweep(389);
    }
}

/// Over 700 checks, some of which search for a mistake's name for seconds.
#[test]
#[ignore = "takes an hour; run it in release"]
fn all_changed_numbers_get_verdicts() {
    sweep(setting("TOYPROOF_LITERALS", 1));
}
