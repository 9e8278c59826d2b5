//! Shaders that draw other numbers than their scene are wrong as far as can be told, and are told that this may be all.

use toyproof::compare::Verdict;

use crate::support::{Edit, MANY_OBJECTS, Rung, SOFT_SHADOWS, edited, judged};

const HASH: &str = "uint state;

uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

void startSample(vec2 fragCoord, int i) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
}
";

/// An integer hash instead of the sine.
const OTHER_HASH: &[Edit] = &[
    ("float seed;\n\nfloat random() {…}\n", HASH),
    ("    seed = 0.0;\n", ""),
    (
        "i < SAMPLES; i++) {\n",
        "i < SAMPLES; i++) {\n        startSample(fragCoord, i);\n",
    ),
];

const OTHER_SEED: &[Edit] = &[("pcg(uint(i))", "pcg(uint(i) + 7u)")];

/// Other draws, and what is wrong beside them in pixels that no draw changes.
static CASES: [(&Rung, &[Edit], Edit); 2] = [
    (
        &MANY_OBJECTS,
        OTHER_HASH,
        ("vec3(0.9, 0.8, 0.1)", "vec3(0.918, 0.816, 0.102)"),
    ),
    (
        &SOFT_SHADOWS,
        OTHER_SEED,
        ("vec3(0.9, 0.4, 0.2)", "vec3(0.918, 0.408, 0.204)"),
    ),
];

#[test]
fn who_draws_other_numbers_is_told_so_and_who_is_wrong_beside_them_is_not() {
    let Some(mut worker) = crate::support::worker() else {
        return;
    };
    for (rung, draws, fault) in CASES {
        let told = "only where the samples' random numbers decide";
        let drawn = judged(&mut worker, &edited(rung, draws), rung);
        assert_eq!(drawn.verdict, Verdict::Wrong, "{}", rung.name);
        assert!(
            drawn.reason.contains(told) && !drawn.reason.contains("it is the mathematics"),
            "{}: {}",
            rung.name,
            drawn.reason
        );
        for edits in [&[draws, &[fault]].concat(), &vec![fault]] {
            let wrong = judged(&mut worker, &edited(rung, edits), rung);
            assert_eq!(wrong.verdict, Verdict::Wrong, "{}", rung.name);
            assert!(!wrong.reason.contains(told), "{}: {}", rung.name, wrong.reason);
        }
    }
}
