//! Normals by derivatives are exact on planes, and arbitrary where a quad sees two surfaces.

use toyproof::verify::Verdict;

use crate::requirements::require_worker;
use crate::support::{Edit, Exercise, STILL, algorithm, check_exercise, edit, numbers};

const SCENE: &str = r#"
ambient = [0.1, 0.1, 0.1]
[background]
color = [0.3, 0.4, 0.6]
[[light]]
position = [3.0, 5.0, 1.0]
color = [0.8, 0.8, 0.8]
shadow = false
[[plane]]
point = [0.0, -1.0, 0.0]
normal = [0.0, 1.0, 0.0]
material = { model = "lambert", color = [0.6, 0.5, 0.4] }
[[plane]]
point = [0.0, 0.0, -9.0]
normal = [0.0, 0.0, 1.0]
material = { model = "lambert", color = [0.4, 0.5, 0.7] }
[[sphere]]
center = [0.5, -0.2, -6.0]
radius = 0.8
material = { model = "lambert", color = [0.9, 0.3, 0.2] }
"#;

const SHADER: &str = "
const vec3 CENTER = vec3(0.5, -0.2, -6.0);
const float RADIUS = 0.8;

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 screen = (2.0 * fragCoord - iResolution.xy) / iResolution.x;
    vec3 direction = normalize(vec3(screen, -2.0));
    float toWall = -9.0 / direction.z;
    float toFloor = direction.y < 0.0 ? -1.0 / direction.y : 1.0e6;
    float b = dot(CENTER, direction);
    float disc = b * b - dot(CENTER, CENTER) + RADIUS * RADIUS;
    float toSphere = disc > 0.0 ? b - sqrt(disc) : 1.0e6;

    float t = min(min(toWall, toFloor), toSphere);
    vec3 point = t * direction;
    vec3 normal = normalize(cross(dFdx(point), dFdy(point)));
    vec3 color = t == toFloor ? vec3(0.6, 0.5, 0.4) : vec3(0.4, 0.5, 0.7);
    if (t == toSphere) {
        normal = (point - CENTER) / RADIUS;
        color = vec3(0.9, 0.3, 0.2);
    }
    vec3 toLight = normalize(vec3(3.0, 5.0, 1.0) - point);
    fragColor = vec4(color * (0.1 + 0.8 * max(dot(normal, toLight), 0.0)), 1.0);
}";

/// Faults beside the derivatives.
static FAULTS: &[(&str, &[Edit])] = &[
    (
        "the normal inward",
        &[(
            "cross(dFdx(point), dFdy(point))",
            "cross(dFdy(point), dFdx(point))",
        )],
    ),
    (
        "a difference along x taken for one along y",
        &[("dFdy(point)", "dFdx(point.zxy)")],
    ),
    (
        "the floor too low",
        &[("-1.0 / direction.y", "-1.05 / direction.y")],
    ),
    ("a sphere too large", &[("RADIUS = 0.8", "RADIUS = 0.82")]),
    ("a light aside", &[("vec3(3.0, 5.0, 1.0)", "vec3(3.1, 5.0, 1.0)")]),
];

#[test]
fn quads_across_edges_have_arbitrary_derivatives() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let exercise = Exercise {
        name: "flat normals",
        shader: SHADER,
        scene: SCENE,
        ..STILL
    };
    let findings = check_exercise(&mut worker, SHADER, &exercise);
    assert_eq!(findings.verdict, Verdict::Correct, "{}", numbers(&findings));
    let left_out = algorithm(&findings).share(algorithm(&findings).undefined);
    eprintln!("{:.2} % left out", 100.0 * left_out);
    assert!(
        left_out > 0.001,
        "without the rule it would be wrong: {}",
        numbers(&findings)
    );
    for (name, edits) in FAULTS {
        let findings = check_exercise(&mut worker, &edit(SHADER, edits, name), &exercise);
        eprintln!("{name}: {}", numbers(&findings));
        assert_eq!(findings.verdict, Verdict::Wrong, "{name}: {}", numbers(&findings));
    }
}
