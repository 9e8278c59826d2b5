//! The trials of a group of candidates: all of them are screened at a few wrong pixels side by side, and
//! those that make progress there are tested at all probes.

use super::edit::{Candidate, Trials};
use super::fit::{Fit, fitted, fitted_colors, roundings};
use super::group::{Group, Run};
use super::probe::{Outcome, Probes};
use super::term::Numbers;

/// The share of the differences that an edit must remove to be half of a repair.
const MIN_PROGRESS: f64 = 0.25;

/// A candidate that was tried, with its numbers.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    pub(super) candidate: Candidate,
    pub(super) outcome: Outcome,
}

/// A candidate of the group with numbers, and their cost.
#[derive(Debug, Clone, Copy)]
struct Attempt {
    candidate: usize,
    numbers: Numbers,
    cost: u32,
}

/// Tries the candidates of a group, and returns those that pass or make progress. `before` are the colors of
/// the shader at the probes.
pub(super) fn try_group(
    group: &mut Group,
    candidates: &[&Candidate],
    probes: &Probes,
    before: &[[f64; 3]],
) -> Vec<Trial> {
    let mut trials = GroupTrials {
        group,
        candidates,
        probes,
        before,
        found: Vec::new(),
        passes: vec![false; candidates.len()],
    };
    trials.given_numbers();
    trials.fitted_numbers();
    trials.fitted_colors();
    trials.found
}

struct GroupTrials<'a, 'g, 'e> {
    group: &'a mut Group<'g, 'e>,
    candidates: &'a [&'a Candidate],
    probes: &'a Probes,
    before: &'a [[f64; 3]],
    found: Vec<Trial>,
    /// Whether each candidate passes with some number.
    passes: Vec<bool>,
}

impl GroupTrials<'_, '_, '_> {
    /// Tries the edits that have no number, or whose numbers are given.
    fn given_numbers(&mut self) {
        let mut attempts = Vec::new();
        for (at, candidate) in self.candidates.iter().enumerate() {
            let attempt = |numbers, cost| Attempt {
                candidate: at,
                numbers,
                cost,
            };
            match &candidate.trials {
                Trials::Once => attempts.push(attempt(Numbers::default(), candidate.cost)),
                Trials::Values { values, .. } => {
                    attempts.extend(values.iter().map(|&(value, cost)| attempt(one(value), cost)));
                }
                Trials::Color(_) => {}
            }
        }
        for attempt in self.screened(attempts) {
            self.test(attempt);
        }
    }

    /// Fits the numbers of the edits that allow it, and do not pass with a given one.
    fn fitted_numbers(&mut self) {
        let fits = |(at, candidate): (usize, &&Candidate)| match candidate.trials {
            Trials::Values {
                fit: Some((cost, start)),
                ..
            } if !self.passes[at] => Some(Fit {
                candidate: at,
                start,
                cost,
            }),
            _ => None,
        };
        let fits: Vec<Fit> = self.candidates.iter().enumerate().filter_map(fits).collect();
        let found = fitted(self.probes, self.group, &fits, self.before);
        let attempts = found.into_iter().map(|(fit, number)| Attempt {
            candidate: fits[fit].candidate,
            numbers: one(number),
            cost: fits[fit].cost,
        });
        for attempt in self.screened(attempts.collect()) {
            let Some(exact) = self.outcome(attempt).filter(|_| !self.passes[attempt.candidate]) else {
                continue;
            };
            // An author wrote the shortest number that passes.
            let shorter = |number: f64| Attempt {
                numbers: one(number),
                ..attempt
            };
            let is_found = exact.passes
                && roundings(attempt.numbers[0], self.probes.are_means())
                    .into_iter()
                    .any(|number| self.test(shorter(number)));
            if !is_found {
                self.record(attempt, exact);
            }
        }
    }

    /// Fits the colors.
    fn fitted_colors(&mut self) {
        for (at, candidate) in self.candidates.iter().enumerate() {
            let Trials::Color(start) = &candidate.trials else {
                continue;
            };
            for numbers in fitted_colors(self.probes, self.group, at, start, self.before) {
                let attempt = Attempt {
                    candidate: at,
                    numbers,
                    cost: candidate.cost,
                };
                if self.test(attempt) {
                    break;
                }
            }
        }
    }

    /// The attempts that make progress at the first probes.
    fn screened(&mut self, attempts: Vec<Attempt>) -> Vec<Attempt> {
        let runs: Vec<Run> = attempts
            .iter()
            .map(|attempt| Run {
                candidate: Some(attempt.candidate),
                numbers: attempt.numbers,
                probes: 0..self.probes.screening(),
            })
            .collect();
        let colors = self.group.colors(self.probes, &runs);
        let are_means = self.probes.are_means();
        let is_promising = |colors: Option<Vec<[f64; 3]>>| {
            let outcome = colors.and_then(|colors| self.probes.outcome(&colors, self.before));
            outcome.is_some_and(|outcome| is_progress(&outcome) || are_means && outcome.passes)
        };
        attempts
            .into_iter()
            .zip(colors)
            .filter_map(|(attempt, colors)| is_promising(colors).then_some(attempt))
            .collect()
    }

    /// Tests an attempt at all probes, or the first if it fails there, and returns whether it passes.
    fn test(&mut self, attempt: Attempt) -> bool {
        let Some(outcome) = self.outcome(attempt) else {
            return false;
        };
        self.record(attempt, outcome);
        outcome.passes
    }

    fn outcome(&mut self, attempt: Attempt) -> Option<Outcome> {
        let run = |probes| Run {
            candidate: Some(attempt.candidate),
            numbers: attempt.numbers,
            probes,
        };
        self.probes
            .test(self.before, |probes| self.group.run(self.probes, run(probes)))
    }

    /// Keeps an attempt that passes or makes progress.
    fn record(&mut self, attempt: Attempt, outcome: Outcome) {
        self.passes[attempt.candidate] |= outcome.passes;
        if outcome.passes || is_progress(&outcome) {
            let candidate = self.candidates[attempt.candidate].with_numbers(&attempt.numbers, attempt.cost);
            self.found.push(Trial { candidate, outcome });
        }
    }
}

/// Whether an edit may be half of a repair.
fn is_progress(outcome: &Outcome) -> bool {
    outcome.repaired > outcome.broken || (outcome.broken == 0 && outcome.remaining < 1.0 - MIN_PROGRESS)
}

/// The numbers of an edit that has one.
pub(super) fn one(number: f64) -> Numbers {
    [number, 0.0, 0.0]
}
