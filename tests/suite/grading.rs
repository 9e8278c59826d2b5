//! What lecturers do around a check: decisions, deadlines, feedback and packs, on made-up downloads.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

use toyproof::project::archive::Archive;

use crate::batch::records;
use crate::program::{Run, toyproof};

/// A disk, the solution of the assignment.
const SOLUTION: &str = "// secret of the solution\n\
    float radiusOfTheDisk() { return 0.61; }\n\
    float distanceTo(vec2 p) { return length(p) - radiusOfTheDisk(); }\n\
    void mainImage(out vec4 fragColor, in vec2 fragCoord) {\n    \
    vec2 p = (2.0 * fragCoord - iResolution.xy) / iResolution.y;\n    \
    fragColor = vec4(distanceTo(p) < 0.0 ? vec3(1.0, 0.75, 0.0) : vec3(0.5 + 0.25 * p, 0.25), 1.0);\n}\n";

const ASSIGNMENT: &str = "reference = \"solution.glsl\"\ndeadline = 2026-03-01T12:00:00Z\n\
    [[frame]]\nsize = [64, 36]\n[[frame]]\nsize = [36, 36]\ntime = 2\n\
    [rubric.compiles]\npoints = 2\n[rubric.algorithm]\npoints = 8\n[rubric.late]\npercent_per_day = 10\n\
    [rules]\nmust_define = [\"distanceTo\"]\n\
    [[function]]\nname = \"distanceTo\"\npoints = 2\ntests = [\"distanceTo(vec2(1.61, 0.0)) == 1.0\"]\n";

/// Noon of 2026-03-01 in UTC, in seconds since 1970.
const NOON: u64 = 1_772_366_400;

fn write(path: &Path, text: &str, time: u64) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
    let file = fs::File::options().write(true).open(path).unwrap();
    file.set_modified(UNIX_EPOCH + Duration::from_secs(time)).unwrap();
}

/// An assignment, and a download of Moodle: Anna is right and late, Bo is wrong, and Cy submitted nothing.
fn class() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let anna = SOLUTION
        .replace("secret of the solution", "anna's own text")
        .replace("radiusOfTheDisk", "r")
        .replace("length(p)", "distance(p, vec2(0.0))");
    let bo = anna
        .replace("0.61", "0.66")
        .replace("anna's own text", "bo's own text");
    write(&path("task/assignment.toml"), ASSIGNMENT, NOON);
    write(&path("task/solution.glsl"), SOLUTION, NOON);
    write(
        &path("moodle/Anna Smith_7_assignsubmission_file_/disk.glsl"),
        &anna,
        NOON + 7500,
    );
    write(
        &path("moodle/Bo Lee_8_assignsubmission_file_/disk.glsl"),
        &bo,
        NOON - 7500,
    );
    write(
        &path("moodle/Cy Fox_9_assignsubmission_file_/notes.txt"),
        "I was ill.\n",
        NOON - 60,
    );
    let run = call(folder.path(), "collect moodle -o hw");
    assert_eq!(run.code, 0, "{}", run.stderr);
    folder
}

/// Runs a command whose arguments have no spaces.
fn call(folder: &Path, command: &str) -> Run {
    toyproof(folder, &command.split_whitespace().collect::<Vec<_>>())
}

fn check(folder: &Path, rest: &str) -> Run {
    let common = "check hw --assignment task --device cpu --out out";
    call(folder, &format!("{common} {rest}"))
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// `verdict points` of the shaders in report.csv.
fn marks(folder: &Path) -> Vec<String> {
    let text = read(folder, "out/report.csv");
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let columns = table.headers().unwrap().clone();
    let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let (verdict, points) = (at("verdict"), at("points"));
    let rows = table.records().map(Result::unwrap);
    rows.map(|row| format!("{} {}", &row[verdict], &row[points]))
        .collect()
}

#[test]
fn the_deadline_of_an_assignment_counts_for_a_collected_folder() {
    let folder = class();
    let folder = folder.path();
    let run = check(folder, "--search 0");
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stdout.contains("; late by 2 h 5 min"), "{}", run.stdout);
    // Of 12 points, Anna loses 10 %.
    assert_eq!(marks(folder), ["correct 10.8", "wrong 2", "missing 0"]);

    // A grading platform has a deadline of its own.
    check(folder, "--search 0 --autograder gradescope");
    assert_eq!(marks(folder)[0], "correct 12");

    // A class has, too, unless it states none.
    for (deadline, points) in [
        ("deadline = 2026-03-01T16:00:00Z\n", "12"),
        ("deadline = 2026-02-28T12:00:00Z\n", "9.6"),
        ("", "10.8"),
    ] {
        let class =
            format!("[[assignment]]\nname = \"disk\"\nfiles = [\"*\"]\nassignment = \"task\"\n{deadline}");
        fs::write(folder.join("class.toml"), class).unwrap();
        let run = call(
            folder,
            "check moodle --class class.toml --device cpu --search 0 --out out",
        );
        assert_eq!(run.code, 1, "{}", run.stderr);
        assert_eq!(marks(folder)[0], format!("correct {points}"), "{deadline}");
    }

    let wrong = ASSIGNMENT.replace("12:00:00Z", "12:00:00");
    fs::write(folder.join("task/assignment.toml"), wrong).unwrap();
    let run = check(folder, "");
    assert_eq!(run.code, 2);
    assert!(
        run.stderr.contains("assignment.toml:2:12") && run.stderr.contains("without an offset"),
        "{}",
        run.stderr
    );
}

#[test]
fn submissions_without_a_time_count_as_on_time() {
    let folder = class();
    let folder = folder.path();
    for student in ["Anna Smith_7", "Bo Lee_8"] {
        let path = format!("moodle/{student}_assignsubmission_file_/disk.glsl");
        write(&folder.join(path), SOLUTION, NOON + 99);
    }
    fs::remove_dir_all(folder.join("moodle/Cy Fox_9_assignsubmission_file_")).unwrap();
    fs::remove_dir_all(folder.join("hw")).unwrap();
    assert_eq!(call(folder, "collect moodle -o hw").code, 0);
    let run = check(folder, "--search 0");
    let warning = "warning: hw: 2 submissions count as on time: the download does not state when";
    assert!(run.code == 0 && run.stderr.contains(warning), "{}", run.stderr);
}

#[test]
fn decisions_are_in_every_report_and_survive_a_resumed_check() {
    let folder = class();
    let folder = folder.path();
    let first = check(folder, "--search 0");
    assert_eq!(first.code, 1, "{}", first.stderr);
    let results = read(folder, "out/results.jsonl");
    let decisions = "[[decision]]\nshader = \"hw/Bo-Lee/disk.glsl\"\nverdict = \"correct\"\nreason = \"the <sheet> was wrong\"\n\
                     [[decision]]\nstudent = \"7\"\npoints = 11.5\nreason = \"the server was down\"\n\
                     [[decision]]\nshader = \"hw/Cy-Fox\"\nverdict = \"correct\"\npoints = 5\nreason = \"on paper\"\n\
                     [[decision]]\nshader = \"hw/Bo-Le/disk.glsl\"\npoints = 1\nreason = \"none\"\n";
    fs::write(folder.join("task/decisions.toml"), decisions).unwrap();
    let run = check(folder, "--search 0 --resume");
    assert_eq!(run.code, 0, "the decided verdicts count: {}", run.stderr);
    assert!(run.stderr.contains("2 of 3 results are reused"), "{}", run.stderr);
    assert!(
        run.stderr
            .contains("decisions.toml:14: no shader matches the decision on `hw/Bo-Le/disk.glsl`")
            && run.stderr.contains("help: did you mean `hw/Bo-Lee/disk.glsl`?"),
        "{}",
        run.stderr
    );
    // Bo's function is still wrong.
    assert_eq!(marks(folder), ["correct 11.5", "correct 10", "correct 5"]);
    for report in ["report.html", "report.csv", "junit.xml", "verdict.json"] {
        let text = read(folder, &format!("out/{report}"));
        for part in [
            "the verdict of the check was wrong",
            "the server was down",
            "on paper",
        ] {
            assert!(text.contains(part), "{report}: {part}");
        }
        assert_eq!(
            text.contains("the <sheet> was wrong"),
            report == "report.csv" || report == "verdict.json"
        );
    }
    assert!(
        run.stdout
            .contains("decided by the teacher: the <sheet> was wrong"),
        "{}",
        run.stdout
    );
    assert!(!run.stdout.contains("likely mistake"), "{}", run.stdout);
    let bo = &records(folder)[1];
    assert_eq!(bo["decision"]["checked_verdict"], "wrong", "{bo}");
    let tests = read(folder, "out/junit.xml");
    assert!(tests.contains("tests=\"3\" failures=\"0\""), "{tests}");
    assert_eq!(
        read(folder, "out/results.jsonl"),
        results,
        "decisions are not cached"
    );

    // Without the file, the verdicts are those of the check.
    fs::rename(folder.join("task/decisions.toml"), folder.join("mine.toml")).unwrap();
    let run = check(folder, "--search 0 --resume");
    assert_eq!(
        (run.code, marks(folder)[1].as_str()),
        (1, "wrong 2"),
        "{}",
        run.stderr
    );
    let run = check(folder, "--search 0 --resume --decisions mine.toml");
    assert_eq!(run.code, 0, "{}", run.stderr);

    // The gradebook has the decided points.
    fs::write(
        folder.join("grades.csv"),
        "Identifier,Full name,Grade\nParticipant 8,Bo Lee,\n",
    )
    .unwrap();
    let gradebook = "gradebook grades.csv --marks out -o filled.csv -q";
    assert_eq!(call(folder, gradebook).code, 0);
    assert!(read(folder, "filled.csv").contains("Bo Lee,10\r\n"));

    fs::write(
        folder.join("mine.toml"),
        "[[decision]]\nshader = \"a\"\nverdict = \"god\"\nreason = \"b\"\n",
    )
    .unwrap();
    let run = check(folder, "--decisions mine.toml");
    assert!(
        run.code == 2 && run.stderr.contains("mine.toml:3:11"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_class_has_decisions_for_each_assignment() {
    let folder = class();
    let folder = folder.path();
    let assignment =
        |name: &str| format!("[[assignment]]\nname = \"{name}\"\nfiles = [\"*\"]\nassignment = \"task\"\n");
    fs::write(folder.join("class.toml"), assignment("one") + &assignment("two")).unwrap();
    fs::write(
        folder.join("decisions.toml"),
        "[[decision]]\nstudent = \"Bo Lee\"\nassignment = \"two\"\npoints = 9\nreason = \"agreed\"\n",
    )
    .unwrap();
    // The file beside an assignment is about its shaders, here those of both.
    fs::write(
        folder.join("task/decisions.toml"),
        "[[decision]]\nstudent = \"Anna Smith\"\npoints = 4\nreason = \"late bus\"\n",
    )
    .unwrap();
    let check = "check moodle --class class.toml --device cpu --search 0 --out out --feedback pages.zip";
    let run = call(folder, check);
    assert_eq!(run.code, 1, "{}", run.stderr);
    let table = read(folder, "out/class.csv");
    let bo = table.lines().find(|line| line.starts_with("Bo Lee")).unwrap();
    assert_eq!(bo, "Bo Lee,8,2,9,11,wrong,,wrong,,,agreed; the check: wrong");
    let anna = table.lines().find(|line| line.starts_with("Anna Smith")).unwrap();
    assert!(anna.starts_with("Anna Smith,7,4,4,8,correct,late by"), "{anna}");
    for archive in ["pages-one.zip", "pages-two.zip"] {
        assert_eq!(pages(folder, archive).len(), 3);
    }
    assert!(!folder.join("pages.zip").exists());
}

/// The names and the texts of an archive.
fn pages(folder: &Path, archive: &str) -> BTreeMap<String, String> {
    let file = fs::File::open(folder.join(archive)).unwrap();
    let mut archive = Archive::open(file, 100).unwrap();
    let entries = archive.take_entries();
    entries
        .iter()
        .map(|entry| {
            let bytes = archive.read(entry, 1 << 26).unwrap();
            (entry.name.clone(), String::from_utf8_lossy(&bytes).into_owned())
        })
        .collect()
}

#[test]
fn each_student_has_a_page_under_the_name_of_the_download() {
    let folder = class();
    let folder = folder.path();
    let canvas = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); } // zoe's own text\n";
    write(&folder.join("canvas/foxzoe_LATE_12_34_disk.glsl"), canvas, NOON);
    write(&folder.join("canvas/roedan_13_35_disk.glsl"), SOLUTION, NOON);
    fs::remove_dir_all(folder.join("hw")).unwrap();
    let collect = "collect moodle canvas -o hw";
    assert_eq!(call(folder, collect).code, 0);
    let run = check(folder, "--feedback feedback.zip");
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(
        run.stderr.contains("feedback: feedback.zip (5 pages)"),
        "{}",
        run.stderr
    );
    let pages = pages(folder, "feedback.zip");
    let names: Vec<_> = pages.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "Anna Smith_7_assignsubmission_file_/feedback.html",
            "Bo Lee_8_assignsubmission_file_/feedback.html",
            "Cy Fox_9_assignsubmission_file_/feedback.html",
            "foxzoe_LATE_12_34_feedback.html",
            "roedan_13_35_feedback.html",
        ]
    );
    let bo = &pages[names[1]];
    for part in [
        "bo&#39;s own text",
        "Points: 2 of 12 (compiles 2 of 2, algorithm 0 of 8, distanceTo 0 of 2)",
        "function: distanceTo is right in 0 of 1 case",
        "an edit of line 2",
        "<span>Reference: solution.glsl</span>",
        " data-actual=\"0\" data-reference=\"1\"",
        "<script id=\"p1\"",
    ] {
        assert!(bo.contains(part), "{part}");
    }
    for (name, page) in &pages {
        // Edits, the solution, and everything of others; Dan submitted the solution.
        let others = ["anna", "bo", "zoe"].map(|other| format!("{other}&#39;s own text"));
        let own = name[..2].to_lowercase();
        for secret in others.iter().filter(|other| !other.starts_with(&own)) {
            assert!(
                !page.contains(secret) || name.starts_with("foxzoe") && secret.starts_with("zoe"),
                "{name}: {secret}"
            );
        }
        for student in ["Anna-Smith", "Bo-Lee", "Cy-Fox"] {
            let is_own = name.replace(' ', "-").starts_with(student);
            assert!(is_own || !page.contains(student), "{name}: {student}");
        }
        if !name.starts_with("roedan") {
            for secret in ["secret of the solution", "radiusOfTheDisk", "replace <code>"] {
                assert!(!page.contains(secret), "{name}: {secret}");
            }
        }
    }

    // All hints for the teacher are still none of the reference for students.
    let run = check(folder, "--resume --hints fix --feedback pages");
    assert_eq!(run.code, 1, "{}", run.stderr);
    let bo = read(folder, "pages/Bo Lee_8_assignsubmission_file_/feedback.html");
    assert!(bo.contains("an edit of line 2") && !bo.contains("replace <code>"));
    let run = check(folder, "--resume --hints none --feedback pages");
    assert_eq!(run.code, 1, "{}", run.stderr);
    let hidden = read(folder, "pages/Bo Lee_8_assignsubmission_file_/feedback.html");
    assert!(!hidden.contains("an edit of line 2") && hidden.len() < bo.len());

    // The images that the rubric shows to students.
    let assignment = ASSIGNMENT.replace(
        "[rubric.compiles]",
        "[rubric]\nimages = \"none\"\nvisibility = \"hidden\"\n[rubric.compiles]",
    );
    fs::write(folder.join("task/assignment.toml"), assignment).unwrap();
    check(folder, "--search 0 --feedback pages");
    let bare = read(folder, "pages/Bo Lee_8_assignsubmission_file_/feedback.html");
    assert!(!bare.contains("<script id=\"p0\"") && !bare.contains("Points:"));
}

#[test]
fn feedback_needs_a_report_and_works_without_students() {
    let folder = class();
    let folder = folder.path();
    let run = call(folder, "check task/solution.glsl --feedback pages");
    assert!(run.code == 2 && run.stderr.contains("--out"), "{}", run.stderr);
    let check = "check task/solution.glsl --device cpu --out out --feedback pages";
    let run = call(folder, check);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(folder.join("pages/solution/feedback.html").is_file());
}

#[test]
fn a_pack_has_nothing_of_the_solution_and_its_commands_work() {
    let folder = class();
    let folder = folder.path();
    let run = call(folder, "new pack task -o pack");
    assert_eq!(run.code, 0, "{}", run.stderr);
    let names = [
        "frame-1.png",
        "frame-2.png",
        "README.md",
        "shader.glsl",
        "shader.test.toml",
    ];
    for name in names {
        let bytes = fs::read(folder.join("pack").join(name)).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        for secret in ["secret", "radiusOfTheDisk", "0.61)", "0.75", "length", "solution"] {
            assert!(!text.contains(secret), "{name}: {secret}");
        }
    }
    assert_eq!(fs::read_dir(folder.join("pack")).unwrap().count(), names.len());
    let readme = read(folder, "pack/README.md");
    let commands = commands(&readme);
    assert_eq!(
        commands,
        [
            "check shader.glsl --reference frame-1.png",
            "check shader.glsl --reference frame-2.png --time 2",
            "test shader.glsl",
        ]
    );
    // The starter compiles, and is wrong; the solution is right.
    let pack = folder.join("pack");
    for (text, code) in [(read(folder, "pack/shader.glsl"), 1), (SOLUTION.to_owned(), 0)] {
        fs::write(pack.join("shader.glsl"), text).unwrap();
        for command in &commands {
            let run = call(&pack, &on_cpu(command));
            assert_eq!(run.code, code, "{command}: {run:?}");
            assert!(!run.stdout.contains("invalid"), "{run:?}");
        }
    }

    let run = call(folder, "new pack task -o pack.zip");
    assert_eq!(run.code, 0, "{}", run.stderr);
    let packed = pages(folder, "pack.zip");
    assert_eq!(packed.keys().collect::<Vec<_>>().len(), names.len());
    assert_eq!(packed["README.md"], readme);
    let again = call(folder, "new pack task -o pack");
    assert!(
        again.code == 2 && again.stderr.contains("already exists"),
        "{}",
        again.stderr
    );
}

/// The commands in a pack's README, without the name of the program.
fn commands(readme: &str) -> Vec<&str> {
    let lines = readme.lines();
    lines.filter_map(|line| line.strip_prefix("toyproof ")).collect()
}

/// The same command on the CPU.
fn on_cpu(command: &str) -> String {
    if command.starts_with("check") {
        format!("{command} --device cpu")
    } else {
        command.to_owned()
    }
}

#[test]
fn the_images_of_a_pack_have_the_uniforms_of_their_frames() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let solution = "precision highp float;\nuniform vec2 u_resolution;\nuniform mat2 turn;\nuniform float speed;\n\
                    void main() {\n    vec2 p = turn * gl_FragCoord.xy / u_resolution;\n    \
                    gl_FragColor = vec4(fract(speed * p), 0.5, 1.0);\n}\n";
    write(&folder.join("task/solution.glsl"), solution, NOON);
    let assignment = "reference = \"solution.glsl\"\n[uniforms]\nspeed = 0.5\n\
                      [[frame]]\nsize = [16, 16]\nuniforms = { turn = [1, 0, 0, 1] }\n\
                      [[frame]]\nsize = [16, 16]\nuniforms = { turn = [0, 1, 1, 0], speed = 1.5 }\n";
    write(&folder.join("task/assignment.toml"), assignment, NOON);
    let run = call(folder, "new pack task -o pack");
    assert_eq!(run.code, 0, "{}", run.stderr);
    let starter = read(folder, "pack/shader.glsl");
    assert!(
        starter.contains("uniform mat2 turn;\nuniform float speed;\n"),
        "{starter}"
    );
    let readme = read(folder, "pack/README.md");
    assert!(
        readme.contains("| `speed` = 1.5, `turn` = (0, 1, 1, 0) |"),
        "{readme}"
    );
    fs::write(folder.join("pack/shader.glsl"), solution).unwrap();
    for command in commands(&readme) {
        let run = call(&folder.join("pack"), &on_cpu(command));
        assert_eq!(run.code, 0, "{command}: {run:?}");
    }
}

#[test]
fn the_pack_of_a_scene_has_the_functions_of_exported_shaders() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    assert_eq!(call(folder, "new assignment ball --from 02-sphere").code, 0);
    let path = folder.join("ball/assignment.toml");
    let text = fs::read_to_string(&path).unwrap();
    let test = "\n[rules]\nmust_define = [\"intersectSphere\"]\n";
    fs::write(&path, text + test).unwrap();
    let run = call(folder, "new pack ball -o pack");
    assert_eq!(run.code, 0, "{}", run.stderr);
    let starter = read(folder, "pack/shader.glsl");
    assert!(starter.contains("intersectSphere("), "{starter}");
    let run = call(&folder.join("pack"), "check shader.glsl --device cpu");
    assert_eq!(run.code, 0, "{}\n{starter}", run.stderr);
    assert!(!folder.join("pack/scene.toml").exists());
}
