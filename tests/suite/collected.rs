//! Downloads of learning management systems: `collect`, and the rows of `check` for all students.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use flate2::Crc;
use serde_json::Value;

use crate::batch::records;
use crate::program::{Run, check_homework, run, toyproof};
use crate::support::SPHERE;

/// An archive of these files, uncompressed, as the simplest programs write it.
fn zip(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let offset = archive.len() as u32;
        let mut crc = Crc::new();
        crc.update(bytes);
        let length = (bytes.len() as u32).to_le_bytes();
        // Version, flags, method, time and date.
        let mut common = vec![10, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
        common.extend(crc.sum().to_le_bytes());
        common.extend([length, length].concat());
        common.extend((name.len() as u16).to_le_bytes());
        common.extend([0, 0]);
        archive.extend([b"PK\x03\x04", &common[..], name.as_bytes(), &bytes[..]].concat());
        directory.extend([b"PK\x01\x02\x14\0", &common[..], &[0; 10]].concat());
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let count = (files.len() as u16).to_le_bytes();
    let sizes = [directory.len(), archive.len()].map(|size| (size as u32).to_le_bytes());
    let end = [
        b"PK\x05\x06\0\0\0\0",
        &count[..],
        &count[..],
        sizes.as_flattened(),
        &[0, 0],
    ]
    .concat();
    [archive, directory, end].concat()
}

fn collect(folder: &Path, rest: &[&str]) -> Run {
    let run = toyproof(folder, &[&["collect"], rest].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    run
}

/// The verdicts of all rows, by the folder of the student.
fn verdicts(folder: &Path) -> BTreeMap<String, String> {
    fs::write(folder.join("scene.toml"), SPHERE.scene).unwrap();
    let run = run(check_homework(folder).args(["--search", "0", "--out", "out"]));
    assert_eq!(run.code, 1, "{}", run.stderr);
    let rows: Vec<_> = records(folder)
        .iter()
        .map(|record| {
            let text = |key: &str| record[key].as_str().unwrap().to_owned();
            (
                text("shader").split('/').nth(1).unwrap().to_owned(),
                text("verdict"),
            )
        })
        .collect();
    let count = rows.len();
    let rows: BTreeMap<_, _> = rows.into_iter().collect();
    assert_eq!(rows.len(), count, "each student has one row");
    rows
}

/// What students do to files: names, contents, and the verdicts.
fn odd_files() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let right = SPHERE.shader.to_owned();
    let wrong = right.replace("sphere.radius * sphere.radius", "sphere.radius");
    let invalid = right.replace("float disc", "flaot disc");
    let latin1 = |text: &str| -> Vec<u8> { text.chars().map(|character| character as u8).collect() };
    let utf16: Vec<u8> = format!("\u{feff}{right}")
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let mac = vec![
        ("work/a.glsl", right.clone().into_bytes()),
        ("__MACOSX/work/._a.glsl", b"\0\x05\x16\x07".to_vec()),
        ("work/.DS_Store", b"\0\0\0\x01Bud1".to_vec()),
    ];
    let bomb = zip(&[(
        "deep.zip",
        zip(&[(
            "deeper.zip",
            zip(&[("deepest.zip", zip(&[("end.zip", zip(&mac))]))]),
        )]),
    )]);
    let project = vec![
        (
            "waves/image.glsl",
            b"void mainImage(out vec4 c, in vec2 p) { c = gray(0.5); }".to_vec(),
        ),
        (
            "waves/common.glsl",
            b"vec4 gray(float level) { return vec4(vec3(level), 1.0); }".to_vec(),
        ),
    ];
    vec![
        ("plain.glsl", right.clone().into_bytes(), "correct"),
        ("UPPER.GLSL", right.clone().into_bytes(), "correct"),
        ("shader.txt", right.clone().into_bytes(), "correct"),
        ("a.glsl.txt", right.clone().into_bytes(), "correct"),
        ("no extension", right.clone().into_bytes(), "correct"),
        ("bom.glsl", format!("\u{feff}{right}").into_bytes(), "correct"),
        ("latin1.glsl", latin1(&format!("// größer\n{right}")), "correct"),
        ("utf16.glsl", utf16, "correct"),
        ("crlf.frag", right.replace('\n', "\r\n").into_bytes(), "correct"),
        ("work.zip", zip(&mac), "correct"),
        ("outer.ZIP", zip(&[("inner.zip", zip(&mac))]), "correct"),
        ("../../up.glsl", right.clone().into_bytes(), "missing"),
        ("bomb.zip", bomb, "missing"),
        ("broken.zip", b"PK\x03\x04 no archive".to_vec(), "missing"),
        ("notes.pdf", b"%PDF-1.5\n\x01\x02".to_vec(), "missing"),
        ("notes.txt", b"I was ill.".to_vec(), "missing"),
        (
            "onlinetext.html",
            format!("<p>{right}</p>").into_bytes(),
            "missing",
        ),
        ("empty.glsl", Vec::new(), "invalid"),
        ("wrong.fs", wrong.into_bytes(), "wrong"),
        ("typo.glsl", invalid.into_bytes(), "invalid"),
        ("waves.zip", zip(&project), "wrong"),
    ]
}

/// Forty students of a Moodle course, with what students do to files.
#[test]
fn every_student_of_a_download_has_a_row() {
    let odd = odd_files();
    let mut files = Vec::new();
    let mut expected = BTreeMap::new();
    for (number, (name, bytes, verdict)) in odd.into_iter().enumerate() {
        // Two have the same name.
        let (student, folder) = match number {
            0 => ("Zoë O'Neill".to_owned(), "Zoë-O-Neill".to_owned()),
            1 => ("Zoë O'Neill".to_owned(), "Zoë-O-Neill-1".to_owned()),
            _ => (format!("Zoë {number}"), format!("Zoë-{number}")),
        };
        files.push((format!("{student}_{number}_assignsubmission_file/{name}"), bytes));
        expected.insert(folder, verdict.to_owned());
    }
    for number in 100..117 {
        files.push((
            format!("Student {number}_{number}_assignsubmission_file_a.glsl"),
            SPHERE.shader.into(),
        ));
        expected.insert(format!("Student-{number}"), "correct".to_owned());
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let borrowed: Vec<_> = files
        .iter()
        .map(|(name, bytes)| (name.as_str(), bytes.clone()))
        .collect();
    fs::write(folder.join("moodle.zip"), zip(&borrowed)).unwrap();
    fs::write(
        folder.join("students.csv"),
        "900,Not There\nStudent 100\n901;Nor Here\n",
    )
    .unwrap();
    fs::write(folder.join("class.toml"), "students = \"students.csv\"\n").unwrap();
    for absent in ["Not-There", "Nor-Here"] {
        expected.insert(absent.to_owned(), "missing".to_owned());
    }
    let run = collect(folder, &["moodle.zip", "--class", "class.toml", "-o", "hw"]);
    assert!(
        run.stderr.contains("\nhw: 40 students, 32 with a shader\n"),
        "{}\n{}",
        run.stdout,
        run.stderr
    );
    for line in [
        "latin1.glsl was saved as Latin-1, now as UTF-8",
        "utf16.glsl was saved as UTF-16, now as UTF-8",
        "a.glsl.txt is a shader, now a.glsl",
        "skipped ../../up.glsl: its path leads out of the archive",
        "skipped bomb.zip/deep.zip/deeper.zip/deepest.zip/end.zip: more than 4 archives are in each other",
        "skipped broken.zip: it is not a valid zip archive: it has no directory",
        "skipped notes.pdf: it is not text",
        "skipped notes.txt: it is not a shader: it has no mainImage",
        "skipped onlinetext.html: it is a formatted document; the shader has to be plain text",
    ] {
        assert!(run.stdout.contains(line), "{line}\n{}", run.stdout);
    }
    assert!(!folder.join("up.glsl").exists());
    assert_eq!(verdicts(folder), expected);
    let again = toyproof(folder, &["collect", "moodle.zip", "-o", "hw"]);
    assert!(
        again.code == 2 && again.stderr.contains("hw already has files; nothing was written"),
        "{}",
        again.stderr
    );
}

#[test]
fn canvas_names_students_in_file_names() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let right = SPHERE.shader.as_bytes().to_vec();
    let archive = [
        ("doejane_12_345_sphere.glsl", right.clone()),
        ("leebo_LATE_13_346_work.zip", zip(&[("sphere-1.glsl", right)])),
        ("maimai_14_347_photo.png", b"\x89PNG\r\n\x1a\n\0".to_vec()),
    ];
    fs::write(folder.join("submissions.zip"), zip(&archive)).unwrap();
    let run = collect(folder, &["submissions.zip", "-o", "hw"]);
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines: Vec<_> = run.stdout.lines().map(words).collect();
    assert_eq!(
        lines,
        [
            "collected doejane 1 file",
            "collected leebo 1 file, late",
            "missing maimai no shader was submitted",
            "skipped photo.png: it is not text"
        ]
    );
    let rows = verdicts(folder);
    let rows: Vec<_> = rows
        .iter()
        .map(|(name, verdict)| format!("{name} {verdict}"))
        .collect();
    assert_eq!(rows, ["doejane correct", "leebo correct", "maimai missing"]);
    let missing = &records(folder)[2];
    assert_eq!(
        missing["reason"],
        "no shader was submitted (photo.png: it is not text)"
    );
    assert_eq!(missing["shader"], "hw/maimai");
    let roster: Value =
        serde_json::from_slice(&fs::read(folder.join("hw/submissions.json")).unwrap()).unwrap();
    assert_eq!(roster["students"][1]["is_late"], true);
}

#[test]
fn assignments_of_a_class_get_folders_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for path in [
        "download/class/anna/hw1/a.glsl",
        "download/class/anna/glass.glsl",
        "download/class/bo/other.glsl",
    ] {
        fs::create_dir_all(folder.join(path).parent().unwrap()).unwrap();
        fs::write(folder.join(path), SPHERE.shader).unwrap();
    }
    let class = "[[assignment]]\nname = \"sphere\"\nfiles = [\"hw1/*\"]\n[[assignment]]\nname = \"glass\"\nfiles = [\"*GLASS*\"]\n";
    fs::write(folder.join("class.toml"), class).unwrap();
    let run = collect(folder, &["download", "--class", "class.toml", "-o", "hw"]);
    for path in [
        "sphere/anna/hw1/a.glsl",
        "glass/anna/glass.glsl",
        "sphere/submissions.json",
        "glass/submissions.json",
    ] {
        assert!(folder.join("hw").join(path).is_file(), "{path}");
    }
    let left_out = "warning: bo: other.glsl was left out: no assignment of the class has this file";
    assert!(run.stderr.contains(left_out), "{}", run.stderr);
    assert!(
        run.stderr
            .contains("to check them: toyproof check hw/glass --out marks"),
        "{}",
        run.stderr
    );

    fs::write(
        folder.join("class.toml"),
        "student = 1\n[[assignment]]\nname = \"a/b\"\nfiles = []\n",
    )
    .unwrap();
    let run = toyproof(
        folder,
        &["collect", "download", "--class", "class.toml", "-o", "other"],
    );
    assert!(
        run.code == 2 && run.stderr.contains("class.toml:1:1") && run.stderr.contains("class.toml:3:8"),
        "{}",
        run.stderr
    );
}

#[test]
fn archives_among_shaders_are_not_skipped_silently() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("hw")).unwrap();
    for (name, text) in [
        ("a.glsl", SPHERE.shader),
        ("b.txt", SPHERE.shader),
        ("c.ZIP", "PK"),
        ("d.png", ""),
    ] {
        fs::write(folder.join("hw").join(name), text).unwrap();
    }
    fs::write(folder.join("scene.toml"), SPHERE.scene).unwrap();
    let run = run(&mut check_homework(folder));
    let warning =
        "warning: skipped hw/b.txt and 1 more file: not a shader\nhelp: `toyproof collect` finds shaders";
    assert!(run.code == 0 && run.stderr.contains(warning), "{}", run.stderr);
}
