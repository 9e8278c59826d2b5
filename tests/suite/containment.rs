//! A panic in one part of the work loses only that part: verdicts, other shaders and other reports remain.

use std::fs;
use std::path::Path;

use serde_json::Value;
use toyproof::verify::contain::{INJECTION, Part};

use crate::program::{Run, command, output};
use crate::support::SPHERE;

/// A correct shader, two wrong ones, and one for which float32 is not enough: together they reach every part.
fn homework() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let wrong = SPHERE
        .shader
        .replace("sphere.radius * sphere.radius", "sphere.radius");
    assert_ne!(wrong, SPHERE.shader);
    for (name, text) in [("a", wrong.as_str()), ("b", SPHERE.shader), ("c", wrong.as_str())] {
        write(&format!("{name}.glsl"), text);
        write(&format!("{name}.toml"), SPHERE.scene);
    }
    write(
        "d.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n    float x = 1.0e7 + p.x / iResolution.x;\n    c = vec4(x - 1.0e7);\n}\n",
    );
    folder
}

fn check(folder: &Path, part: Option<Part>) -> Run {
    let mut command = command(folder);
    let shaders = ["a.glsl", "b.glsl", "c.glsl", "d.glsl"];
    let flags = [
        "--out", "out", "--size", "64x36", "--jobs", "1", "--device", "cpu",
    ];
    command.arg("check").args(shaders).args(flags);
    if let Some(part) = part {
        command.env(INJECTION, format!("{part:?}"));
    }
    output(&mut command)
}

fn verdicts(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("out/results.jsonl")).unwrap();
    let verdict = |line| {
        let line: Value = serde_json::from_str(line).unwrap();
        line["record"]["verdict"].as_str().unwrap().to_owned()
    };
    text.lines().map(verdict).collect()
}

const VERDICTS: [&str; 4] = ["wrong", "correct", "wrong", "ok"];
const REPORTS: [&str; 5] = [
    "report.html",
    "report.csv",
    "junit.xml",
    "report.sarif",
    "verdict.json",
];

#[test]
fn a_panic_affects_only_its_part() {
    let folder = homework();
    let sound = check(folder.path(), None);
    assert_eq!(sound.code, 1, "{}", sound.stderr);
    assert_eq!(verdicts(folder.path()), VERDICTS);
    let named = sound
        .stdout
        .lines()
        .filter(|line| line.contains("likely mistake: "))
        .count();
    assert_eq!(named, 2, "{}", sound.stdout);

    for part in Part::ALL {
        fs::remove_dir_all(folder.path().join("out")).unwrap();
        let run = check(folder.path(), Some(part));
        let Run { code, stdout, stderr } = &run;
        let case = format!("{part:?}:\n{stdout}\n{stderr}");
        assert_eq!(*code, 2, "{case}");
        let reported = format!("internal error while {part}: injected by {INJECTION}");
        assert!(format!("{stdout}{stderr}").contains(&reported), "{case}");
        if part == Part::Command {
            assert!(!folder.path().join("out").exists(), "{case}");
            fs::create_dir(folder.path().join("out")).unwrap();
            continue;
        }
        let expected = if part == Part::Shader {
            ["error"; 4]
        } else {
            VERDICTS
        };
        assert_eq!(verdicts(folder.path()), expected, "{case}");
        let there = |name: &str| folder.path().join("out").join(name).exists();
        assert_eq!(REPORTS.map(there), [part != Part::Report; 5], "{case}");
        let images = part != Part::Shader && part != Part::Image;
        assert_eq!(there("c-actual.png"), images, "{case}");
        for (verdict, name) in expected.iter().zip(["a", "b", "c", "d"]) {
            let line = format!("{verdict:<12} {name}.glsl");
            assert!(stdout.contains(&line), "{line}: {case}");
        }
    }
}
