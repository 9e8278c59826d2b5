//! Shaders whose algorithm is the scene's but for which float32 is not enough, each for a different cause;
//! and for each a formula that renders the same scene without harm. The first must be `unstable` with the
//! line that loses the digits, the second `correct`.

use toyproof::verify::Verdict;

use crate::requirements::require_worker;
use crate::support::{Edit, Exercise, MANY_OBJECTS, SHADING, SPHERE, check_exercise, edit, numbers};

/// A scene that is demanding for float32, and two formulas that render it.
struct Case {
    /// The cause of the loss.
    cause: &'static str,
    exercise: &'static Exercise,
    /// The exercise's scene file, made demanding.
    scene: &'static [Edit],
    /// The same for the exercise's shader.
    shader: &'static [Edit],
    /// The formula that loses its digits.
    unstable: &'static [Edit],
    /// Part of each source line that may be blamed.
    blamed: &'static [&'static str],
    /// The formula that keeps them.
    harmless: &'static [Edit],
}

const CENTER: &str = "vec3(0.0, 0.0, -6.0)";
const CENTER_TOML: &str = "[0.0, 0.0, -6.0]";
const F: &str = "vec3 f = ray.origin - sphere.center;";
const B: &str = "float b = dot(f, ray.direction);";
const C: &str = "float c = dot(f, f) - sphere.radius * sphere.radius;";
const DISC: &str = "float disc = b * b - c;";
const NEAR: &str = "float t = -b - root;";
const NORMAL: &str = "vec3 normal = normalize(hitPoint - sphere.center);";
const UNIT: &str = "normalize(vec3(x, y, SCREEN_DEPTH))";
const LIT: &str = "max(dot(normal, toLight), 0.0)";
const SHADED: &str = "vec4(color, 1.0)";

/// The squared distance of the center from the ray instead of b² − c: no difference of large squares.
const RECENTERED: &[Edit] = &[
    (C, "vec3 aside = f - b * ray.direction;"),
    (
        DISC,
        "float disc = sphere.radius * sphere.radius - dot(aside, aside);",
    ),
];

static CASES: &[Case] = &[
    Case {
        cause: "a small sphere far away, by the textbook's discriminant",
        exercise: &SPHERE,
        scene: &[
            ("screen_distance = 2.0", "screen_distance = 4000.0"),
            (CENTER_TOML, "[0.0, 0.0, -20000.0]"),
            ("radius = 1.5", "radius = 2.5"),
        ],
        shader: &[
            ("SCREEN_DEPTH = -2.0", "SCREEN_DEPTH = -4000.0"),
            (CENTER, "vec3(0.0, 0.0, -20000.0)"),
            ("1.5, vec3(1.0", "2.5, vec3(1.0"),
        ],
        unstable: &[],
        blamed: &["float c =", "float disc ="],
        harmless: RECENTERED,
    },
    Case {
        cause: "the ground as a huge sphere",
        exercise: &SHADING,
        scene: &[
            (CENTER_TOML, "[0.0, -8000001.0, -6.0]"),
            ("radius = 1.5", "radius = 8000000.0"),
        ],
        shader: &[
            (CENTER, "vec3(0.0, -8000001.0, -6.0)"),
            ("1.5, vec3(0.9", "8000000.0, vec3(0.9"),
        ],
        unstable: &[],
        blamed: &["float c ="],
        // The sphere given by its topmost point, and the root without a difference.
        harmless: &[
            (
                F,
                "vec3 f = ray.origin - (sphere.center + vec3(0.0, sphere.radius, 0.0));",
            ),
            (
                B,
                "float b = dot(f, ray.direction) + sphere.radius * ray.direction.y;",
            ),
            (C, "float c = dot(f, f) + 2.0 * sphere.radius * f.y;"),
            (NEAR, "float t = b < 0.0 ? c / (-b + root) : -b - root;"),
        ],
    },
    Case {
        cause: "a scene far from the origin of the world",
        exercise: &SPHERE,
        scene: &[
            ("eye = [0.0, 0.0, 0.0]", "eye = [2000000.0, 0.0, 0.0]"),
            (CENTER_TOML, "[2000000.0, 0.0, -6.0]"),
        ],
        shader: &[
            (CENTER, "vec3(2000000.0, 0.0, -6.0)"),
            (
                "Ray(vec3(0.0), normalize",
                "Ray(vec3(2000000.0, 0.0, 0.0), normalize",
            ),
        ],
        unstable: &[],
        blamed: &["vec3 hitPoint =", "vec3 normal ="],
        harmless: &[(
            NORMAL,
            "vec3 normal = normalize((ray.origin - sphere.center) + t * ray.direction);",
        )],
    },
    Case {
        cause: "two surfaces that lie closer than the digits of t",
        exercise: &MANY_OBJECTS,
        scene: &[(
            "center = [0.5, -0.7, -4.0]\nradius = 0.3",
            "center = [0.0, 0.0, -6.0]\nradius = 1.0000002",
        )],
        shader: &[("vec3(0.5, -0.7, -4.0), 0.3", "vec3(0.0, 0.0, -6.0), 1.0000002")],
        // The inner one is tested last and wins the tie.
        unstable: &[("if (t < hit.t)", "if (t <= hit.t && t < NO_HIT)")],
        blamed: &["if (t <= hit.t"],
        harmless: &[],
    },
    Case {
        cause: "underflow: the square of a tiny direction",
        exercise: &SPHERE,
        scene: &[],
        shader: &[
            (DISC, "float disc = b * b - a * c;"),
            (NEAR, "float t = (-b - root) / a;"),
            ("t = -b + root", "t = (-b + root) / a"),
            (
                "vec3 f = ray",
                "float a = dot(ray.direction, ray.direction);\n    vec3 f = ray",
            ),
            (
                "dot(ray.direction, normal)",
                "dot(normalize(ray.direction * 1.0e10), normal)",
            ),
            ("if (t < NO_HIT)", "if (t < 1.0e30)"),
            ("NO_HIT = 1.0e6", "NO_HIT = 1.0e30"),
        ],
        unstable: &[(UNIT, "1.0e-25 * normalize(vec3(x, y, SCREEN_DEPTH))")],
        blamed: &["float a =", "float disc ="],
        harmless: &[(UNIT, "1.0e-10 * normalize(vec3(x, y, SCREEN_DEPTH))")],
    },
    Case {
        cause: "overflow: the square of a large distance",
        exercise: &SPHERE,
        scene: &[
            (CENTER_TOML, "[0.0, 0.0, -6e19]"),
            ("radius = 1.5", "radius = 1.5e19"),
        ],
        shader: &[
            ("vec3(0.0, 0.0, -6.0), 1.5", "vec3(0.0, 0.0, -6.0e19), 1.5e19"),
            ("NO_HIT = 1.0e6", "NO_HIT = 1.0e30"),
            (
                NORMAL,
                "vec3 normal = (hitPoint - sphere.center) / sphere.radius;",
            ),
        ],
        unstable: &[],
        blamed: &["float b =", "float c =", "float disc ="],
        harmless: &[
            (
                F,
                "float scale = 1.0e-19;\n    vec3 f = scale * (ray.origin - sphere.center);",
            ),
            (
                C,
                "float r = scale * sphere.radius;\n    float c = dot(f, f) - r * r;",
            ),
            (NEAR, "float t = (-b - root) / scale;"),
        ],
    },
    Case {
        cause: "a cosine by the law of cosines, for a light far away",
        exercise: &SHADING,
        scene: &[(
            "position = [5.0, 5.0, 0.0]",
            "position = [500000.0, 500000.0, 0.0]",
        )],
        shader: &[("vec3(5.0, 5.0, 0.0)", "vec3(500000.0, 500000.0, 0.0)")],
        unstable: &[
            (
                LIT,
                "max(lawOfCosines(point, lights[i].position - point, lights[i].position - vec3(0.0, 0.0, -6.0)), 0.0)",
            ),
            (
                "vec3 shade(",
                "float lawOfCosines(vec3 point, vec3 toLight, vec3 fromCenter) {\n    \
             float squares = dot(fromCenter, fromCenter) - 1.5 * 1.5 - dot(toLight, toLight);\n    \
             return squares / (2.0 * 1.5 * length(toLight));\n}\n\nvec3 shade(",
            ),
        ],
        blamed: &["float squares ="],
        harmless: &[],
    },
    Case {
        cause: "absorption: a number added to keep a sum positive",
        exercise: &SPHERE,
        scene: &[],
        shader: &[],
        unstable: &[(SHADED, "vec4((color + 1.0e6) - 1.0e6, 1.0)")],
        blamed: &["(color + 1.0e6)"],
        harmless: &[(SHADED, "vec4((color + 1.0) - 1.0, 1.0)")],
    },
    Case {
        cause: "the sine of an angle of many turns",
        exercise: &SHADING,
        scene: &[],
        shader: &[],
        unstable: &[
            (LIT, "max(dot(normal, turned(toLight, 6283185.307179586)), 0.0)"),
            (
                "vec3 shade(",
                "vec3 turned(vec3 v, float angle) {\n    float s = sin(angle);\n    float c = cos(angle);\n    \
             return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);\n}\n\nvec3 shade(",
            ),
        ],
        blamed: &["sin(angle)", "cos(angle)"],
        harmless: &[
            (LIT, "max(dot(normal, turned(toLight, 6.283185307179586)), 0.0)"),
            (
                "vec3 shade(",
                "vec3 turned(vec3 v, float angle) {\n    float s = sin(angle);\n    float c = cos(angle);\n    \
             return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);\n}\n\nvec3 shade(",
            ),
        ],
    },
    Case {
        cause: "overflow: the quotient of two large exponentials",
        exercise: &SPHERE,
        scene: &[],
        shader: &[],
        unstable: &[(SHADED, "vec4(color * exp(100.0) / exp(100.0), 1.0)")],
        blamed: &["exp(100.0)"],
        harmless: &[(SHADED, "vec4(color * exp(10.0) / exp(10.0), 1.0)")],
    },
    Case {
        cause: "a normal by differences over too short a step",
        exercise: &SPHERE,
        scene: &[],
        shader: &[(
            "Ray cameraRay(",
            "float field(vec3 p, Sphere sphere) {\n    return length(p - sphere.center) - sphere.radius;\n}\n\n\
             vec3 gradient(vec3 p, Sphere sphere, float h) {\n    vec2 e = vec2(h, 0.0);\n    \
             float dx = field(p + e.xyy, sphere) - field(p - e.xyy, sphere);\n    \
             float dy = field(p + e.yxy, sphere) - field(p - e.yxy, sphere);\n    \
             float dz = field(p + e.yyx, sphere) - field(p - e.yyx, sphere);\n    \
             return vec3(dx, dy, dz);\n}\n\nRay cameraRay(",
        )],
        unstable: &[(
            NORMAL,
            "vec3 normal = normalize(gradient(hitPoint, sphere, 1.0e-6));",
        )],
        blamed: &[
            "float dx =",
            "float dy =",
            "float dz =",
            "length(p - sphere.center) - sphere.radius",
        ],
        harmless: &[(
            NORMAL,
            "vec3 normal = normalize(gradient(hitPoint, sphere, 0.01));",
        )],
    },
    Case {
        cause: "a system of equations that is nearly singular",
        exercise: &SPHERE,
        scene: &[],
        shader: &[],
        unstable: &[
            (SHADED, "vec4(inverse(SKEW) * (SKEW * color), 1.0)"),
            (
                "const float NO_HIT",
                "const mat3 SKEW = mat3(1.0, 1.0, 1.0, 1.0, 1.0000005, 1.0, 1.0, 1.0, 1.0000005);\nconst float NO_HIT",
            ),
        ],
        blamed: &["inverse(SKEW)"],
        harmless: &[
            (SHADED, "vec4(inverse(SKEW) * (SKEW * color), 1.0)"),
            (
                "const float NO_HIT",
                "const mat3 SKEW = mat3(1.0, 1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 2.0);\nconst float NO_HIT",
            ),
        ],
    },
];

#[test]
fn unstable_formulas_are_blamed_with_their_line_and_stable_ones_are_correct() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let only = std::env::var("TOYPROOF_ONLY").unwrap_or_default();
    let mut failures = Vec::new();
    for case in CASES.iter().filter(|case| case.cause.contains(&only)) {
        let scene = edit(case.exercise.scene, case.scene, case.cause);
        let common = edit(case.exercise.shader, case.shader, case.cause);
        let unstable = edit(&common, case.unstable, case.cause);
        let findings = check_exercise(
            &mut worker,
            &unstable,
            &Exercise {
                scene: scene.clone().leak(),
                ..*case.exercise
            },
        );
        let line = findings
            .cause
            .map_or("nowhere", |cause| line_of(&unstable, cause.start as usize));
        let named = case.blamed.iter().any(|blamed| line.contains(blamed));
        let reported = format!(
            "{}: {}; lost in `{}`",
            case.cause,
            numbers(&findings),
            line.trim()
        );
        eprintln!("{reported}");
        if findings.verdict != Verdict::Unstable || !named {
            failures.push(reported);
        }
        if case.harmless.is_empty() {
            continue;
        }
        let harmless = edit(&common, case.harmless, case.cause);
        let findings = check_exercise(
            &mut worker,
            &harmless,
            &Exercise {
                scene: scene.leak(),
                ..*case.exercise
            },
        );
        let reported = format!("{}, its twin: {}", case.cause, numbers(&findings));
        eprintln!("{reported}");
        if findings.verdict != Verdict::Correct {
            failures.push(reported);
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn line_of(text: &str, at: usize) -> &str {
    let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    text[start..].lines().next().unwrap_or_default()
}
