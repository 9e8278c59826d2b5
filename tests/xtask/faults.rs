//! The names of planted faults, alone and in pairs.

use std::time::{Duration, Instant};

use toyproof_testkit::faults::{faults, hypotheses, name, named_faults};
use toyproof_testkit::{EVERY_EXERCISE, Exercise, edited, try_edit};

/// Every `PAIR_STEP`th pair of an exercise's faults is tried.
const PAIR_STEP: usize = 23;

fn exercises(only: &str) -> impl Iterator<Item = &'static Exercise> {
    EVERY_EXERCISE
        .into_iter()
        .filter(move |exercise| exercise.name.contains(only))
}

pub(super) fn print_names(only: &str) {
    for exercise in exercises(only) {
        for line in named_faults(exercise) {
            println!("{line}");
        }
    }
}

pub(super) fn print_pairs(only: &str) {
    let (mut all, mut explained, mut right) = (0, 0, 0);
    let (mut longest, mut spent) = (Duration::ZERO, Duration::ZERO);
    for exercise in exercises(only) {
        let hypotheses = hypotheses(exercise);
        let own: Vec<_> = faults().filter(|fault| std::ptr::eq(fault.1, exercise)).collect();
        let alone: Vec<String> = own
            .iter()
            .map(|(_, _, edits)| name(exercise, &hypotheses, &edited(exercise, edits), 0))
            .collect();
        let pairs = (0..own.len()).flat_map(|one| (one + 1..own.len()).map(move |other| (one, other)));
        for (one, other) in pairs.step_by(PAIR_STEP) {
            let Ok(both) = try_edit(&edited(exercise, own[one].2), own[other].2) else {
                continue;
            };
            let start = Instant::now();
            let name = name(exercise, &hypotheses, &both, usize::MAX);
            let took = start.elapsed();
            (longest, spent) = (longest.max(took), spent + took);
            let mut names: Vec<_> = name.split('+').collect();
            names.sort_unstable();
            let mut own_names = [alone[one].as_str(), &alone[other]];
            own_names.sort_unstable();
            all += 1;
            explained += usize::from(!name.is_empty());
            right += usize::from(names == own_names);
            println!("{took:5.2?} {}: {own_names:?}: {name}", exercise.name);
        }
    }
    println!(
        "{explained} of {all} pairs are explained, {right} by their own names; {spent:.1?} in all, {longest:.1?} at most"
    );
}
