//! Authors' functions at extreme inputs: planted mistakes are named, correct functions are not blamed, and
//! the GPU agrees with the CPU.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use serde_json::Value;
use toyproof::glsl::{Checked, Options};
use toyproof::image::Frame;
use toyproof::stress::function::{self, Findings, Role, RoleMap, Signature};
use toyproof::stress::{self, Settings, formula};
use toyproof::translate::FloatMode;

use crate::program::{command, toyproof};
use crate::requirements::{require_driver, require_worker};
use crate::support::wait::wait_until;
use crate::support::{EVERY_EXERCISE, Edit, QUADRICS, SPHERE, checked, edited};

const FEW_CASES: Settings = Settings { seed: 1, cases: 60 };

fn examine(text: &str, name: &str, map: &RoleMap) -> Findings {
    let signature = Signature::recognize(&checked(text), name, map).unwrap_or_else(|why| panic!("{why}"));
    let (options, never) = (Options::default(), AtomicBool::new(false));
    function::examine(text, &signature, &options, None, FEW_CASES, &never, || ()).unwrap()
}

fn mistake(text: &str, name: &str) -> Option<&'static str> {
    examine(text, name, &RoleMap::new())
        .mistake
        .map(|mistake| mistake.name)
}

/// A complete quadratic equation, for directions of any length, as on the slide except for the division that
/// the slide omits.
const TEXTBOOK: &str = "bool hitSphere(vec3 ro, vec3 rd, vec3 center, float radius, out float t) {
    vec3 oc = ro - center;
    float a = dot(rd, rd);
    float b = 2.0 * dot(oc, rd);
    float c = dot(oc, oc) - radius * radius;
    float disc = b * b - 4.0 * a * c;
    if (disc < 0.0) return false;
    t = (-b - sqrt(disc)) / (2.0 * a);
    if (t > 0.0) return true;
    t = (-b + sqrt(disc)) / (2.0 * a);
    return t > 0.0;
}
void mainImage(out vec4 color, in vec2 place) { color = vec4(0.0); }
";

#[test]
fn planted_mistakes_are_named() {
    let near = "float t = -b - root;";
    let of_exercise: [(&str, &[Edit]); 9] = [
        ("unit-direction-only", &[]),
        (
            "roots-not-halved",
            &[
                (near, "float t = 2.0 * (-b - root);"),
                ("t = -b + root;", "t = 2.0 * (-b + root);"),
            ],
        ),
        ("larger-root", &[(near, "float t = -b + root;")]),
        (
            "behind-origin",
            &[(
                "if (t > 0.00001) {\n            return t;\n        }\n        t = -b + root;\n        if (t > 0.00001) {\n            return t;\n        }",
                "return t;",
            )],
        ),
        (
            "not-from-inside",
            &[(
                "        t = -b + root;\n        if (t > 0.00001) {\n            return t;\n        }\n",
                "",
            )],
        ),
        (
            "radius-not-squared",
            &[("sphere.radius * sphere.radius", "sphere.radius")],
        ),
        (
            "sign-of-b",
            &[(
                "float b = dot(f, ray.direction);",
                "float b = -dot(f, ray.direction);",
            )],
        ),
        (
            "radius-added",
            &[("dot(f, f) - sphere.radius", "dot(f, f) + sphere.radius")],
        ),
        (
            "center-ignored",
            &[("vec3 f = ray.origin - sphere.center;", "vec3 f = ray.origin;")],
        ),
    ];
    let of_textbook: [(&str, &str, &str); 7] = [
        ("roots-not-halved", "/ (2.0 * a)", ""),
        ("not-divided-by-a", "/ (2.0 * a)", "/ 2.0"),
        ("discriminant-without-4", "4.0 * a * c", "a * c"),
        ("no-square-root", "sqrt(disc)", "disc"),
        ("discriminant-plus", "b * b - 4.0", "b * b + 4.0"),
        ("half-b-with-4", "float b = 2.0 *", "float b ="),
        ("unit-direction-only", "float a = dot(rd, rd);", "float a = 1.0;"),
    ];
    let mut right = 0;
    let mut reported = Vec::new();
    let mut judge = |expected: &str, found: Option<&str>| {
        right += u32::from(found == Some(expected));
        reported.push(format!("{expected}: {found:?}"));
    };
    for (expected, edits) in of_exercise {
        judge(expected, mistake(&edited(&SPHERE, edits), "intersectSphere"));
    }
    for (expected, from, to) in of_textbook {
        judge(expected, mistake(&TEXTBOOK.replace(from, to), "hitSphere"));
    }
    assert!(right >= 15, "{right} of 16 are named: {reported:#?}");
}

/// The convention of a nearest hit: a function replaces `t` by a smaller one.
const NEAREST: &str = "bool hit(vec3 p, vec3 v, vec4 ball, inout float t) {
    vec3 f = p - ball.xyz;
    float b = dot(f, v), c = dot(f, f) - ball.w * ball.w;
    float root = b * b - c * dot(v, v);
    if (root < 0.0) { return false; }
    root = sqrt(root);
    float near = (-b - root) / dot(v, v);
    if (near < 0.0001) { near = (-b + root) / dot(v, v); }
    if (near < 0.0001 || near > t) { return false; }
    t = near;
    return true;
}
void mainImage(out vec4 c, in vec2 p) { float t = 1e9; c = vec4(hit(vec3(p, 0), vec3(0, 0, 1), vec4(1), t)); }";

#[test]
fn a_function_that_replaces_t_starts_with_the_largest() {
    let only_t: RoleMap = [("t".to_owned(), Role::TMax)].into();
    for map in [RoleMap::new(), only_t] {
        let findings = examine(NEAREST, "hit", &map);
        assert_eq!(findings.mistake, None);
        let example = findings.example.unwrap();
        assert!(
            example.assignments.contains(&"t = 3.0e38;".to_owned()),
            "{example:?}"
        );
    }
    // In a structure, too.
    let hit = NEAREST
        .replace("inout float t", "inout Hit h")
        .replace("near > t", "near > h.t")
        .replace("    t = near", "    h.t = near")
        .replace("float t = 1e9", "Hit t = Hit(1e9)");
    assert_eq!(
        examine(
            &format!("struct Hit {{ float t; }};\n{hit}"),
            "hit",
            &RoleMap::new()
        )
        .mistake,
        None
    );
}

#[test]
fn a_function_that_never_hits_adds_the_squared_radius_only_if_its_text_does() {
    let never = NEAREST.replace("near > t", "near < 1e9");
    assert_eq!(mistake(&never, "hit"), None);
    let adds = NEAREST.replace("- ball.w * ball.w", "+ ball.w * ball.w");
    assert_eq!(mistake(&adds, "hit"), Some("radius-added"));
}

#[test]
fn correct_functions_are_not_blamed_and_their_limits_are_reported() {
    let findings = examine(TEXTBOOK, "hitSphere", &RoleMap::new());
    assert_eq!(findings.mistake, None);
    let summary = findings.summary("hitSphere").join("\n");
    assert!(
        summary.starts_with("hitSphere makes none of the known mistakes, but fails for extreme input"),
        "{summary}"
    );
    let row = summary.lines().find(|line| line.contains("scene scale ≤"));
    assert!(
        row.is_some_and(|row| row.contains(" 1e-20 ") && row.ends_with('–')),
        "{summary}"
    );
    let example = findings.example.unwrap();
    assert!(
        example
            .assignments
            .iter()
            .any(|line| line.starts_with("ro = vec3(")),
        "{example:?}"
    );
}

#[test]
fn examples_have_few_digits_and_fail_as_stated() {
    let text = edited(&SPHERE, &[("float t = -b - root;", "float t = -b + root;")]);
    let example = examine(&text, "intersectSphere", &RoleMap::new())
        .example
        .unwrap();
    let digits: usize = example.assignments.iter().map(String::len).sum();
    assert!(digits < 160, "{example:?}");
    assert_ne!(example.expected, example.actual);
}

#[test]
fn signatures_are_recognized_by_types_and_names_or_given() {
    let main = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }";
    let answer = "vec3 oc = O - C; float b = dot(oc, D); float h = b * b - dot(oc, oc) + R * R;";
    let cases = [
        (
            "vec2 f(in vec3 ro, in vec3 rd, in vec3 ce, float ra)",
            "ro",
            "rd",
            "ce",
            "ra",
            "if (h < 0.0) return vec2(-1.0); h = sqrt(h); return vec2(-b - h, -b + h);",
        ),
        (
            "float f(vec3 ro, vec3 rd, vec4 sph)",
            "ro",
            "rd",
            "sph.xyz",
            "sph.w",
            "return h < 0.0 ? -1.0 : -b - sqrt(h) > 0.0 ? -b - sqrt(h) : -b + sqrt(h);",
        ),
        (
            "bool f(vec3 center, float radius, vec3 origin, vec3 direction, out float dist)",
            "origin",
            "direction",
            "center",
            "radius",
            "if (h < 0.0) return false; dist = -b - sqrt(h); if (dist < 0.0) dist = -b + sqrt(h); return dist > 0.0;",
        ),
        (
            "int f(Ray ray, Ball ball, inout Hit hit)",
            "ray.pos",
            "ray.dir",
            "ball.pos",
            "ball.r",
            "if (h < 0.0) return 0; hit.t = -b - sqrt(h); if (hit.t < 0.0) hit.t = -b + sqrt(h); return hit.t > 0.0 ? 1 : 0;",
        ),
    ];
    let structs = "struct Ray { vec3 pos; vec3 dir; }; struct Ball { vec3 pos; vec3 color; float r; }; struct Hit { float t; vec3 n; };";
    for (head, o, d, c, r, body) in cases {
        let formula = answer
            .replace('O', o)
            .replace('D', d)
            .replace('C', c)
            .replace('R', r);
        let text = format!("{structs}\n{head} {{ {formula} {body} }}\n{main}");
        assert_eq!(mistake(&text, "f"), Some("unit-direction-only"), "{text}");
    }
    let formula = answer
        .replace('O', "a")
        .replace('D', "v")
        .replace('C', "m")
        .replace('R', "w");
    let text = format!(
        "float f(vec3 m, vec3 a, vec3 v, float w) {{ {formula} return h < 0.0 ? 1e9 : -b - sqrt(h) > 0.0 ? -b - sqrt(h) : -b + sqrt(h) > 0.0 ? -b + sqrt(h) : 1e9; }}\n{main}"
    );
    let map = [("m", Role::Center), ("a", Role::Origin), ("v", Role::Direction)];
    let map: RoleMap = map
        .into_iter()
        .map(|(path, role)| (path.to_owned(), role))
        .collect();
    let found = examine(&text, "f", &map).mistake.map(|mistake| mistake.name);
    assert_eq!(found, Some("unit-direction-only"));
    let why = Signature::recognize(&checked(&text), "g", &RoleMap::new())
        .unwrap_err()
        .to_string();
    assert!(
        why.contains("there is no function `g`; the shader has f"),
        "{why}"
    );
    let other = format!("float f(float x) {{ return x; }}\n{main}");
    let why = Signature::recognize(&checked(&other), "f", &RoleMap::new())
        .unwrap_err()
        .to_string();
    assert!(
        why.contains("no parameter of f is recognized as the ray's origin"),
        "{why}"
    );
}

#[test]
fn exercise_functions_are_blamed_only_for_unit_directions() {
    let mut seen = 0;
    for exercise in EVERY_EXERCISE {
        let Ok(signature) =
            Signature::recognize(&checked(exercise.shader), "intersectSphere", &RoleMap::new())
        else {
            continue;
        };
        let found = mistake(exercise.shader, &signature.name);
        assert_eq!(found, Some("unit-direction-only"), "{}", exercise.name);
        seen += 1;
    }
    assert!(seen >= 12, "{seen}");
}

#[test]
fn other_shapes_are_not_mistaken_for_spheres() {
    for exercise in EVERY_EXERCISE {
        for signature in Signature::all(&checked(exercise.shader), &RoleMap::new()) {
            let name = signature.name.to_lowercase();
            // `keepNearest` takes a ray and a sphere, too.
            assert!(
                name.contains("sph") || name == "keepnearest",
                "{}: {name}",
                exercise.name
            );
        }
    }
    let why = Signature::recognize(&checked(QUADRICS.shader), "intersectQuadric", &RoleMap::new())
        .unwrap_err()
        .to_string();
    assert!(why.contains("is recognized as") && why.contains("--map"), "{why}");
    let body = "{ return length(o + d + c) + r; } void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }";
    for (head, is_sphere) in [
        ("float f(vec3 o, vec3 d, vec3 c, float r)", true),
        ("float f(vec3 o, vec3 d, vec3 c, float w, float r)", true),
        ("float disk(vec3 o, vec3 d, vec3 c, float r)", false),
        ("float f(vec3 o, vec3 d, vec3 c, vec3 n, float r)", false),
        ("float f(vec3 o, vec3 d, vec3 c, vec3 axis, float r)", false),
    ] {
        let found = Signature::recognize(&checked(&format!("{head} {body}")), name(head), &RoleMap::new());
        assert_eq!(found.is_ok(), is_sphere, "{head}");
    }
}

/// The name of the function in a header.
fn name(head: &str) -> &str {
    head.split([' ', '(']).nth(1).unwrap()
}

#[test]
fn a_strict_gpu_fails_where_the_cpu_does() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let subjects = formula::subjects();
    let never = AtomicBool::new(false);
    let mut gpu = |checked: &Checked, frame: &Frame| {
        let float = FloatMode::Strict;
        worker.draw_unwatched(float.lower(checked), frame.clone(), float)
    };
    let report = stress::study(&subjects, Some(&mut gpu), FEW_CASES, &never, || ()).unwrap();
    let mut compared = 0;
    for row in report.rows.iter().filter(|row| row.device != stress::CPU) {
        let same = |other: &&stress::Row| {
            (other.device.as_str(), other.precision) == (stress::CPU, "f32")
                && (&other.formula, other.axis, other.value) == (&row.formula, row.axis, row.value)
        };
        let cpu = report.rows.iter().find(same).unwrap();
        assert_eq!(
            cpu.tally, row.tally,
            "{} on {} {}",
            row.formula, row.axis, row.value
        );
        compared += 1;
    }
    assert!(compared > 700, "{compared}");
}

#[test]
fn known_weaknesses_of_the_formulas_are_found() {
    let never = AtomicBool::new(false);
    let few = Settings {
        cases: 200,
        ..FEW_CASES
    };
    let report = stress::study(&formula::subjects(), None, few, &never, || ()).unwrap();
    let share = |formula: &str, precision: &str, axis: &str, value: &str| {
        let rows = report.rows.iter();
        let mut rows = rows.filter(|row| row.formula == formula && row.precision == precision);
        let row = rows.find(|row| row.axis == axis && row.value.to_string() == value);
        row.unwrap_or_else(|| panic!("{formula} {axis} {value}"))
            .tally
            .failing_share()
    };
    // Cancellation in |f|² − r², and the effect of recentering.
    assert!(share("textbook", "f32", "distance/radius", "1e4") > 0.1);
    assert!(share("half-b", "f32", "distance/radius", "1e4") > 0.1);
    assert!(share("recentered", "f32", "distance/radius", "1e4") == 0.0);
    // Overflow and underflow of squares.
    assert!(share("textbook", "f32", "scale", "1e20") > 0.9);
    for (scale, precision) in [
        ("1e-30", "f32"),
        ("1e30", "f32"),
        ("1e-30", "f64"),
        ("1e30", "f64"),
    ] {
        assert!(
            share("scaled", precision, "scale", scale) == 0.0,
            "{precision} {scale}"
        );
    }
    // a = 1 with another direction.
    assert!(share("course", "f64", "|d|", "1e2") > 0.5 && share("textbook", "f64", "|d|", "1e2") == 0.0);
    let summary = report.summary().join("\n");
    assert!(
        summary.contains("Recommended for spheres: recentered ("),
        "{summary}"
    );
    // Rays that leave a surface.
    assert!(share("t > 0", "f32", "mirrored rays", "scale 1") > 0.3);
    assert!(share("t > 1e-3", "f32", "mirrored rays", "scale 1") > 0.9);
    assert!(share("skip own surface", "f32", "grazing rays", "ground r = 1000") == 0.0);
}

#[test]
fn the_command_writes_its_files_and_names_the_columns() {
    let folder = tempfile::tempdir().unwrap();
    let on = if require_driver() { "auto" } else { "cpu" };
    let run = toyproof(
        folder.path(),
        &["stress", "-o", "out", "--cases", "20", "--device", on],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout
            .starts_with("Where ray–sphere formulas stop being right in float32\n")
            && run.stdout.contains("\nRecommended for spheres: recentered ("),
        "{}",
        run.stdout
    );
    let out = folder.path().join("out");
    let csv = fs::read_to_string(out.join("stress.csv")).unwrap();
    let head = "formula,precision,device,axis,step,cases,failing,wrong_hits,t_error_ulp_median,t_error_ulp_p99,\
                t_error_ulp_max,non_finite,self_intersections,missed_nearby";
    assert_eq!(csv.lines().next(), Some(head));
    let json: Value = serde_json::from_str(&fs::read_to_string(out.join("stress.json")).unwrap()).unwrap();
    assert_eq!(json["rows"].as_array().unwrap().len(), csv.lines().count() - 1);
    for name in ["spheres", "errors", "quadrics", "secondary"] {
        for extension in ["png", "svg"] {
            let file = out.join(format!("stress-{name}.{extension}"));
            assert!(file.is_file(), "{}", file.display());
        }
    }
}

/// Functions that do not intersect a ray with a sphere.
const ANY: &str = "float root(float x) {
    float s = sqrt(1.0 + x);
    return s - 1.0;
}
void nothing(float x) {}
float box(vec3 p, vec3 b) {
    vec3 q = abs(p) - b;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}
void mainImage(out vec4 c, in vec2 p) {
    vec2 uv = p / iResolution.xy;
    c = vec4(root(uv.x * 0.001), box(vec3(uv * 4.0 - 2.0, 0.5), vec3(1.0)), 0.0, 1.0);
}
";

#[test]
fn any_function_is_examined_in_the_ranges_that_the_shader_passes() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("any.glsl"), ANY).unwrap();
    let stress = |arguments: &[&str]| {
        let all = [&["stress", "any.glsl", "--cases", "2000"], arguments].concat();
        toyproof(folder.path(), &all)
    };
    let run = stress(&["--function", "root", "-o", "out"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for part in [
        "float root(float x): 2,000 random inputs",
        "observed",
        "result: the formula loses digits",
        "    root(",
        "digits are lost at line 3: `s - 1.0`",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
    let out = folder.path().join("out");
    let csv = fs::read_to_string(out.join("stress.csv")).unwrap();
    assert!(csv.starts_with("function,output,case,"), "{csv}");
    let json: Value = serde_json::from_str(&fs::read_to_string(out.join("stress.json")).unwrap()).unwrap();
    let input = &json["inputs"][0];
    assert_eq!(
        (input["path"].as_str(), input["source"].as_str()),
        (Some("x"), Some("observed"))
    );
    assert!(
        input["high"]
            .as_f64()
            .is_some_and(|high| (0.0009..0.001).contains(&high)),
        "{input}"
    );
    // A function of one input has no pairs.
    assert!(!out.join("stress-pairs.svg").exists());

    let holding = ["--property", "symmetric p", "--property", "range -10..10"];
    let run = stress(&[&["--function", "box", "-o", "box"][..], &holding].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("result is accurate"), "{}", run.stdout);
    assert!(
        run.stdout.contains("property `symmetric p` holds"),
        "{}",
        run.stdout
    );
    assert!(folder.path().join("box/stress-pairs.png").is_file());

    let run = stress(&[
        "--function",
        "box",
        "--range",
        "b=0..1",
        "--property",
        "monotone p.x",
    ]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(
        run.stdout.contains("property `monotone p.x` is violated by"),
        "{}",
        run.stdout
    );
}

#[test]
fn bad_input_is_reported_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glsl");
    fs::write(&path, "void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); }").unwrap();
    fs::write(folder.path().join("textbook.glsl"), TEXTBOOK).unwrap();
    fs::write(folder.path().join("any.glsl"), ANY).unwrap();
    let stress = |arguments: &[&str]| {
        let all = [&["stress", "-o", "out", "--device", "cpu"], arguments].concat();
        toyproof(folder.path(), &all)
    };
    for (arguments, message) in [
        (&["a.glsl", "--function", "f"][..], "there is no function `f`"),
        (&["a.glsl"], "the shader has no function to examine"),
        (&["any.glsl"], "choose a function with --function: root, box"),
        (
            &["any.glsl", "--function", "nothing"],
            "nothing returns nothing, and has no `out` parameter",
        ),
        (
            &["any.glsl", "--function", "bxo"],
            "there is no function `bxo`; did you mean `box`?",
        ),
        (
            &["any.glsl", "--function", "box", "--range", "q=0..1"],
            "box has no input `q`; it has p, b",
        ),
        (
            &["any.glsl", "--function", "box", "--range", "p=1..0"],
            "expected NAME=LOW..HIGH",
        ),
        (
            &["any.glsl", "--function", "box", "--property", "odd p"],
            "expected `unit`",
        ),
        (
            &["any.glsl", "--function", "box", "--property", "monotone p"],
            "needs a single number, such as `p.x`",
        ),
        (&["any.glsl", "--range", "p=0..1"], "--function"),
        (&["none.glsl"], "none.glsl"),
        (&["--function", "f"], "SHADER"),
        (&["a.glsl", "--map", "x=nonsense"], "expected PATH=ROLE"),
        (
            &["textbook.glsl", "--function", "hitSphere", "--map", "q=origin"],
            "hitSphere has no parameter `q`",
        ),
        (
            &[
                "textbook.glsl",
                "--function",
                "hitSphere",
                "--map",
                "ro.at=center",
            ],
            "no parameter `ro.at`",
        ),
        (
            &[
                "textbook.glsl",
                "--function",
                "hitSphere",
                "--map",
                "radius=origin",
            ],
            "`radius` cannot be the ray's origin",
        ),
        (
            &["textbook.glsl", "--map", "q=origin"],
            "hitSphere has no parameter `q`",
        ),
        (&["--cases", "0"], "--cases"),
        (&["--cases", "1000000"], "at most 100,000 cases"),
    ] {
        let run = stress(arguments);
        assert_eq!(run.code, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
    }
    assert!(!folder.path().join("out").exists());
}

/// Whether a process has a handler for interrupts, without which they would kill it.
#[cfg(target_os = "linux")]
fn handles_interrupts(pid: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    let mask = u64::from_str_radix(mask.unwrap().trim(), 16).unwrap();
    // Signal n is bit n − 1.
    mask & 1 << 1 != 0
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_leaves_no_partial_files() {
    use rustix::process::{Pid, Signal, kill_process};
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["stress", "-o", "out", "--device", "cpu", "--cases", "10000"][..],
        &[
            "trade",
            "-o",
            "out",
            "--device",
            "cpu",
            "--budget",
            "60s",
            "--size",
            "1920x1080",
            "s.toml",
        ],
    ] {
        fs::write(folder.path().join("s.toml"), SPHERE.scene).unwrap();
        let mut child = command(folder.path())
            .args(arguments)
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        wait_until(|| handles_interrupts(child.id()));
        kill_process(Pid::from_child(&child), Signal::INT).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(2), "{arguments:?}");
        assert!(!Path::exists(&folder.path().join("out")), "{arguments:?}");
    }
}
