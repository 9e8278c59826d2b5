//! The archive for Gradescope, unpacked and run as Gradescope does.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;

use flate2::read::DeflateDecoder;
use serde_json::Value;

use crate::program::toyproof;
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

/// An unpacked autograder that runs this program.
#[cfg(unix)]
struct Autograder {
    /// What is `/autograder` on Gradescope's machines.
    root: PathBuf,
    /// Its script, with that folder.
    script: String,
}

#[cfg(unix)]
impl Autograder {
    /// Packs the assignment in a folder, and unpacks the archive there.
    fn new(folder: &Path) -> Self {
        let arguments = [
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
    let autograder = Autograder::new(folder.path());
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
    let autograder = Autograder::new(folder.path());
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
            &["gradescope", "task/assignment.toml", "--program", program],
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
