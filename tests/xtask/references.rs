//! How verdicts change where a shader is the reference instead of the scene that it renders.

use toyproof::verify::Verdict;
use toyproof_testkit::faults::faults;
use toyproof_testkit::rewrites::rewrites;
use toyproof_testkit::{
    EVERY_EXERCISE, Edit, Exercise, SIZE, check_reference, edited, exported_reference, numbers, try_edit,
};

/// An edit after which the stochastic exercises use other random numbers.
const OTHER_SEED: Edit = ("pcg(uint(i))", "pcg(uint(i) + 1000u)");

/// Prints the planted faults that are not `wrong`, and the rewrites that are not `correct`, where the exported
/// shader of each exercise is the reference. `levels` is the tolerance in 8-bit levels. With `reseed`, the shaders
/// use other random numbers, if they use any of an integer hash.
pub(super) fn print_disagreements(only: &str, levels: f64, reseed: bool) {
    for exercise in EVERY_EXERCISE {
        if exercise.name.contains(only) {
            compare(exercise, levels / 255.0, reseed);
        }
    }
}

fn compare(exercise: &'static Exercise, tolerance: f64, reseed: bool) {
    let larger = Exercise {
        size: SIZE,
        ..*exercise
    };
    let [reference, larger_reference] =
        [exercise, &larger].map(|exercise| exported_reference(exercise, tolerance));
    let (mut all, mut disagreements) = ([0; 2], [0; 2]);
    let mut try_one = |kind: usize, name: &str, edits: &[Edit]| {
        let mut shader = edited(exercise, edits);
        if reseed {
            shader = try_edit(&shader, &[OTHER_SEED]).unwrap_or(shader);
        }
        let mut findings = check_reference(&reference, &shader, exercise);
        if findings.verdict == Verdict::Inconclusive {
            // Too few pixels to compare means.
            findings = check_reference(&larger_reference, &shader, &larger);
        }
        let expected = [Verdict::Wrong, Verdict::Correct][kind];
        all[kind] += 1;
        if findings.verdict != expected {
            disagreements[kind] += 1;
            println!("  {name}: {}", numbers(&findings));
        }
    };
    for (name, _, edits) in faults().filter(|fault| std::ptr::eq(fault.1, exercise)) {
        try_one(0, name, edits);
    }
    for (name, _, edits) in rewrites().filter(|rewrite| std::ptr::eq(rewrite.1, exercise)) {
        try_one(1, name, edits);
    }
    println!(
        "{}: {} of {} faults are not wrong, {} of {} rewrites are not correct",
        exercise.name, disagreements[0], all[0], disagreements[1], all[1]
    );
}
