//! The tournament of the hypotheses of a field: all of them are tried at the first probes side by side, and
//! those that make progress there are tested at all probes. Numbers are given or fitted.
//!
//! An *entrant* is a hypothesis with the numbers that it tries, an *attempt* has one of these, and a
//! *finalist* is an attempt that was kept.

use super::fit::{Fit, Precision, fitted};
use super::probes::{Outcome, Probes};
use super::{Colors, Field, Numbers, Run, one};

/// The values that a hypothesis tries for its numbers, each with the cost that it then has.
#[derive(Debug, Clone)]
pub(crate) enum Values {
    /// It has no number to be found.
    Fixed,
    /// Some numbers, and if it may be fitted, how.
    Tried {
        values: Vec<(f64, u32)>,
        fit: Option<(u32, Fit)>,
    },
}

impl Values {
    /// Only fitted numbers, at no cost.
    pub(crate) fn fitted(fit: Fit) -> Self {
        Self::Tried {
            values: Vec::new(),
            fit: Some((0, fit)),
        }
    }
}

/// A hypothesis of the field, with the numbers that it tries.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entrant<'a> {
    pub(crate) values: &'a Values,
    pub(crate) cost: u32,
}

/// An attempt that passes or makes progress, with its outcome.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Finalist {
    pub(crate) hypothesis: usize,
    pub(crate) numbers: Numbers,
    pub(crate) cost: u32,
    pub(crate) outcome: Outcome,
}

/// A hypothesis, by its place in the field, with numbers and their cost.
#[derive(Debug, Clone, Copy)]
struct Attempt {
    hypothesis: usize,
    numbers: Numbers,
    cost: u32,
}

/// Tries the hypotheses of a field, and returns those that pass or make progress.
pub(crate) fn play(field: &mut dyn Field, entrants: &[Entrant], probes: &Probes) -> Vec<Finalist> {
    let passes = vec![false; entrants.len()];
    let mut tournament = Tournament {
        field,
        entrants,
        probes,
        found: Vec::new(),
        passes,
    };
    tournament.given_numbers();
    tournament.fitted_numbers();
    tournament.found
}

/// Tries hypotheses without numbers, and returns those that pass, with their outcomes.
pub(crate) fn passing(field: &mut dyn Field, count: usize, probes: &Probes) -> Vec<(usize, Outcome)> {
    let entrants = vec![
        Entrant {
            values: &Values::Fixed,
            cost: 0
        };
        count
    ];
    let finalists = play(field, &entrants, probes).into_iter();
    let passing = finalists.filter(|finalist| finalist.outcome.passes);
    passing
        .map(|finalist| (finalist.hypothesis, finalist.outcome))
        .collect()
}

struct Tournament<'a> {
    field: &'a mut dyn Field,
    entrants: &'a [Entrant<'a>],
    probes: &'a Probes,
    found: Vec<Finalist>,
    /// Whether each hypothesis passes with some number.
    passes: Vec<bool>,
}

impl Tournament<'_> {
    /// Tries the hypotheses that have no number, or whose numbers are given.
    fn given_numbers(&mut self) {
        let mut attempts = Vec::new();
        for (hypothesis, entrant) in self.entrants.iter().enumerate() {
            let attempt = |numbers, cost| Attempt {
                hypothesis,
                numbers,
                cost,
            };
            match entrant.values {
                Values::Fixed => attempts.push(attempt(Numbers::default(), entrant.cost)),
                Values::Tried { values, .. } => {
                    attempts.extend(values.iter().map(|&(value, cost)| attempt(one(value), cost)));
                }
            }
        }
        for (attempt, colors) in self.screened(attempts) {
            if let Some(outcome) = self.outcome(attempt, &colors) {
                self.record(attempt, outcome);
            }
        }
    }

    /// Fits the numbers of the hypotheses that allow it, and do not pass with a given one.
    fn fitted_numbers(&mut self) {
        let fits = self
            .entrants
            .iter()
            .enumerate()
            .filter(|&(at, _)| !self.passes[at]);
        let fits = fits.filter_map(|(at, entrant)| match entrant.values {
            Values::Tried {
                fit: Some((cost, fit)),
                ..
            } => Some((*cost, (at, *fit))),
            _ => None,
        });
        let (costs, fits): (Vec<u32>, Vec<(usize, Fit)>) = fits.unzip();
        let found = fitted(self.probes, self.field, &fits);
        let attempt = |(fit, numbers): (usize, Numbers)| Attempt {
            hypothesis: fits[fit].0,
            numbers,
            cost: costs[fit],
        };
        for (attempt, colors) in self.screened(found.into_iter().map(attempt).collect()) {
            if self.passes[attempt.hypothesis] {
                continue;
            }
            let Some(exact) = self.outcome(attempt, &colors) else {
                continue;
            };
            if !(exact.passes && self.passes_with_shorter(attempt)) {
                self.record(attempt, exact);
            }
        }
    }

    /// Tries the shorter numbers near those of an attempt, and returns whether one passes.
    fn passes_with_shorter(&mut self, attempt: Attempt) -> bool {
        // Authors usually write the shortest number that passes.
        for numbers in Precision::at(self.probes).shorter(&attempt.numbers) {
            let shorter = Attempt { numbers, ..attempt };
            // Attempts that only make progress are kept, too.
            if let Some(outcome) = self.outcome(shorter, &[])
                && self.record(shorter, outcome)
            {
                return true;
            }
        }
        false
    }

    /// The attempts that make progress at the first probes, with their colors there.
    fn screened(&mut self, attempts: Vec<Attempt>) -> Vec<(Attempt, Colors)> {
        let probes = 0..self.probes.screening();
        let runs: Vec<Run> = attempts
            .iter()
            .map(|attempt| attempt.run(probes.clone()))
            .collect();
        let colors = self.field.colors(self.probes, &runs);
        let may_pass_at_once = self.probes.are_means() || self.probes.grid.is_some();
        let is_promising = |colors: &Colors| {
            let outcome = self.probes.outcome(colors);
            outcome.is_some_and(|outcome| outcome.is_progress() || may_pass_at_once && outcome.passes)
        };
        let screened = attempts.into_iter().zip(colors);
        screened
            .filter_map(|(attempt, colors)| Some((attempt, colors.filter(&is_promising)?)))
            .collect()
    }

    /// Tests an attempt at all probes, but stops after the first ones if it fails there. `known` are its
    /// colors there, if computed.
    fn outcome(&mut self, attempt: Attempt, known: &[[f64; 3]]) -> Option<Outcome> {
        self.probes.test(|probes| {
            if probes.start == 0 && known.len() == probes.end {
                return Some(known.to_vec());
            }
            self.field.run(self.probes, attempt.run(probes))
        })
    }

    /// Keeps an attempt that passes or makes progress, and returns whether it passes.
    fn record(&mut self, attempt: Attempt, outcome: Outcome) -> bool {
        let Attempt {
            hypothesis,
            numbers,
            cost,
        } = attempt;
        self.passes[hypothesis] |= outcome.passes;
        if outcome.passes || outcome.is_progress() {
            self.found.push(Finalist {
                hypothesis,
                numbers,
                cost,
                outcome,
            });
        }
        outcome.passes
    }
}

impl Attempt {
    fn run(&self, probes: std::ops::Range<usize>) -> Run {
        Run {
            hypothesis: Some(self.hypothesis),
            numbers: self.numbers,
            probes,
        }
    }
}
