//! Shaders whose random numbers differ from their scene's are compared by their mean.

use toyproof::verify::{Means, Reason, Verdict};

use crate::requirements::require_worker;
use crate::support::{Edit, Exercise, MANY_OBJECTS, SIZE, SOFT_SHADOWS, check_exercise, edited};

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

/// An integer hash instead of the sine hash.
pub(crate) const OTHER_HASH: &[Edit] = &[
    ("float seed;\n\nfloat random() {…}\n", HASH),
    ("    seed = 0.0;\n", ""),
    (
        "i < SAMPLES; i++) {\n",
        "i < SAMPLES; i++) {\n        startSample(fragCoord, i);\n",
    ),
];

const OTHER_SEED: Edit = ("pcg(uint(i))", "pcg(uint(i) + 1000u)");

/// The same random numbers in each pixel.
const SAME_EVERYWHERE: Edit = ("startSample(fragCoord, i)", "startSample(vec2(0.0), i)");

/// One sample per cell of a grid.
const STRATIFIED: &[Edit] = &[
    (
        "fragCoord.x + random() - 0.5",
        "fragCoord.x + (float(i % 4) + random()) / 4.0 - 0.5",
    ),
    (
        "fragCoord.y + random() - 0.5",
        "fragCoord.y + (float(i / 4) + random()) / 4.0 - 0.5",
    ),
];

/// The edits of the sampling, the other edits, the expected verdict, and whether the comparison of the means,
/// if there is one, is the expected one.
type Case = (
    &'static Exercise,
    &'static [Edit],
    &'static [Edit],
    Verdict,
    fn(Option<Means>) -> bool,
);

static CASES: &[Case] = &[
    (&MANY_OBJECTS, OTHER_HASH, &[], Verdict::Correct, |means| {
        matches!(means, Some(Means::Same { .. }))
    }),
    (&SOFT_SHADOWS, &[OTHER_SEED], &[], Verdict::Correct, |means| {
        matches!(means, Some(Means::Same { .. }))
    }),
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        STRATIFIED,
        Verdict::Correct,
        |means| matches!(means, Some(Means::Same { .. })),
    ),
    (
        &SOFT_SHADOWS,
        &[SAME_EVERYWHERE],
        &[],
        Verdict::Inconclusive,
        |means| means == Some(Means::Correlated),
    ),
    // Faults that only the mean shows: in each of these pixels, different random numbers give different
    // colors.
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        &[("vec3(3.0, 5.0, -5.0), 0.6", "vec3(3.0, 5.0, -5.0), 1.0")],
        Verdict::Wrong,
        |means| matches!(means, Some(Means::Different { .. })),
    ),
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        &[("fragCoord.x + random() - 0.5", "fragCoord.x + random()")],
        Verdict::Wrong,
        |means| matches!(means, Some(Means::Different { .. })),
    ),
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        &[("SAMPLES = 16", "SAMPLES = 6")],
        Verdict::Wrong,
        |means| matches!(means, Some(Means::FewerSamples { .. })),
    ),
    // Shaders with the scene's own random numbers are compared pixel by pixel.
    (
        &SOFT_SHADOWS,
        &[],
        &[("vec3(3.0, 5.0, -5.0), 0.6", "vec3(3.0, 5.0, -5.0), 0.63")],
        Verdict::Wrong,
        |means| means.is_none(),
    ),
    // Errors in pixels that no random number affects are not stochastic.
    (
        &MANY_OBJECTS,
        OTHER_HASH,
        &[("vec3(0.9, 0.8, 0.1)", "vec3(0.918, 0.816, 0.102)")],
        Verdict::Wrong,
        |means| means.is_none(),
    ),
];

#[test]
fn different_random_numbers_are_compared_by_the_mean() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    for &(exercise, draws, edits, verdict, is_expected) in CASES {
        let exercise = &Exercise {
            size: SIZE,
            ..*exercise
        };
        let findings = check_exercise(&mut worker, &edited(exercise, &[draws, edits].concat()), exercise);
        let case = format!("{} {edits:?}: {:?}", exercise.name, findings.reason);
        assert_eq!(findings.verdict, verdict, "{case}");
        let means = match findings.reason {
            Reason::OtherRandomNumbers { means, .. } => Some(means),
            _ => None,
        };
        assert!(is_expected(means), "{case}");
    }
}
