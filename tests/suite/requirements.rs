//! What tests need that not every machine has: a Vulkan driver, programs, folders of shaders.
//!
//! A test that lacks something is skipped with one line on standard error. `make test` counts these lines in the
//! file that `TOYPROOF_SKIPPED` names.

use std::collections::BTreeSet;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::panic::Location;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{LazyLock, Mutex};
use std::time::Duration;
use std::{env, thread};

use toyproof::gpu::browser::find;
use toyproof::gpu::{AdapterSelector, Failure, Worker};

/// Returns whether there is a Vulkan driver.
///
/// # Panics
/// If there is none although `CI` is set, or its worker fails otherwise.
#[track_caller]
pub(crate) fn require_driver() -> bool {
    static PROBE: LazyLock<Result<(), Failure>> =
        LazyLock::new(|| new_worker(AdapterSelector::Auto).probe().map(drop));
    match &*PROBE {
        Ok(()) => true,
        Err(Failure::NoDriver(_)) if env::var_os("CI").is_none() => {
            skip("no Vulkan driver (`make setup` installs one)");
            false
        }
        Err(failure) => panic!("{failure}"),
    }
}

/// Creates the only worker of a test.
///
/// # Panics
/// Like [`require_driver`].
#[track_caller]
pub(crate) fn require_worker() -> Option<Worker> {
    require_driver().then(|| new_worker(AdapterSelector::Auto))
}

/// Creates a worker on `SwiftShader`, the software driver that Chromium ships.
#[track_caller]
pub(crate) fn require_swiftshader() -> Option<Worker> {
    let manifest = [
        "/usr/lib/chromium",
        "/usr/lib/chromium-browser",
        "/usr/lib64/chromium-browser",
        "/opt/google/chrome",
    ]
    .map(|folder| Path::new(folder).join("vk_swiftshader_icd.json"))
    .into_iter()
    .find(|path| path.exists());
    let worker = new_worker(AdapterSelector::Named("SwiftShader".into()));
    found(manifest, "no Chromium with SwiftShader").map(|manifest| worker.with_manifest(manifest))
}

/// The path of Chromium.
#[track_caller]
pub(crate) fn require_chromium() -> Option<PathBuf> {
    found(find(), "no Chromium")
}

/// Returns whether a program is installed.
#[track_caller]
pub(crate) fn require_program(name: &str) -> bool {
    let mut program = Command::new(name);
    program
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    found(program.status().ok(), &format!("no {name}")).is_some()
}

/// The folder that an environment variable names.
#[track_caller]
pub(crate) fn require_folder(variable: &str) -> Option<PathBuf> {
    let folder = env::var_os(variable).map(PathBuf::from);
    found(folder, &format!("{variable} names no folder"))
}

#[track_caller]
fn found<T>(needed: Option<T>, missing: &str) -> Option<T> {
    if needed.is_none() {
        skip(missing);
    }
    needed
}

fn new_worker(on: AdapterSelector) -> Worker {
    let program = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    Worker::new(
        program,
        vec![toyproof::cli::WORKER.into()],
        on,
        Duration::from_secs(60),
    )
}

/// Reports, once for each reason, that the test of this thread is skipped, or a part of it.
#[track_caller]
pub(crate) fn skip(why: &str) {
    static REPORTED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    // libtest names the threads of tests, unless they all run on the main thread.
    let thread = thread::current();
    let test = thread.name().filter(|name| *name != "main");
    let test = test.map_or_else(|| Location::caller().to_string(), str::to_owned);
    let line = format!("skipped: {test}: {why}\n");
    let mut reported = REPORTED.lock().unwrap();
    if reported.insert(line.clone()) {
        // `eprintln!` would be captured, since the test passes.
        io::stderr().write_all(line.as_bytes()).unwrap();
        if let Some(file) = env::var_os("TOYPROOF_SKIPPED") {
            let mut file = OpenOptions::new().create(true).append(true).open(file).unwrap();
            file.write_all(line.as_bytes()).unwrap();
        }
    }
}

/// Runs a test of this binary that needs a driver, on a machine without one.
fn without_a_driver(variables: &[(&str, &str)]) -> (bool, String) {
    let output = Command::new(env::current_exe().unwrap())
        .args(["--exact", "strict::strict_shaders_compute_the_same_bits_as_rust"])
        .env_remove("CI")
        .envs([("VK_DRIVER_FILES", "/none"), ("VK_ICD_FILENAMES", "/none")])
        .envs(variables.iter().copied())
        .output()
        .unwrap();
    (output.status.success(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn tests_without_a_driver_are_reported_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("skipped");
    let (passed, stderr) = without_a_driver(&[("TOYPROOF_SKIPPED", file.to_str().unwrap())]);
    let line = "skipped: strict::strict_shaders_compute_the_same_bits_as_rust: no Vulkan driver (`make setup` installs one)\n";
    assert!(passed && stderr.contains(line), "{stderr}");
    assert_eq!(std::fs::read_to_string(file).unwrap(), line);
}

#[test]
fn tests_without_a_driver_fail_on_ci() {
    let (passed, stderr) = without_a_driver(&[("CI", "1")]);
    assert!(!passed && !stderr.contains("skipped"), "{stderr}");
}
