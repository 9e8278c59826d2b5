//! Tests the checker itself: equivalent rewrites of a shader must stay correct. `planted_faults` is the other
//! half.

use std::fmt;
use std::sync::LazyLock;

use toyproof::eval::{Program, Settings};
use toyproof::explain::Findings;
use toyproof::tracer::{ColorRange, EpsilonSet};
use toyproof::verify::Verdict;
use toyproof::verify::compare::EXACT_TOLERANCE;

use crate::requirements::{require_driver, require_worker};
use crate::support::exercises::{EDITED, Edited};
use crate::support::rewrites::{REWRITES, rewrites};
use crate::support::{
    DISNEY, EXERCISES, Exercise, algorithm, check_exercise, checked, edited, frame, numbers, tracer,
};

/// A rewrite and its findings.
struct Outcome {
    name: &'static str,
    exercise: &'static Exercise,
    shader: String,
    findings: Findings,
}

/// All rewrites, checked once for all tests here.
static OUTCOMES: LazyLock<Vec<Outcome>> = LazyLock::new(|| {
    let mut worker = require_worker().expect("there is a driver");
    let mut outcomes = Vec::new();
    for (name, exercise, edits) in rewrites() {
        let shader = edited(exercise, edits);
        let findings = check_exercise(&mut worker, &shader, exercise);
        eprintln!("{}: {name}: {}", exercise.name, numbers(&findings));
        outcomes.push(Outcome {
            name,
            exercise,
            shader,
            findings,
        });
    }
    outcomes
});

#[test]
fn every_rewrite_stays_correct() {
    if !require_driver() {
        return;
    }
    let outcomes = &*OUTCOMES;
    let undecided = |outcome: &&Outcome| algorithm(&outcome.findings).ill_conditioned;
    if let Some(most) = outcomes.iter().max_by_key(undecided) {
        eprintln!(
            "{} rewrites; “{}” of {} leaves most undecided: {:.2} % of the pixels",
            outcomes.len(),
            most.name,
            most.exercise.name,
            100.0 * algorithm(&most.findings).share(undecided(&most)),
        );
    }
    let failed: Vec<_> = outcomes
        .iter()
        .filter(|outcome| outcome.findings.verdict != Verdict::Correct)
        .map(|outcome| {
            format!(
                "{}: {}: {}",
                outcome.exercise.name,
                outcome.name,
                numbers(&outcome.findings)
            )
        })
        .collect();
    assert!(failed.is_empty(), "not correct:\n{}", failed.join("\n"));
}

/// The sixth class starts its shadow rays 0.01 off the surface.
#[test]
fn scenes_set_the_offset_of_ray_origins() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let shader = edited(&DISNEY, &[("0.001 * normal", "0.01 * normal")]);
    let scene: &'static str = Box::leak(format!("max_offset = 0.01\n{}", DISNEY.scene).into_boxed_str());
    let allowed = check_exercise(&mut worker, &shader, &Exercise { scene, ..DISNEY });
    assert_eq!(allowed.verdict, Verdict::Correct, "{}", numbers(&allowed));
    let unsaid = check_exercise(&mut worker, &shader, &DISNEY);
    assert!(algorithm(&unsaid).differing > 0, "{}", numbers(&unsaid));
}

#[test]
fn every_exercise_has_rewrites() {
    for exercise in EXERCISES {
        let count = REWRITES
            .iter()
            .filter(|(_, exercises, edits)| {
                !edits.is_empty() && exercises.iter().any(|&one| std::ptr::eq(one, exercise))
            })
            .count();
        assert!(count >= 16, "{}: {count}", exercise.name);
    }
    for Edited {
        exercise, rewrites, ..
    } in EDITED
    {
        let named = rewrites.iter().copied().flatten();
        let count = named.filter(|(_, edits)| !edits.is_empty()).count();
        assert!(count >= 5, "{}: {count}", exercise.name);
    }
}

/// The tolerance may exceed the measured need by this factor, since other drivers round differently.
const TOLERANCE_MARGIN: f64 = 10.0;

/// Correct shaders need the tolerance for colors outside of the accepted range in f64. Differences beyond it
/// are outliers, so shaders with differing or ill-conditioned pixels are left out.
#[test]
fn the_tolerance_is_no_larger_than_needed() {
    if !require_driver() {
        return;
    }
    let outcomes = &*OUTCOMES;
    let mut needed = Largest::default();
    for exercise in EXERCISES {
        let hulls = hulls(exercise);
        for outcome in outcomes
            .iter()
            .filter(|outcome| std::ptr::eq(outcome.exercise, exercise))
        {
            let (program, frame) = (
                Program::new(&checked(&outcome.shader)).unwrap(),
                frame(exercise, exercise.size),
            );
            let exact = program.render::<f64>(&frame, &Settings::default()).unwrap();
            let outside = |(hull, [r, g, b, _]): (&ColorRange, &[f32; 4])| {
                hull.distance([r, g, b].map(|&c| f64::from(c)))
            };
            let excess = hulls
                .iter()
                .zip(exact.framebuffer.image().pixels())
                .map(outside)
                .fold(0.0, f64::max);
            if algorithm(&outcome.findings).is_same() {
                needed.see(excess, outcome);
            }
        }
    }
    eprintln!("the largest excess over the hull is {needed}");
    assert!(
        EXACT_TOLERANCE < TOLERANCE_MARGIN * needed.value,
        "the tolerance {EXACT_TOLERANCE:.1e} has become too large: the largest excess is {needed}"
    );
}

/// The accepted color range of each pixel, bottom row first.
fn hulls(exercise: &Exercise) -> Vec<ColorRange> {
    let tracer = tracer(exercise);
    let [width, height] = exercise.size;
    (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| tracer.color_range(x, y, EpsilonSet::Alike))
        .collect()
}

/// The largest of several numbers and its origin.
#[derive(Default)]
struct Largest {
    value: f64,
    from: String,
}

impl Largest {
    fn see(&mut self, value: f64, Outcome { name, exercise, .. }: &Outcome) {
        if value > self.value {
            self.value = value;
            self.from = format!("“{name}” of {}", exercise.name);
        }
    }
}

impl fmt::Display for Largest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1e}, by {}", self.value, self.from)
    }
}
