//! Faults injected at every write: after a full disk, a failing device, an interrupted call or a short write, every file
//! is absent, or has its old content or its complete new content; the exit code and a message tell what is missing.
//!
//! `cargo test --release --test suite write_faults -- --ignored --nocapture` tries every fault at every write of all
//! commands, and prints a line for each command.

mod command;
mod injector;

use std::collections::BTreeMap;
use std::fmt::Write;

use self::command::{COMMANDS, Case, Files, Tested};
use self::injector::{Fault, Injector};

/// The result of all runs of a command.
#[derive(Debug, Default)]
struct Sweep {
    positions: usize,
    runs: usize,
    violations: Vec<String>,
}

/// Tries each fault at every `stride`th write of a command, with and without files of an earlier run.
fn sweep(tested: &Tested, injector: &Injector, stride: usize) -> Sweep {
    let place = tempfile::tempdir().unwrap();
    let case = Case::new(tested, injector, place.path());
    let mut sweep = Sweep {
        positions: case.calls.len(),
        ..Sweep::default()
    };
    for (at, call) in case.calls.iter().enumerate().step_by(stride) {
        for fault in Fault::ALL {
            if fault == Fault::Short && !call.starts_with("write ") {
                continue;
            }
            for has_old_files in [false, true] {
                if has_old_files && !tested.overwrites {
                    continue;
                }
                sweep.runs += 1;
                let found = case.run_with(fault, at + 1, has_old_files);
                let described = |violation| format!("{fault:?} at {}, {call}: {violation}", at + 1);
                sweep.violations.extend(found.into_iter().map(described));
            }
        }
    }
    sweep
}

#[test]
fn no_fault_of_a_write_loses_a_result() {
    let Some(injector) = Injector::new() else {
        return;
    };
    let mut violations = String::new();
    for tested in COMMANDS {
        let Some(stride) = tested.stride else { continue };
        for violation in sweep(tested, &injector, stride).violations {
            let _ = writeln!(violations, "{}: {violation}", tested.name);
        }
    }
    assert!(violations.is_empty(), "{violations}");
}

#[test]
#[ignore = "takes half an hour"]
fn no_fault_of_any_write_loses_a_result() {
    let Some(injector) = Injector::new() else {
        return;
    };
    let mut violations = String::new();
    for tested in COMMANDS {
        let swept = sweep(tested, &injector, 1);
        let Sweep { positions, runs, .. } = swept;
        eprintln!(
            "{}: {positions} writes, {runs} runs, {} violations",
            tested.name,
            swept.violations.len()
        );
        for violation in swept.violations {
            let _ = writeln!(violations, "{}: {violation}", tested.name);
        }
    }
    assert!(violations.is_empty(), "{violations}");
}

/// The files below a folder that differ between two runs, except in numbers.
fn differing(expected: &Files, actual: &Files) -> Vec<String> {
    let is_same =
        |(name, content): &(&String, &Vec<u8>)| actual.get(*name).is_some_and(|actual| actual == *content);
    let differing = expected.iter().filter(|file| !is_same(file));
    differing.map(|(name, _)| name.clone()).collect()
}

#[test]
fn a_fault_is_injected_where_it_is_requested() {
    let Some(injector) = Injector::new() else {
        return;
    };
    let place = tempfile::tempdir().unwrap();
    let render = COMMANDS.iter().find(|tested| tested.name == "render").unwrap();
    let case = Case::new(render, &injector, place.path());
    let names: BTreeMap<&str, usize> = case.calls.iter().fold(BTreeMap::new(), |mut names, call| {
        *names.entry(call.split(' ').next().unwrap()).or_default() += 1;
        names
    });
    for name in ["openat", "write", "close"] {
        assert!(names.contains_key(name), "{name}: {names:?}");
    }
    assert!(names.keys().any(|name| name.starts_with("rename")), "{names:?}");
    let write = case
        .calls
        .iter()
        .position(|call| call.starts_with("write "))
        .unwrap();
    let run = case.attempt(Fault::Full, write + 1, false);
    assert!(
        run.code == 2 && run.stderr.contains("No space left on device"),
        "{run:?}"
    );
}
