//! Downloads of learning management systems: `collect`, and the rows of `check` for all students.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use flate2::Crc;
use serde_json::Value;

use crate::batch::records;
use crate::program::{Run, check_homework, run, toyproof};
use crate::support::SPHERE;

/// The time and the date that programs write that state none: 1980-01-01.
const NO_TIME: [u16; 2] = [0, 0x21];

/// An archive of these files, uncompressed, as the simplest programs write it.
pub(crate) fn zip(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let files: Vec<_> = files
        .iter()
        .map(|(name, bytes)| (*name, bytes.clone(), NO_TIME))
        .collect();
    zip_with_times(&files)
}

/// An archive of files with their times and dates in the format of DOS.
fn zip_with_times(files: &[(&str, Vec<u8>, [u16; 2])]) -> Vec<u8> {
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes, changed) in files {
        let offset = archive.len() as u32;
        let mut crc = Crc::new();
        crc.update(bytes);
        let length = (bytes.len() as u32).to_le_bytes();
        // Version, flags and method.
        let mut common = vec![10, 0, 0, 0, 0, 0];
        common.extend(changed.map(u16::to_le_bytes).as_flattened());
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
        "900,Not There\nStudent 100\n901,\"Here, Nor\"\n",
    )
    .unwrap();
    fs::write(folder.join("class.toml"), "students = \"students.csv\"\n").unwrap();
    for absent in ["Not-There", "Here--Nor"] {
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
    assert_eq!(roster["students"][1]["late"]["seconds"], Value::Null);
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
            .contains("to check them: toyproof check hw/glass --assignment FILE --out marks"),
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
    let run = crate::program::run(&mut check_homework(folder));
    let warning =
        "warning: skipped hw/b.txt and 1 more file: not a shader\nhelp: `toyproof collect` finds shaders";
    assert!(run.code == 0 && run.stderr.contains(warning), "{}", run.stderr);

    // Of students who have nothing else, there is a row.
    for (name, bytes) in [
        ("hw/anna/shader.txt", SPHERE.shader.as_bytes().to_vec()),
        ("hw/bo/work/a.zip", zip(&[("a.glsl", SPHERE.shader.into())])),
        ("hw/cy/notes.txt", b"I was ill.".to_vec()),
        ("hw/di/a.txt", SPHERE.shader.into()),
        ("hw/di/a.glsl", SPHERE.shader.into()),
    ] {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), bytes).unwrap();
    }
    let verdicts = verdicts(folder);
    let verdicts: Vec<_> = verdicts
        .iter()
        .map(|(name, verdict)| format!("{name} {verdict}"))
        .collect();
    assert_eq!(
        verdicts,
        ["a.glsl correct", "anna missing", "bo missing", "di correct"]
    );
    let reason = "no shader was submitted (work/a.zip: `toyproof collect` finds its shader)";
    assert_eq!(records(folder)[2]["reason"], reason);
}

/// The first of March 2026 at a time of day, in the format of DOS.
fn at(hour: u16, minute: u16) -> [u16; 2] {
    [hour << 11 | minute << 5, 46 << 9 | 3 << 5 | 1]
}

/// A download of two assignments with a deadline at noon, and the file of the class.
fn class(folder: &Path) {
    let wrong = SPHERE
        .shader
        .replace("sphere.radius * sphere.radius", "sphere.radius");
    let flat = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.5, 0.5, 0.5, 1.0); }\n";
    let file = |student: &str, name: &str| format!("{student}_assignsubmission_file/{name}");
    let files = [
        (file("anna s_7", "sphere.glsl"), SPHERE.shader, at(11, 0)),
        (file("anna s_7", "Flat-final.txt"), flat, at(14, 5)),
        (file("Bo_8", "my sphere.glsl"), wrong.as_str(), at(12, 1)),
        (file("Bo_8", "sphere-2.glsl"), SPHERE.shader, at(11, 0)),
        (file("Bo_8", "notes.txt"), "I was ill.", at(11, 0)),
        (file("Bo_8", "extra.glsl"), flat, at(11, 0)),
        (file("Cy_9", "flat.glsl"), flat, NO_TIME),
    ];
    let files: Vec<_> = files
        .iter()
        .map(|(name, text, time)| (name.as_str(), text.as_bytes().to_vec(), *time))
        .collect();
    fs::write(folder.join("moodle.zip"), zip_with_times(&files)).unwrap();
    for task in ["sphere", "flat"] {
        fs::create_dir_all(folder.join("tasks").join(task)).unwrap();
    }
    let rubric = "compiles.points = 2\nalgorithm.points = 8\nlate.percent_per_day = 10\n";
    let frame = "[[frame]]\nsize = [64, 36]\n";
    let write = |name: &str, text: &str| fs::write(folder.join("tasks").join(name), text).unwrap();
    write("sphere/scene.toml", SPHERE.scene);
    write(
        "sphere/assignment.toml",
        &format!("scene = \"scene.toml\"\n{frame}"),
    );
    write("sphere/rubric.toml", rubric);
    write("flat/solution.glsl", flat);
    write(
        "flat/assignment.toml",
        &format!("reference = \"solution.glsl\"\n{frame}"),
    );
    write(
        "class.toml",
        "[students]\n7 = \"Anna Smith\"\n10 = \"Not There\"\n\
         [[assignment]]\nname = \"sphere\"\nfiles = [\"*sphere*\"]\nassignment = \"sphere\"\n\
         rubric = \"sphere/rubric.toml\"\ndeadline = 2026-03-01T12:00:00+01:00\n\
         [[assignment]]\nname = \"flat\"\nfiles = [\"*flat*\"]\nassignment = \"flat/assignment.toml\"\n\
         deadline = 2026-03-01T12:00:00+01:00\n",
    );
}

const CHECK_CLASS: [&str; 11] = [
    "check",
    "moodle.zip",
    "--class",
    "tasks/class.toml",
    "--device",
    "cpu",
    "--search",
    "0",
    "--jobs",
    "1",
    "--out",
];

#[test]
fn a_class_is_checked_in_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    class(folder);
    let check = |out: &str| toyproof(folder, &[&CHECK_CLASS[..], &[out]].concat());
    let run = check("out");
    assert_eq!(run.code, 1, "{}", run.stderr);
    for line in [
        "warning: Bo: extra.glsl was left out: no assignment of the class has this file",
        "Bo: skipped notes.txt: it is not a shader: it has no mainImage",
        "warning: out/submissions/flat: 1 submission counts as on time: the download does not state when",
        "report: out/report.html",
    ] {
        assert!(run.stderr.contains(line), "{line}\n{}", run.stderr);
    }
    let rows: Vec<_> = records(folder)
        .iter()
        .map(|record| {
            let submitted = &record["submitted"];
            let text = |value: &Value| value.as_str().unwrap_or("-").to_owned();
            let late = submitted["late"]["seconds"].to_string();
            let [assignment, student, id] = ["assignment", "student", "id"].map(|key| text(&submitted[key]));
            format!("{assignment} {student} {id} {late} {}", text(&record["verdict"]))
        })
        .collect();
    assert_eq!(
        rows,
        [
            "sphere Anna Smith 7 null correct",
            "sphere Bo 8 60 wrong",
            "sphere Bo 8 60 correct",
            "sphere Cy 9 null missing",
            "sphere Not There 10 null missing",
            "flat Anna Smith 7 7500 correct",
            "flat Bo 8 null missing",
            "flat Cy 9 null correct",
            "flat Not There 10 null missing",
        ]
    );
    let read = |name: &str| fs::read_to_string(folder.join("out").join(name)).unwrap();
    let table = "student,id,sphere,flat,total,sphere verdict,sphere late,flat verdict,flat late\r\n\
                 Anna Smith,7,10,correct,10,correct,,correct,late by 2 h 5 min\r\n\
                 Bo,8,1,missing,1,wrong,late by 1 min,missing,\r\n\
                 Cy,9,0,correct,0,missing,,correct,\r\n\
                 Not There,10,0,missing,0,missing,,missing,\r\n";
    assert_eq!(read("class.csv"), table);
    // How late a submission is, in every report.
    assert!(read("report.csv").contains(",flat,Anna Smith,7,7500,,\r\n"));
    for report in ["report.html", "junit.xml", "report.sarif"] {
        assert!(read(report).contains("late by 2 h 5 min"), "{report}");
    }
    let shown = "late by 2 h 5 min\n";
    assert!(run.stdout.contains(shown), "{}", run.stdout);
    assert!(folder.join("out/flat/Anna-Smith/Flat-final-actual.png").is_file());

    // Again, without what was removed from the download.
    fs::write(
        folder.join("moodle.zip"),
        zip(&[("Bo_8_assignsubmission_file/sphere.glsl", SPHERE.shader.into())]),
    )
    .unwrap();
    assert_eq!(check("out").code, 1);
    let files: Vec<_> = records(folder)
        .iter()
        .map(|record| record["shader"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(files[0], "out/submissions/sphere/Anna-Smith");
    assert_eq!(files[1], "out/submissions/sphere/Bo/sphere.glsl");
    assert_eq!(files.len(), 6, "{files:?}");

    fs::create_dir_all(folder.join("other/submissions")).unwrap();
    fs::write(folder.join("other/submissions/mine.txt"), "mine").unwrap();
    let refused = check("other");
    let error = "error: other/submissions already has files that toyproof did not collect";
    assert!(
        refused.code == 2 && refused.stderr.contains(error),
        "{}",
        refused.stderr
    );
}

/// Shards need one collection, which all of them read.
#[test]
fn the_shards_of_a_class_give_the_report_of_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    class(folder);
    let refused = toyproof(folder, &[&CHECK_CLASS[..], &["out", "--shard", "1/2"]].concat());
    assert!(
        refused.code == 2
            && refused
                .stderr
                .contains("error: a shard needs collected submissions, not a download\nhelp: "),
        "{}",
        refused.stderr
    );
    collect(folder, &["moodle.zip", "--class", "tasks/class.toml", "-o", "hw"]);
    let mut arguments = CHECK_CLASS;
    arguments[1] = "hw";
    let one = toyproof(folder, &[&arguments[..], &["out"]].concat());
    assert_eq!(one.code, 1, "{}", one.stderr);
    let read = |name: &str| fs::read_to_string(folder.join("out").join(name)).unwrap();
    let expected = (records(folder), read("class.csv"));
    assert!(expected.0[0]["shader"] == "hw/sphere/Anna-Smith/sphere.glsl");
    for shard in ["1/2", "2/2"] {
        let out = format!("shards/{}", &shard[..1]);
        let run = toyproof(folder, &[&arguments[..], &[&out, "--shard", shard]].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
    }
    let merged = toyproof(folder, &["merge", "shards/1", "shards/2", "--out", "out"]);
    assert_eq!(merged.code, 1, "{}", merged.stderr);
    assert_eq!((records(folder), read("class.csv")), expected);
}

#[test]
fn errors_of_a_class_have_their_places_and_advice() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    class(folder);
    for (text, place, message, help) in [
        (
            "students = 1",
            "1:12",
            "`students` must be a string",
            "for example",
        ),
        (
            "[students]\n7 = 8",
            "2:5",
            "`7` must be a string, found 8",
            "for example `7 = \"name\"`",
        ),
        (
            "",
            "1:1",
            "the class has no assignment",
            "add a table [[assignment]]",
        ),
        (
            "[[assignment]]\nname = \"a\"\nfiles = [\"*\"]",
            "1:1",
            "missing key `assignment` in [[assignment]]",
            "add `assignment = ",
        ),
        (
            "[[assignment]]\nname = \"a\"\nfiles = []\nassignment = \"flat\"",
            "3:9",
            "`files` has no pattern",
            "for example `files = ",
        ),
        (
            "[[assignment]]\nname = \"a\"\nfiles = [\"*\"]\nassignment = \"none\"",
            "4:14",
            "there is no file \"none\"",
            "paths are relative",
        ),
        (
            "[[assignment]]\nname = \"a\"\nfiles = [\"*\"]\nassignment = \"flat\"\ndeadline = 2026-03-01",
            "5:12",
            "`deadline` must be a date and a time with the offset from UTC, found a date without a time",
            "for example `deadline = 2026-03-01T23:59:00+01:00`",
        ),
    ] {
        fs::write(folder.join("tasks/class.toml"), text).unwrap();
        let run = toyproof(folder, &[&CHECK_CLASS[..], &["out"]].concat());
        assert_eq!(run.code, 2, "{text}: {}", run.stderr);
        let place = format!("tasks/class.toml:{place}");
        for expected in [place.as_str(), message, help] {
            assert!(
                run.stderr.contains(expected),
                "{text}: {expected}\n{}",
                run.stderr
            );
        }
        assert!(!folder.join("out").exists());
    }
}

#[test]
fn times_of_a_copy_are_not_those_of_submissions() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    class(folder);
    let files = ["Anna_7", "Bo_8"].map(|student| format!("{student}_assignsubmission_file/sphere.glsl"));
    let files: Vec<_> = files
        .iter()
        .map(|name| (name.as_str(), SPHERE.shader.into(), at(13, 0)))
        .collect();
    fs::write(folder.join("moodle.zip"), zip_with_times(&files)).unwrap();
    let run = toyproof(folder, &[&CHECK_CLASS[..], &["out"]].concat());
    let warning = "warning: moodle.zip: the files of all students have the same time";
    assert!(run.stderr.contains(warning), "{}", run.stderr);
    assert!(
        records(folder)
            .iter()
            .all(|record| record["submitted"]["late"].is_null())
    );
}
