//! The fuzzer's seeds and findings in `fuzz/`, checked by the fuzz targets' own judges.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::judge::front_end::Outcome;
use crate::support::judge::{front_end, images, programs, projects, records, scenes};
use crate::support::wait::HANG_GUARD;

/// The files of a target; none if it has no such folder.
fn files(folder: &str, target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new("fuzz").join(folder).join(target);
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut files: Vec<_> = entries
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.clone(), fs::read(path).unwrap()))
        .collect();
    files.sort();
    files
}

/// Judges all files of a target; returns the names of those that are accepted.
fn judge(folder: &str, target: &str, mut is_accepted: impl FnMut(&[u8]) -> bool) -> Vec<String> {
    let mut accepted = Vec::new();
    for (path, bytes) in files(folder, target) {
        eprintln!("{}", path.display());
        if is_accepted(&bytes) {
            accepted.push(path.file_name().unwrap().to_string_lossy().into_owned());
        }
    }
    accepted
}

/// Judges all files of all targets but `front_end`; returns the number of those that are accepted, by target.
fn judge_others(folder: &str) -> [(&'static str, usize); 5] {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap_or_default();
    let temporary = tempfile::tempdir().unwrap();
    [
        (
            "scenes",
            judge(folder, "scenes", |bytes| scenes::judge(&text(bytes), HANG_GUARD)),
        ),
        (
            "images",
            judge(folder, "images", |bytes| {
                images::judge(bytes, temporary.path(), HANG_GUARD)
            }),
        ),
        (
            "records",
            judge(folder, "records", |bytes| records::judge(bytes, HANG_GUARD) > 0),
        ),
        (
            "projects",
            judge(folder, "projects", |bytes| {
                projects::judge(&text(bytes), HANG_GUARD)
            }),
        ),
        (
            "programs",
            judge(folder, "programs", |bytes| {
                programs::judge(bytes, HANG_GUARD).1.compared > 0
            }),
        ),
    ]
    .map(|(target, accepted)| (target, accepted.len()))
}

#[test]
fn seeds_reach_their_targets() {
    let mut valid = 0;
    for (path, text) in files("seeds", "front_end") {
        match front_end::judge(str::from_utf8(&text).unwrap(), HANG_GUARD) {
            Outcome::Refused => assert_eq!(path, Path::new("fuzz/seeds/front_end/errors.glsl")),
            Outcome::Valid => valid += 1,
            Outcome::Naga(words) => panic!("{}: naga {words}", path.display()),
        }
    }
    assert!(valid > 10, "only {valid} seeds were found");
    let counts = [
        ("scenes", 3),
        ("images", 7),
        ("records", 1),
        ("projects", 4),
        ("programs", 8),
    ];
    assert_eq!(judge_others("seeds"), counts);
}

#[test]
fn findings_are_fixed() {
    for (path, text) in files("regressions", "front_end") {
        if let Outcome::Naga(words) = front_end::judge(str::from_utf8(&text).unwrap(), HANG_GUARD) {
            panic!("{}: naga {words}", path.display());
        }
    }
    judge_others("regressions");
}
