//! Malicious shaders. Each ends with the right verdict, the program and its worker together stay
//! within their memory limit, no file outside of `--out` is touched, and no process is left. `cargo test
//! hostile -- --nocapture` prints the table.

mod case;
mod driver;
mod loops;
mod memory;
mod preprocessor;
mod syntax;
mod text;
mod watch;

use std::ffi::OsStr;
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, thread};

use serde_json::Value;

use self::case::Case;
use self::watch::{Seen, files, left, watch};
use crate::program::command;
use crate::requirements::require_driver;
use crate::support::SPHERE;

/// The time limit of an image: for a shader that is expected to exceed it, and for one that is not.
const SHORT_TIME_LIMIT: &str = "1s";
const LONG_TIME_LIMIT: &str = "20s";
/// The maximum memory of the program, which renders with two threads, and its worker together, in bytes.
const MAX_MEMORY_BYTES: u64 = 1536 << 20;
/// The maximum size of all reports of one shader, in bytes.
const MAX_REPORT_BYTES: usize = 4 << 20;

fn cases() -> Vec<Case> {
    let groups = [
        text::cases(),
        preprocessor::cases(),
        syntax::cases(),
        loops::cases(),
        memory::cases(),
        driver::cases(),
    ];
    groups.into_iter().flatten().collect()
}

/// Runs `check` in its own folder, where all files that programs usually write would be found.
fn check(folder: &Path, arguments: &[&str]) -> Command {
    let home = folder.join("home");
    fs::create_dir(&home).unwrap();
    let mut check = command(folder);
    check.args(["check", "hw", "--out", "out"]).args(arguments);
    for name in ["HOME", "TMPDIR", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR"] {
        check.env(name, &home);
    }
    // Only the driver's own cache is written elsewhere.
    check.env("MESA_SHADER_CACHE_DISABLE", "true");
    // Unoptimized builds load the validation layer where it is installed, which keeps a cache too.
    check.env("VK_LOADER_LAYERS_DISABLE", "~all~");
    // Each render thread has its own registers.
    check.env("RAYON_NUM_THREADS", "2");
    check.stdin(Stdio::null());
    check
}

/// Each shader's name and verdict.
fn verdicts(folder: &Path) -> Vec<(String, String)> {
    let text = fs::read_to_string(folder.join("out/verdict.json")).unwrap_or_default();
    let report: Value = serde_json::from_str(&text).unwrap_or_default();
    let shaders = report["shaders"].as_array().cloned().unwrap_or_default();
    let text_of = |shader: &Value, field: &str| shader[field].as_str().unwrap_or_default().to_owned();
    shaders
        .iter()
        .map(|shader| (text_of(shader, "shader"), text_of(shader, "verdict")))
        .collect()
}

/// Describes what is wrong with the result of a case, and formats its line of the table.
fn judge(case: &Case) -> (Vec<String>, String) {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("hw")).unwrap();
    fs::write(folder.join("hw/s.glsl"), &case.text).unwrap();
    let timeout = if case.verdicts.contains(&"timeout") {
        SHORT_TIME_LIMIT
    } else {
        LONG_TIME_LIMIT
    };
    let mut check = check(folder, &["--size", "64x36", "--timeout", timeout]);
    let words = fs::File::create(folder.join("words")).unwrap();
    check.stdout(words.try_clone().unwrap()).stderr(words);
    let before = files(folder);
    let Seen { code, seconds, bytes } = watch(check.spawn().unwrap());
    let mut wrong = Vec::new();
    let verdict = match verdicts(folder).as_slice() {
        [(_, verdict)] => verdict.clone(),
        _ => "none".to_owned(),
    };
    if !case.verdicts.contains(&&*verdict) {
        wrong.push(format!("is {verdict}, not {}", case.verdicts.join(" or ")));
    }
    if code != Some(i32::from(verdict != "ok")) {
        wrong.push(format!("ends with {code:?}"));
    }
    if bytes > MAX_MEMORY_BYTES {
        wrong.push(format!("takes {} MB", bytes >> 20));
    }
    let mut written = 0;
    for (path, now) in files(folder) {
        if path.starts_with(folder.join("out")) || path == folder.join("words") {
            written += now.len();
            // The file that an #include would have read.
            if String::from_utf8_lossy(&now).contains("root:") {
                wrong.push(format!("{} tells of the system's files", path.display()));
            }
        } else if before.get(&path) != Some(&now) {
            wrong.push(format!("touches {}", path.display()));
        }
    }
    if written > MAX_REPORT_BYTES {
        wrong.push(format!("writes {written} bytes"));
    }
    if fs::read_to_string(folder.join("words"))
        .unwrap_or_default()
        .contains("panic at")
    {
        wrong.push("panics".to_owned());
    }
    let left = left(folder.as_os_str());
    if !left.is_empty() {
        wrong.push(format!("leaves {left:?}"));
    }
    let line = format!(
        "{:<60} {verdict:<9} {seconds:>5.1} s {:>5} MB {:>5} kB",
        case.name,
        bytes >> 20,
        written >> 10
    );
    (wrong, line)
}

#[test]
fn each_case_ends_with_its_verdict_and_leaves_nothing() {
    if !require_driver() {
        return;
    }
    let cases = cases();
    assert!(cases.len() >= 100, "{}", cases.len());
    let next = AtomicUsize::new(0);
    let check_exercise = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let (wrong, line) = judge(case);
                    eprintln!("{line} {}", if wrong.is_empty() { "" } else { "WRONG" });
                    check_exercise.lock().unwrap().push((case.name, wrong));
                }
            });
        }
    });
    let mut words = String::new();
    for (name, wrong) in check_exercise.into_inner().unwrap() {
        for wrong in wrong {
            writeln!(words, "{name}: {wrong}").unwrap();
        }
    }
    assert!(words.is_empty(), "\n{words}");
}

/// Runs all cases in one command, each between valid shaders, which must not be affected.
#[test]
fn no_case_affects_others() {
    if !require_driver() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("hw")).unwrap();
    fs::write(folder.join("scene.toml"), SPHERE.scene).unwrap();
    let names = [
        "a megabyte of NUL bytes",
        "fifty thousand mistakes",
        "a macro that doubles forty times",
        "#include of an endless file",
        "a loop without end",
        "an array in registers",
        "four times sixty thousand matrices",
        "calls that double thirty times",
    ];
    let all = cases();
    for (at, name) in names.iter().enumerate() {
        let case = all.iter().find(|case| case.name == *name).unwrap();
        fs::write(folder.join(format!("hw/{at}-bad.glsl")), &case.text).unwrap();
        fs::write(
            folder.join(format!("hw/{at}-good.glsl")),
            format!("// {at}\n{}", SPHERE.shader),
        )
        .unwrap();
    }
    let arguments = [
        "--scene",
        "scene.toml",
        "--size",
        "64x36",
        "--timeout",
        "5s",
        "--jobs",
        "2",
    ];
    let mut check = check(folder, &arguments);
    check.stdout(Stdio::null()).stderr(Stdio::null());
    let Seen { code, bytes, .. } = watch(check.spawn().unwrap());
    assert_eq!(code, Some(1));
    assert!(bytes < 2 * MAX_MEMORY_BYTES, "{} MB", bytes >> 20);
    let verdicts = verdicts(folder);
    assert_eq!(verdicts.len(), 2 * names.len());
    for (shader, verdict) in verdicts {
        let is_good = shader.ends_with("good.glsl");
        assert_eq!(verdict == "correct", is_good, "{shader} is {verdict}");
    }
    assert_eq!(left(OsStr::new(folder)), [""; 0]);
}
