//! Autograders, unpacked and run as their platforms do.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};

use flate2::read::DeflateDecoder;
use serde_json::{Value, json};

use crate::program::toyproof;
use crate::requirements::require_program;
use crate::support::SPHERE;

const ASSIGNMENT: &str = "scene = \"scenes/sphere.toml\"\n[[frame]]\nsize = [64, 36]\n\
                          [rubric.compiles]\npoints = 2\n[rubric.algorithm]\npoints = 6\n[rubric.precision]\npoints = 2\n";

/// A folder with an assignment, and a file that passes for a program.
fn assignment() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("task/scenes")).unwrap();
    fs::write(folder.path().join("task/assignment.toml"), ASSIGNMENT).unwrap();
    fs::write(folder.path().join("task/scenes/sphere.toml"), SPHERE.scene).unwrap();
    let mut program = b"\x7fELF\x02\x01".to_vec();
    program.resize(18, 0);
    program.extend([0x3e, 0]);
    fs::write(folder.path().join("program"), program).unwrap();
    folder
}

/// Unpacks an archive by the headers of its files, which have their sizes.
fn unpack(archive: &[u8], folder: &Path) {
    let mut rest = archive;
    while let Some(header) = rest.strip_prefix(b"PK\x03\x04") {
        let number = |at: usize, count: usize| {
            let bytes = header[at..at + count].iter().rev();
            bytes.fold(0, |number, &byte| number << 8 | usize::from(byte))
        };
        let (packed, size, name) = (number(14, 4), number(18, 4), number(22, 2));
        let content = &header[26 + name..][..packed];
        let path = folder.join(std::str::from_utf8(&header[26..26 + name]).unwrap());
        let mut bytes = Vec::new();
        DeflateDecoder::new(content).read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes.len(), size);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
        rest = &header[26 + name + packed..];
    }
    assert!(rest.starts_with(b"PK\x01\x02"));
}

/// An unpacked autograder for Gradescope that runs this program.
#[cfg(unix)]
struct Gradescope {
    /// What is `/autograder` on Gradescope's machines.
    root: PathBuf,
    /// Its script, with that folder.
    script: String,
}

#[cfg(unix)]
impl Gradescope {
    /// Packs the assignment in a folder, and unpacks the archive there.
    fn new(folder: &Path) -> Self {
        let arguments = [
            "autograder",
            "gradescope",
            "task",
            "--program",
            "program",
            "-o",
            "autograder.zip",
        ];
        let packed = toyproof(folder, &arguments);
        assert_eq!(packed.code, 0, "{}", packed.stderr);
        assert!(
            packed.stderr.contains("upload it on Gradescope"),
            "{}",
            packed.stderr
        );
        let root = folder.join("autograder");
        let archive = fs::read(folder.join("autograder.zip")).unwrap();
        unpack(&archive, &root.join("source"));
        fs::remove_file(root.join("source/toyproof")).unwrap();
        std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_toyproof"), root.join("source/toyproof")).unwrap();
        let script = fs::read_to_string(root.join("source/run_autograder")).unwrap();
        let script = script.replace("/autograder", root.to_str().unwrap());
        Self { root, script }
    }

    /// Grades the files of a submission; returns what `results.json` has.
    fn grade(&self, files: &[(&str, &str)]) -> Value {
        let _ = fs::remove_dir_all(self.root.join("submission"));
        fs::create_dir(self.root.join("submission")).unwrap();
        for (name, bytes) in files {
            let path = self.root.join("submission").join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        let status = Command::new("sh").args(["-c", &self.script]).status().unwrap();
        assert!(status.success());
        let results = fs::read_to_string(self.root.join("results/results.json")).unwrap();
        serde_json::from_str(&results).unwrap()
    }
}

#[cfg(unix)]
#[test]
fn submissions_get_marks() {
    let folder = assignment();
    let autograder = Gradescope::new(folder.path());
    let right = SPHERE.shader;
    let wrong = right.replace("sphere.radius * sphere.radius", "sphere.radius");
    let invalid = right.replace("float disc", "flaot disc");
    let endless = "void mainImage(out vec4 c, in vec2 p) { while (p.x > -1.0) { c += vec4(p, 0, 1); } }";
    let common = "vec4 gray(float level) { return vec4(level); }";
    for (files, points, output) in [
        (
            &[("mine.glsl", right)][..],
            10.0,
            "correct: all 2,304 pixels agree",
        ),
        (
            &[("src/mine.txt", right), ("notes.pdf", "%PDF\x01")][..],
            10.0,
            "correct: ",
        ),
        (&[("mine.glsl", wrong.as_str())][..], 2.0, "wrong: "),
        (&[("mine.glsl", invalid.as_str())][..], 0.0, "invalid: "),
        (&[("mine.glsl", endless)][..], 2.0, "timeout: "),
        (&[][..], 0.0, "missing: no shader was submitted"),
        (
            &[("notes.pdf", "%PDF\x01")][..],
            0.0,
            "missing: no shader was submitted (notes.pdf: it is not text)",
        ),
        (
            &[("a.glsl", right), ("b.glsl", wrong.as_str())][..],
            2.0,
            "2 shaders: ",
        ),
        (
            &[
                (
                    "image.glsl",
                    "void mainImage(out vec4 c, in vec2 p) { c = gray(0.5); }",
                ),
                ("common.glsl", common),
            ][..],
            2.0,
            "wrong: ",
        ),
    ] {
        let marks = autograder.grade(files);
        let scores = marks["tests"]
            .as_array()
            .unwrap()
            .iter()
            .map(|test| test["score"].as_f64().unwrap());
        let sum = marks["score"].as_f64().unwrap_or(scores.sum());
        assert!((sum - points).abs() < 1e-9, "{points}: {marks:#}");
        let shown = marks["output"].as_str().unwrap();
        let images = shown.matches("<img alt=").count();
        assert!(
            shown.trim_start_matches("<p>").starts_with(output),
            "{output}: {marks:#}"
        );
        // What was rendered is shown beside the reference and the difference.
        let expected = match output.split_once(": ").map_or("", |(verdict, _)| verdict) {
            "correct" | "wrong" => 3,
            "2 shaders" => 6,
            _ => 0,
        };
        assert_eq!(images, expected, "{output}: {marks:#}");
        assert_eq!(marks["output_format"], if images > 0 { "html" } else { "text" });
    }
    fs::remove_file(autograder.root.join("source/toyproof")).unwrap();
    let failed = autograder.grade(&[("mine.glsl", right)]);
    assert!(
        failed["output"]
            .as_str()
            .unwrap()
            .starts_with("The autograder failed"),
        "{failed}"
    );
}

#[cfg(unix)]
#[test]
fn the_rubric_sets_which_images_students_see() {
    let folder = assignment();
    let autograder = Gradescope::new(folder.path());
    for (choice, images) in [("all", 3), ("rendered", 1), ("none", 0)] {
        let rubric = format!("[rubric]\nimages = \"{choice}\"\n[rubric.compiles]");
        let text = ASSIGNMENT.replace("[rubric.compiles]", &rubric);
        fs::write(autograder.root.join("source/assignment/assignment.toml"), text).unwrap();
        let marks = autograder.grade(&[("mine.glsl", SPHERE.shader)]);
        let shown = marks["output"].as_str().unwrap();
        assert_eq!(shown.matches("<img alt=").count(), images, "{marks:#}");
    }
}

#[test]
fn assignments_that_cannot_be_packed_are_rejected() {
    let folder = assignment();
    let folder = folder.path();
    let rejected = |assignment: &str, program: &str, error: &str| {
        fs::write(folder.join("task/assignment.toml"), assignment).unwrap();
        let run = toyproof(
            folder,
            &[
                "autograder",
                "gradescope",
                "task/assignment.toml",
                "--program",
                program,
            ],
        );
        assert!(run.code == 2 && run.stderr.contains(error), "{}", run.stderr);
        assert!(!folder.join("autograder.zip").exists());
    };
    rejected(
        "scene = \"scenes/sphere.toml\"\n",
        "program",
        "task/assignment.toml gives no points",
    );
    fs::write(folder.join("scene.toml"), SPHERE.scene).unwrap();
    let outside = ASSIGNMENT.replace("scenes/sphere.toml", "../scene.toml");
    rejected(
        &outside,
        "program",
        "task/../scene.toml is not in the folder of the assignment",
    );
    rejected(
        ASSIGNMENT,
        "scene.toml",
        "scene.toml is not a program for Linux on x86-64",
    );
}

#[test]
fn the_folder_of_a_project_is_packed_as_a_reference() {
    let folder = assignment();
    let folder = folder.path();
    let solution = folder.join("task/solution");
    fs::create_dir(&solution).unwrap();
    let shown = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }";
    fs::write(solution.join("image.glsl"), shown).unwrap();
    fs::write(solution.join("buffer-a.glsl"), SPHERE.shader).unwrap();
    fs::write(solution.join("notes.txt"), "not part of it").unwrap();
    let text = ASSIGNMENT.replace("scene = \"scenes/sphere.toml\"", "reference = \"solution\"");
    fs::write(folder.join("task/assignment.toml"), text).unwrap();
    let arguments = [
        "autograder",
        "gradescope",
        "task",
        "--program",
        "program",
        "-o",
        "autograder.zip",
    ];
    let packed = toyproof(folder, &arguments);
    assert_eq!(packed.code, 0, "{}", packed.stderr);
    let root = folder.join("unpacked");
    unpack(&fs::read(folder.join("autograder.zip")).unwrap(), &root);
    let packed = root.join("assignment/solution");
    assert_eq!(fs::read_to_string(packed.join("image.glsl")).unwrap(), shown);
    assert_eq!(
        fs::read_to_string(packed.join("buffer-a.glsl")).unwrap(),
        SPHERE.shader
    );
    assert!(!packed.join("notes.txt").exists());
}

/// An autograder in a folder, made with this program.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn packed(platform: &str) -> tempfile::TempDir {
    let folder = assignment();
    let run = toyproof(folder.path(), &["autograder", platform, "task", "-o", "out"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.contains("to use it: "), "{}", run.stderr);
    folder
}

/// Runs a command in a folder, with no more of the environment than a platform has.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn bare(folder: &Path, program: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Output {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(folder).env_clear();
    command
        .env("PATH", "/usr/local/bin:/usr/bin:/bin")
        .envs(environment.iter().copied());
    command.output().unwrap()
}

/// Submissions with the share of their points: a right one, a wrong one, one that does not compile, one that
/// is late, and an empty one. Platforms know how late a submission is, so its marks are those of others.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn submissions() -> [(&'static str, Option<String>, f64); 5] {
    let right = SPHERE.shader;
    let wrong = right.replace("sphere.radius * sphere.radius", "sphere.radius");
    let invalid = right.replace("float disc", "flaot disc");
    [
        ("right", Some(right.to_owned()), 1.0),
        ("wrong", Some(wrong), 0.2),
        ("invalid", Some(invalid), 0.0),
        ("late", Some(right.to_owned()), 1.0),
        ("empty", None, 0.0),
    ]
}

/// Writes a submission as `shader.glsl` into a new folder; a late one is of the year 2096.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn submit(folder: &Path, name: &str, text: Option<&str>) {
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder).unwrap();
    let Some(text) = text else { return };
    let path = folder.join("shader.glsl");
    fs::write(&path, text).unwrap();
    if name == "late" {
        let file = fs::File::options().write(true).open(path).unwrap();
        file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(4_000_000_000))
            .unwrap();
    }
}

/// Copies a folder, with the permissions of its files.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn copy(from: &Path, to: &Path) {
    let copied = Command::new("cp").arg("-R").args([from, to]).status().unwrap();
    assert!(copied.success());
}

#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[test]
fn prairielearn_reads_results() {
    let folder = packed("prairielearn");
    let (question, grade) = (folder.path().join("out"), folder.path().join("grade"));
    let info: Value = serde_json::from_slice(&fs::read(question.join("info.json")).unwrap()).unwrap();
    assert_eq!(
        (&info["title"], &info["gradingMethod"]),
        (&json!("task"), &json!("External"))
    );
    assert!(question.join("question.html").is_file());
    fs::create_dir(&grade).unwrap();
    copy(&question.join("tests"), &grade.join("tests"));
    let entry = info["externalGradingOptions"]["entrypoint"].as_str().unwrap();
    let entry = grade.join(entry.strip_prefix("/grade/").unwrap());
    let script = fs::read_to_string(&entry).unwrap();
    fs::write(
        &entry,
        script.replace("/grade/", &format!("{}/", grade.display())),
    )
    .unwrap();
    for (name, text, share) in submissions() {
        submit(&grade.join("student"), name, text.as_deref());
        let run = bare(folder.path(), entry.to_str().unwrap(), &[], &[]);
        assert!(run.status.success(), "{run:?}");
        let results: Value =
            serde_json::from_slice(&fs::read(grade.join("results/results.json")).unwrap()).unwrap();
        assert_eq!(results["score"], share, "{name}: {results:#}");
        assert_eq!(results["gradable"], share > 0.0, "{name}: {results:#}");
        let images = results["images"].as_array().unwrap().len();
        assert_eq!(images, if share > 0.0 { 3 } else { 0 }, "{name}");
        assert_eq!(results["tests"].as_array().unwrap().len(), 3);
        assert!(
            results["output"].as_str().unwrap().contains(": "),
            "{name}: {results:#}"
        );
    }
    fs::write(grade.join("tests/toyproof"), "not a program").unwrap();
    assert!(
        bare(folder.path(), entry.to_str().unwrap(), &[], &[])
            .status
            .success()
    );
    let results: Value =
        serde_json::from_slice(&fs::read(grade.join("results/results.json")).unwrap()).unwrap();
    assert_eq!(results["gradable"], false);
    assert!(
        results["format_errors"][0]
            .as_str()
            .unwrap()
            .starts_with("The autograder failed")
    );
}

#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[test]
fn autolab_reads_the_last_line() {
    if !require_program("make") {
        return;
    }
    let folder = packed("autolab");
    let instance = folder.path().join("instance");
    let grade = |name: &str, text: Option<&str>| {
        submit(&instance, name, text);
        // A handin is a file, if only an empty one.
        if text.is_none() {
            fs::write(instance.join("shader.glsl"), "").unwrap();
        }
        for (from, to) in [
            ("autograde-Makefile", "Makefile"),
            ("autograde.tar", "autograde.tar"),
        ] {
            fs::copy(folder.path().join("out").join(from), instance.join(to)).unwrap();
        }
        let run = bare(&instance, "make", &[], &[]);
        assert!(run.status.success(), "{run:?}");
        String::from_utf8(run.stdout).unwrap()
    };
    for (name, text, share) in submissions() {
        let output = grade(name, text.as_deref());
        let mut lines = output.lines().rev().map(serde_json::from_str::<Value>);
        let scores = lines
            .next()
            .unwrap()
            .unwrap_or_else(|error| panic!("{name}: {error}: {output}"));
        let shown = lines.next().unwrap().unwrap();
        let sum = ["compiles", "algorithm", "precision"].map(|key| scores["scores"][key].as_f64().unwrap());
        assert!(
            (sum.iter().sum::<f64>() - 10.0 * share).abs() < 1e-9,
            "{name}: {output}"
        );
        assert_eq!(shown["_presentation"], "semantic");
        assert_eq!(
            shown["Points"]["algorithm"]["passed"],
            share == 1.0,
            "{name}: {output}"
        );
    }
    let archive = folder.path().join("out/autograde.tar");
    let listed = bare(folder.path(), "tar", &["-tvf", archive.to_str().unwrap()], &[]);
    let listed = String::from_utf8(listed.stdout).unwrap();
    assert!(
        listed.contains("toyproof/assignment/scenes/sphere.toml"),
        "{listed}"
    );
    // Without the program, the last line has no scores.
    fs::create_dir_all(folder.path().join("broken/toyproof")).unwrap();
    let broken = bare(
        folder.path(),
        "sh",
        &[
            "-c",
            "cd broken && tar -xf ../out/autograde.tar && rm toyproof/toyproof && tar -cf ../out/autograde.tar toyproof",
        ],
        &[],
    );
    assert!(broken.status.success(), "{broken:?}");
    let output = grade("right", Some(SPHERE.shader));
    assert!(
        output.starts_with("The autograder failed") && !output.contains("scores"),
        "{output}"
    );
}

#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[test]
fn coderunner_reads_standard_output() {
    if !require_program("python3") {
        return;
    }
    let folder = packed("coderunner");
    let template = fs::read_to_string(folder.path().join("out/template.py")).unwrap();
    let sandbox = folder.path().join("sandbox");
    // What Twig replaces, with its escaping for Python.
    let expand = |answer: &str, attachments: &str| {
        let escaped = answer.replace('\\', "\\\\").replace('"', "\\\"");
        let expanded = template.replace("{{ STUDENT_ANSWER | e('py') }}", &escaped);
        expanded.replace("{{ ATTACHMENTS | e('py') }}", attachments)
    };
    let run = |program: &str| {
        fs::write(sandbox.join("prog.py"), program).unwrap();
        fs::copy(
            folder.path().join("out/toyproof.zip"),
            sandbox.join("toyproof.zip"),
        )
        .unwrap();
        let run = bare(&sandbox, "python3", &["prog.py"], &[]);
        assert!(run.status.success() && run.stderr.is_empty(), "{run:?}");
        String::from_utf8(run.stdout).unwrap()
    };
    for (name, text, share) in submissions() {
        submit(&sandbox, name, None);
        // A backslash and quotes in a comment have to survive.
        let answer = text.map(|text| format!("{text}// \"\\n\"\"\"\n"));
        let output = run(&expand(answer.as_deref().unwrap_or_default(), ""));
        let results: Value =
            serde_json::from_str(&output).unwrap_or_else(|error| panic!("{name}: {error}: {output}"));
        assert_eq!(results["fraction"], share, "{name}: {results:#}");
        assert_eq!(results["testresults"].as_array().unwrap().len(), 4);
        let images = results["epiloguehtml"].as_str().unwrap().matches("<img ").count();
        assert_eq!(images, if share > 0.0 { 3 } else { 0 }, "{name}");
    }
    submit(&sandbox, "attached", Some(SPHERE.shader));
    let results: Value = serde_json::from_str(&run(&expand("", "shader.glsl"))).unwrap();
    assert_eq!(results["fraction"], 1.0, "{results:#}");
}

/// `schemas/result-v1.schema.json` of Classroom 50, for one submission.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn classroom50_schema() -> Value {
    let (text, count) = (
        json!({ "type": "string", "minLength": 1 }),
        json!({ "type": "integer", "minimum": 0 }),
    );
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["schema", "classroom", "assignment", "assignment_type", "owner", "submission", "commit", "release",
                     "review", "datetime", "score", "max-score", "tests"],
        "properties": {
            "schema": { "const": "classroom50/result/v1" },
            "classroom": { "const": "graphics" },
            "assignment": { "const": "sphere" },
            "assignment_type": { "enum": ["individual", "group"] },
            "owner": { "const": "anna" },
            "submission": { "type": "string", "pattern": "^submit/" },
            "commit": text, "release": text, "review": text,
            "datetime": { "type": "string",
                          "pattern": "^[0-9]{4}-[0-9]{2}-[0-9]{2}T([01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9]Z$" },
            "score": count, "max-score": count,
            "tests": { "type": "array", "items": {
                "type": "object",
                "required": ["test-name", "passed", "score", "max-score"],
                "properties": { "test-name": text, "passed": { "type": "boolean" }, "score": count, "max-score": count },
            } },
        },
    })
}

#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[test]
fn classroom50_reads_results() {
    if !require_program("python3") {
        return;
    }
    let folder = packed("classroom50");
    let bundle = folder.path().join("out/autograder");
    assert!(
        !bundle.join("toyproof").exists(),
        "it is larger than a bundle may be"
    );
    let script = fs::read_to_string(bundle.join("autograder.py")).unwrap();
    let checkout = folder.path().join("checkout");
    let grade = |script: &str| {
        fs::write(bundle.join("autograder.py"), script).unwrap();
        bare(
            &checkout,
            "python3",
            &[bundle.join("autograder.py").to_str().unwrap()],
            &[
                ("CLASSROOM", "graphics"),
                ("ASSIGNMENT", "sphere"),
                ("SUBMISSION_TAG", "submit/2026-11-01T10-00-00Z-a1b2c3d"),
                ("USERNAME", "anna"),
                ("COMMIT_URL", "https://example.org/commit/1"),
                ("RELEASE_URL", "https://example.org/releases/1"),
            ],
        )
    };
    submit(&checkout, "right", Some(SPHERE.shader));
    let run = grade(&script);
    let error = String::from_utf8(run.stderr).unwrap();
    assert!(
        !run.status.success() && error.contains("has no PROGRAM_URL"),
        "{error}"
    );
    let at = |file: &str| {
        let url = format!("PROGRAM_URL = \"file://{}\"", folder.path().join(file).display());
        script.replace("PROGRAM_URL = \"\"", &url)
    };
    let run = grade(&at("task/assignment.toml"));
    let error = String::from_utf8(run.stderr).unwrap();
    assert!(
        !run.status.success() && error.contains("is not the toyproof with which"),
        "{error}"
    );
    let schema = jsonschema::validator_for(&classroom50_schema()).unwrap();
    for (name, text, share) in submissions() {
        submit(&checkout, name, text.as_deref());
        let run = grade(&at("out/toyproof"));
        assert!(run.status.success(), "{name}: {run:?}");
        let result: Value = serde_json::from_slice(&fs::read(checkout.join("result.json")).unwrap()).unwrap();
        let errors: Vec<_> = schema
            .iter_errors(&result)
            .map(|error| error.to_string())
            .collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
        for key in classroom50_schema()["required"].as_array().unwrap() {
            let mut without = result.clone();
            without.as_object_mut().unwrap().remove(key.as_str().unwrap());
            assert!(!schema.is_valid(&without), "{key}");
        }
        let score = result["score"].as_f64().unwrap() / result["max-score"].as_f64().unwrap();
        assert!((score - share).abs() < 1e-9, "{name}: {result:#}");
        let body = fs::read_to_string(checkout.join("release-body.md")).unwrap();
        assert!(body.lines().all(|line| line.starts_with("    ")), "{body}");
    }
    // A program that fails is an error of the autograder.
    fs::write(bundle.join("toyproof"), "not a program").unwrap();
    assert!(!grade(&script).status.success());
}

#[test]
fn platforms_and_outputs_are_checked() {
    let folder = assignment();
    let folder = folder.path();
    let run = toyproof(folder, &["autograder", "prairylearn", "task"]);
    assert!(
        run.code == 2 && run.stderr.contains("'prairielearn'"),
        "{}",
        run.stderr
    );
    let run = toyproof(
        folder,
        &[
            "autograder",
            "autolab",
            "task",
            "--program",
            "program",
            "-o",
            "program",
        ],
    );
    assert!(
        run.code == 2 && run.stderr.contains("program is a file"),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr
            .contains("help: name a folder, or an archive that ends in .zip"),
        "{}",
        run.stderr
    );
}
