//! Inputs that must not block a command: slow texts, links, vanishing files, closed pipes.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::program::{command, run, toyproof};
use crate::support::SPHERE;
use crate::support::wait::wait_until;

/// Creates a folder `hw` with `count` correct shaders.
fn homework(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("hw")).unwrap();
    for index in 0..count {
        let path = folder.path().join(format!("hw/{index:03}.glsl"));
        fs::write(path, SPHERE.shader).unwrap();
    }
    folder
}

fn check(folder: &Path, arguments: &[&str]) -> Command {
    let mut check = command(folder);
    check
        .args(["check", "hw", "--device", "cpu", "--size", "16x9"])
        .args(arguments);
    check
}

fn results(folder: &Path) -> usize {
    let text = fs::read_to_string(folder.join("out/results.jsonl")).unwrap_or_default();
    text.lines().count()
}

#[test]
fn a_shader_that_takes_too_long_to_compile_is_a_timeout_with_a_code() {
    let folder = homework(1);
    let run = run(&mut check(
        folder.path(),
        &["--timeout", "1ns", "--format", "json"],
    ));
    assert_eq!(run.code, 1, "{run:?}");
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let shader = &report["shaders"][0];
    assert_eq!(shader["verdict"], "timeout");
    assert_eq!(shader["diagnostics"][0]["code"], "E0410");
    let reason = shader["reason"].as_str().unwrap();
    assert!(reason.starts_with("compilation exceeded the time limit of"), "{reason}");

    let others: [&[&str]; 4] = [
        &["convert", "hw/000.glsl", "-o", "x.wgsl", "--timeout", "1ns"],
        &["run", "hw/000.glsl", "-o", "x.png", "--timeout", "1ns"],
        &["debug", "hw/000.glsl", "--pixel", "0,0", "--timeout", "1ns"],
        &[
            "trade",
            "hw/000.glsl",
            "-o",
            "trade",
            "--budget",
            "1ns",
            "--device",
            "cpu",
        ],
    ];
    for arguments in others {
        let run = toyproof(folder.path(), arguments);
        assert_eq!(run.code, 1, "{run:?}");
        assert!(run.stderr.contains("E0410"), "{run:?}");
    }
}

#[test]
fn slow_readings_by_naga_are_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!(
        "void mainImage(out vec4 c, in vec2 p) {{ bool b = {} true; c = vec4(b); }}",
        "p.x > 1.0 && ".repeat(80_000)
    );
    fs::write(folder.path().join("x.glsl"), text).unwrap();
    let convert = ["convert", "x.glsl", "-o", "x.wgsl", "--timeout", "5s"];
    let run = toyproof(folder.path(), &convert);
    assert_ne!(run.code, 0, "{run:?}");
    assert!(
        run.stderr.contains("naga was translating") || run.stderr.contains("E0410"),
        "{run:?}"
    );
}

#[cfg(unix)]
#[test]
fn links_out_of_the_submissions_are_not_followed() {
    use std::os::unix::fs::symlink;
    let folder = homework(3);
    let secret = "[film]\nsize = [16, 9]\nsecret = 42\n";
    fs::write(folder.path().join("secret.toml"), secret).unwrap();
    symlink("/", folder.path().join("hw/root")).unwrap();
    symlink("../secret.toml", folder.path().join("hw/leak.glsl")).unwrap();
    symlink("../secret.toml", folder.path().join("hw/000.toml")).unwrap();
    symlink("nothing.toml", folder.path().join("hw/001.toml")).unwrap();
    let run = run(&mut check(folder.path(), &["--out", "out", "--format", "json"]));
    assert_eq!(run.code, 2, "{run:?}");
    for link in ["hw/root", "hw/leak.glsl"] {
        let wanted = format!("skipped `{link}`: it links to `");
        assert_eq!(run.stderr.matches(&wanted).count(), 1, "{run:?}");
    }
    // A shader whose scene cannot be read is not `ok`.
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    for (name, verdict, reason) in [
        (
            "hw/000.glsl",
            "error",
            "there is no scene to compare with: skipped `hw/000.toml`",
        ),
        ("hw/001.glsl", "error", "hw/001.toml: no such file"),
        ("hw/002.glsl", "ok", ""),
    ] {
        let mut shaders = report["shaders"].as_array().unwrap().iter();
        let shader = shaders.find(|shader| shader["shader"] == name).unwrap();
        assert_eq!(shader["verdict"], verdict, "{shader}");
        assert!(shader["reason"].as_str().unwrap().starts_with(reason), "{shader}");
    }
    for entry in fs::read_dir(folder.path().join("out")).unwrap() {
        let text = fs::read(entry.unwrap().path()).unwrap();
        assert!(!String::from_utf8_lossy(&text).contains("secret = 42"));
    }
    // A file that is named explicitly is read, wherever its link leads.
    let named = toyproof(folder.path(), &["check", "hw/leak.glsl", "--device", "cpu"]);
    assert!(named.stderr.contains("film"), "{named:?}");
}

#[test]
fn broken_lines_of_an_earlier_run_are_skipped_and_counted() {
    let folder = homework(2);
    let arguments = ["--out", "out", "--resume"];
    assert_eq!(run(&mut check(folder.path(), &arguments)).code, 0);
    let path = folder.path().join("out/results.jsonl");
    let mut bytes = fs::read(&path).unwrap();
    bytes.extend_from_slice(b"\xff\xfe\n{\"key\":\n");
    fs::write(&path, bytes).unwrap();
    let again = run(&mut check(folder.path(), &arguments));
    assert_eq!(again.code, 0, "{again:?}");
    assert!(
        again.stderr.contains("2 lines of results.jsonl cannot be read"),
        "{again:?}"
    );
    assert!(again.stderr.contains("2 of 2 results are reused"), "{again:?}");
}

#[test]
fn removing_the_folder_during_the_run_is_an_error() {
    let folder = homework(40);
    let running = check(folder.path(), &["--out", "out", "--jobs", "1"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until(|| results(folder.path()) > 0);
    fs::rename(folder.path().join("out"), folder.path().join("moved")).unwrap();
    let output = running.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(
        stderr.contains("were removed while they were written"),
        "{stderr}"
    );
    assert!(!stderr.contains("pictures and reports are in"), "{stderr}");
}

#[test]
fn a_batch_ends_when_its_output_is_closed() {
    const COUNT: usize = 60;
    let folder = homework(COUNT);
    let mut running = check(folder.path(), &["--out", "out", "--jobs", "1"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = String::new();
    BufReader::new(running.stdout.take().unwrap())
        .read_line(&mut first)
        .unwrap();
    assert!(first.contains("000.glsl"), "{first}");
    let output = running.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("standard output was closed after "), "{stderr}");
    let kept = results(folder.path());
    assert!((1..COUNT).contains(&kept), "{kept}");
}
