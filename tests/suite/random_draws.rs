//! Shaders that draw other numbers than their scene are judged by their mean.

use toyproof::verify::compare::Verdict;

use crate::support::{Edit, MANY_OBJECTS, Rung, SIZE, SOFT_SHADOWS, edited, judged};

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

const OTHER_SEED: Edit = ("pcg(uint(i))", "pcg(uint(i) + 1000u)");

/// In each pixel the same.
const SAME_EVERYWHERE: Edit = ("startSample(fragCoord, i)", "startSample(vec2(0.0), i)");

/// One sample in each square of a grid.
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

/// What is drawn, what else is edited, and what is to be said of it.
type Case = (
    &'static Rung,
    &'static [Edit],
    &'static [Edit],
    Verdict,
    &'static str,
);

static CASES: &[Case] = &[
    (
        &MANY_OBJECTS,
        OTHER_HASH,
        &[],
        Verdict::Correct,
        "the same in the mean",
    ),
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        &[],
        Verdict::Correct,
        "the same in the mean",
    ),
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        STRATIFIED,
        Verdict::Correct,
        "the same in the mean",
    ),
    (
        &SOFT_SHADOWS,
        &[SAME_EVERYWHERE],
        &[],
        Verdict::Inconclusive,
        "in neighbouring pixels has much in common",
    ),
    // What only the mean tells: in each of these pixels other draws paint other colours.
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        &[("vec3(3.0, 5.0, -5.0), 0.6", "vec3(3.0, 5.0, -5.0), 1.0")],
        Verdict::Wrong,
        "its mean is another too",
    ),
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        &[("fragCoord.x + random() - 0.5", "fragCoord.x + random()")],
        Verdict::Wrong,
        "its mean is another too",
    ),
    (
        &SOFT_SHADOWS,
        &[OTHER_SEED],
        &[("SAMPLES = 16", "SAMPLES = 6")],
        Verdict::Wrong,
        "it takes fewer samples",
    ),
    // Who draws the scene's own numbers is held to its pixels.
    (
        &SOFT_SHADOWS,
        &[],
        &[("vec3(3.0, 5.0, -5.0), 0.6", "vec3(3.0, 5.0, -5.0), 0.63")],
        Verdict::Wrong,
        "it is the mathematics",
    ),
    // What is wrong in pixels that no draw changes is no matter of chance.
    (
        &MANY_OBJECTS,
        OTHER_HASH,
        &[("vec3(0.9, 0.8, 0.1)", "vec3(0.918, 0.816, 0.102)")],
        Verdict::Wrong,
        "it is the mathematics",
    ),
];

#[test]
fn who_draws_other_numbers_is_judged_by_the_mean() {
    let Some(mut worker) = crate::support::worker() else {
        return;
    };
    for &(rung, draws, edits, verdict, reason) in CASES {
        let rung = &Rung { size: SIZE, ..*rung };
        let findings = judged(&mut worker, &edited(rung, &[draws, edits].concat()), rung);
        let case = format!("{} {edits:?}: {}", rung.name, findings.reason);
        assert_eq!(findings.verdict, verdict, "{case}");
        assert!(findings.reason.contains(reason), "{case}");
    }
}
