//! Reference shaders that march along their rays: limits and lengths of steps are a matter of style.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{Run, toyproof};
use crate::support::{Edit, edit};

/// Two blended balls and a distant tower on a plane, whose horizon depends on both limits: at 26 units, the march
/// runs out of steps, and at 30, out of distance.
const SOLUTION: &str = "#define MAX_STEPS 128
#define MAX_DIST 30.0

float blended(float a, float b, float k) {
    float h = clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
    return mix(b, a, h) - k * h * (1.0 - h);
}

float sceneDistance(vec3 p) {
    float large = length(p - vec3(0.0, 1.0, 4.0)) - 1.0;
    float small = length(p - vec3(1.3, 0.7, 4.2)) - 0.7;
    float tower = length(max(abs(p - vec3(-6.0, 1.0, 22.0)) - vec3(0.8, 1.6, 0.8), 0.0));
    return min(min(p.y, tower), blended(large, small, 0.4));
}

float march(vec3 origin, vec3 ray) {
    float t = 0.0;
    for (int i = 0; i < MAX_STEPS; i++) {
        float d = sceneDistance(origin + t * ray);
        if (d < 0.001) {
            return t;
        }
        t += d;
        if (t > MAX_DIST) {
            break;
        }
    }
    return -1.0;
}

float visibility(vec3 p, vec3 light) {
    float t = 0.05;
    for (int i = 0; i < 64 && t < 8.0; i++) {
        float d = sceneDistance(p + t * light);
        if (d < 0.001) {
            return 0.3;
        }
        t += d;
    }
    return 1.0;
}

vec3 normal(vec3 p) {
    vec2 e = vec2(0.001, 0.0);
    return normalize(vec3(
        sceneDistance(p + e.xyy) - sceneDistance(p - e.xyy),
        sceneDistance(p + e.yxy) - sceneDistance(p - e.yxy),
        sceneDistance(p + e.yyx) - sceneDistance(p - e.yyx)));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 uv = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    vec3 origin = vec3(0.0, 1.5, 0.0);
    vec3 ray = normalize(vec3(uv, 1.5));
    vec3 light = normalize(vec3(0.6, 0.8, -0.5));
    vec3 color = vec3(0.5, 0.7, 0.9);
    float t = march(origin, ray);
    if (t > 0.0) {
        vec3 p = origin + t * ray;
        vec3 n = normal(p);
        color = vec3(0.8, 0.6, 0.4) * (0.1 + max(dot(n, light), 0.0) * visibility(p + 0.01 * n, light));
    }
    fragColor = vec4(color, 1.0);
}
";

/// A name, and edits of the solution.
type Edited = (&'static str, &'static [Edit]);

/// Edits of the solution after which it is as right, and after which it is wrong.
const RIGHT: [Edited; 5] = [
    ("more-steps", &[("MAX_STEPS 128", "MAX_STEPS 200")]),
    ("farther", &[("MAX_DIST 30.0", "MAX_DIST 50.0")]),
    (
        "both",
        &[("MAX_STEPS 128", "MAX_STEPS 200"), ("t > MAX_DIST", "t > 40.")],
    ),
    (
        "short-steps",
        &[("t += d;\n        if (t", "t += 0.9 * d;\n        if (t")],
    ),
    (
        "all",
        &[
            ("MAX_STEPS 128", "MAX_STEPS 200"),
            ("MAX_DIST 30.0", "MAX_DIST 40.0"),
            ("t += d;\n        if (t", "t += 0.9 * d;\n        if (t"),
        ],
    ),
];

const WRONG: [Edited; 6] = [
    ("no-shadow", &[(" * visibility(p + 0.01 * n, light)", "")]),
    ("blend", &[("small, 0.4)", "small, 0.3)")]),
    ("radius", &[("4.0)) - 1.0", "4.0)) - 1.03")]),
    ("no-tower", &[("min(p.y, tower)", "p.y")]),
    ("near-limit", &[("MAX_DIST 30.0", "MAX_DIST 15.0")]),
    (
        "long-steps",
        &[("t += d;\n        if (t", "t += 1.9 * d;\n        if (t")],
    ),
];

/// The solution in other styles, which teachers may write, too.
const STYLES: [Edited; 3] = [
    (
        "constants and a while loop",
        &[
            ("#define MAX_STEPS 128", "const int STEPS = 128;"),
            ("#define MAX_DIST 30.0", "const float FAR = 30.0;"),
            (
                "for (int i = 0; i < MAX_STEPS; i++) {",
                "int i = 0;\n    while (i++ < STEPS && t < FAR) {",
            ),
            ("\n        if (t > MAX_DIST) {\n            break;\n        }", ""),
        ],
    ),
    (
        "a parameter, and a position that moves",
        &[
            (
                "march(vec3 origin, vec3 ray) {",
                "march(vec3 origin, vec3 ray, float far) {\n    vec3 p = origin;",
            ),
            ("march(origin, ray);", "march(origin, ray, 30.0);"),
            (
                "= sceneDistance(origin + t * ray);\n        if (d < 0.001) {\n            return t;",
                "= sceneDistance(p);\n        if (d < 0.001) {\n            return t;",
            ),
            (
                "t += d;\n        if (t > MAX_DIST)",
                "p += d * ray;\n        t += d;\n        if (t >= far)",
            ),
        ],
    ),
    (
        "numbers, and the distance as a limit afterwards",
        &[
            ("i < MAX_STEPS", "i < 128"),
            ("t > MAX_DIST", "t > 30.0"),
            ("return -1.0;", "return 30.0;"),
            ("if (t > 0.0)", "if (t < 30.0)"),
        ],
    ),
];

fn write(folder: &Path, shaders: &[Edited]) {
    fs::create_dir_all(folder.join("hw")).unwrap();
    for (name, edits) in shaders {
        let text = edit(SOLUTION, edits, name);
        fs::write(folder.join(format!("hw/{name}.glsl")), text).unwrap();
    }
}

/// Checks the folder against the solution in this style.
fn check(folder: &Path, style: &[Edit]) -> Run {
    fs::write(folder.join("solution.glsl"), edit(SOLUTION, style, "solution")).unwrap();
    let arguments = "check hw --reference solution.glsl --device cpu --size 160x90 --search 0 --format json";
    toyproof(folder, &arguments.split(' ').collect::<Vec<_>>())
}

fn verdicts(run: &Run) -> Vec<(String, String)> {
    let report: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{run:?}"));
    let shaders = report["shaders"].as_array().unwrap().iter();
    shaders
        .map(|record| {
            let name = record["shader"].as_str().unwrap();
            (
                name.to_owned(),
                format!("{}: {}", record["verdict"].as_str().unwrap(), record["reason"]),
            )
        })
        .collect()
}

#[test]
fn limits_of_a_march_are_a_matter_of_style_and_other_mistakes_stay_wrong() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &[&RIGHT[..], &WRONG].concat());
    let run = check(folder.path(), &[]);
    for (name, verdict) in verdicts(&run) {
        let is_right = RIGHT
            .iter()
            .any(|(right, _)| name.ends_with(&format!("/{right}.glsl")));
        let expected = if is_right { "correct: " } else { "wrong: " };
        assert!(verdict.starts_with(expected), "{name}: {verdict}\n{run:?}");
    }
    assert!(
        run.stderr
            .contains("they depend on `MAX_STEPS`, `MAX_DIST` and the length of the steps"),
        "{}",
        run.stderr
    );
}

#[test]
fn limits_are_found_in_every_style_of_the_reference() {
    let folder = tempfile::tempdir().unwrap();
    // The hardest of both kinds.
    write(folder.path(), &[RIGHT[2], RIGHT[4], WRONG[1], WRONG[3]]);
    for (style, edits) in STYLES {
        let run = check(folder.path(), edits);
        let found: Vec<_> = verdicts(&run)
            .into_iter()
            .map(|(name, verdict)| format!("{name} {}", verdict.split(':').next().unwrap()))
            .collect();
        assert_eq!(
            found,
            [
                "hw/all.glsl correct",
                "hw/blend.glsl wrong",
                "hw/both.glsl correct",
                "hw/no-tower.glsl wrong"
            ],
            "{style}: {run:?}"
        );
    }
}

#[test]
fn a_new_assignment_says_which_pixels_depend_on_the_march() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("solution.glsl"), SOLUTION).unwrap();
    let run = toyproof(
        folder.path(),
        &["new", "assignment", "balls", "--from", "solution.glsl"],
    );
    assert_eq!(run.code, 0, "{run:?}");
    let words = [
        "the march along the rays of solution.glsl decides the color of ",
        "they depend on `MAX_STEPS`, `MAX_DIST` and the length of the steps",
        "help: give students these numbers",
    ];
    for words in words {
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
    let disk = "void mainImage(out vec4 c, in vec2 p) {
        c = vec4(0.0);
        for (int i = 0; i < 9; i++) c += length(p - 0.5 * iResolution.xy) < 10.0 * float(i) ? vec4(0.1) : vec4(0.05);
    }";
    fs::write(folder.path().join("disk.glsl"), disk).unwrap();
    let run = toyproof(
        folder.path(),
        &["new", "assignment", "disk", "--from", "disk.glsl"],
    );
    assert!(run.code == 0 && !run.stderr.contains("march"), "{run:?}");
}
