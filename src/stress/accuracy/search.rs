//! The search for the inputs with the largest errors: random and special cases, then rounds of neighbors of
//! the worst ones.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use toyproof_verify::debug::ulps;

use super::Case;
use super::domain::Domain;
use super::evaluator::Evaluator;
use super::interface::Interface;
use super::measure::{Comparison, Measured, Sensitivity};
use super::sample::Sampler;
use crate::run::RunError;

/// The most cases that are evaluated at once.
const BATCH: usize = 1 << 14;

/// The rounds of neighbors.
const ROUNDS: usize = 14;

/// The neighbors of a round for each goal, of all outputs together, and of one at most.
const ALL_NEIGHBORS: usize = 1 << 14;
const NEIGHBORS: usize = 1 << 12;

/// The cases of a population whose neighbors are tried.
const MEMBERS: usize = 12;

/// The most outputs whose worst cases are refined: as many as a `mat4` has.
const MAX_REFINED_OUTPUTS: usize = 16;

/// The number of special cases, for each random one.
const SPECIAL_SHARE: f64 = 0.25;

/// The evaluations in f64 that a round spends on sensitivities.
const SENSITIVITY_EVALUATIONS: usize = 1 << 15;

/// A case is certain if the uncertainty of its reference in f64 is at most this share of its error, and of
/// the reference itself, which has the unit of the error. Others are compared with exact results.
const MAX_REFERENCE_SHARE: f64 = 0.125;

/// The most time for exact results of uncertain cases: a function that takes long has only certain ones.
const MAX_EXACT_TIME: Duration = Duration::from_secs(1);

/// The least number of units in the last place that a normal f32 has.
const ULPS_OF_REFERENCE: f64 = (1u32 << (f32::MANTISSA_DIGITS - 1)) as f64;

/// Errors up to this, in ULPs, are those of a few roundings, and not searched for a formula's fault.
const FEW_ULPS: f64 = 2.0;

/// What the search is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Goal {
    /// The largest error.
    Error,
    /// The error that is largest beside what rounding the inputs explains.
    Excess,
}

/// A case with the score of a goal.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) measured: Measured,
    pub(super) error: f64,
    /// The error of f64 in units in the last place of f32, if the reference has 160 bits.
    pub(super) double_error: Option<f64>,
    pub(super) sensitivity: Option<Sensitivity>,
    score: f64,
}

impl Candidate {
    fn new(measured: Measured, error: f64, sensitivity: Option<Sensitivity>) -> Self {
        let score = sensitivity
            .as_ref()
            .map_or(error, |sensitivity| sensitivity.excess(error));
        Self {
            measured,
            error,
            double_error: None,
            sensitivity,
            score,
        }
    }
}

/// What is found.
#[derive(Debug)]
pub(super) struct Found {
    /// The random cases.
    pub(super) random: Vec<Measured>,
    /// What is found for each output.
    pub(super) outputs: Vec<Worst>,
    /// The number of evaluated cases.
    pub(super) evaluated: u64,
    /// Whether the time limit ended the search.
    pub(super) is_cut: bool,
}

/// The worst cases of an output.
#[derive(Debug, Default)]
pub(super) struct Worst {
    /// The case with the largest error.
    pub(super) error: Option<Candidate>,
    /// The case whose error exceeds most what rounding its inputs explains.
    pub(super) excess: Option<Candidate>,
    /// The largest absolute error.
    pub(super) absolute: f64,
    /// A case in which f32 has NaN or infinity, and the reference does not.
    pub(super) not_finite: Option<Measured>,
}

/// The limits of a search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits<'a> {
    /// The number of random cases.
    pub(super) cases: usize,
    pub(super) seed: u64,
    /// The time for the search.
    pub(super) time: Option<Duration>,
    pub(super) interrupt: &'a AtomicBool,
}

/// The number of steps of a search, each of which calls `done`.
pub(super) const STEPS: u64 = 1 + ROUNDS as u64;

/// Searches the domain of a function.
pub(super) fn search(
    evaluator: &Evaluator,
    interface: &Interface,
    domain: &Domain,
    limits: Limits,
    done: &dyn Fn(),
) -> Result<Found, RunError> {
    let start = Instant::now();
    let mut search = Search {
        evaluator,
        interface,
        sampler: Sampler::new(interface, domain, limits.seed, "cases"),
        found: Found {
            random: Vec::new(),
            outputs: interface.outputs.iter().map(|_| Worst::default()).collect(),
            evaluated: 0,
            is_cut: false,
        },
        exact_time: Duration::ZERO,
    };
    let check = || {
        if limits.interrupt.load(Ordering::Relaxed) {
            return Err(RunError::Interrupted);
        }
        Ok(())
    };
    let mut first = Vec::new();
    for kind in [Sampler::uniform, Sampler::special] {
        let is_special = !first.is_empty();
        let share = if is_special { SPECIAL_SHARE } else { 1.0 };
        let mut left = (limits.cases as f64 * share).ceil() as usize;
        while left > 0 && !search.found.is_cut {
            check()?;
            let count = left.min(BATCH);
            let cases = (0..count).map(|_| kind(&mut search.sampler)).collect();
            first.extend(search.measure(cases)?);
            left -= count;
            search.found.is_cut = limits.time.is_some_and(|limit| start.elapsed() > limit / 2);
        }
        if !is_special {
            search.found.random.clone_from(&first);
        }
    }
    let mut populations = search.populations(&first)?;
    done();
    for _ in 0..ROUNDS {
        check()?;
        let round = Instant::now();
        for population in &mut populations {
            search.refine(population)?;
        }
        done();
        // Rounds take about the same time, and the rest of the examination takes that of a few.
        if limits
            .time
            .is_some_and(|limit| start.elapsed() + 4 * round.elapsed() > limit)
        {
            search.found.is_cut = true;
            break;
        }
    }
    for population in populations {
        search.keep(population)?;
    }
    Ok(search.found)
}

/// Candidates for one goal and output, the best first.
struct Population {
    output: usize,
    goal: Goal,
    members: Vec<Candidate>,
}

struct Search<'a> {
    evaluator: &'a Evaluator<'a>,
    interface: &'a Interface,
    sampler: Sampler<'a>,
    found: Found,
    /// The time that exact results of uncertain cases took.
    exact_time: Duration,
}

impl Search<'_> {
    /// Evaluates cases, and notes what is not finite and the absolute errors.
    fn measure(&mut self, cases: Vec<Case>) -> Result<Vec<Measured>, RunError> {
        self.found.evaluated += cases.len() as u64;
        let measured = self.evaluator.measure(cases)?;
        for (output, worst) in self.found.outputs.iter_mut().enumerate() {
            for one in &measured {
                match one.compare(self.interface, output) {
                    Comparison::NotFinite => {
                        worst.not_finite.get_or_insert_with(|| one.clone());
                    }
                    Comparison::Error(_) => {
                        let absolute = (one.single[output] - one.reference[output]).abs();
                        worst.absolute = worst.absolute.max(absolute);
                    }
                    Comparison::Undefined => {}
                }
            }
        }
        Ok(measured)
    }

    /// The populations that begin with the first cases.
    fn populations(&mut self, first: &[Measured]) -> Result<Vec<Population>, RunError> {
        let ranked = (0..self.interface.outputs.len()).map(|output| {
            let error = |one| Some((Measured::error(one, self.interface, output)?, one));
            let mut sorted: Vec<(f64, &Measured)> = first.iter().filter_map(error).collect();
            sorted.sort_by(|a, b| b.0.total_cmp(&a.0));
            (output, sorted)
        });
        let mut ranked: Vec<_> = ranked.filter(|(_, sorted)| !sorted.is_empty()).collect();
        ranked.sort_by(|(_, a), (_, b)| b[0].0.total_cmp(&a[0].0));
        let mut populations = Vec::new();
        for (rank, (output, sorted)) in ranked.into_iter().enumerate() {
            for goal in [Goal::Error, Goal::Excess] {
                // The worst errors are often those of ill-conditioned inputs, so that others take part, too.
                let room = self.room(goal);
                let (worst, spread) = (sorted.iter().take(room / 2), sorted.len().div_ceil(room));
                let others = sorted.iter().skip(room / 2).step_by(spread.max(1)).take(room / 2);
                let start: Vec<Measured> = worst.chain(others).map(|&(_, one)| one.clone()).collect();
                let mut population = Population {
                    output,
                    goal,
                    members: Vec::new(),
                };
                self.add(&mut population, start)?;
                if rank < MAX_REFINED_OUTPUTS {
                    populations.push(population);
                } else {
                    self.keep(population)?;
                }
            }
        }
        Ok(populations)
    }

    /// The number of candidates of a round.
    fn room(&self, goal: Goal) -> usize {
        let outputs = self.interface.outputs.len().min(MAX_REFINED_OUTPUTS);
        let most = (ALL_NEIGHBORS / outputs).min(NEIGHBORS);
        match goal {
            Goal::Error => most,
            Goal::Excess => (SENSITIVITY_EVALUATIONS / (2 * self.interface.inputs.len())).min(most),
        }
    }

    /// One round: tries neighbors of the members.
    fn refine(&mut self, population: &mut Population) -> Result<(), RunError> {
        if population.members.is_empty() {
            return Ok(());
        }
        let count = self.room(population.goal);
        let centers: Vec<Case> = population
            .members
            .iter()
            .map(|one| one.measured.case.clone())
            .collect();
        let cases = (0..count).map(|at| self.sampler.neighbor(&centers[at % centers.len()]));
        let cases: Vec<Case> = cases.collect();
        let measured = self.measure(cases)?;
        self.add(population, measured)
    }

    /// Adds the best of some cases to a population.
    fn add(&mut self, population: &mut Population, cases: Vec<Measured>) -> Result<(), RunError> {
        let Population { output, goal, .. } = *population;
        let mut measured: Vec<(f64, Measured)> = cases
            .into_iter()
            .filter_map(|one| Some((one.error(self.interface, output)?, one)))
            .filter(|(error, _)| *error > if goal == Goal::Excess { FEW_ULPS } else { 0.0 })
            .collect();
        measured.sort_by(|a, b| b.0.total_cmp(&a.0));
        let sensitivities = match goal {
            Goal::Error => vec![None; measured.len()],
            Goal::Excess => {
                let cases: Vec<&Measured> = measured.iter().map(|(_, one)| one).collect();
                let all = self.evaluator.sensitivities(self.interface, &cases, output)?;
                all.into_iter().map(Some).collect()
            }
        };
        let candidates = measured.into_iter().zip(sensitivities);
        let candidates =
            candidates.map(|((error, measured), sensitivity)| Candidate::new(measured, error, sensitivity));
        let mut best: Vec<Candidate> = candidates.collect();
        best.sort_by(|a, b| b.score.total_cmp(&a.score));
        best.truncate(4 * MEMBERS);
        let cases: Vec<&Measured> = best.iter().map(|one| &one.measured).collect();
        let uncertainties = self.evaluator.reference_errors(&cases, output)?;
        let mut uncertain = Vec::new();
        for (one, uncertainty) in best.into_iter().zip(uncertainties) {
            let is_certain = uncertainty <= MAX_REFERENCE_SHARE * one.error.min(ULPS_OF_REFERENCE);
            let kept = if is_certain {
                &mut population.members
            } else {
                &mut uncertain
            };
            kept.push(one);
        }
        uncertain.truncate(MEMBERS);
        if self.exact_time < MAX_EXACT_TIME {
            let start = Instant::now();
            let confirmed = self.compared_exactly(uncertain, output)?;
            population.members.extend(confirmed.unwrap_or_default());
            self.exact_time += start.elapsed();
        }
        let members = &mut population.members;
        members.sort_by(|a, b| b.score.total_cmp(&a.score));
        members.dedup_by(|a, b| a.measured.case == b.measured.case);
        members.truncate(MEMBERS);
        Ok(())
    }

    /// Keeps the best member of a population: of those with exact results, where these are found in time.
    fn keep(&mut self, mut population: Population) -> Result<(), RunError> {
        let output = population.output;
        if let Some(compared) = self.compared_exactly(population.members.clone(), output)? {
            population.members = compared;
            population.members.sort_by(|a, b| b.score.total_cmp(&a.score));
        }
        let mut best = population.members.into_iter().next();
        if let Some(candidate) = best.as_mut().filter(|best| best.sensitivity.is_none()) {
            let one = [&candidate.measured];
            let found = self.evaluator.sensitivities(self.interface, &one, output)?;
            candidate.sensitivity = found.into_iter().next();
        }
        let worst = &mut self.found.outputs[output];
        match population.goal {
            Goal::Error => worst.error = best,
            Goal::Excess => worst.excess = best,
        }
        Ok(())
    }

    /// The candidates compared with results in 160 bits, without those that have none; `None` if these are
    /// not found in time.
    fn compared_exactly(
        &self,
        candidates: Vec<Candidate>,
        output: usize,
    ) -> Result<Option<Vec<Candidate>>, RunError> {
        let cases: Vec<Case> = candidates.iter().map(|one| one.measured.case.clone()).collect();
        let Some(exact) = self.evaluator.exact(&cases)? else {
            return Ok(None);
        };
        let compared = candidates.into_iter().zip(exact);
        let compared = compared.filter_map(|(mut one, exact)| {
            let double_error = one
                .double_error
                .unwrap_or_else(|| ulps(one.measured.reference[output], exact[output]));
            one.measured.reference = exact;
            let error = one.measured.error(self.interface, output)?;
            Some(Candidate {
                double_error: Some(double_error),
                ..Candidate::new(one.measured, error, one.sensitivity)
            })
        });
        Ok(Some(compared.collect()))
    }
}
