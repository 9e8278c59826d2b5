//! Many shaders in one command: reported in order, each once, even if the command is killed and resumed.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, SystemTime};

use serde_json::Value;

use crate::program::{Run, check_homework, command, run, toyproof};
use crate::requirements::require_folder;
use crate::support::wait::wait_until;
use crate::support::{MANY_OBJECTS, SHADING, SPHERE, edited};

/// Creates a folder of submissions: every third is wrong, every seventh does not compile.
pub(crate) fn homework(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let hw = folder.path().join("hw");
    fs::create_dir(&hw).unwrap();
    fs::write(folder.path().join("scene.toml"), SPHERE.scene).unwrap();
    for at in 0..count {
        let text = match at {
            _ if at % 7 == 6 => SPHERE.shader.replace("float disc", "flaot disc"),
            _ if at % 3 == 2 => SPHERE
                .shader
                .replace("sphere.radius * sphere.radius", "sphere.radius"),
            _ => SPHERE.shader.to_owned(),
        };
        fs::write(hw.join(format!("{at:03}.glsl")), format!("// {at}\n{text}")).unwrap();
    }
    folder
}

fn verdict(at: usize) -> &'static str {
    match at {
        _ if at % 7 == 6 => "invalid",
        _ if at % 3 == 2 => "wrong",
        _ => "correct",
    }
}

fn check(folder: &Path, rest: &[&str]) -> Run {
    run(check_homework(folder).args(["--out", "out"]).args(rest))
}

/// The records without their timings.
pub(crate) fn records(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("out/verdict.json")).unwrap();
    let mut report: Value = serde_json::from_str(&text).unwrap();
    let shaders = report["shaders"].as_array_mut().unwrap();
    for shader in shaders.iter_mut() {
        shader["seconds"] = Value::Null;
    }
    shaders.clone()
}

fn results(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("out/results.jsonl")).unwrap();
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn shaders_are_reported_in_order_for_any_number_of_jobs() {
    let folder = homework(20);
    let one = check(folder.path(), &["--jobs", "1"]);
    let alone = records(folder.path());
    let three = check(folder.path(), &["--jobs", "3"]);
    assert_eq!((one.code, three.code), (1, 1));
    assert_eq!(one.stdout, three.stdout);
    // The summary ends with the time, in parentheses.
    let without_time = |text: &str| text.split(" (").next().unwrap().to_owned();
    assert_eq!(without_time(&one.stderr), without_time(&three.stderr));
    assert_eq!(alone, records(folder.path()));
    let verdicts: Vec<_> = alone
        .iter()
        .map(|record| record["verdict"].as_str().unwrap())
        .collect();
    assert_eq!(verdicts, (0..20).map(verdict).collect::<Vec<_>>());
    assert!(
        three
            .stderr
            .contains("20 shaders: 12 correct, 6 wrong, 2 invalid"),
        "{}",
        three.stderr
    );
    let mut named: Vec<_> = results(folder.path())
        .iter()
        .map(|line| line["record"]["shader"].as_str().unwrap().to_owned())
        .collect();
    named.sort();
    let all: Vec<_> = (0..20).map(|at| format!("hw/{at:03}.glsl")).collect();
    assert_eq!(named, all);
}

/// Caching scenes between shaders changes no result: shaders of two alternating scenes, and each alone.
#[test]
fn a_shader_has_the_same_verdict_alone_and_in_a_batch() {
    let folder = tempfile::tempdir().unwrap();
    let hw = folder.path().join("hw");
    fs::create_dir(&hw).unwrap();
    let faulty = |shader: &str| shader.replace("aspect;", "1.0;");
    let mut shaders = Vec::new();
    for (exercise, name) in [(&SPHERE, "2"), (&MANY_OBJECTS, "4")] {
        for (style, text) in [("a", exercise.shader.to_owned()), ("b", faulty(exercise.shader))] {
            for time in [1, 2] {
                let stem = format!("{time}{style}{name}");
                fs::write(hw.join(format!("{stem}.glsl")), format!("// {stem}\n{text}")).unwrap();
                fs::write(hw.join(format!("{stem}.toml")), exercise.scene).unwrap();
                shaders.push(stem);
            }
        }
    }
    let check = |what: &str| {
        let arguments = [
            "check", what, "--device", "cpu", "--size", "64x36", "--out", "out",
        ];
        toyproof(folder.path(), &arguments);
        records(folder.path())
    };
    let together = check("hw");
    assert_eq!(together.len(), shaders.len());
    for record in together {
        let is_wrong = record["verdict"] == "wrong";
        let shader = record["shader"].as_str().unwrap();
        assert_eq!(is_wrong, shader.contains('b'), "{record}");
        assert_eq!(check(shader)[0], record);
    }
}

#[test]
fn killed_runs_resume_without_losing_or_repeating_work() {
    const COUNT: usize = 30;
    let folder = homework(COUNT);
    check(folder.path(), &[]);
    let whole = records(folder.path());
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    for wanted in [3, 11, 20] {
        let mut running = check_homework(folder.path())
            .args(["--out", "out", "--resume"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let lines = || {
            let text = fs::read_to_string(folder.path().join("out/results.jsonl")).unwrap_or_default();
            text.lines().count()
        };
        wait_until(|| lines() >= wanted);
        running.kill().unwrap();
        running.wait().unwrap();
    }
    // Simulates a truncated last line.
    let path = folder.path().join("out/results.jsonl");
    let mut text = fs::read_to_string(&path).unwrap();
    text.push_str("{\"key\":\"abc\",\"rec");
    fs::write(&path, text).unwrap();
    let last = check(folder.path(), &["--resume"]);
    assert!(
        last.stderr.contains("are reused from an earlier run"),
        "{}",
        last.stderr
    );
    assert_eq!(records(folder.path()), whole);
    let mut named: Vec<_> = results(folder.path())
        .iter()
        .map(|line| line["record"]["shader"].as_str().unwrap().to_owned())
        .collect();
    named.sort();
    named.dedup();
    assert_eq!(named.len(), COUNT);
    assert_eq!(results(folder.path()).len(), COUNT, "none is there twice");
}

#[test]
fn plain_images_and_sample_counts_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let exercise = &MANY_OBJECTS;
    fs::write(folder.path().join("scene.toml"), exercise.scene).unwrap();
    let last = "fragColor = vec4(color / float(SAMPLES), 1.0);";
    let count = "i < SAMPLES;";
    assert!(exercise.shader.contains(last) && exercise.shader.contains(count));
    let black = exercise
        .shader
        .replace(last, "fragColor = vec4(0.0, 0.0, 0.0, 1.0);");
    let more = exercise.shader.replace(count, "i <= SAMPLES;");
    let less = exercise.shader.replace("SAMPLES = 4", "SAMPLES = 3");
    for (text, words) in [
        (black, "\n             every pixel is black"),
        (more, "the sum has one sample more than its divisor"),
        (less, "the number of samples is one less than the scene's"),
    ] {
        fs::write(folder.path().join("a.glsl"), text).unwrap();
        let arguments = [
            "check",
            "a.glsl",
            "--scene",
            "scene.toml",
            "--device",
            "cpu",
            "--size",
            "160x90",
        ];
        let run = toyproof(folder.path(), &arguments);
        assert!(run.stdout.contains(words), "{words}: {}", run.stdout);
    }
}

#[test]
fn endless_neighbors_do_not_cause_a_timeout() {
    let folder = tempfile::tempdir().unwrap();
    let endless =
        "void mainImage(out vec4 c, in vec2 p) { for (float s = p.x; s > -1.0; s += 0.0) c.x += s; }";
    for name in ["a", "c", "d"] {
        fs::write(folder.path().join(name).with_extension("glsl"), endless).unwrap();
    }
    for kind in ["glsl", "toml"] {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl/02-sphere");
        fs::copy(
            from.with_extension(kind),
            folder.path().join("b").with_extension(kind),
        )
        .unwrap();
    }
    let run = toyproof(
        folder.path(),
        &[
            "check",
            ".",
            "--device",
            "cpu",
            "--jobs",
            "4",
            "--timeout",
            "3s",
            "--size",
            "160x90",
        ],
    );
    let verdicts: Vec<_> = run
        .stdout
        .lines()
        .filter_map(|line| line.split_once("./"))
        .collect();
    let verdicts: Vec<_> = verdicts.iter().map(|(verdict, _)| verdict.trim()).collect();
    assert_eq!(
        verdicts,
        ["timeout", "correct", "timeout", "timeout"],
        "{}",
        run.stdout
    );
}

/// Checks the folder of shaders that `TOYPROOF_CORPUS` names, killed ten times at random moments.
#[test]
#[ignore = "takes minutes, and a folder of shaders that TOYPROOF_CORPUS names"]
fn a_corpus_that_is_killed_ten_times_is_complete() {
    let Some(corpus) = require_folder("TOYPROOF_CORPUS") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let check = || {
        let mut check = command(folder.path());
        check
            .arg("check")
            .arg(&corpus)
            .args(["--out", "out", "--resume", "--size", "160x90"]);
        check
    };
    let count = fs::read_dir(&corpus).unwrap().count();
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap();
    let mut seed = now.as_nanos() as u64;
    for kill in 0..10 {
        let mut running = check()
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let moment = Duration::from_millis(500 + (seed >> 33) % 15_000);
        std::thread::sleep(moment);
        running.kill().unwrap();
        running.wait().unwrap();
        let text = fs::read_to_string(folder.path().join("out/results.jsonl")).unwrap_or_default();
        let whole = text.lines().filter(|line| line.ends_with('}')).count();
        eprintln!("kill {kill} after {moment:?}: {whole} of {count} are known");
    }
    let last = run(&mut check());
    let reported = records(folder.path());
    let lines = results(folder.path());
    eprintln!("{}", last.stderr.lines().next().unwrap_or_default());
    let named = |records: &mut dyn Iterator<Item = &Value>| {
        let mut names: Vec<_> = records.map(|record| record["shader"].to_string()).collect();
        names.sort();
        names
    };
    let (reported, kept) = (
        named(&mut reported.iter()),
        named(&mut lines.iter().map(|line| &line["record"])),
    );
    assert_eq!(reported, kept, "what is told is what is kept, each once");
    let mut once = reported.clone();
    once.dedup();
    assert_eq!(
        (once.len(), reported.len()),
        (count, count),
        "nothing lost, nothing twice"
    );
}

#[test]
fn changed_shaders_are_checked_again() {
    let folder = homework(4);
    check(folder.path(), &[]);
    let again = check(folder.path(), &["--resume"]);
    assert!(
        again.stderr.contains("4 of 4 results are reused"),
        "{}",
        again.stderr
    );
    let unsearched = check(folder.path(), &["--search", "0", "--resume"]);
    assert!(!unsearched.stderr.contains("reused"), "{}", unsearched.stderr);
    let path = folder.path().join("hw/002.glsl");
    fs::write(&path, SPHERE.shader).unwrap();
    let mended = check(folder.path(), &["--resume"]);
    assert!(
        mended.stderr.contains("3 of 4 results are reused"),
        "{}",
        mended.stderr
    );
    assert_eq!(mended.code, 0, "{}", mended.stdout);
    let scene = SPHERE.scene.replace("radius = 1.5", "radius = 1.4");
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let other = check(folder.path(), &["--resume"]);
    assert!(!other.stderr.contains("reused"), "{}", other.stderr);
    assert_eq!(other.code, 1);
    let bare = toyproof(folder.path(), &["check", "hw", "--resume"]);
    assert!(bare.code == 2 && bare.stderr.contains("--out"), "{}", bare.stderr);
}

#[test]
fn stale_images_are_removed() {
    let folder = homework(3);
    check(folder.path(), &[]);
    let exists = |name: &str| folder.path().join("out").join(name).is_file();
    assert!(exists("002-actual.png") && exists("002-algorithm.png"));
    fs::write(folder.path().join("hw/002.glsl"), SPHERE.shader).unwrap();
    check(folder.path(), &[]);
    assert!(exists("002-actual.png") && !exists("002-algorithm.png"));
    fs::write(folder.path().join("hw/002.glsl"), "void main").unwrap();
    check(folder.path(), &[]);
    assert!(!exists("002-actual.png"));
}

#[test]
fn another_build_reuses_nothing() {
    let folder = homework(2);
    check(folder.path(), &[]);
    let other = folder.path().join("toyproof");
    fs::copy(env!("CARGO_BIN_EXE_toyproof"), &other).unwrap();
    let run = std::process::Command::new(other)
        .args(check_homework(folder.path()).get_args())
        .args(["--out", "out", "--resume"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let stderr = String::from_utf8(run.stderr).unwrap();
    assert!(run.status.success() && !stderr.contains("taken over"), "{stderr}");
}

/// The first shader's cosine repairs the second; the third has nothing in common with either.
#[test]
fn correct_shaders_repair_wrong_ones_that_no_edit_repairs() {
    let folder = tempfile::tempdir().unwrap();
    let hw = folder.path().join("hw");
    fs::create_dir(&hw).unwrap();
    fs::write(folder.path().join("scene.toml"), SHADING.scene).unwrap();
    let cosine = "max(dot(normal, toLight), 0.0)";
    let shaders = [
        (
            "a",
            edited(&SHADING, &[(cosine, "clamp(dot(toLight, normal), 0.0, 1.0)")]),
        ),
        ("b", edited(&SHADING, &[(cosine, "fract(7.3 * normal.x)")])),
        (
            "c",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(fract(0.1 * p), 0, 1); }".to_owned(),
        ),
    ];
    for (name, text) in &shaders {
        fs::write(hw.join(name).with_extension("glsl"), text).unwrap();
    }
    let run = check(folder.path(), &["--search", "1"]);
    let fixes: Vec<_> = records(folder.path())
        .into_iter()
        .map(|record| record["fix"]["text"].clone())
        .collect();
    let fix = "replace `fract(7.3 * normal.x)` with `clamp(dot(normal, toLight), 0.0, 1.0)`";
    assert_eq!(fixes, [Value::Null, fix.into(), Value::Null]);
    assert!(
        run.stderr
            .contains("\n1 more shader is repaired by expressions of correct shaders:\n"),
        "{}",
        run.stderr
    );
    assert!(
        run.stdout.contains("clamp(dot(normal, toLight)"),
        "{}",
        run.stdout
    );
    assert!(folder.path().join("out/b-fixed.png").is_file());
    // Alone, it has no fix.
    fs::remove_file(hw.join("a.glsl")).unwrap();
    check(folder.path(), &["--search", "1"]);
    assert!(
        records(folder.path())
            .iter()
            .all(|record| record["fix"].is_null())
    );
}
