//! The import rule of ARCHITECTURE.md: later stages import earlier ones, only `cli` prints or exits.

use std::fs;
use std::path::{Path, PathBuf};

/// The stages in the order of the flow.
const STAGES: [&str; 26] = [
    "contain",
    "deadline",
    "source",
    "diagnostic",
    "output",
    "image",
    "chart",
    "frame",
    "elementary",
    "glsl",
    "eval",
    "module",
    "emit",
    "gpu",
    "browser",
    "scene",
    "export",
    "trace",
    "compare",
    "stress",
    "trade",
    "explain",
    "mistake",
    "verify",
    "report",
    "cli",
];

/// What prints or ends the program.
const VOICES: [&str; 8] = [
    "println!",
    "print!(",
    "dbg!",
    "stdout()",
    "stderr()",
    "process::exit",
    "ExitCode",
    "process::abort",
];

pub(crate) fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found
}

/// The stage of a file: the first name of its path below `src`.
fn stage(path: &Path) -> String {
    let below = path.strip_prefix("src").unwrap();
    let first = below.components().next().unwrap().as_os_str().to_str().unwrap();
    first.trim_end_matches(".rs").to_owned()
}

/// The stages that a text names as `crate::stage` or `crate::{stage, …}`.
fn imports(text: &str) -> Vec<String> {
    text.match_indices("crate::")
        .filter(|(at, _)| !text[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$'))
        .flat_map(|(at, crate_)| {
            let rest = &text[at + crate_.len()..];
            let names = match rest.strip_prefix('{') {
                Some(group) => group.split('}').next().unwrap().split(',').collect(),
                None => vec![rest],
            };
            names.into_iter().map(first_name).collect::<Vec<_>>()
        })
        .collect()
}

fn first_name(text: &str) -> String {
    text.trim()
        .chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect()
}

#[test]
fn later_stages_import_earlier_ones_and_never_the_other_way() {
    let order = |name: &str| STAGES.iter().position(|stage| *stage == name);
    let mut seen = 0;
    for path in sources(Path::new("src")) {
        let stage = stage(&path);
        if stage == "lib" || stage == "main" {
            continue;
        }
        let own = order(&stage).unwrap_or_else(|| panic!("{} belongs to no stage", path.display()));
        for import in imports(&fs::read_to_string(&path).unwrap()) {
            let other = order(&import).unwrap_or_else(|| panic!("{}: crate::{import}?", path.display()));
            assert!(
                other <= own,
                "{}: {stage} imports {import}, which comes later",
                path.display()
            );
            seen += 1;
        }
    }
    assert!(
        seen > 50,
        "only {seen} imports were found: the test itself is blind"
    );
}

#[test]
fn only_the_command_line_prints_or_exits() {
    for path in sources(Path::new("src")) {
        let stage = stage(&path);
        // What only tests run may tell who runs them.
        let is_test = path.iter().any(|part| part == "tests" || part == "tests.rs");
        if stage == "cli" || stage == "main" || is_test {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        for voice in VOICES {
            assert!(!text.contains(voice), "{}: {voice}", path.display());
        }
    }
}

#[test]
fn the_architecture_page_names_every_stage() {
    let page = fs::read_to_string("ARCHITECTURE.md").unwrap();
    for stage in STAGES {
        assert!(
            page.contains(&format!("| `{stage}")),
            "ARCHITECTURE.md does not name {stage}"
        );
    }
}

#[test]
fn imports_are_found_in_every_form() {
    assert_eq!(
        imports(
            "use crate::glsl::lower; use crate::{emit, source::File}; crate::gpu::x() $crate::no mycrate::no"
        ),
        ["glsl", "emit", "source", "gpu"]
    );
}
