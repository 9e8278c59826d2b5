//! Assignments: shaders that must be right in several frames, and everything else that one file asks of them.

use std::fs;
use std::path::Path;

use expect_test::{Expect, expect};
use serde_json::Value;

use crate::program::{Run, toyproof};

/// A disk that moves to the right, and follows the mouse upwards.
const DISK: &str = "void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 p = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    vec2 center = vec2(0.2 * iTime, 2.0 * iMouse.y / iResolution.y);
    vec3 color = vec3(0.5 + 0.25 * p, 0.25);
    if (length(p - center) < 0.61) {
        color = vec3(1.0, 0.75, 0.0);
    }
    fragColor = vec4(color, 1.0);
}
";

/// Three frames, of which only the second has another time, and only the third a mouse.
const FRAMES: &str = "[[frame]]\nsize = [64, 36]\n\
                      [[frame]]\nsize = [48, 36]\ntime = 2\n\
                      [[frame]]\nsize = [64, 36]\nmouse = [10.0, 9]\n";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn check(folder: &Path, arguments: &[&str]) -> Run {
    toyproof(folder, &[&["check", "--device", "cpu"], arguments].concat())
}

/// The records of all shaders.
fn records(run: &Run) -> Vec<Value> {
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    report["shaders"].as_array().unwrap().clone()
}

/// The folder of an assignment whose reference is the disk, with submissions in `hw`.
fn assigned(assignment: &str, submissions: &[(&str, &str)]) -> tempfile::TempDir {
    let assignment = format!("reference = \"solution.glsl\"\n{assignment}");
    let fixed = [
        ("task/assignment.toml", assignment.as_str()),
        ("task/solution.glsl", DISK),
    ];
    folder(&[&fixed, submissions].concat())
}

const TASK: [&str; 3] = ["hw", "--assignment", "task/assignment.toml"];

#[test]
fn a_shader_is_wrong_if_it_is_wrong_in_one_frame() {
    let other_style = DISK.replace("length(p - center) < 0.61", "distance(center, p) - 0.61 < 0.0");
    let no_time = DISK.replace("0.2 * iTime", "0.0");
    let no_mouse = DISK.replace("2.0 * iMouse.y", "0.0 * iMouse.y");
    let folder = assigned(
        FRAMES,
        &[
            ("hw/anna.glsl", &other_style),
            ("hw/mai.glsl", &no_time),
            ("hw/kim.glsl", &no_mouse),
        ],
    );
    let run = check(folder.path(), &[&TASK[..], &["--format", "json"]].concat());
    assert_eq!(run.code, 1, "{run:?}");
    let [anna, kim, mai] = &records(&run)[..] else {
        panic!("{run:?}");
    };
    let verdicts = |record: &Value| -> Vec<String> {
        let frames = record["frames"].as_array().unwrap().iter();
        frames
            .map(|frame| frame["verdict"].as_str().unwrap().to_owned())
            .collect()
    };
    assert_eq!(anna["verdict"], "correct");
    assert_eq!(anna["reason"], "all 3 frames agree with the reference");
    assert_eq!(verdicts(anna), ["correct"; 3]);

    assert_eq!(mai["verdict"], "wrong");
    let reason = mai["reason"].as_str().unwrap();
    assert!(reason.starts_with("at 48x36, time 2: "), "{reason}");
    assert_eq!(verdicts(mai), ["correct", "wrong", "correct"]);
    // The checks are those of the wrong frame.
    assert_eq!(mai["algorithm"], mai["frames"][1]["algorithm"]);
    assert_eq!(mai["algorithm"]["pixels"], 48 * 36);
    assert!(
        mai["details"].to_string().contains("right in 2 of 3 frames"),
        "{mai}"
    );

    assert_eq!(verdicts(kim), ["correct", "correct", "wrong"]);
    let reason = kim["reason"].as_str().unwrap();
    assert!(reason.starts_with("at 64x36, mouse (10, 9): "), "{reason}");
    // The search is the one of that frame.
    assert_eq!(kim["fix"]["edits"][0]["replacement"], "2.0", "{kim}");
}

#[test]
fn the_images_and_the_command_are_those_of_the_wrong_frame() {
    let no_time = DISK.replace("0.2 * iTime", "0.0");
    let folder = assigned(FRAMES, &[("hw/mai.glsl", &no_time)]);
    let run = check(
        folder.path(),
        &[&TASK[..], &["--search", "0", "--out", "out"]].concat(),
    );
    assert_eq!(run.code, 1, "{run:?}");
    assert!(
        run.stdout.contains(
            "help: toyproof debug hw/mai.glsl --pixel 13,15 --reference task/solution.glsl --size 48x36 --time 2"
        ),
        "{run:?}"
    );
    let image = toyproof::image::read(&folder.path().join("out/mai-actual.png")).unwrap();
    assert_eq!(image.size(), [48, 36]);
    let page = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("48x36, time 2 (shown here)"));
}

#[test]
fn an_assignment_in_the_folder_of_the_shaders_is_used() {
    let no_time = DISK.replace("0.2 * iTime", "0.0");
    let folder = assigned(
        FRAMES,
        &[
            ("task/mai.glsl", &no_time),
            // A student's own assignment counts for nothing.
            ("task/mai/assignment.toml", "reference = \"../mai.glsl\"\n"),
            ("other/mai.glsl", &no_time),
        ],
    );
    let flags = ["--search", "0", "-q"];
    let verdicts = |run: &Run| -> Vec<String> {
        let lines = run.stdout.lines();
        lines
            .map(|line| line.split("  ").next().unwrap().to_owned())
            .collect()
    };
    let run = check(folder.path(), &[&["task"][..], &flags].concat());
    assert_eq!(
        (run.code, verdicts(&run)),
        (1, vec!["wrong".to_owned(), "correct".to_owned()])
    );
    let run = check(folder.path(), &[&["task/mai.glsl"][..], &flags].concat());
    assert_eq!((run.code, verdicts(&run)), (1, vec!["wrong".to_owned()]));
    // Another reference replaces the assignment, and a flag of a frame its frames.
    let run = check(
        folder.path(),
        &[&["task/mai.glsl", "--size", "64x36"][..], &flags].concat(),
    );
    assert_eq!(
        (run.code, verdicts(&run)),
        (0, vec!["correct".to_owned()]),
        "{run:?}"
    );
    let other = [
        "task/mai.glsl",
        "--reference",
        "task/mai.glsl",
        "--time",
        "2",
        "--size",
        "64x36",
    ];
    let run = check(folder.path(), &[&other[..], &flags].concat());
    assert_eq!((run.code, verdicts(&run)), (0, vec!["correct".to_owned()]));

    let run = check(folder.path(), &[&["task", "other"][..], &flags].concat());
    assert_eq!(run.code, 2);
    assert!(
        run.stderr
            .contains("task/assignment.toml is not the assignment of other"),
        "{run:?}"
    );
    fs::write(
        folder.path().join("other/assignment.toml"),
        "reference = \"mai.glsl\"\n",
    )
    .unwrap();
    let run = check(folder.path(), &[&["task", "other"][..], &flags].concat());
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("there are several assignments"), "{run:?}");
}

#[test]
fn flags_that_an_assignment_sets_conflict_with_it() {
    let folder = assigned("", &[("hw/a.glsl", DISK)]);
    for flags in [["--reference", "a.glsl"], ["--scene", "a.toml"]] {
        let run = check(folder.path(), &[&TASK[..], &flags].concat());
        assert_eq!(run.code, 2);
        assert!(run.stderr.contains("cannot be used with"), "{run:?}");
    }
    let run = check(folder.path(), &["hw", "--assignment", "missing.toml"]);
    assert_eq!(run.code, 2);
    assert!(
        run.stderr.contains("there is no assignment missing.toml"),
        "{run:?}"
    );
    let run = check(
        folder.path(),
        &["hw", "--assignment", "task", "--size", "64x36", "-q"],
    );
    assert_eq!(run.code, 0, "its folder will do: {run:?}");
}

#[test]
fn a_scene_sets_the_size_of_frames_without_one() {
    let scene = "[film]\nsize = [32, 18]\n[background]\ncolor = [0.25, 0.5, 0.75]\n";
    let assignment = "scene = \"scene.toml\"\n[[frame]]\n[[frame]]\nsize = [20, 20]\n";
    let folder = folder(&[
        ("hw/assignment.toml", assignment),
        ("hw/scene.toml", scene),
        (
            "hw/a.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.25, 0.5, iResolution.x > 30.0 ? 0.75 : 0.5, 1.0); }",
        ),
    ]);
    let run = check(folder.path(), &["hw", "--format", "json"]);
    let record = &records(&run)[0];
    assert_eq!(record["scene"], "hw/scene.toml");
    let reason = record["reason"].as_str().unwrap();
    assert!(reason.starts_with("at 20x20: "), "{reason}");
    assert_eq!(record["frames"][0]["size"], serde_json::json!([32, 18]));
}

#[test]
fn a_frame_without_an_image_ends_the_check() {
    let endless = "void mainImage(out vec4 c, in vec2 p) { float x = p.x; while (x > -iTime) x = abs(sin(x)) + 0.1; c = vec4(x); }";
    let invalid = "void mainImage(out vec4 c, in vec2 p) { c = vec4(q); }";
    let folder = assigned(FRAMES, &[("hw/a.glsl", endless), ("hw/b.glsl", invalid)]);
    let run = check(
        folder.path(),
        &[&TASK[..], &["--timeout", "300ms", "--format", "json"]].concat(),
    );
    let [endless, invalid] = &records(&run)[..] else {
        panic!("{run:?}");
    };
    assert_eq!(endless["verdict"], "timeout");
    assert_eq!(endless["frames"].as_array().unwrap().len(), 1);
    assert!(
        endless["details"]
            .to_string()
            .contains("2 further frames were not checked"),
        "{endless}"
    );
    assert_eq!(invalid["verdict"], "invalid");
    assert_eq!(invalid["diagnostics"].as_array().unwrap().len(), 1);
    assert!(
        !invalid["reason"].as_str().unwrap().contains("64x36"),
        "{invalid}"
    );
}

#[test]
fn the_rubric_of_an_assignment_gives_the_points_of_the_worst_frame() {
    let rubric = "[rubric]\nvisibility = \"hidden\"\n[rubric.algorithm]\npoints = 4\npartial_from = 0.0\n";
    let slower = DISK.replace("0.2 * iTime", "0.19 * iTime");
    let folder = assigned(
        &format!("{FRAMES}[[frame]]\nsize = [64, 36]\ntime = 9\n{rubric}"),
        &[("hw/anna.glsl", DISK), ("hw/mai.glsl", &slower)],
    );
    let flags = ["--search", "0", "--out", "out", "-q"];
    let run = check(folder.path(), &[&TASK[..], &flags].concat());
    assert_eq!(run.code, 1, "{run:?}");
    let results = fs::read_to_string(folder.path().join("out/results.json")).unwrap();
    let results: Value = serde_json::from_str(&results).unwrap();
    assert_eq!(results["visibility"], "hidden");
    let [anna, mai] = &results["tests"].as_array().unwrap()[..] else {
        panic!("{results}");
    };
    assert_eq!(anna["score"], 4.0);
    let score = mai["score"].as_f64().unwrap();
    assert!(score > 3.0 && score < 4.0, "{mai}");
    assert!(
        mai["output"].as_str().unwrap().starts_with("at 64x36, time 9: "),
        "{mai}"
    );
    // A rubric of one's own replaces it.
    fs::write(folder.path().join("own.toml"), "[compiles]\npoints = 1\n").unwrap();
    check(
        folder.path(),
        &[&TASK[..], &flags, &["--rubric", "own.toml"]].concat(),
    );
    let results = fs::read_to_string(folder.path().join("out/results.json")).unwrap();
    assert!(
        results.contains("compiles") && !results.contains("algorithm"),
        "{results}"
    );
}

#[test]
fn a_changed_assignment_invalidates_results() {
    let folder = assigned(FRAMES, &[("hw/anna.glsl", DISK)]);
    let resumed = [&TASK[..], &["--out", "out", "--resume"]].concat();
    assert_eq!(check(folder.path(), &resumed).code, 0);
    let again = check(folder.path(), &resumed);
    assert!(again.stderr.contains("1 of 1 result is reused"), "{again:?}");
    let changed = format!("reference = \"solution.glsl\"\ntolerance = 1\n{FRAMES}");
    fs::write(folder.path().join("task/assignment.toml"), changed).unwrap();
    let changed = check(folder.path(), &resumed);
    assert!(
        changed.code == 0 && !changed.stderr.contains("reused"),
        "{changed:?}"
    );
}

/// What is printed for an assignment that cannot be used.
fn errors(assignment: &str, expected: &Expect) {
    let folder = folder(&[
        ("assignment.toml", assignment),
        ("scene.toml", "[background]\n"),
        ("solution.glsl", DISK),
        ("a.glsl", DISK),
    ]);
    let run = check(folder.path(), &["a.glsl", "-q"]);
    assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{run:?}");
    expected.assert_eq(&run.stderr);
}

#[test]
fn errors_in_an_assignment_have_their_place() {
    errors(
        "",
        &expect![[r#"
        assignment.toml:1:1: error[E0506]: the assignment has neither a scene nor a reference
    "#]],
    );
    errors(
        "scene = 4",
        &expect![[r#"
        assignment.toml:1:9: error[E0505]: `scene` must be a string, found 4
    "#]],
    );
    errors(
        "scene = \"scene.toml\"\nreference = \"solution.glsl\"",
        &expect![[r#"
        assignment.toml:2:13: error[E0506]: `reference` cannot be used with `scene`
    "#]],
    );
    errors(
        "scene = \"solution.glsl\"",
        &expect![[r#"
        assignment.toml:1:9: error[E0506]: `scene` must be a .toml file, found "solution.glsl"
    "#]],
    );
    errors(
        "reference = \"soluton.glsl\"",
        &expect![[r#"
        assignment.toml:1:13: error[E0506]: there is no file "soluton.glsl"
    "#]],
    );
    errors(
        "scene = \"scene.toml\"\ntolerance = 1",
        &expect![[r#"
        assignment.toml:2:13: error[E0506]: `tolerance` cannot be used with `scene`
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\ntolerance = 256",
        &expect![[r#"
        assignment.toml:2:13: error[E0506]: `tolerance` must be a number of 8-bit levels from 0 to 255, found 256
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frames]]\n",
        &expect![[r#"
        assignment.toml:2:3: error[E0505]: unknown table [[frames]]
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[frame]\n",
        &expect![[r#"
        assignment.toml:2:1: error[E0505]: [frame] must be written [[frame]]
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frame]]\nsize = [0, 4]\ntime = inf\nframe = -1\nmouse = [1, 2, 3]\n\
         date = [2026, 12, 1, 0]\nchannel0 = \"wood.png\"\nchannel4 = \"noise\"\n",
        &expect![[r#"
            assignment.toml:3:8: error[E0506]: `size` must be at least 1 pixel in each direction, found [0, 4]
            assignment.toml:4:8: error[E0506]: `time` must be a finite number of seconds, found inf
            assignment.toml:5:9: error[E0506]: `frame` must be from 0 to 2,147,483,647, found -1
            assignment.toml:6:9: error[E0506]: `mouse` must be two or four numbers: [x, y] or [x, y, z, w], found [1, 2, 3]
            assignment.toml:7:8: error[E0506]: `date` must be four numbers: year, month from 0 (January) to 11, day, seconds since midnight, found [2026, 12, 1, 0]
            assignment.toml:8:12: error[E0506]: there is no file "wood.png"
            assignment.toml:9:1: error[E0505]: unknown key `channel4` in [[frame]]
        "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frame]]\n[[frame]]\ntime = 0.0\n",
        &expect![[r#"
        assignment.toml:3:1: error[E0506]: this frame is listed twice
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frame]]\nmouse = 3\n",
        &expect![[r#"
        assignment.toml:3:9: error[E0505]: `mouse` must be a list of numbers, found 3
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[rubric.algorithm]\npoint = 4\n",
        &expect![[r#"
        assignment.toml:3:1: error[E0505]: unknown key `point` in [algorithm]
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[rubric]\n",
        &expect![[r#"
        assignment.toml:1:1: error[E0506]: the rubric gives no points
    "#]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frame]\n",
        &expect![[r#"
        assignment.toml:2:9: error[E0505]: missing `]]` at the end of a table header
    "#]],
    );
    let frames: String = (0..65)
        .map(|time| format!("[[frame]]\ntime = {time}\n"))
        .collect();
    errors(
        &format!("reference = \"solution.glsl\"\n{frames}"),
        &expect![[r#"
        assignment.toml:130:1: error[E0506]: an assignment has at most 64 frames
    "#]],
    );
}
