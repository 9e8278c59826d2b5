//! The fuzzer's seeds and findings in `fuzz/`, checked by the fuzz targets' own code.

use std::fs;
use std::path::{Path, PathBuf};

#[path = "../../fuzz/judge.rs"]
mod judge;

use judge::{Outcome, judge};

use crate::support::wait::HANG_GUARD;

fn texts(folder: &str) -> Vec<(PathBuf, String)> {
    let folder = Path::new("fuzz").join(folder);
    let mut texts: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "glsl"))
        .map(|path| {
            let text = fs::read_to_string(&path).unwrap();
            (path, text)
        })
        .collect();
    texts.sort();
    texts
}

#[test]
fn seeds_reach_their_targets() {
    let mut valid = 0;
    for (path, text) in texts("seeds") {
        match judge(&text, HANG_GUARD) {
            Outcome::Refused => assert_eq!(path, Path::new("fuzz/seeds/errors.glsl")),
            Outcome::Valid => valid += 1,
            Outcome::Naga(words) => panic!("{}: naga {words}", path.display()),
        }
    }
    assert!(valid > 10, "only {valid} seeds were found");
}

#[test]
fn findings_are_fixed() {
    for (path, text) in texts("regressions") {
        if let Outcome::Naga(words) = judge(&text, HANG_GUARD) {
            panic!("{}: naga {words}", path.display());
        }
    }
}
