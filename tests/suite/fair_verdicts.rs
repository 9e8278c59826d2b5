//! Right shaders in styles unlike the exercises', all of which must be `correct`, and stochastic ones with a bias, which must not be.
//!
//! The evaluator alone judges them: what a driver makes of a shader is asked elsewhere.

use toyproof::verify::compare::Verdict;

use crate::support::{
    Edit, IMPORTANCE_SAMPLING, MANY_OBJECTS, REFLECTIONS, Rung, SOFT_SHADOWS, STILL, WHITTED, edited,
    judged_by, numbers, scene,
};

/// Judges an edited exercise in a size.
fn verdict(rung: &Rung, size: [u32; 2], edits: &[Edit]) -> (Verdict, String) {
    let rung = Rung { size, ..*rung };
    let findings = judged_by(None, &edited(&rung, edits), &rung);
    let mistake = findings.mistake.iter().flatten().map(|named| named.name);
    let mistake: Vec<_> = mistake.collect();
    let told = format!("{} {mistake:?}: {}", numbers(&findings), findings.reason);
    (findings.verdict, told)
}

/// Where secondary rays of the glass exercise start.
pub(crate) fn glass(way: &str, offset: f64) -> Vec<Edit> {
    let mirrored = "Ray mirrored = Ray(hit.point, reflect(ray.direction, hit.normal));";
    let refracted = "Branch(Ray(hit.point, refracted)";
    let epsilon = "const float EPSILON = 0.001;";
    let least = "const float EPSILON = 0.00001;".to_owned();
    let own = |from: &'static str, to: String| -> Edit { (from, to.leak()) };
    match way {
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

const WAYS: [&str; 3] = ["least t", "along the normal", "along the ray"];

fn glass_is_correct(size: [u32; 2], offsets: &[f64]) {
    let mut wrong = Vec::new();
    for way in WAYS {
        for &offset in offsets {
            let (verdict, told) = verdict(&WHITTED, size, &glass(way, offset));
            eprintln!("{way} {offset}: {told}");
            if verdict != Verdict::Correct {
                wrong.push(format!("{way} {offset}: {told}"));
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
    // Nearer to their surface, float32 has too few digits for b² − c.
    let offsets = [
        1e-4, 2e-4, 3e-4, 3.5e-4, 4e-4, 5e-4, 6e-4, 7e-4, 7.7e-4, 8e-4, 9e-4, 1e-3,
    ];
    glass_is_correct([160, 90], &offsets);
    glass_is_correct([320, 180], &offsets);
}

#[test]
fn a_light_may_be_looked_at_from_where_the_shadow_ray_starts() {
    let edit = (
        "normalize(light.position - hit.point)",
        "normalize(light.position - (hit.point + 0.001 * hit.normal))",
    );
    let (verdict, told) = verdict(&MANY_OBJECTS, [160, 90], &[edit]);
    assert_eq!(verdict, Verdict::Correct, "{told}");
}

const NEAR_TEST: &str = "t > 0.00001) {\n            return t;\n        }\n        t =";
const FAR_TEST: &str = "+ root;\n        if (t > 0.00001)";

/// Rays that meet the surface that they start from, by how far they start off it: in double precision, too, or in float32 alone.
static ACNE: &[Case] = &[
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
    (
        "mirrors, from the surface itself",
        &REFLECTIONS,
        &[("EPSILON = 0.001", "EPSILON = 0.0")],
    ),
    (
        "mirrors, from a little off it",
        &REFLECTIONS,
        &[("EPSILON = 0.001", "EPSILON = 1.0e-9")],
    ),
];

#[test]
fn rays_that_meet_their_own_surface_are_a_mistake_with_a_name() {
    for (name, rung, edits) in ACNE {
        let (verdict, told) = verdict(rung, [160, 90], edits);
        eprintln!("{name}: {told}");
        assert_eq!(verdict, Verdict::Wrong, "{name}: {told}");
        assert!(told.contains("self-intersection"), "{name}: {told}");
    }
}

/// Another hash than the scene's.
const OWN: Edit = ("pcg(uint(i))", "pcg(uint(i) + 1000u)");

const COUNTED_IF_MET: Edit = (
    "if (inShadow(Ray(hit.point + EPSILON * hit.normal, direction), emitter)) {",
    "if (nearestHit(Ray(hit.point + EPSILON * hit.normal, direction)).sphere != emitter) {",
);
const WEIGHT: &str = "* weight(density, other) / density;";
const SHARE: &str = "share = weight(density, lightDensity(ray.origin, spheres[hit.sphere]));";
const LIGHT: &str = "color += throughput * sampleLight(hit, reflected);";
const GO_ON: &str = "ray = Ray(hit.point + EPSILON * hit.normal, direction);";

/// What is done, where, and how.
type Case = (&'static str, &'static Rung, &'static [Edit]);

static CORRECT: &[Case] = &[
    (
        "a lamp counts if it is met",
        &IMPORTANCE_SAMPLING,
        &[COUNTED_IF_MET],
    ),
    (
        "a lamp counts if it is met, and is looked at from where the ray starts",
        &IMPORTANCE_SAMPLING,
        &[
            COUNTED_IF_MET,
            (
                "float cosine = 1.0 - u * coneDepth(hit.point, spheres[emitter]);\n    vec3 direction = around(normalize(spheres[emitter].center - hit.point), cosine, v);",
                "vec3 start = hit.point + EPSILON * hit.normal;\n    float cosine = 1.0 - u * coneDepth(start, spheres[emitter]);\n    vec3 direction = around(normalize(spheres[emitter].center - start), cosine, v);",
            ),
        ],
    ),
    ("another hash", &IMPORTANCE_SAMPLING, &[OWN]),
    (
        "Russian roulette, compensated",
        &IMPORTANCE_SAMPLING,
        &[
            OWN,
            (
                GO_ON,
                "if (random() > 0.8) {\n            return color;\n        }\n        throughput /= 0.8;\n        ray = Ray(hit.point + EPSILON * hit.normal, direction);",
            ),
        ],
    ),
    (
        "lights sampled alone",
        &IMPORTANCE_SAMPLING,
        &[OWN, (WEIGHT, "/ density;"), (SHARE, "share = 0.0;")],
    ),
    (
        "the balance heuristic",
        &IMPORTANCE_SAMPLING,
        &[
            OWN,
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
            OWN,
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
        &[OWN, ("SAMPLES = 16", "SAMPLES = 32")],
    ),
];

static BIASED: &[Case] = &[
    (
        "Russian roulette, not compensated",
        &IMPORTANCE_SAMPLING,
        &[
            OWN,
            (
                GO_ON,
                "if (random() > 0.9) {\n            return color;\n        }\n        ray = Ray(hit.point + EPSILON * hit.normal, direction);",
            ),
        ],
    ),
    (
        "both ways to sample counted in full",
        &IMPORTANCE_SAMPLING,
        &[OWN, (WEIGHT, "/ density;"), (SHARE, "share = 1.0;")],
    ),
    (
        "the number of lamps forgotten",
        &IMPORTANCE_SAMPLING,
        &[OWN, (" * float(EMITTERS));", ");")],
    ),
    (
        "a segment less",
        &IMPORTANCE_SAMPLING,
        &[OWN, ("MAX_DEPTH = 4", "MAX_DEPTH = 3")],
    ),
    (
        "the cosine to the lamp forgotten",
        &IMPORTANCE_SAMPLING,
        &[
            OWN,
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
            OWN,
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
            OWN,
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
            OWN,
            (
                "float cosine = 1.0 - u * depth;",
                "float cosine = 1.0 - sqrt(u) * depth;",
            ),
        ],
    ),
    (
        "half of the light",
        &SOFT_SHADOWS,
        &[OWN, ("6.28318530718 * turn", "3.14159265359 * turn")],
    ),
    (
        "a larger light",
        &SOFT_SHADOWS,
        &[OWN, ("vec3(3.0, 5.0, -5.0), 0.6", "vec3(3.0, 5.0, -5.0), 0.75")],
    ),
    (
        "half of the samples",
        &SOFT_SHADOWS,
        &[OWN, ("SAMPLES = 16", "SAMPLES = 8")],
    ),
    (
        "samples beside their pixel",
        &SOFT_SHADOWS,
        &[OWN, ("fragCoord.x + random() - 0.5", "fragCoord.x + random()")],
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

fn told(cases: &[Case], size: [u32; 2], is_right: impl Fn(Verdict) -> bool) {
    let only = std::env::var("TOYPROOF_ONLY").unwrap_or_default();
    let mut wrong = Vec::new();
    for (name, rung, edits) in cases.iter().filter(|(name, ..)| name.contains(&only)) {
        let start = std::time::Instant::now();
        let (verdict, told) = verdict(rung, size, edits);
        eprintln!("{name}: {told} ({:.1?})", start.elapsed());
        if !is_right(verdict) {
            wrong.push(format!("{name}: {told}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Right, and not accepted: few directions meet the lamp, so that eight sets of random numbers do not tell the mean.
static RARE: &[Case] = &[(
    "the BRDF sampled alone",
    &IMPORTANCE_SAMPLING,
    &[OWN, (LIGHT, ""), (SHARE, "share = 1.0;")],
)];

#[test]
fn estimators_with_rare_events_are_not_wrong() {
    told(RARE, [160, 90], |verdict| {
        matches!(verdict, Verdict::Correct | Verdict::Inconclusive)
    });
}

#[test]
fn unbiased_estimators_are_correct() {
    told(CORRECT, [160, 90], |verdict| verdict == Verdict::Correct);
}

#[test]
fn biased_estimators_are_found() {
    told(BIASED, [160, 90], |verdict| {
        matches!(verdict, Verdict::Wrong | Verdict::Inconclusive)
    });
}

/// A checkered floor. In pictures of 160×90, the middles of a row of pixels see z = −8 there, where squares meet.
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
fn an_edge_of_the_scene_in_a_row_of_pixels_is_not_the_shaders_fault() {
    let rung = Rung {
        name: "tied",
        scene: TIED,
        size: [160, 90],
        ..STILL
    };
    let shader = toyproof::scene::export::shader(&scene(&rung)).unwrap();
    let findings = judged_by(None, &shader, &rung);
    let told = format!("{}: {}", numbers(&findings), findings.reason);
    eprintln!("{told}");
    assert_eq!(findings.verdict, Verdict::Correct, "{told}");
    assert!(findings.reason.contains("an edge of the scene itself"), "{told}");
    // A mistake in such a scene is still found.
    let shader = shader.replace("vec3(0.9, 0.3, 0.2)", "vec3(0.9, 0.31, 0.2)");
    let findings = judged_by(None, &shader, &rung);
    assert_eq!(findings.verdict, Verdict::Wrong, "{}", findings.reason);
}
