//! Correct shaders in styles unlike the exercises', all of which must be `correct`, and biased stochastic
//! ones, which must not be.
//!
//! The evaluator alone checks them; drivers are tested elsewhere.

use toyproof::explain::known::Diagnosis;
use toyproof::verify::{Reason, Verdict};

use crate::support::{
    Edit, Exercise, IMPORTANCE_SAMPLING, MANY_OBJECTS, REFLECTIONS, SHADING, SOFT_SHADOWS, STILL, WHITTED,
    algorithm, check_exercise_with, edited, numbers, scene,
};

/// Checks an edited exercise in a size.
fn verdict(exercise: &Exercise, size: [u32; 2], edits: &[Edit]) -> (Verdict, String) {
    let exercise = Exercise { size, ..*exercise };
    let findings = check_exercise_with(None, &edited(&exercise, edits), &exercise);
    let mistake = findings.mistake.as_ref().map(Diagnosis::id);
    let assert_verdicts = format!("{} {mistake:?}: {:?}", numbers(&findings), findings.reason);
    (findings.verdict, assert_verdicts)
}

/// Edits that move the origins of secondary rays in the glass exercise.
pub(crate) fn glass(offset_direction: &str, offset: f64) -> Vec<Edit> {
    let mirrored = "Ray mirrored = Ray(hit.point, reflect(ray.direction, hit.normal));";
    let refracted = "Branch(Ray(hit.point, refracted)";
    let epsilon = "const float EPSILON = 0.001;";
    let least = "const float EPSILON = 0.00001;".to_owned();
    let own = |from: &'static str, to: String| -> Edit { (from, to.leak()) };
    match offset_direction {
        "least t" => vec![own(epsilon, format!("const float EPSILON = {offset:?};"))],
        "along the normal" => vec![
            own(epsilon, least),
            own(
                mirrored,
                format!(
                    "vec3 off = {offset:?} * (dot(ray.direction, hit.normal) < 0.0 ? hit.normal : -hit.normal);\n        \
                     Ray mirrored = Ray(hit.point + off, reflect(ray.direction, hit.normal));"
                ),
            ),
            own(refracted, "Branch(Ray(hit.point - off, refracted)".to_owned()),
            own(
                "vec3 origin = hit.point + EPSILON * hit.normal;",
                format!("vec3 origin = hit.point + {offset:?} * hit.normal;"),
            ),
        ],
        "along the ray" => vec![
            own(epsilon, least),
            own(
                mirrored,
                format!(
                    "vec3 away = reflect(ray.direction, hit.normal);\n        Ray mirrored = Ray(hit.point + {offset:?} * away, away);"
                ),
            ),
            own(
                refracted,
                format!("Branch(Ray(hit.point + {offset:?} * refracted, refracted)"),
            ),
            own(
                "vec3 origin = hit.point + EPSILON * hit.normal;",
                format!("vec3 origin = hit.point + {offset:?} * normalize(LIGHT - hit.point);"),
            ),
        ],
        _ => unreachable!("no such way"),
    }
}

const OFFSET_DIRECTIONS: [&str; 3] = ["least t", "along the normal", "along the ray"];

fn glass_is_correct(size: [u32; 2], offsets: &[f64]) {
    let mut wrong = Vec::new();
    for offset_direction in OFFSET_DIRECTIONS {
        for &offset in offsets {
            let (verdict, assert_verdicts) = verdict(&WHITTED, size, &glass(offset_direction, offset));
            eprintln!("{offset_direction} {offset}: {assert_verdicts}");
            if verdict != Verdict::Correct {
                wrong.push(format!("{offset_direction} {offset}: {assert_verdicts}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn glass_is_correct_wherever_its_rays_start() {
    glass_is_correct([160, 90], &[1e-4, 2e-4, 5e-4, 8e-4]);
}

/// `cargo test --test suite -- --ignored glass_is_correct --nocapture`
#[test]
#[ignore = "takes minutes"]
fn glass_is_correct_in_a_sweep_of_offsets() {
    // Closer to the surface, float32 has too few digits for b² − c.
    let offsets = [
        1e-4, 2e-4, 3e-4, 3.5e-4, 4e-4, 5e-4, 6e-4, 7e-4, 7.7e-4, 8e-4, 9e-4, 1e-3,
    ];
    glass_is_correct([160, 90], &offsets);
    glass_is_correct([320, 180], &offsets);
}

#[test]
fn light_vectors_may_start_at_the_shadow_rays_origin() {
    let edit = (
        "normalize(light.position - hit.point)",
        "normalize(light.position - (hit.point + 0.001 * hit.normal))",
    );
    let (verdict, assert_verdicts) = verdict(&MANY_OBJECTS, [160, 90], &[edit]);
    assert_eq!(verdict, Verdict::Correct, "{assert_verdicts}");
}

const NEAR_TEST: &str = "t > 0.00001) {\n            return t;\n        }\n        t =";
const FAR_TEST: &str = "+ root;\n        if (t > 0.00001)";

/// Rays that intersect the surface that they start from: without an offset in double precision, too, with a small one
/// only in float32.
static ACNE: &[(Verdict, Case)] = &[
    (
        Verdict::Wrong,
        (
            "shadow rays from the surface itself",
            &MANY_OBJECTS,
            &[
                ("0.001 * normal", "0.0 * normal"),
                (
                    NEAR_TEST,
                    "t > 0.0) {\n            return t;\n        }\n        t =",
                ),
                (FAR_TEST, "+ root;\n        if (t > 0.0)"),
            ],
        ),
    ),
    (
        Verdict::Unstable,
        (
            "shadow rays from a little off it",
            &MANY_OBJECTS,
            &[
                ("0.001 * normal", "1.0e-9 * normal"),
                (
                    NEAR_TEST,
                    "t > 0.0) {\n            return t;\n        }\n        t =",
                ),
                (FAR_TEST, "+ root;\n        if (t > 0.0)"),
            ],
        ),
    ),
    (
        Verdict::Wrong,
        (
            "mirrors, from the surface itself",
            &REFLECTIONS,
            &[("EPSILON = 0.001", "EPSILON = 0.0")],
        ),
    ),
    (
        Verdict::Unstable,
        (
            "mirrors, from a little off it",
            &REFLECTIONS,
            &[("EPSILON = 0.001", "EPSILON = 1.0e-9")],
        ),
    ),
];

#[test]
fn self_intersecting_rays_are_a_named_mistake() {
    for (expected, (name, exercise, edits)) in ACNE {
        let (verdict, assert_verdicts) = verdict(exercise, [160, 90], edits);
        eprintln!("{name}: {assert_verdicts}");
        assert_eq!(verdict, *expected, "{name}: {assert_verdicts}");
        assert!(
            assert_verdicts.contains("self-intersection"),
            "{name}: {assert_verdicts}"
        );
    }
}

/// A hash that differs from the scene's.
const OTHER_HASH: Edit = ("pcg(uint(i))", "pcg(uint(i) + 1000u)");

const COUNT_LIGHT_HITS: Edit = (
    "if (inShadow(Ray(hit.point + EPSILON * hit.normal, direction), emitter)) {",
    "if (nearestHit(Ray(hit.point + EPSILON * hit.normal, direction)).sphere != emitter) {",
);
const WEIGHT: &str = "* weight(density, other) / density;";
const SHARE: &str = "share = weight(density, lightDensity(ray.origin, spheres[hit.sphere]));";
const LIGHT: &str = "color += throughput * sampleLight(hit, reflected);";
const CONTINUE_PATH: &str = "ray = Ray(hit.point + EPSILON * hit.normal, direction);";

/// The name of the change, its exercise, and the edits.
type Case = (&'static str, &'static Exercise, &'static [Edit]);

static CORRECT: &[Case] = &[
    (
        "a lamp counts if it is met",
        &IMPORTANCE_SAMPLING,
        &[COUNT_LIGHT_HITS],
    ),
    (
        "a lamp counts if it is met, and is looked at from where the ray starts",
        &IMPORTANCE_SAMPLING,
        &[
            COUNT_LIGHT_HITS,
            (
                "float cosine = 1.0 - u * coneDepth(hit.point, spheres[emitter]);\n    vec3 direction = around(normalize(spheres[emitter].center - hit.point), cosine, v);",
                "vec3 start = hit.point + EPSILON * hit.normal;\n    float cosine = 1.0 - u * coneDepth(start, spheres[emitter]);\n    vec3 direction = around(normalize(spheres[emitter].center - start), cosine, v);",
            ),
        ],
    ),
    ("another hash", &IMPORTANCE_SAMPLING, &[OTHER_HASH]),
    (
        "Russian roulette, compensated",
        &IMPORTANCE_SAMPLING,
        &[
            OTHER_HASH,
            (
                CONTINUE_PATH,
                "if (random() > 0.8) {\n            return color;\n        }\n        throughput /= 0.8;\n        ray = Ray(hit.point + EPSILON * hit.normal, direction);",
            ),
        ],
    ),
    (
        "lights sampled alone",
        &IMPORTANCE_SAMPLING,
        &[OTHER_HASH, (WEIGHT, "/ density;"), (SHARE, "share = 0.0;")],
    ),
    (
        "the balance heuristic",
        &IMPORTANCE_SAMPLING,
        &[
            OTHER_HASH,
            (
                "return 1.0 / (1.0 + ratio * ratio);",
                "return 1.0 / (1.0 + ratio);",
            ),
        ],
    ),
    (
        "a grid of samples in each pixel",
        &SOFT_SHADOWS,
        &[
            OTHER_HASH,
            (
                "fragCoord.x + random() - 0.5",
                "fragCoord.x + (float(i % 4) + random()) / 4.0 - 0.5",
            ),
            (
                "fragCoord.y + random() - 0.5",
                "fragCoord.y + (float(i / 4) + random()) / 4.0 - 0.5",
            ),
        ],
    ),
    (
        "a hash of sines",
        &SOFT_SHADOWS,
        &[
            (
                "state = pcg(state);\n    return float(state >> 8u) / 16777216.0;",
                "seed += 1.0;\n    return fract(sin(seed * 12.9898) * 43758.5453);",
            ),
            ("uint state;", "uint state;\nfloat seed;"),
            (
                "state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));",
                "seed = fract(sin(dot(fragCoord, vec2(12.9898, 78.233))) * 43758.5453) * 100.0 + float(i) * 7.31;",
            ),
        ],
    ),
    (
        "twice the samples",
        &SOFT_SHADOWS,
        &[OTHER_HASH, ("SAMPLES = 16", "SAMPLES = 32")],
    ),
];

static BIASED: &[Case] = &[
    (
        "Russian roulette, not compensated",
        &IMPORTANCE_SAMPLING,
        &[
            OTHER_HASH,
            (
                CONTINUE_PATH,
                "if (random() > 0.9) {\n            return color;\n        }\n        ray = Ray(hit.point + EPSILON * hit.normal, direction);",
            ),
        ],
    ),
    (
        "both ways to sample counted in full",
        &IMPORTANCE_SAMPLING,
        &[OTHER_HASH, (WEIGHT, "/ density;"), (SHARE, "share = 1.0;")],
    ),
    (
        "the number of lamps forgotten",
        &IMPORTANCE_SAMPLING,
        &[OTHER_HASH, (" * float(EMITTERS));", ");")],
    ),
    (
        "a segment less",
        &IMPORTANCE_SAMPLING,
        &[OTHER_HASH, ("MAX_DEPTH = 4", "MAX_DEPTH = 3")],
    ),
    (
        "the cosine to the lamp forgotten",
        &IMPORTANCE_SAMPLING,
        &[
            OTHER_HASH,
            (
                "brdf(hit.material, reflected, direction) * facing\n",
                "brdf(hit.material, reflected, direction)\n",
            ),
        ],
    ),
    (
        "the light's angle drawn evenly",
        &SOFT_SHADOWS,
        &[
            OTHER_HASH,
            (
                "float cosine = 1.0 - u * depth;",
                "float cosine = cos(u * asin(sqrt(sine2)));",
            ),
        ],
    ),
    (
        "the light's middle drawn too often",
        &SOFT_SHADOWS,
        &[
            OTHER_HASH,
            (
                "float cosine = 1.0 - u * depth;",
                "float cosine = 1.0 - u * u * depth;",
            ),
        ],
    ),
    (
        "the light's edge drawn too often",
        &SOFT_SHADOWS,
        &[
            OTHER_HASH,
            (
                "float cosine = 1.0 - u * depth;",
                "float cosine = 1.0 - sqrt(u) * depth;",
            ),
        ],
    ),
    (
        "half of the light",
        &SOFT_SHADOWS,
        &[OTHER_HASH, ("6.28318530718 * turn", "3.14159265359 * turn")],
    ),
    (
        "a larger light",
        &SOFT_SHADOWS,
        &[
            OTHER_HASH,
            ("vec3(3.0, 5.0, -5.0), 0.6", "vec3(3.0, 5.0, -5.0), 0.75"),
        ],
    ),
    (
        "half of the samples",
        &SOFT_SHADOWS,
        &[OTHER_HASH, ("SAMPLES = 16", "SAMPLES = 8")],
    ),
    (
        "samples beside their pixel",
        &SOFT_SHADOWS,
        &[
            OTHER_HASH,
            ("fragCoord.x + random() - 0.5", "fragCoord.x + random()"),
        ],
    ),
    (
        "the same numbers along diagonals",
        &SOFT_SHADOWS,
        &[(
            "pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))))",
            "pcg(uint(fragCoord.x) + uint(fragCoord.y) + pcg(uint(i)))",
        )],
    ),
];

fn assert_verdicts(cases: &[Case], size: [u32; 2], is_right: impl Fn(Verdict) -> bool) {
    let only = std::env::var("TOYPROOF_ONLY").unwrap_or_default();
    let mut wrong = Vec::new();
    for (name, exercise, edits) in cases.iter().filter(|(name, ..)| name.contains(&only)) {
        let start = std::time::Instant::now();
        let (verdict, assert_verdicts) = verdict(exercise, size, edits);
        eprintln!("{name}: {assert_verdicts} ({:.1?})", start.elapsed());
        if !is_right(verdict) {
            wrong.push(format!("{name}: {assert_verdicts}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Correct, but not accepted: few directions hit the lamp, so that eight sets of random numbers do not
/// determine the mean.
static RARE: &[Case] = &[(
    "the BRDF sampled alone",
    &IMPORTANCE_SAMPLING,
    &[OTHER_HASH, (LIGHT, ""), (SHARE, "share = 1.0;")],
)];

#[test]
fn estimators_with_rare_events_are_not_wrong() {
    assert_verdicts(RARE, [160, 90], |verdict| {
        matches!(verdict, Verdict::Correct | Verdict::Inconclusive)
    });
}

#[test]
fn unbiased_estimators_are_correct() {
    assert_verdicts(CORRECT, [160, 90], |verdict| verdict == Verdict::Correct);
}

#[test]
fn biased_estimators_are_rejected() {
    assert_verdicts(BIASED, [160, 90], |verdict| {
        matches!(verdict, Verdict::Wrong | Verdict::Inconclusive)
    });
}

/// A checkered floor. In images of 160×90, the centers of a row of pixels see z = −8 there, which is an edge
/// between squares.
const TIED: &str = "ambient = [0.2, 0.2, 0.2]
[[light]]
position = [3.0, 5.0, 2.0]
color = [0.7, 0.7, 0.7]
[[plane]]
point = [0.0, -1.125, 0.0]
normal = [0.0, 1.0, 0.0]
material = { model = \"lambert\", color = [0.9, 0.9, 0.9], checker = { color = [0.1, 0.1, 0.1], size = 1.0 } }
[[sphere]]
center = [0.3, 0.4, -7.0]
radius = 1.0
material = { model = \"lambert\", color = [0.9, 0.3, 0.2] }
";

#[test]
fn edges_through_pixel_centers_are_not_the_shaders_fault() {
    let exercise = Exercise {
        name: "tied",
        scene: TIED,
        size: [160, 90],
        ..STILL
    };
    let shader = toyproof::scene::export::shader(&scene(&exercise)).unwrap();
    let findings = check_exercise_with(None, &shader, &exercise);
    let assert_verdicts = format!("{}: {:?}", numbers(&findings), findings.reason);
    eprintln!("{assert_verdicts}");
    assert_eq!(findings.verdict, Verdict::Correct, "{assert_verdicts}");
    assert!(
        matches!(findings.reason, Reason::Agrees { tied: 1.., .. }),
        "{assert_verdicts}"
    );
    // A mistake in such a scene is still found.
    let shader = shader.replace("vec3(0.9, 0.3, 0.2)", "vec3(0.9, 0.31, 0.2)");
    let findings = check_exercise_with(None, &shader, &exercise);
    assert_eq!(findings.verdict, Verdict::Wrong, "{:?}", findings.reason);
}

#[test]
fn a_small_object_that_is_missing_is_a_mistake() {
    let scene = |radius: f64| {
        let sphere = format!(
            "{}\n[[sphere]]\ncenter = [1.71, 1.12, -6.0]\nradius = {radius}\n\
             material = {{ model = \"lambert\", color = [0.9, 0.2, 0.2] }}\n",
            SHADING.scene
        );
        Exercise {
            scene: sphere.leak(),
            ..SHADING
        }
    };
    // A disk of a dozen pixels of 14,400, and one of four.
    for (radius, expected) in [(0.075, Verdict::Wrong), (0.04, Verdict::Correct)] {
        let findings = check_exercise_with(None, SHADING.shader, &scene(radius));
        let summary = algorithm(&findings);
        assert!(
            (1..=14).contains(&summary.differing),
            "{radius}: {}",
            numbers(&findings)
        );
        assert_eq!(findings.verdict, expected, "{radius}: {}", numbers(&findings));
        let area = summary.regions.largest_compact.map(|region| region.pixels);
        assert_eq!(area, (expected == Verdict::Wrong).then_some(summary.differing));
    }
}
