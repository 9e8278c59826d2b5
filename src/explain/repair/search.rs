//! The search for repairs: candidates are tried in the order of their cost and of the suspicion of their
//! place, until some are confirmed or the budget is spent; then pairs of them.

use std::time::Instant;

use toyproof_diagnostic::Fix;
use toyproof_eval::{Fault, Places};
use toyproof_verify::random::NoisyPixel;
use toyproof_verify::{Case, CheckResult};

use super::confirm::{Judge, compose};
use super::edit::{Candidate, EditKind};
use super::edits::{Constants, candidates, donor_candidates};
use super::probe::Probes;
use super::shader::Shader;
use super::trials::Trial;
use super::under_test::{ShaderUnderTest, UNLIMITED};
use super::{Donors, Repair, SearchOptions, SearchResult, Suspect};

/// How much more than the first repair a candidate may cost to be tried as an alternative.
const ALTERNATIVE_MARGIN: f64 = 5.0;

/// How much more to find a repair that leaves no pixel wrong, after one that leaves some.
const COMPLETE_MARGIN: f64 = 10.0;

/// The largest number of repairs that are reported, that are confirmed, and of attempts to confirm one.
const MAX_REPAIRS: usize = 3;
const MAX_CONFIRMED: usize = 8;
const MAX_ATTEMPTS: usize = 24;

/// The work of confirming a repair, relative to evaluating each pixel once, and the share of the budget that
/// confirming alternatives may take.
const CONFIRMATION_FACTOR: f64 = 4.0;
const CONFIRMATION_SHARE: f64 = 0.2;

/// The number of attempts that are made whatever their work.
const SURE_ATTEMPTS: usize = 4;

/// The largest number of attempts where means are compared, which takes seconds.
const MAX_ATTEMPTS_BY_MEANS: usize = 4;

/// The share of the budget for exact colors, if the means of a shader were compared.
const EXACT_SHARE: f64 = 0.6;

/// The rank of a repair above which an expression of the scene's shader may be more likely: fitted numbers.
const MAX_NATURAL_RANK: f64 = 28.0;

/// The shares of the budget after which single edits, and donors, are no longer tried.
const SINGLES_SHARE: f64 = 0.6;
const DONORS_SHARE: f64 = 0.8;

/// The largest number of places in which donors are tried.
const MAX_DONOR_SITES: usize = 120;

/// The largest number of edits that are tried as the first of two, and of those in one statement.
const MAX_FIRSTS: usize = 8;
const MAX_FIRSTS_OF_STATEMENT: usize = 2;

/// The work of a unit of the budget: about a second of one core.
const WORK_PER_UNIT: f64 = 3e8;

/// Searches for the repairs of a wrong shader; `None` if there is nothing to search for. `means` evaluates
/// pixel means; it returns `None` unless shader and reference are both stochastic. If means were compared,
/// their seeds differ, possibly because of the bug. Work is counted; the search also ends at the `deadline`,
/// which only a hang exceeds.
pub(crate) fn search(
    case: &Case,
    options: SearchOptions,
    before: Before,
    means: &dyn Fn() -> Option<NoisyImage>,
    deadline: Instant,
) -> Option<SearchResult> {
    let Before {
        check,
        compares_means,
        ..
    } = before;
    let expected = case.expected?;
    let shader = Shader::new(case.checked, options.source);
    let mut search = Search {
        case,
        shader: &shader,
        constants: Constants::of(expected),
        donors: options.donors,
        judge: Judge::new(case, expected, options, before, deadline),
        deadline,
        found: Vec::new(),
        best: f64::INFINITY,
        attempts: 0,
        confirmations: 0,
        confirmation_work: 0.0,
        budget: options.budget * WORK_PER_UNIT,
        confirmation_budget: CONFIRMATION_SHARE * options.budget * WORK_PER_UNIT,
        suspects: None,
        is_cut: false,
    };
    let budget = options.budget * WORK_PER_UNIT;
    let exact = Probes::select(check, expected, case.frame.size[0] as usize)?;
    // A shader with other random numbers has no exact colors, unless its mistake is in the reference's own
    // hash.
    let follows_reference = search.constants.has_hash_of(case.checked);
    let mut noisy = if follows_reference { None } else { means() };
    let exact_share = match (compares_means, &noisy) {
        (_, Some(_)) => 0.0,
        (true, None) => EXACT_SHARE,
        (false, None) => 1.0,
    };
    if exact_share > 0.0 {
        search.run(&exact, exact_share * budget);
    }
    if compares_means && search.found.is_empty() && noisy.is_none() {
        noisy = means();
    }
    if let Some(image) = noisy
        && let Some(probes) = Probes::of_means(&image.pixels, &image.places)
    {
        search.attempts = MAX_ATTEMPTS - MAX_ATTEMPTS_BY_MEANS;
        search.run(&probes, (1.0 - exact_share) * budget);
    }
    Some(SearchResult {
        suspects: search.suspects.take()?,
        is_cut: search.is_cut,
        repairs: search.repairs(),
    })
}

/// The results of the shader before any edit.
#[derive(Clone, Copy)]
pub(crate) struct Before<'a> {
    /// The algorithm check.
    pub(crate) check: &'a CheckResult,
    /// The faults that were observed, each at one place.
    pub(crate) faults: &'a [Fault],
    /// Whether its means were compared.
    pub(crate) compares_means: bool,
}

/// Some pixels of a shader that has its own random numbers.
pub(crate) struct NoisyImage {
    pub(crate) pixels: Vec<NoisyPixel>,
    pub(crate) places: Places,
}

/// A search in progress.
struct Search<'a> {
    case: &'a Case<'a>,
    shader: &'a Shader<'a>,
    constants: Constants,
    /// The donors of other shaders, if only these are tried.
    donors: Option<&'a Donors>,
    judge: Judge<'a>,
    deadline: Instant,
    found: Vec<Found>,
    /// The rank up to which the best repair has been found, if there is one.
    best: f64,
    attempts: usize,
    /// The number of confirmations.
    confirmations: usize,
    /// The budget of the whole search.
    budget: f64,
    /// The work of confirmations, and the work after which no more alternatives are confirmed.
    confirmation_work: f64,
    confirmation_budget: f64,
    /// The suspects of the last probes; `None` if the shader could not be evaluated at any.
    suspects: Option<Vec<Suspect>>,
    is_cut: bool,
}

/// A confirmed repair.
struct Found {
    repair: Repair,
    /// Its place among the repairs.
    rank: f64,
    /// The statement that it changes.
    statement: usize,
}

impl Search<'_> {
    /// Searches for edits after which the probes are right: single ones, donors, then pairs.
    fn run(&mut self, probes: &Probes, budget: f64) {
        // The check has rendered the shader, so its loops end.
        let Some(mut tested) =
            ShaderUnderTest::new(self.case, self.shader, probes, UNLIMITED, budget, self.deadline)
        else {
            return;
        };
        if self.donors.is_some() {
            self.suspects = Some(tested.suspects(&[]));
            return self.donors(&mut tested, budget);
        }
        let partial = self.explore(&mut tested, None, SINGLES_SHARE * budget);
        self.suspects = Some(tested.suspects(&partial));
        if self.found.iter().all(|found| found.rank > MAX_NATURAL_RANK) {
            self.donors(&mut tested, DONORS_SHARE * budget);
        }
        if self.found.is_empty() && !probes.are_means() {
            self.pairs(&tested, probes, partial, budget - tested.work);
        }
    }

    /// Tries all edits of a shader, in addition to a first edit that it has already, and confirms those that
    /// pass. Returns those that make progress only.
    fn explore(&mut self, tested: &mut ShaderUnderTest, first: Option<&First>, budget: f64) -> Vec<Trial> {
        let (sites, statements) = tested.in_order();
        let all = candidates(tested.shader, &self.constants, &sites, &statements);
        self.try_in_order(tested, all, first, budget)
    }

    /// Tries expressions of other shaders, or of the scene's, in the most suspicious places.
    fn donors(&mut self, tested: &mut ShaderUnderTest, budget: f64) {
        let sites = tested.suspicious_sites(MAX_DONOR_SITES);
        let donors = self.donors.map_or(&self.constants.donors, |donors| &donors.0);
        let all = donor_candidates(tested.shader, &self.constants, donors, &sites);
        self.try_in_order(tested, all, None, budget);
    }

    fn try_in_order(
        &mut self,
        tested: &mut ShaderUnderTest,
        candidates: Vec<Candidate>,
        first: Option<&First>,
        budget: f64,
    ) -> Vec<Trial> {
        let mut all: Vec<(f64, Candidate)> = candidates
            .into_iter()
            .map(|candidate| (tested.trial_rank(&candidate), candidate))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut partial = Vec::new();
        for wave in all.chunks(tested.wave()) {
            let is_spent = tested.is_spent(budget);
            self.is_cut |= is_spent;
            if is_spent
                || tested.is_late()
                || wave[0].0 > self.best + ALTERNATIVE_MARGIN
                || self.is_complete()
            {
                break;
            }
            let (mut passing, progress): (Vec<Trial>, Vec<Trial>) = tested
                .try_all(wave)
                .into_iter()
                .partition(|trial| trial.outcome.passes);
            partial.extend(progress);
            passing.sort_by(|a, b| tested.report_rank(a).total_cmp(&tested.report_rank(b)));
            for trial in passing {
                self.confirm(tested, &trial, first);
            }
        }
        partial
    }

    /// Whether no more repairs need to be confirmed.
    fn is_complete(&self) -> bool {
        self.found.len() >= MAX_CONFIRMED || self.attempts >= MAX_ATTEMPTS
    }

    fn confirm(&mut self, tested: &mut ShaderUnderTest, trial: &Trial, first: Option<&First>) {
        let candidate = &trial.candidate;
        let statement = candidate.statement(tested.shader);
        let rank = tested.report_rank(trial);
        // Alternatives in the same statement would hide those elsewhere.
        let is_better =
            |found: &Found| found.statement == statement && found.repair.is_complete() && found.rank <= rank;
        if self.is_complete() || self.found.iter().any(is_better) {
            return;
        }
        let fix = candidate.fix(tested.shader);
        let fix = match first {
            None => fix,
            Some(first) => fix.and_then(|second| compose(&first.fix, &second)),
        };
        let Some(fix) = fix else { return };
        // An image takes the work of as many probes; in double precision, in f32, and in a second frame.
        let pixels = f64::from(self.case.frame.size[0]) * f64::from(self.case.frame.size[1]);
        let work = CONFIRMATION_FACTOR * pixels * tested.probe_work;
        self.confirmation_work += work;
        if !self.found.is_empty() && self.confirmation_work > self.confirmation_budget {
            return;
        }
        if self.confirmations >= SURE_ATTEMPTS && self.confirmation_work > self.budget {
            self.is_cut = true;
            return;
        }
        tested.work += work;
        self.attempts += 1;
        self.confirmations += 1;
        let kinds: Vec<EditKind> = first
            .map(|first| first.kind)
            .into_iter()
            .chain([candidate.kind(tested.shader)])
            .collect();
        if let Some(repair) = self.judge.confirm(fix, &kinds, tested.max_iterations) {
            let margin = if repair.is_complete() {
                0.0
            } else {
                COMPLETE_MARGIN
            };
            self.best = self.best.min(tested.trial_rank(candidate) + margin);
            self.found.retain(|found| found.statement != statement);
            self.found.push(Found {
                repair,
                rank,
                statement,
            });
        }
    }

    /// Tries a second edit after each of the most promising first ones.
    fn pairs(&mut self, whole: &ShaderUnderTest, probes: &Probes, partial: Vec<Trial>, mut budget: f64) {
        let firsts = firsts(whole, partial);
        let count = firsts.len();
        for (at, first) in firsts.iter().enumerate() {
            self.is_cut |= budget <= 0.0;
            if budget <= 0.0 || whole.is_late() {
                break;
            }
            let Some((text, checked)) = self.judge.edited(&first.fix) else {
                continue;
            };
            let shader = Shader::new(&checked, &text);
            let Some(mut tested) = ShaderUnderTest::new(
                self.case,
                &shader,
                probes,
                whole.max_iterations,
                budget / (count - at) as f64,
                self.deadline,
            ) else {
                continue;
            };
            self.explore(&mut tested, Some(first), budget / (count - at) as f64);
            budget -= tested.work;
            if !self.found.is_empty() {
                break;
            }
        }
    }

    /// The repairs that are reported, the most likely first. One that leaves pixels wrong is not an
    /// alternative to one that leaves fewer.
    fn repairs(mut self) -> Vec<Repair> {
        let left = |found: &Found| found.repair.pixels - found.repair.agreeing;
        self.found
            .sort_by(|a, b| left(a).cmp(&left(b)).then(a.rank.total_cmp(&b.rank)));
        self.found
            .into_iter()
            .take(MAX_REPAIRS)
            .map(|found| found.repair)
            .collect()
    }
}

impl Repair {
    /// Whether no pixel is wrong any more.
    fn is_complete(&self) -> bool {
        self.agreeing == self.pixels
    }
}

/// The first of two edits.
struct First {
    fix: Fix,
    kind: EditKind,
}

/// The edits that repair most of the wrong pixels, or remove most of the difference, without breaking others.
fn firsts(tested: &ShaderUnderTest, mut partial: Vec<Trial>) -> Vec<First> {
    let progress = |trial: &Trial| {
        let outcome = &trial.outcome;
        let pixels = outcome.repaired as f64 - 2.0 * outcome.broken as f64;
        pixels / outcome.evaluated.max(1) as f64 + 0.5 * (1.0 - outcome.remaining).clamp(0.0, 1.0)
    };
    partial.sort_by(|a, b| {
        let rank = |trial: &Trial| tested.trial_rank(&trial.candidate);
        progress(b)
            .total_cmp(&progress(a))
            .then(rank(a).total_cmp(&rank(b)))
    });
    let mut statements: Vec<usize> = Vec::new();
    let mut firsts = Vec::new();
    for trial in partial {
        let statement = trial.candidate.statement(tested.shader);
        let known = statements.iter().filter(|&&known| known == statement).count();
        if firsts.len() == MAX_FIRSTS {
            break;
        }
        if known < MAX_FIRSTS_OF_STATEMENT
            && let Some(fix) = trial.candidate.fix(tested.shader)
        {
            statements.push(statement);
            firsts.push(First {
                fix,
                kind: trial.candidate.kind(tested.shader),
            });
        }
    }
    firsts
}
