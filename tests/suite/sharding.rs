//! Batches that several processes check: `check --shard`, `merge` and `--compare`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::batch::{homework, records};
use crate::program::{Run, check_homework, output, run, toyproof};
use crate::support::{SHADING, edited};

fn check_shard(folder: &Path, shard: &str, rest: &[&str]) -> Run {
    let out = format!("shards/{}", shard.replace('/', "-of-"));
    let run = run(check_homework(folder)
        .args(["--shard", shard, "--out", &out])
        .args(rest));
    assert_eq!(run.code, 0, "{}", run.stderr);
    run
}

fn merge(folder: &Path, shards: &[&str]) -> Run {
    let mut arguments = vec!["merge"];
    arguments.extend(shards);
    arguments.extend(["--out", "out"]);
    toyproof(folder, &arguments)
}

/// The files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> = walkdir::WalkDir::new(folder)
        .into_iter()
        .map(Result::unwrap)
        .filter(|entry| entry.file_type().is_file())
        .map(|entry| entry.path().strip_prefix(folder).unwrap().to_owned())
        .collect();
    files.sort();
    files
}

/// What a merged folder has apart from the time of the page.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let all = files(folder).into_iter();
    all.filter(|name| name != Path::new("report.html"))
        .map(|name| (name.clone(), fs::read(folder.join(name)).unwrap()))
        .collect()
}

/// Also with a file that is not text, one that is there twice, and a shader that an expression of another
/// repairs.
#[test]
fn the_merged_report_is_that_of_a_single_process() {
    let folder = homework(1);
    let hw = folder.path().join("hw");
    fs::write(hw.join("binary.glsl"), b"\xff\xfe").unwrap();
    fs::write(hw.join("twice.glsl"), fs::read(hw.join("000.glsl")).unwrap()).unwrap();
    let cosine = "max(dot(normal, toLight), 0.0)";
    for (name, replacement) in [
        ("cosine", "clamp(dot(toLight, normal), 0.0, 1.0)"),
        ("repaired", "fract(7.3 * normal.x)"),
    ] {
        fs::write(
            hw.join(name).with_extension("glsl"),
            edited(&SHADING, &[(cosine, replacement)]),
        )
        .unwrap();
    }
    fs::write(folder.path().join("scene.toml"), SHADING.scene).unwrap();
    fs::write(folder.path().join("rubric.toml"), "algorithm.points = 1").unwrap();
    let rest = ["--search", "1", "--rubric", "rubric.toml"];
    let single = run(check_homework(folder.path()).args(rest).args(["--out", "out"]));
    let expected = (records(folder.path()), files(&folder.path().join("out")));
    assert!(expected.0.iter().any(|record| !record["fix"].is_null()));
    fs::remove_dir_all(folder.path().join("out")).unwrap();

    for shard in ["1/3", "2/3", "3/3"] {
        let run = check_shard(folder.path(), shard, &rest);
        assert!(
            run.stderr
                .ends_with(&format!("shard {shard}: shards/{}\n", shard.replace('/', "-of-")))
        );
    }
    let all = ["shards/1-of-3", "shards/2-of-3", "shards/3-of-3"];
    let merged = merge(folder.path(), &all);
    assert_eq!(merged.code, single.code);
    assert_eq!(merged.stdout, single.stdout);
    assert_eq!(
        (records(folder.path()), files(&folder.path().join("out"))),
        expected
    );

    let first = contents(&folder.path().join("out"));
    merge(folder.path(), &[all[2], all[0], all[1], all[0]]);
    assert!(
        first == contents(&folder.path().join("out")),
        "merging again changes nothing"
    );
}

#[test]
fn missing_and_interrupted_shards_are_listed() {
    let folder = homework(8);
    check_shard(folder.path(), "1/3", &[]);
    check_shard(folder.path(), "2/3", &[]);
    let path = folder.path().join("shards/2-of-3/results.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    let count = text.lines().count();
    assert!(count > 1, "{count}");
    // As after `kill -9` while the last line was written.
    fs::write(&path, &text[..text.len() - 10]).unwrap();
    let shards = ["shards/1-of-3", "shards/2-of-3", "shards/3-of-3"];
    let incomplete = merge(folder.path(), &shards[..2]);
    let expected = format!(
        "error: 2 of 3 shards are missing or incomplete\n\
         shard 2/3: {} of {count} shaders are checked\n\
         shard 3/3: missing\n\
         help: check them with `toyproof check hw --scene scene.toml --device cpu --size 64x36 --shard K/3 --out DIR \
         --resume`, and merge again\n",
        count - 1
    );
    assert_eq!(
        (incomplete.code, incomplete.stderr.as_str()),
        (2, expected.as_str())
    );
    assert!(!folder.path().join("out").exists());
    let resumed = check_shard(folder.path(), "2/3", &["--resume", "-v"]);
    let reused = format!("{} of {count} results are reused", count - 1);
    assert!(resumed.stderr.contains(&reused), "{}", resumed.stderr);
    check_shard(folder.path(), "3/3", &["--jobs=1"]);
    assert_eq!(merge(folder.path(), &shards).code, 1);
    assert_eq!(records(folder.path()).len(), 8);
}

#[test]
fn shards_that_do_not_belong_together_are_rejected() {
    let folder = homework(4);
    let folder = folder.path();
    check_shard(folder, "1/2", &[]);
    check_shard(folder, "2/2", &[]);
    check_shard(folder, "1/3", &[]);
    let rejected = |shards: &[&str], error: &str| {
        let run = merge(folder, shards);
        assert!(run.code == 2 && run.stderr.contains(error), "{}", run.stderr);
        assert!(!folder.join("out").exists());
    };
    rejected(&["hw"], "hw is not the folder of a shard: it has no shard.json");
    rejected(
        &["shards/1-of-2", "shards/1-of-3"],
        "shards/1-of-3 is shard 1/3, and shards/1-of-2 is shard 1/2",
    );
    let own_folder = output(check_homework(folder).args(["--shard", "2/3", "--out", "shards/1-of-2"]));
    let error = "shards/1-of-2: it has the results of shard 1/2; shard 2/3 needs a folder of its own";
    assert!(
        own_folder.code == 2 && own_folder.stderr.contains(error),
        "{}",
        own_folder.stderr
    );
    let overwritten = toyproof(folder, &["merge", "shards/1-of-2", "--out", "shards/1-of-2"]);
    assert!(
        overwritten
            .stderr
            .contains("is a shard, and would be overwritten"),
        "{}",
        overwritten.stderr
    );

    let both = ["shards/1-of-2", "shards/2-of-2"];
    let text = fs::read_to_string(folder.join("hw/000.glsl")).unwrap();
    fs::write(folder.join("hw/000.glsl"), format!("{text}\n")).unwrap();
    rejected(&both, "changed after the shards were checked");
    check_shard(folder, "2/2", &[]);
    rejected(
        &both,
        "shards/2-of-2 was checked with other shaders, references or settings than shards/1-of-2",
    );
    check_shard(folder, "2/2", &["--search", "0"]);
    rejected(
        &both,
        "shards/2-of-2 was checked with other arguments than shards/1-of-2",
    );

    let other = folder.join("toyproof");
    let mut program = fs::read(env!("CARGO_BIN_EXE_toyproof")).unwrap();
    program.push(0);
    fs::copy(env!("CARGO_BIN_EXE_toyproof"), &other).unwrap();
    fs::write(&other, program).unwrap();
    let run = output(
        Command::new(other)
            .args(["merge", "shards/1-of-2", "-o", "out"])
            .current_dir(folder),
    );
    let error = "shards/1-of-2 was written by another build of toyproof";
    assert!(run.code == 2 && run.stderr.contains(error), "{}", run.stderr);
}

#[test]
fn changed_verdicts_are_listed() {
    let folder = homework(4);
    let folder = folder.path();
    run(check_homework(folder).args(["--out", "old"]));
    let fixed = fs::read_to_string(folder.join("hw/000.glsl")).unwrap();
    fs::write(folder.join("hw/002.glsl"), fixed).unwrap();
    let changed = run(check_homework(folder).args(["--out", "new", "--compare", "old"]));
    assert!(
        changed
            .stdout
            .ends_with("wrong        → correct      hw/002.glsl\n"),
        "{}",
        changed.stdout
    );
    assert!(
        changed
            .stderr
            .contains("\n1 verdict differs from old/verdict.json\n"),
        "{}",
        changed.stderr
    );
    let same = run(check_homework(folder).args(["--compare", "new/verdict.json"]));
    assert!(
        same.stderr
            .contains("\n0 verdicts differ from new/verdict.json\n"),
        "{}",
        same.stderr
    );
    let other = output(check_homework(folder).args(["--compare", "scene.toml"]));
    let error = "error: scene.toml is not an earlier report: it is not a verdict.json";
    assert!(
        other.code == 2 && other.stderr.starts_with(error),
        "{}",
        other.stderr
    );
}

/// A shader that took as long as all others is alone in its shard, and `merge` distributes as the shards did.
#[test]
fn shards_are_balanced_by_measured_times() {
    let folder = homework(6);
    let folder = folder.path();
    let single = run(check_homework(folder).args(["--out", "out"]));
    assert_eq!(single.code, 1, "{}", single.stderr);
    let mut report: Value =
        serde_json::from_slice(&fs::read(folder.join("out/verdict.json")).unwrap()).unwrap();
    let shaders = report["shaders"].as_array_mut().unwrap();
    let others = shaders.len() - 1;
    for (index, shader) in shaders.iter_mut().enumerate() {
        let seconds = &mut shader["seconds"]["all"];
        assert!(seconds.as_f64() > Some(0.0), "{seconds}");
        *seconds = if index == 4 { others as f64 } else { 1.0 }.into();
    }
    fs::create_dir(folder.join("old")).unwrap();
    let write = |report: &Value| fs::write(folder.join("old/verdict.json"), report.to_string()).unwrap();
    write(&report);
    let count = |shard: &str| {
        check_shard(folder, shard, &["--costs", "old"]);
        let path = format!("shards/{}/results.jsonl", shard.replace('/', "-of-"));
        fs::read_to_string(folder.join(path)).unwrap().lines().count()
    };
    let mut counts = ["1/2", "2/2"].map(count);
    counts.sort_unstable();
    assert_eq!(counts, [1, others]);
    let all = ["shards/1-of-2", "shards/2-of-2"];
    assert_eq!(merge(folder, &all).code, 1);
    assert_eq!(records(folder).len(), others + 1);

    report["shaders"][0]["seconds"]["all"] = 2.0.into();
    write(&report);
    let changed = merge(folder, &all);
    assert!(
        changed.code == 2 && changed.stderr.contains("changed after the shards were checked"),
        "{}",
        changed.stderr
    );
}

/// The script of `contrib/`, as Slurm runs it; `tests/slurm.sh` runs it in Slurm.
#[cfg(unix)]
#[test]
fn the_slurm_script_checks_the_shard_of_its_task() {
    let folder = homework(4);
    let program = Path::new(env!("CARGO_BIN_EXE_toyproof")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("contrib/slurm-array.sh");
    for task in ["1", "2"] {
        let mut task_run = Command::new(&script);
        task_run
            .args(check_homework(folder.path()).get_args().skip(1))
            .current_dir(folder.path())
            .env("PATH", &path)
            .env("SLURM_ARRAY_TASK_ID", task)
            .env("SLURM_ARRAY_TASK_COUNT", "2");
        assert_eq!(run(&mut task_run).code, 0);
    }
    merge(folder.path(), &["shards/1", "shards/2"]);
    let verdicts: Vec<Value> = records(folder.path())
        .into_iter()
        .map(|record| record["verdict"].clone())
        .collect();
    assert_eq!(verdicts, ["correct", "correct", "wrong", "correct"]);
}
