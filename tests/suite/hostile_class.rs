//! One student's submission harms nobody else's.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde_json::Value;

use crate::batch::records;
use crate::collected::zip;
use crate::program::{Run, toyproof};
use crate::support::SPHERE;

/// The offset of a field in the first entry of an archive's directory, which begins with its mark.
fn directory_field(archive: &[u8], at: usize) -> usize {
    archive
        .windows(4)
        .position(|bytes| bytes == b"PK\x01\x02")
        .unwrap()
        + at
}

/// An archive of one file with another flag or method of compression in its directory.
fn with_field(name: &str, bytes: &[u8], at: usize, value: u8) -> Vec<u8> {
    let mut archive = zip(&[(name, bytes.to_vec())]);
    let at = directory_field(&archive, at);
    archive[at] = value;
    archive
}

/// An archive of one compressed file of zeros.
fn bomb(name: &str, mebibytes: usize) -> Vec<u8> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    for _ in 0..mebibytes {
        std::io::Write::write_all(&mut encoder, &vec![0; 1 << 20]).unwrap();
    }
    with_field(name, &encoder.finish().unwrap(), 10, 8)
}

/// What ten students submit, a word for each, and what is reported of it.
fn hostile() -> Vec<(&'static str, &'static str, Vec<u8>, &'static str)> {
    let shader = || SPHERE.shader.as_bytes().to_vec();
    let many = (0..100_001)
        .map(|number| format!("{number}.c"))
        .collect::<Vec<_>>();
    let many: Vec<_> = many.iter().map(|name| (name.as_str(), Vec::new())).collect();
    let mut nested = zip(&[("a.glsl", shader())]);
    for _ in 0..5 {
        nested = zip(&[("a.zip", nested)]);
    }
    let large = vec![b' '; 1 << 20];
    let texts = (0..9).map(|number| format!("{number}.glsl")).collect::<Vec<_>>();
    let texts: Vec<_> = texts.iter().map(|name| (name.as_str(), large.clone())).collect();
    let mut truncated = zip(&[("a.glsl", shader())]);
    truncated.truncate(truncated.len() - 30);
    // The directory is after the end of the archive.
    let mut elsewhere = zip(&[("a.glsl", shader())]);
    let end = elsewhere.len() - 6;
    elsewhere.splice(end..end + 4, [0xfe, 0xff, 0xff, 0x7f]);
    let deep = "deep/".repeat(1000) + "a.glsl";
    vec![
        (
            "large",
            "a.zip",
            bomb("inner.zip", 65),
            "it is larger than 64 MiB",
        ),
        (
            "many",
            "a.zip",
            zip(&many),
            "the submission has more than 1,000 files; the others were left out",
        ),
        (
            "nested",
            "a.zip",
            nested,
            "more than 4 archives are in each other",
        ),
        (
            "texts",
            "a.zip",
            zip(&texts),
            "the texts of the submission are larger than 8 MiB",
        ),
        (
            "truncated",
            "a.zip",
            truncated,
            "it is not a valid zip archive: it has no directory",
        ),
        ("elsewhere", "a.zip", elsewhere, "it is not a valid zip archive"),
        (
            "deep",
            "a.zip",
            zip(&[(&deep, shader())]),
            "its path is longer than 1,000 bytes",
        ),
        (
            "encrypted",
            "a.zip",
            with_field("a.glsl", &shader(), 8, 1),
            "it cannot be read: it is encrypted",
        ),
        (
            "method",
            "a.zip",
            with_field("a.glsl", &shader(), 10, 14),
            "its compression, method 14, is not supported",
        ),
        (
            "outside",
            "a.zip",
            zip(&[("../../a.glsl", shader())]),
            "its path leads out of the archive",
        ),
    ]
}

/// What others submit, whose names need care: all of it is collected.
fn odd() -> Vec<(&'static str, &'static str, Vec<u8>, usize)> {
    let shader = || SPHERE.shader.as_bytes().to_vec();
    let long = "n".repeat(300) + ".glsl";
    let both = [
        ("a.glsl", shader()),
        ("a.glsl/b.glsl", shader()),
        ("A.glsl", shader()),
    ];
    vec![
        ("submissions.json", "a.glsl", shader(), 1),
        ("CON", "nul.glsl", shader(), 1),
        ("Names", "a.zip", zip(&[(&long, shader())]), 1),
        ("Both", "a.zip", zip(&both), 3),
    ]
}

/// Forty downloads of Moodle: ten are hostile.
fn download() -> Vec<u8> {
    let mut files = Vec::new();
    for (number, (student, name, bytes, _)) in hostile().into_iter().enumerate() {
        files.push((
            format!("Evil {student}_{number}_assignsubmission_file/{name}"),
            bytes,
        ));
    }
    for (number, (student, name, bytes, _)) in odd().into_iter().enumerate() {
        files.push((
            format!("{student}_{}_assignsubmission_file/{name}", 10 + number),
            bytes,
        ));
    }
    for number in 14..40 {
        let name = format!("Student {number}_{number}_assignsubmission_file_a.glsl");
        files.push((name, SPHERE.shader.into()));
    }
    let files: Vec<_> = files
        .iter()
        .map(|(name, bytes)| (name.as_str(), bytes.clone()))
        .collect();
    zip(&files)
}

/// The file of a class with one assignment.
fn write_class(folder: &Path) {
    fs::write(folder.join("scene.toml"), SPHERE.scene).unwrap();
    let assignment = "scene = \"scene.toml\"\n[[frame]]\nsize = [32, 18]\n[rubric.algorithm]\npoints = 5\n";
    fs::write(folder.join("assignment.toml"), assignment).unwrap();
    let class = "[[assignment]]\nname = \"sphere\"\nfiles = [\"*\"]\nassignment = \"assignment.toml\"\n";
    fs::write(folder.join("class.toml"), class).unwrap();
}

fn check_class(folder: &Path, download: &str) -> Run {
    let arguments = ["check", download, "--class", "class.toml", "--out", "out"];
    toyproof(
        folder,
        &[&arguments[..], &["--device", "cpu", "--search", "0"]].concat(),
    )
}

#[test]
fn ten_hostile_submissions_of_forty_cost_only_their_own_rows() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("moodle.zip"), download()).unwrap();
    write_class(folder);
    let run = check_class(folder, "moodle.zip");
    assert_eq!(run.code, 1, "{}", run.stderr);
    let records = records(folder);
    let of = |student: &str| -> Vec<&Value> {
        let own = records
            .iter()
            .filter(|record| record["submitted"]["student"] == student);
        own.collect()
    };
    let mut right = 0;
    for (student, _, _, files) in odd() {
        let own = of(student);
        assert_eq!(own.len(), files, "{student}");
        assert!(
            own.iter().all(|record| record["verdict"] == "correct"),
            "{student}: {own:?}"
        );
        right += 1;
    }
    for number in 14..40 {
        let own = of(&format!("Student {number}"));
        assert!(own.len() == 1 && own[0]["verdict"] == "correct", "{own:?}");
        right += 1;
    }
    assert_eq!(right, 30);
    let roster = fs::read_to_string(folder.join("out/submissions/sphere/submissions.json")).unwrap();
    let roster: Value = serde_json::from_str(&roster).unwrap();
    let roster = roster["students"].as_array().unwrap();
    assert_eq!(roster.len(), 40);
    for (student, _, _, expected) in hostile() {
        let name = format!("Evil {student}");
        let own = of(&name);
        let entry = roster
            .iter()
            .find(|entry| entry["name"] == name.as_str())
            .unwrap();
        let skipped = entry["skipped"].as_array().unwrap();
        let has_reason = |skipped: &Value| skipped["reason"].as_str().unwrap().contains(expected);
        assert!(skipped.iter().any(has_reason), "{student}: {skipped:?}");
        if student == "texts" {
            assert!(own.len() == 8 && own.iter().all(|record| record["verdict"] == "invalid"));
            continue;
        }
        assert!(
            own.len() == 1 && own[0]["verdict"] == "missing",
            "{student}: {own:?}"
        );
        let reason = own[0]["reason"].as_str().unwrap();
        assert!(reason.starts_with("no shader was submitted (a.zip"), "{reason}");
        assert_eq!(
            skipped.len(),
            if student == "many" { 1001 } else { 1 },
            "{student}"
        );
    }
    let table = fs::read_to_string(folder.join("out/class.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 40, "{table}");
    // The marks of several students are not those of one submission to Gradescope.
    assert!(!folder.join("out/results.json").exists());
    // `collect` prints a few of the many skipped files.
    let run = toyproof(folder, &["collect", "moodle.zip", "-o", "hw"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout
            .contains("skipped 991 more files: see submissions.json"),
        "{}",
        run.stdout
    );
    assert!(
        run.stderr.contains("\nhw: 40 students, 31 with a shader\n"),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr
            .contains("to check them: toyproof check hw --assignment FILE --out marks"),
        "{}",
        run.stderr
    );
}

/// What a download, an unpacked folder and the folder that is checked may have instead of files.
#[cfg(unix)]
#[test]
fn pipes_and_sockets_are_not_waited_for() {
    use rustix::fs::{CWD, FileType, Mode, mknodat};

    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let pipe = |name: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        mknodat(CWD, &path, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
    };
    let shader = |name: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, SPHERE.shader).unwrap();
    };
    pipe("moodle/Evil_2_assignsubmission_file/f.glsl");
    pipe("moodle/Evil_2_assignsubmission_file/f.zip");
    let socket = folder.join("moodle/Evil_2_assignsubmission_file/s.txt");
    let _listener = std::os::unix::net::UnixListener::bind(socket).unwrap();
    shader("moodle/Anna_1_assignsubmission_file/a.glsl");
    write_class(folder);
    let run = check_class(folder, "moodle");
    assert_eq!(run.code, 1, "{}", run.stderr);
    for line in [
        "Evil: skipped f.glsl: it cannot be read: it is a named pipe, not a file",
        "Evil: skipped f.zip: it cannot be read: it is a named pipe, not a file",
        "Evil: skipped s.txt: it cannot be read: it is a socket, not a file",
    ] {
        assert!(run.stderr.contains(line), "{line}\n{}", run.stderr);
    }
    let verdicts: Vec<_> = records(folder)
        .iter()
        .map(|record| record["verdict"].clone())
        .collect();
    assert_eq!(verdicts, ["correct", "missing"]);

    // Beside a shader, and as files that `check` finds by their names.
    for name in [
        "hw/submissions.json",
        "hw/assignment.toml",
        "hw/a.toml",
        "hw/b/image.glsl",
        "hw/c.json",
        "hw/p.glsl",
    ] {
        pipe(name);
    }
    shader("hw/a.glsl");
    pipe("earlier.json");
    pipe("moodle.zip");
    pipe("reference.png");
    let check = [
        "check", "hw", "--device", "cpu", "--size", "16x9", "--out", "marks",
    ];
    let run = toyproof(folder, &check);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for arguments in [
        &["check", "hw", "--compare", "earlier.json"][..],
        &[
            "check",
            "hw/a.glsl",
            "hw/p.glsl",
            "--device",
            "cpu",
            "--size",
            "16x9",
        ],
        &["check", "hw/a.glsl", "--scene", "hw/a.toml"],
        &["collect", "moodle.zip", "-o", "collected"],
        &["check", "hw", "--reference", "reference.png"],
    ] {
        let run = toyproof(folder, arguments);
        let what = "it is a named pipe, not a file";
        let all = format!("{}{}", run.stdout, run.stderr);
        assert!(run.code == 2 && all.contains(what), "{arguments:?}: {all}");
    }
}

/// A file or a folder in the place of the list of students, in a folder that nobody collected.
#[test]
fn what_is_called_like_the_list_of_students_is_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir_all(folder.join("folder/submissions.json")).unwrap();
    fs::create_dir_all(folder.join("file")).unwrap();
    fs::write(folder.join("folder/submissions.json/a.glsl"), SPHERE.shader).unwrap();
    fs::write(folder.join("file/a.glsl"), SPHERE.shader).unwrap();
    fs::write(folder.join("file/submissions.json"), "[1, 2").unwrap();
    for (name, warning) in [
        ("folder", "it is a folder, not a file"),
        (
            "file",
            "warning: file/submissions.json is not a list of students: ",
        ),
    ] {
        let run = toyproof(folder, &["check", name, "--device", "cpu", "--size", "16x9"]);
        assert!(run.code == 0 && run.stderr.contains(warning), "{}", run.stderr);
    }
}

/// A broken archive or an empty folder does not change whose the files of the others are.
#[test]
fn students_of_a_folder_in_a_download_do_not_depend_on_their_files() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let shader = || SPHERE.shader.as_bytes().to_vec();
    let inner = zip(&[("a.glsl", shader())]);
    let files = [
        ("hw1/Anna.zip", inner),
        ("hw1/Broken.zip", b"PK".to_vec()),
        ("hw1/Bo_7_assignsubmission_file_a.glsl", shader()),
        ("hw1/Cy/a.glsl", shader()),
    ];
    let without_folder = files.clone().map(|(name, bytes)| (&name[4..], bytes));
    let students = "Anna, Bo, Broken, Cy".to_owned();
    fs::write(folder.join("class.zip"), zip(&files)).unwrap();
    fs::write(
        folder.join("outer.zip"),
        zip(&[("class.zip", zip(&without_folder))]),
    )
    .unwrap();
    for download in ["class.zip", "outer.zip"] {
        let out = format!("of-{download}");
        let run = toyproof(folder, &["collect", download, "-o", &out]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let roster = fs::read(folder.join(out).join("submissions.json")).unwrap();
        let roster: Value = serde_json::from_slice(&roster).unwrap();
        let names = roster["students"].as_array().unwrap().iter();
        let names: Vec<_> = names.map(|entry| entry["name"].as_str().unwrap()).collect();
        assert_eq!(names.join(", "), students, "{download}");
    }
    fs::write(folder.join("a.glsl"), shader()).unwrap();
    let run = toyproof(folder, &["collect", "a.glsl", "-o", "one"]);
    let error =
        "error: a.glsl is neither an archive (.zip) nor a folder\nhelp: `toyproof check` takes shaders";
    assert!(run.code == 2 && run.stderr.contains(error), "{}", run.stderr);
}

/// The export of a learning management system, in the encoding and with the separators of a spreadsheet.
#[test]
fn tables_of_students_are_read_and_written_as_csv() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = |student: &str| -> (String, Vec<u8>) {
        (
            format!("{student}_assignsubmission_file/a.glsl"),
            SPHERE.shader.into(),
        )
    };
    let files = ["Zoë Müller_1", "Anna Smith_2", "Anna Smith_3", "=1+2_4"].map(file);
    let files: Vec<(&str, Vec<u8>)> = files
        .iter()
        .map(|(name, bytes)| (name.as_str(), bytes.clone()))
        .collect();
    fs::write(folder.join("moodle.zip"), zip(&files)).unwrap();
    write_class(folder);
    let class = fs::read_to_string(folder.join("class.toml")).unwrap();
    fs::write(
        folder.join("class.toml"),
        format!("students = \"students.csv\"\n{class}"),
    )
    .unwrap();
    // Windows-1252, as Excel saves it in Europe.
    let mut table = String::from("Identifier;Full name;Grade\r\n");
    for (number, name) in [
        (1, "M\u{fc}ller, Zo\u{eb}"),
        (2, "Smith, Anna"),
        (3, "Smith, Anna"),
        (5, "\"\"Bo\"\";"),
    ] {
        write!(table, "Participant {number};\"{name}\";\r\n").unwrap();
    }
    let bytes: Vec<u8> = table.chars().map(|character| character as u8).collect();
    fs::write(folder.join("students.csv"), bytes).unwrap();
    let run = check_class(folder, "moodle.zip");
    assert_eq!(run.code, 1, "{}", run.stderr);
    let table = fs::read_to_string(folder.join("out/class.csv")).unwrap();
    assert_eq!(
        table,
        "student,id,sphere,total,sphere verdict,sphere late\r\n\
         \"\"\"Bo\"\";\",5,0,0,missing,\r\n\
         '=1+2,4,5,5,correct,\r\n\
         \"Müller, Zoë\",1,5,5,correct,\r\n\
         \"Smith, Anna\",2,5,5,correct,\r\n\
         \"Smith, Anna\",3,5,5,correct,\r\n"
    );
}

/// Mistakes of teachers that have a way out.
#[test]
fn messages_name_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_class(folder);
    fs::write(folder.join("s.glsl"), SPHERE.shader).unwrap();
    fs::remove_file(folder.join("assignment.toml")).unwrap();
    let expected = "warning: scene.toml was not used: it has another name than the shader\n\
                    help: compare with it with `--scene scene.toml`\n";
    let run = toyproof(folder, &["check", "s.glsl", "--device", "cpu", "--size", "16x9"]);
    assert!(run.code == 0 && run.stderr.contains(expected), "{}", run.stderr);

    let latin1: Vec<u8> = format!("// gr\u{f6}\u{df}er\n{}", SPHERE.shader)
        .chars()
        .map(|c| c as u8)
        .collect();
    fs::write(folder.join("s.glsl"), latin1).unwrap();
    let run = toyproof(folder, &["check", "s.glsl", "--device", "cpu"]);
    let help = "`toyproof collect FOLDER -o NEW` saves shaders as UTF-8";
    assert!(run.code == 1 && run.stderr.contains(help), "{}", run.stderr);

    let run = toyproof(folder, &["new", "class", "spring"]);
    let next = "created spring.toml\nnext:\n  edit spring.toml\n  toyproof check DOWNLOAD --class spring.toml --out marks\n";
    assert!(run.code == 0 && run.stderr.contains(next), "{}", run.stderr);
    fs::write(
        folder.join("moodle.zip"),
        zip(&[("Anna/a.glsl", SPHERE.shader.into())]),
    )
    .unwrap();
    let run = toyproof(
        folder,
        &["collect", "moodle.zip", "--class", "spring.toml", "-o", "new"],
    );
    let missing = "there is no file \"week1/assignment.toml\"";
    assert!(run.code == 2 && run.stderr.contains(missing), "{}", run.stderr);
    fs::create_dir(folder.join("week1")).unwrap();
    fs::write(
        folder.join("week1/assignment.toml"),
        "scene = \"../scene.toml\"\n",
    )
    .unwrap();
    let run = toyproof(
        folder,
        &["collect", "moodle.zip", "--class", "spring.toml", "-o", "new"],
    );
    assert!(
        run.code == 0 && folder.join("new/week1/Anna/a.glsl").is_file(),
        "{}",
        run.stderr
    );
}
