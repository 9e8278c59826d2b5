//! Checks the workspace against ARCHITECTURE.md. Cargo refuses import cycles; these tests check the table of
//! allowed imports.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Code that writes to the terminal or ends the program.
const TERMINAL: [&str; 8] = [
    "println!",
    "print!(",
    "dbg!",
    "stdout()",
    "stderr()",
    "process::exit",
    "ExitCode",
    "process::abort",
];

/// Lists the `.rs` files below a folder.
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

/// The crates of ARCHITECTURE.md's table, each with its allowed imports.
fn documented() -> BTreeMap<String, Vec<String>> {
    let page = fs::read_to_string("ARCHITECTURE.md").unwrap();
    let names = |cell: &str| {
        cell.split('`')
            .skip(1)
            .step_by(2)
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let table = page
        .lines()
        .skip_while(|line| !line.starts_with("| crate |"))
        .skip(2);
    let rows = table.take_while(|line| line.starts_with('|'));
    rows.map(|row| {
        let cells: Vec<_> = row.split('|').collect();
        (names(cells[1]).remove(0), names(cells[3]))
    })
    .collect()
}

/// The workspace crates in a manifest's `[dependencies]`.
fn imports(manifest: &Path) -> Vec<String> {
    let manifest: toml::Table = fs::read_to_string(manifest).unwrap().parse().unwrap();
    let dependencies = manifest["dependencies"].as_table().unwrap().keys();
    dependencies
        .filter_map(|name| name.strip_prefix("toyproof-").map(str::to_owned))
        .collect()
}

#[test]
fn crates_import_only_documented_crates() {
    let documented = documented();
    let mut folders = Vec::new();
    for entry in fs::read_dir("src").unwrap() {
        let folder = entry.unwrap().path();
        let manifest = folder.join("Cargo.toml");
        if !manifest.is_file() {
            continue;
        }
        let name = folder.file_name().unwrap().to_str().unwrap().to_owned();
        let allowed = documented
            .get(&name)
            .unwrap_or_else(|| panic!("ARCHITECTURE.md has no crate `{name}`"));
        assert_eq!(&imports(&manifest), allowed, "the imports of `{name}`");
        folders.push(name);
    }
    folders.sort();
    assert_eq!(folders, documented.into_keys().collect::<Vec<_>>());
}

/// Files of others may be pipes, which `toyproof_image::input` does not wait for.
#[test]
fn files_are_opened_by_one_function() {
    /// Files of the program and of the system, and pipes of the shell: the ends of the paths of their sources.
    const OWN: [&str; 4] = [
        "cli/check/sharding.rs",
        "convert/tool.rs",
        "gpu/sandbox/files.rs",
        "project/files/read.rs",
    ];
    let mut found = Vec::new();
    for path in sources(Path::new("src")) {
        if path.iter().any(|part| part == "tests" || part == "tests.rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let opens = ["File::open(", "fs::read(", "fs::read_to_string("];
        if opens.iter().any(|open| code.contains(open)) {
            found.push(toyproof::diagnostic::path_name(&path));
        }
    }
    found.sort();
    assert_eq!(found, OWN.map(|path| format!("src/{path}")));
}

/// Diagnostics name their codes by the variants of one table.
#[test]
fn codes_are_written_in_one_table() {
    let is_code = |word: &str| {
        word.strip_prefix("E0")
            .or_else(|| word.strip_prefix("W0"))
            .is_some_and(|digits| digits.len() == 3 && digits.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let mut in_table = 0;
    for path in sources(Path::new("src")) {
        if path.iter().any(|part| part == "tests" || part == "tests.rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let mut codes = code.split('"').filter(|word| is_code(word));
        if path.starts_with("src/diagnostic/code") {
            in_table += codes.count();
        } else {
            let found = codes.next();
            assert_eq!(found, None, "{}", toyproof::diagnostic::path_name(&path));
        }
    }
    assert_eq!(in_table, toyproof::diagnostic::Code::ALL.len());
}

#[test]
fn unsafe_code_occurs_in_four_files() {
    let found = sources(Path::new("src"))
        .into_iter()
        .filter(|path| fs::read_to_string(path).unwrap().contains("unsafe_code"))
        .map(|path| toyproof::diagnostic::path_name(&path));
    let mut found: Vec<String> = found.collect();
    found.sort();
    let expected = [
        "src/eval-native/x86_64/executable.rs",
        "src/eval/exec/ops/mod.rs",
        "src/gpu/device.rs",
        "src/gpu/pipeline.rs",
    ];
    assert_eq!(found, expected);
}

/// The parts of the evaluator are a tower.
#[test]
fn parts_of_the_evaluator_import_only_those_below() {
    const TOWER: [&str; 5] = ["ir", "build", "opt", "lower", "exec"];
    /// What callers use, above the tower.
    const TOP: [&str; 6] = ["compile", "parametric", "passes", "program", "render", "trace"];
    for (height, part) in TOWER.iter().enumerate() {
        for path in sources(&Path::new("src/eval").join(part)) {
            let text = fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            for above in TOWER[height + 1..].iter().chain(&TOP) {
                let name = toyproof::diagnostic::path_name(&path);
                assert!(
                    !code.contains(&format!("crate::{above}::")),
                    "{name} imports `{above}`"
                );
            }
        }
    }
}

#[test]
fn only_the_command_line_prints_or_exits() {
    for path in sources(Path::new("src")) {
        if path.starts_with("src/cli") || path == Path::new("src/main.rs") {
            continue;
        }
        // Tests may print.
        let is_test = path.iter().any(|part| part == "tests" || part == "tests.rs");
        if is_test {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            let found = TERMINAL.iter().find(|word| line.contains(*word));
            assert!(
                found.is_none(),
                "{}: {}",
                toyproof::diagnostic::path_name(&path),
                line.trim()
            );
        }
    }
}
