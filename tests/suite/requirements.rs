//! What tests need that not every machine has: a Vulkan driver, programs, folders of shaders.
//!
//! A test that lacks something is skipped with one line on standard error. `make test` counts these lines in the
//! file that `TOYPROOF_SKIPPED` names. If `CI` is set, only what is [optional](OPTIONAL) may be missing: a test
//! that lacks anything else fails.

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

/// Programs that may be missing if `CI` is set: no package contains them.
const OPTIONAL: [&str; 2] = ["naga", "tint"];

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
        Err(Failure::NoDriver(_)) => {
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
///
/// # Panics
/// If it is not, although `CI` is set, unless it is optional.
#[track_caller]
pub(crate) fn require_program(name: &str) -> bool {
    let mut program = Command::new(name);
    program
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let is_installed = program.status().is_ok();
    match format!("no {name}") {
        _ if is_installed => {}
        missing if OPTIONAL.contains(&name) => report(&missing),
        missing => skip(&missing),
    }
    is_installed
}

/// The folder of the npm package `three`: that which `TOYPROOF_THREE` names, or which `setup.sh --tests` has
/// installed.
#[track_caller]
pub(crate) fn require_three() -> Option<PathBuf> {
    let named = env::var_os("TOYPROOF_THREE").map(PathBuf::from);
    let installed = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/npm/node_modules/three");
    let folder = named.unwrap_or(installed);
    let is_package = folder.join("package.json").exists();
    if !is_package {
        // It comes from a registry, not with the system.
        report("no npm package three");
    }
    is_package.then_some(folder)
}

/// Returns whether ffmpeg and ffprobe are installed.
///
/// # Panics
/// Like [`require_program`].
#[track_caller]
pub(crate) fn require_ffmpeg() -> bool {
    require_program("ffmpeg") && require_program("ffprobe")
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
///
/// # Panics
/// If `CI` is set.
#[track_caller]
pub(crate) fn skip(why: &str) {
    assert!(env::var_os("CI").is_none(), "skipped although CI is set: {why}");
    report(why);
}

#[track_caller]
fn report(why: &str) {
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

/// Runs a test of this binary with these variables; returns whether it passed, and its standard error.
fn run_test(name: &str, variables: &[(&str, &str)]) -> (bool, String) {
    let output = Command::new(env::current_exe().unwrap())
        .args(["--exact", name])
        .env_remove("CI")
        .env_remove("TOYPROOF_SKIPPED")
        .envs(variables.iter().copied())
        .output()
        .unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(stdout.contains("running 1 test\n"), "{name}: {stdout}");
    (output.status.success(), String::from_utf8(output.stderr).unwrap())
}

/// A test that needs something, the variables with which it is missing, and what is reported then.
type Lacking = (
    &'static str,
    &'static [(&'static str, &'static str)],
    &'static str,
);

const LACKING: [Lacking; 3] = [
    (
        "strict::strict_shaders_compute_the_same_bits_as_rust",
        &[("VK_DRIVER_FILES", "/none"), ("VK_ICD_FILENAMES", "/none")],
        "no Vulkan driver (`make setup` installs one)",
    ),
    (
        "generated::glslang_and_the_evaluator_agree_with_ours",
        &[("PATH", "/none")],
        "no glslangValidator",
    ),
    (
        "requirements::an_optional_program_may_be_missing",
        &[("PATH", "/none")],
        "no naga",
    ),
];

/// Passes with and without the program; the tests below run it without one.
#[test]
fn an_optional_program_may_be_missing() {
    require_program(OPTIONAL[0]);
}

#[test]
fn tests_that_lack_something_are_reported_and_counted() {
    for (test, variables, reason) in LACKING {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("skipped");
        let counted = [("TOYPROOF_SKIPPED", file.to_str().unwrap())];
        let (passed, stderr) = run_test(test, &[variables, &counted].concat());
        let line = format!("skipped: {test}: {reason}\n");
        assert!(passed && stderr.contains(&line), "{stderr}");
        assert_eq!(std::fs::read_to_string(file).unwrap(), line);
    }
}

#[test]
fn tests_that_lack_something_fail_on_ci_unless_it_is_optional() {
    for (test, variables, reason) in LACKING {
        let (passed, stderr) = run_test(test, &[variables, &[("CI", "1")]].concat());
        let is_optional = OPTIONAL.iter().any(|name| reason == format!("no {name}"));
        assert_eq!(passed, is_optional, "{test}: {stderr}");
        assert_eq!(stderr.contains("skipped: "), is_optional, "{stderr}");
    }
}
