//! Tests the checker itself: mistakes that students make in the course's shaders must all be found.
//! `equivalent_rewrites` is the other half.

use toyproof::verify::Verdict;

use crate::requirements::require_worker;
use crate::support::exercises::EDITED;
use crate::support::faults::faults;
use crate::support::{EXERCISES, Exercise, SIZE, algorithm, check_and_name, check_exercise, edited, numbers};

#[test]
fn every_planted_fault_is_found() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let mut missed = Vec::new();
    let mut smallest = (f64::INFINITY, "");
    for (name, exercise, edits) in faults() {
        let shader = edited(exercise, edits);
        let mut findings = check_exercise(&mut worker, &shader, exercise);
        if findings.verdict != Verdict::Wrong {
            // Differences of stochastic pixels are compared by their mean, unless a mistake explains them.
            findings = check_and_name(&mut worker, &shader, exercise);
        }
        if findings.verdict == Verdict::Inconclusive {
            // Too few pixels to compare means.
            let larger = Exercise {
                size: SIZE,
                ..*exercise
            };
            findings = check_and_name(&mut worker, &shader, &larger);
        }
        let share = algorithm(&findings).share(algorithm(&findings).differing);
        eprintln!("{}: {name}: {}", exercise.name, numbers(&findings));
        if share < smallest.0 {
            smallest = (share, name);
        }
        if findings.verdict != Verdict::Wrong {
            missed.push(format!("{}: {name}: {}", exercise.name, numbers(&findings)));
        }
    }
    eprintln!(
        "{} faults; the least visible, “{}”, shows in {:.2} % of the pixels",
        faults().count(),
        smallest.1,
        100.0 * smallest.0
    );
    assert!(missed.is_empty(), "not found:\n{}", missed.join("\n"));
}

#[test]
fn every_exercise_has_faults() {
    for exercise in EXERCISES.into_iter().chain(EDITED.map(|edited| edited.exercise)) {
        let count = faults().filter(|fault| std::ptr::eq(fault.1, exercise)).count();
        assert!(count >= 10, "{}: {count}", exercise.name);
    }
}
