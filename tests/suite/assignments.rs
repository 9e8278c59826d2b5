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
fn permitted_differences_are_correct_in_all_frames() {
    let mirrored = DISK.replace(
        "/ iResolution.y;\n    vec2 center",
        "/ iResolution.y;\n    p.x = -p.x;\n    vec2 center",
    );
    assert_ne!(mirrored, DISK);
    let check_with = |permitted: &str| {
        let folder = assigned(&format!("{permitted}{FRAMES}"), &[("hw/mai.glsl", &mirrored)]);
        let run = check(folder.path(), &[&TASK[..], &["--format", "json"]].concat());
        let [mai] = &records(&run)[..] else {
            panic!("{run:?}");
        };
        (run.code, mai.clone())
    };
    let (code, mai) = check_with("");
    assert_eq!((code, &mai["mistake"]["id"]), (1, &"mirrored-x".into()), "{mai}");
    let (code, mai) = check_with("permitted = [\"antialiasing\", \"mirrored-x\"]\n");
    assert_eq!((code, &mai["verdict"]), (0, &"correct".into()), "{mai}");
    assert!(
        mai["details"]
            .to_string()
            .contains("`mirrored-x`, which is permitted"),
        "{mai}"
    );
    errors(
        "reference = \"solution.glsl\"\npermitted = [\"mirored-x\"]\n",
        &expect![[r"
            assignment.toml:2:13: error[E0506]: `permitted` has the unknown id `mirored-x`
        "]],
    );
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
            "help: toyproof debug hw/mai.glsl --pixel 25,8 --reference task/solution.glsl --size 48x36 --time 2"
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
    // Another reference replaces the assignment, a flag of a frame its frames, and a size theirs.
    let resized = ["task/mai.glsl", "--size", "32x18"];
    let run = check(folder.path(), &[&resized[..], &flags].concat());
    assert_eq!((run.code, verdicts(&run)), (1, vec!["wrong".to_owned()]));
    assert!(run.stdout.contains("at 32x18, time 2"), "{run:?}");
    let moment = ["task/mai.glsl", "--size", "64x36", "--time", "0"];
    let run = check(folder.path(), &[&moment[..], &flags].concat());
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
        &expect![[r"
        assignment.toml:1:1: error[E0506]: the assignment has neither a scene nor a reference
    "]],
    );
    errors(
        "scene = 4",
        &expect![[r"
        assignment.toml:1:9: error[E0505]: `scene` must be a string, found 4
    "]],
    );
    errors(
        "scene = \"scene.toml\"\nreference = \"solution.glsl\"",
        &expect![[r"
        assignment.toml:2:13: error[E0506]: `reference` cannot be used with `scene`
    "]],
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
        &expect![[r"
        assignment.toml:2:13: error[E0506]: `tolerance` cannot be used with `scene`
    "]],
    );
    errors(
        "reference = \"solution.glsl\"\ntolerance = 256",
        &expect![[r"
        assignment.toml:2:13: error[E0506]: `tolerance` must be a number of 8-bit levels from 0 to 255, found 256
    "]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frames]]\n",
        &expect![[r"
        assignment.toml:2:3: error[E0505]: unknown table [[frames]]
    "]],
    );
    errors(
        "reference = \"solution.glsl\"\n[frame]\n",
        &expect![[r"
        assignment.toml:2:1: error[E0505]: [frame] must be written [[frame]]
    "]],
    );
}

#[test]
fn errors_in_frames_and_points_have_their_place() {
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
        &expect![[r"
        assignment.toml:3:1: error[E0506]: this frame is listed twice
    "]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frame]]\nmouse = 3\n",
        &expect![[r"
        assignment.toml:3:9: error[E0505]: `mouse` must be a list of numbers, found 3
    "]],
    );
    errors(
        "reference = \"solution.glsl\"\n[rubric.algorithm]\npoint = 4\n",
        &expect![[r"
        assignment.toml:3:1: error[E0505]: unknown key `point` in [algorithm]
    "]],
    );
    errors(
        "reference = \"solution.glsl\"\n[rubric]\n",
        &expect![[r"
        assignment.toml:1:1: error[E0506]: the rubric gives no points
    "]],
    );
    errors(
        "reference = \"solution.glsl\"\n[[frame]\n",
        &expect![[r"
        assignment.toml:2:9: error[E0505]: missing `]]` at the end of a table header
    "]],
    );
    let frames = (0..65).map(|time| format!("[[frame]]\ntime = {time}\n"));
    let frames = frames.collect::<Vec<_>>().concat();
    errors(
        &format!("reference = \"solution.glsl\"\n{frames}"),
        &expect![[r"
        assignment.toml:130:1: error[E0506]: an assignment has at most 64 frames
    "]],
    );
}

/// A shader with the functions of a ray tracer, the body of one of which is to be inserted.
fn with_intersection(function: &str) -> String {
    format!(
        "struct Ray {{ vec3 origin; vec3 direction; }};
struct Sphere {{ vec3 center; float radius; }};
{function}
void mainImage(out vec4 fragColor, in vec2 fragCoord) {{
    fragColor = vec4(fragCoord / iResolution.xy, 0.5, 1.0);
}}
"
    )
}

/// The roots of t² + 2 b t + c = 0.
const ROOTS: &str = "    vec3 f = o - center;
    float b = dot(f, d);
    float disc = b * b - dot(f, f) + r * r;
    if (disc < 0.0) return -1.0;
    float near = -b - sqrt(disc);
    return near > 0.0 ? near : -b + sqrt(disc);
}";

/// A folder with an assignment whose image is a gradient, and one submission.
fn intersecting(assignment: &str, function: &str) -> tempfile::TempDir {
    let assignment = format!("reference = \"solution.glsl\"\n[[frame]]\nsize = [16, 9]\n{assignment}");
    folder(&[
        ("task/assignment.toml", &assignment),
        ("task/solution.glsl", &with_intersection("")),
        ("hw/a.glsl", &with_intersection(function)),
    ])
}

/// The exit code, and the record of the only submission.
fn checked(folder: &tempfile::TempDir) -> (i32, Value) {
    let run = check(folder.path(), &[&TASK[..], &["--format", "json"]].concat());
    (run.code, records(&run).remove(0))
}

const CASES: &str = "[[function]]\nname = \"intersectSphere\"\npoints = 2\n\
    [[function.case]]\narguments = [[0.0, 0.0, 0.0], [0, 0, -1], [0, 0, -6], 1.5]\nresult = 4.5\n\
    [[function.case]]\narguments = [[0, 0, 0], [0.0, 1.0, 0.0], [0, 0, -6], 1.5]\nresult = -1\n";

#[test]
fn a_function_is_tested_in_listed_cases() {
    let right = format!("float intersectSphere(vec3 o, vec3 d, vec3 center, float r) {{\n{ROOTS}");
    let (code, record) = checked(&intersecting(CASES, &right));
    let function = &record["functions"][0];
    assert_eq!(
        (code, &function["passed"], &function["right"]),
        (0, &true.into(), &2.into())
    );
    assert_eq!(function["at"]["line"], 3);

    let wrong = right.replace("-b - sqrt", "-b + sqrt");
    let (code, record) = checked(&intersecting(CASES, &wrong));
    assert_eq!((code, &record["verdict"]), (1, &"correct".into()), "{record}");
    let function = &record["functions"][0];
    assert_eq!(
        (&function["passed"], &function["right"]),
        (&false.into(), &1.into())
    );
    assert_eq!(
        function["message"],
        "in case 1, intersectSphere([0.0, 0.0, 0.0], [0, 0, -1], [0, 0, -6], 1.5) is 7.5, expected 4.5"
    );

    let (code, record) = checked(&intersecting(CASES, ""));
    let expected =
        "there is no function `intersectSphere`; expected `float intersectSphere(vec3, vec3, vec3, float)`";
    assert_eq!((code, &record["functions"][0]["message"]), (1, &expected.into()));

    let other = "float intersectSphere(Ray ray, out float t) { t = 1.0; return 2.0; }";
    let (code, record) = checked(&intersecting(CASES, other));
    let expected = "`intersectSphere` has another signature: expected `float intersectSphere(vec3, vec3, vec3, float)`, \
                    found `float intersectSphere(Ray, out float)`";
    assert_eq!((code, &record["functions"][0]["message"]), (1, &expected.into()));
}

#[test]
fn arguments_and_results_have_any_type() {
    let cases = "[[function]]\nname = \"hit\"\n\
        [[function.case]]\narguments = [[[0, 0, 0], [0, 0, -1]], [[0, 0, -6], 1.5], 3, true, [[1, 2], [3, 4]]]\n\
        result = true\noutputs = [[0.0, 0.0, -4.5], [[2, 4], [6, 8]]]\n";
    let function =
        "bool hit(Ray ray, const in Sphere sphere, int count, bool flag, out vec3 point, inout mat2 m) {
    point = ray.origin + (abs(sphere.center.z) - sphere.radius) * ray.direction;
    m *= 2.0;
    return flag && count == 3;
}";
    let folder = intersecting(cases, function);
    let (code, record) = checked(&folder);
    // The order of the parameters counts: `m` follows `point`, which is not an argument.
    assert_eq!(
        (code, &record["functions"][0]["passed"]),
        (0, &true.into()),
        "{record}"
    );
    let (code, record) = checked(&intersecting(cases, &function.replace("m *= 2.0", "m *= 2.001")));
    assert_eq!(code, 1);
    assert_eq!(
        record["functions"][0]["message"],
        "in case 1, hit([[0, 0, 0], [0, 0, -1]], [[0, 0, -6], 1.5], 3, true, [[1, 2], [3, 4]]) is \
         (1.0, 0.0, 0.0, -4.5, 2.001, 4.002, 6.003, 8.004), expected (1.0, 0.0, 0.0, -4.5, 2.0, 4.0, 6.0, 8.0)"
    );
    // Functions are evaluated in double precision, and NaN is a result like others.
    let cases = "[[function]]\nname = \"f\"\n[[function.case]]\narguments = [0.1]\nresult = 0.1\ntolerance = 1e-15\n\
                 [[function.case]]\narguments = [1e30]\nresult = nan\n";
    let function = "float f(float x) { return x > 1.0 ? sqrt(-x) : x; }";
    let (code, record) = checked(&intersecting(cases, function));
    assert_eq!(code, 0, "{record}");
}

#[test]
fn a_function_of_any_signature_is_tested_with_the_cases_of_stress() {
    let cases = "[[function]]\nname = \"intersectSphere\"\ncases = \"stress\"\npoints = 3\n";
    let right = format!(
        "float intersectSphere(Ray ray, Sphere sphere) {{\n    vec3 o = ray.origin, d = ray.direction, center = sphere.center;\n    float r = sphere.radius;\n{ROOTS}"
    );
    let (code, record) = checked(&intersecting(cases, &right));
    let function = &record["functions"][0];
    assert_eq!(
        (code, &function["passed"], &function["cases"]),
        (0, &true.into(), &240.into()),
        "{record}"
    );
    let (code, record) = checked(&intersecting(cases, &right.replace("r * r", "r")));
    let function = &record["functions"][0];
    assert_eq!(
        (code, &function["message"]),
        (1, &"it does not square the radius".into())
    );
    let (code, record) = checked(&intersecting(
        cases,
        "float intersectSphere(float x) { return x; }",
    ));
    assert_eq!(
        (code, &record["functions"][0]["cases"]),
        (1, &0.into()),
        "{record}"
    );
}

#[test]
fn a_function_that_does_not_end_is_not_right() {
    let cases = "[[function]]\nname = \"f\"\n[[function.case]]\narguments = [1.0]\nresult = 1.0\n";
    let endless = "float f(float x) { while (x > -1.0) x = abs(sin(x)) + 0.1; return x; }";
    let folder = intersecting(cases, endless);
    let run = check(
        folder.path(),
        &[&TASK[..], &["--timeout", "300ms", "--format", "json"]].concat(),
    );
    let record = records(&run).remove(0);
    assert_eq!((run.code, &record["verdict"]), (1, &"correct".into()));
    let message = record["functions"][0]["message"].as_str().unwrap();
    assert!(message.starts_with("the test cannot be run: "), "{message}");
}

#[test]
fn violated_rules_are_listed_with_their_lines() {
    let rules = "[rules]\nmust_define = [\"intersectSphere\"]\nmust_not_call = [\"pow\", \"helper\"]\n\
                 textures = false\nmax_lines = 9\npoints = 1\n";
    let kept =
        "float intersectSphere() { return 1.0; } // pow(1.0, 2.0)\n\n/* texture(iChannel0, vec2(0)) */";
    let (code, record) = checked(&intersecting(rules, kept));
    assert_eq!(
        (code, &record["rules"]["violations"]),
        (0, &serde_json::json!([]))
    );

    let broken = "float helper() {\n    return pow(2.0, 3.0) + texture(iChannel0, vec2(0.0)).x;\n}\nfloat g() { return helper(); }";
    let folder = intersecting(&format!("{rules}{CASES}"), broken);
    let flags = ["--out", "out", "--search", "0"];
    let run = check(folder.path(), &[&TASK[..], &flags].concat());
    assert_eq!(run.code, 1);
    expect![[r"
        correct      hw/a.glsl  all 144 pixels agree with the reference
                     rule: the function `intersectSphere` must be defined
                     rule: line 4: `pow` must not be called
                     rule: line 6: `helper` must not be called
                     rule: line 4: textures must not be read
                     function: there is no function `intersectSphere`; expected `float intersectSphere(vec3, vec3, vec3, float)`
    "]].assert_eq(&run.stdout);
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let page = read("report.html");
    assert!(
        page.contains("<li>rule: line 4: <code>pow</code> must not be called</li>"),
        "{page}"
    );
    assert!(
        read("junit.xml").contains("<failure message=\"the function `intersectSphere` must be defined\"")
    );
    let results: Value = serde_json::from_str(&read("results.json")).unwrap();
    let marks: Vec<_> = results["tests"]
        .as_array()
        .unwrap()
        .iter()
        .map(|test| {
            let [score, of] = ["score", "max_score"].map(|key| test[key].as_f64().unwrap());
            (test["name"].as_str().unwrap(), score, of)
        })
        .collect();
    assert_eq!(marks, [("rules", 0.0, 1.0), ("intersectSphere", 0.0, 2.0)]);
}

#[test]
fn a_shader_that_does_not_compile_earns_no_points() {
    let folder = intersecting(
        &format!("[rules]\ntextures = false\npoints = 1\n{CASES}"),
        "float f(",
    );
    let (code, record) = checked(&folder);
    assert_eq!((code, &record["verdict"]), (1, &"invalid".into()));
    assert_eq!(record["rules"]["violations"], Value::Null);
    let run = check(folder.path(), &[&TASK[..], &["--out", "out"]].concat());
    assert!(
        !run.stdout.contains("function:") && !run.stdout.contains("rule:"),
        "{run:?}"
    );
    let results = fs::read_to_string(folder.path().join("out/results.json")).unwrap();
    let results: Value = serde_json::from_str(&results).unwrap();
    let tests = results["tests"].as_array().unwrap();
    let outputs: Vec<_> = tests
        .iter()
        .map(|test| (&test["score"], test["output"].as_str().unwrap()))
        .collect();
    assert_eq!(outputs, [(&0.0.into(), "the shader does not compile"); 2]);
}

#[test]
fn errors_in_rules_and_functions_have_their_place() {
    let errors =
        |text: &str, expected: &Expect| errors(&format!("reference = \"solution.glsl\"\n{text}"), expected);
    errors(
        "[rules]\nmust_define = \"f\"\nmust_not_call = [\"a b\"]\ntextures = 0\nmax_lines = 0\npoints = -1\n",
        &expect![[r"
            assignment.toml:3:15: error[E0505]: `must_define` must be a list of strings, found a string
            assignment.toml:4:17: error[E0506]: `must_not_call` must list names of functions; `a b` is not a name
            assignment.toml:5:12: error[E0505]: `textures` must be `true` or `false`, found 0
            assignment.toml:6:13: error[E0506]: `max_lines` must be from 1 to 1,000,000, found 0
            assignment.toml:7:10: error[E0506]: `points` must be from 0 to 1,000,000, found -1
        "]],
    );
    errors(
        "[rules]\nmax_line = 4\n",
        &expect![[r"
        assignment.toml:3:1: error[E0505]: unknown key `max_line` in [rules]
    "]],
    );
    errors(
        "[[function]]\n",
        &expect![[r"
        assignment.toml:2:1: error[E0505]: missing key `name` in [[function]]
    "]],
    );
    errors(
        "[[function]]\nname = \"f()\"\ncases = \"many\"\n",
        &expect![[r#"
        assignment.toml:3:8: error[E0506]: `name` must be the name of a function, found "f()"
        assignment.toml:4:9: error[E0505]: unknown source of cases `many`
    "#]],
    );
    errors(
        "[[function]]\nname = \"f\"\n",
        &expect![[r"
        assignment.toml:2:1: error[E0506]: the function has no cases
    "]],
    );
    errors(
        "[[function]]\nname = \"f\"\n[[function.case]]\n",
        &expect![[r"
        assignment.toml:4:1: error[E0505]: missing key `arguments` in [[case]]
    "]],
    );
    errors(
        "[[function]]\nname = \"f\"\n[[function.case]]\narguments = [1.0]\n",
        &expect![[r"
            assignment.toml:4:1: error[E0506]: the case has neither a `result` nor `outputs`
        "]],
    );
    errors(
        "[[function]]\nname = \"f\"\n[[function.case]]\narguments = [\"1.0\"]\nresult = \"yes\"\n",
        &expect![[r"
            assignment.toml:5:14: error[E0505]: `arguments` must be a list of values, found a string
            assignment.toml:6:10: error[E0505]: `result` must be a number, `true`, `false` or a list of these, found a string
        "]],
    );
    errors(
        "[[function]]\nname = \"f\"\n[[function.case]]\narguments = [1e39]\nresult = 1\ntolerance = -1\n",
        &expect![[r"
            assignment.toml:5:13: error[E0506]: `arguments` must have finite numbers that float32 can hold, found [1e39]
            assignment.toml:7:13: error[E0506]: `tolerance` must be finite and at least 0, found -1
        "]],
    );
    errors(
        "[[function]]\nname = \"f\"\ncases = \"stress\"\n[[function.case]]\narguments = []\nresult = 1\n",
        &expect![[r"
            assignment.toml:4:9: error[E0506]: `cases` cannot be used with [[function.case]]
        "]],
    );
    errors(
        &format!("{CASES}{CASES}"),
        &expect![[r"
        assignment.toml:11:1: error[E0506]: there are two tests of `intersectSphere`
    "]],
    );
}

#[test]
fn a_new_assignment_accepts_its_model_solution() {
    let folder = folder(&[("model.glsl", DISK)]);
    let new = ["new", "assignment", "disks", "--from", "model.glsl"];
    let run = toyproof(folder.path(), &new);
    assert_eq!(run.code, 0, "{run:?}");
    let read = |name: &str| fs::read_to_string(folder.path().join("disks").join(name)).unwrap();
    assert_eq!(read("solution.glsl"), DISK);
    let text = read("assignment.toml");
    let frames = text.lines().filter(|line| *line == "[[frame]]").count();
    assert_eq!(frames, 3, "one for the time, one for the mouse: {text}");
    for index in 1..=frames {
        let path = folder.path().join(format!("disks/frame-{index}.png"));
        assert_eq!(toyproof::image::read(&path).unwrap().size(), [320, 180]);
    }
    let check = check(folder.path(), &["disks", "--format", "json"]);
    let record = &records(&check)[0];
    assert_eq!(
        (check.code, &record["verdict"]),
        (0, &"correct".into()),
        "{record}"
    );
    assert_eq!(record["frames"].as_array().unwrap().len(), 3);

    let again = toyproof(folder.path(), &new);
    assert_eq!(again.code, 2);
    assert!(again.stderr.contains("disks already exists"), "{again:?}");
}

#[test]
fn the_keys_in_the_comments_of_a_new_assignment_are_valid() {
    let folder = folder(&[(
        "model.glsl",
        &with_intersection(&format!(
            "float intersectSphere(vec3 o, vec3 d, vec3 center, float r) {{\n{ROOTS}"
        )),
    )]);
    let new = ["new", "assignment", "spheres", "--from", "model.glsl"];
    assert_eq!(toyproof(folder.path(), &new).code, 0);
    let path = folder.path().join("spheres/assignment.toml");
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("# must_define = [\"intersectSphere\"]"), "{text}");
    // What is meant to be used without the comment has an `=`, or is a header.
    let lines = text.lines().map(|line| match line.strip_prefix("# ") {
        Some(key) if key.starts_with('[') || (!key.starts_with(' ') && key.contains(" = ")) => key,
        _ => line,
    });
    fs::write(&path, lines.collect::<Vec<_>>().join("\n")).unwrap();
    let run = check(folder.path(), &["spheres", "--format", "json"]);
    let record = &records(&run)[0];
    assert_eq!(run.code, 0, "{record}");
    assert_eq!(record["functions"][0]["passed"], true);
}

#[test]
fn a_new_assignment_from_a_scene_has_its_solution() {
    let folder = tempfile::tempdir().unwrap();
    let run = toyproof(
        folder.path(),
        &[
            "new",
            "assignment",
            "week 2",
            "--from",
            "02-sphere",
            "-o",
            "a/week2",
        ],
    );
    assert_eq!(run.code, 0, "{run:?}");
    for file in ["scene.toml", "solution.glsl", "frame-1.png", "assignment.toml"] {
        assert!(folder.path().join("a/week2").join(file).is_file(), "{file}");
    }
    let run = check(folder.path(), &["a/week2", "--size", "64x36", "-q"]);
    assert_eq!(run.code, 0, "{run:?}");
    assert!(run.stdout.starts_with("correct"), "{run:?}");
}

#[test]
fn a_model_that_cannot_be_used_leaves_no_file() {
    let undefined =
        "void mainImage(out vec4 c, in vec2 p) { float a[2]; a[0] = 0.25; c = vec4(a[int(p.x)]); }";
    let folder = folder(&[
        ("broken.glsl", "void mainImage("),
        ("undefined.glsl", undefined),
        ("s.toml", "[film]\nsize = 3\n"),
    ]);
    for (from, message) in [
        ("broken.glsl", "broken.glsl:1:"),
        ("undefined.glsl", "has no defined color in"),
        ("missing.glsl", "no such file"),
        ("s.toml", "s.toml:2:"),
        ("nothing", "no such file or built-in scene"),
    ] {
        let run = toyproof(folder.path(), &["new", "assignment", "new", "--from", from]);
        assert_eq!(run.code, 2, "{from}: {run:?}");
        assert!(run.stderr.contains(message), "{from}: {run:?}");
        assert!(!folder.path().join("new").exists(), "{from}");
    }
}
