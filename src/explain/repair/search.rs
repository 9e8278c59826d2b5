//! The search for repairs: candidates are tried in the order of their cost and of the suspicion of their
//! place, until some are confirmed or the budget is spent; then pairs of them.

use std::cmp::Ordering;

use toyproof_diagnostic::Fix;
use toyproof_eval::Places;
use toyproof_glsl as glsl;
use toyproof_verify::random::NoisyPixel;

use super::edit::{Candidate, EditKind};
use super::edits::{
    Constants, TextEdit, assignment_candidates, candidates, donor_candidates, structural_edits,
};
use super::evaluation::{Evaluation, TriedEdit, UNLIMITED};
use super::shader::Shader;
use super::{Donors, Repair, SearchOptions, SearchResult, Suspect};
use crate::engine::budget::Budget;
use crate::engine::confirm::{Confirmer, apply, compose};
use crate::engine::probes::Probes;

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
const SINGLES_SHARE: f64 = 0.7;
const DONORS_SHARE: f64 = 0.9;

/// The number of texts that are tried between two decisions on how to continue.
const TEXTS: usize = 32;

/// The largest numbers of places in which donors are tried, and of statements after which assignments are.
const MAX_DONOR_SITES: usize = 120;
const MAX_DONOR_STATEMENTS: usize = 60;

/// The largest number of edits that are tried as the first of two, and of those in one statement.
const MAX_FIRST_EDITS: usize = 8;
const MAX_FIRST_EDITS_OF_STATEMENT: usize = 2;

/// Some pixels of a shader that has its own random numbers.
pub(crate) struct NoisyImage {
    pub(crate) pixels: Vec<NoisyPixel>,
    pub(crate) places: Places,
}

/// Searches for the repairs of a wrong shader; `None` if there is nothing to search for. `means` evaluates
/// pixel means; it returns `None` unless shader and reference are both stochastic. If means were compared,
/// their seeds differ, possibly because of the bug.
pub(crate) fn search(
    confirmer: &Confirmer,
    options: SearchOptions,
    compares_means: bool,
    means: &dyn Fn() -> Option<NoisyImage>,
) -> Option<SearchResult> {
    let Confirmer {
        case,
        expected,
        before,
        ..
    } = *confirmer;
    let constants = Constants::new(expected);
    let shader = Shader {
        copied: constants.definitions.shared_with(&case.checked.tree),
        ..Shader::new(case.checked, options.source)
    };
    let mut search = Search {
        confirmer,
        options,
        shader: &shader,
        constants,
        budget: Budget::of_units(options.budget, confirmer.deadline),
        found: Vec::new(),
        best: f64::INFINITY,
        attempts: 0,
        confirmations: 0,
        suspects: None,
        is_cut: false,
    };
    let exact = Probes::select(before, expected, case.frame.size[0] as usize)?;
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
        search.run(&exact, exact_share);
    }
    if compares_means && search.found.is_empty() && noisy.is_none() {
        noisy = means();
    }
    if let Some(image) = noisy
        && let Some(probes) = Probes::of_means(&image.pixels, &image.places)
    {
        search.attempts = MAX_ATTEMPTS - MAX_ATTEMPTS_BY_MEANS;
        search.run(&probes, 1.0 - exact_share);
    }
    Some(SearchResult {
        suspects: search.suspects.take()?,
        is_cut: search.is_cut,
        repairs: search.repairs(),
    })
}

/// A search in progress.
struct Search<'a> {
    confirmer: &'a Confirmer<'a>,
    options: SearchOptions<'a>,
    shader: &'a Shader<'a>,
    constants: Constants,
    /// The budget of the whole search, to which confirmations are charged.
    budget: Budget,
    found: Vec<Found>,
    /// The rank up to which the best repair has been found, if there is one.
    best: f64,
    /// The number of attempts to confirm a repair with the current probes, and of all.
    attempts: usize,
    confirmations: usize,
    /// The suspects of the last probes; `None` if the shader could not be evaluated at any.
    suspects: Option<Vec<Suspect>>,
    is_cut: bool,
}

/// An edit that passes at all probes.
struct Tested {
    fix: Fix,
    kind: EditKind,
    /// The statement that it changes.
    statement: usize,
    search_rank: f64,
    /// Its place among the repairs.
    rank: f64,
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
    fn run(&mut self, probes: &Probes, share: f64) {
        let (shader, budget) = (self.shader, self.budget.share(share));
        // The check has rendered the shader, so its loops end.
        let frame = self.confirmer.case.frame;
        let Some(mut whole) = Evaluation::new(frame, shader, probes, UNLIMITED, budget) else {
            return;
        };
        if self.options.donors.is_some() {
            self.suspects = Some(whole.suspects(&[]));
            return self.donors(&mut whole, 1.0);
        }
        let texts = if probes.are_means() {
            Vec::new()
        } else {
            structural_edits(shader, &self.constants)
        };
        let partial = self.explore(&mut whole, texts, None, SINGLES_SHARE);
        self.suspects = Some(whole.suspects(&partial));
        let is_natural = |found: &Found| found.rank <= MAX_NATURAL_RANK;
        if !self.found.iter().any(is_natural) {
            self.donors(&mut whole, DONORS_SHARE);
        }
        if self.found.is_empty() && !probes.are_means() {
            self.pairs(&whole, probes, partial);
        }
    }

    /// Tries all edits of a shader, in addition to a first edit that it has already, and edits of its texts,
    /// and confirms those that pass. Returns those that make progress only.
    fn explore(
        &mut self,
        evaluation: &mut Evaluation,
        texts: Vec<TextEdit>,
        first: Option<&Fix>,
        share: f64,
    ) -> Vec<TriedEdit> {
        let [sites, statements] = evaluation.in_order();
        let all = candidates(evaluation.shader, &self.constants, &sites, &statements);
        self.try_in_order(evaluation, all, texts, first, share)
    }

    /// Tries expressions of other shaders, or of the scene's, in the most suspicious places.
    fn donors(&mut self, evaluation: &mut Evaluation, share: f64) {
        let sites = evaluation.suspicious_sites(MAX_DONOR_SITES);
        let donors = self
            .options
            .donors
            .map_or(&self.constants.donors, |Donors(donors)| donors);
        let mut all = donor_candidates(evaluation.shader, &self.constants, donors, &sites);
        if self.options.donors.is_none() {
            let [_, statements] = evaluation.in_order();
            let statements = &statements[..statements.len().min(MAX_DONOR_STATEMENTS)];
            all.extend(assignment_candidates(
                evaluation.shader,
                &self.constants,
                statements,
            ));
        }
        self.try_in_order(evaluation, all, Vec::new(), None, share);
    }

    /// Tries candidates and texts, the most likely first, until a share of the budget is spent. Returns the
    /// candidates that make progress only.
    fn try_in_order(
        &mut self,
        evaluation: &mut Evaluation,
        candidates: Vec<Candidate>,
        texts: Vec<TextEdit>,
        first: Option<&Fix>,
        share: f64,
    ) -> Vec<TriedEdit> {
        let candidates = candidates
            .into_iter()
            .map(|candidate| (evaluation.search_rank(&candidate), candidate));
        let texts = texts.into_iter().map(|edit| {
            let suspicion = evaluation.statement(edit.statement);
            (suspicion.search_rank(edit.cost), edit)
        });
        let (candidates, texts) = (sorted(candidates), sorted(texts));
        let (mut candidates, mut texts) = (&candidates[..], &texts[..]);
        let mut partial = Vec::new();
        let rank = |first: Option<f64>| first.unwrap_or(f64::INFINITY);
        while !candidates.is_empty() || !texts.is_empty() {
            let next = rank(candidates.first().map(|(rank, _)| *rank));
            let next_text = rank(texts.first().map(|(rank, _)| *rank));
            let is_spent = evaluation.budget.is_spent(share);
            self.is_cut |= is_spent;
            let is_worse = next.min(next_text) > self.best + ALTERNATIVE_MARGIN;
            if is_spent || evaluation.budget.is_late() || is_worse || self.is_complete() {
                break;
            }
            if next_text <= next {
                let (batch, rest) = texts.split_at(texts.len().min(TEXTS));
                texts = rest;
                self.try_texts(evaluation, batch);
            } else {
                let (batch, rest) = candidates.split_at(candidates.len().min(evaluation.batch()));
                candidates = rest;
                partial.extend(self.try_candidates(evaluation, batch, first));
            }
        }
        partial
    }

    /// Tries candidates, confirms those that pass, and returns those that make progress only.
    fn try_candidates(
        &mut self,
        evaluation: &mut Evaluation,
        batch: &[(f64, Candidate)],
        first: Option<&Fix>,
    ) -> Vec<TriedEdit> {
        let tried = evaluation.try_all(batch).into_iter();
        let (mut passing, progress): (Vec<_>, Vec<_>) = tried.partition(|edit| edit.outcome.passes);
        passing.sort_by(|a, b| evaluation.report_rank(a).total_cmp(&evaluation.report_rank(b)));
        for edit in passing {
            self.confirm_candidate(evaluation, &edit, first);
        }
        progress
    }

    /// Whether no more repairs need to be confirmed.
    fn is_complete(&self) -> bool {
        self.found.len() >= MAX_CONFIRMED || self.attempts >= MAX_ATTEMPTS
    }

    /// Tries edits of the structure, each as a text, and confirms those that pass.
    fn try_texts(&mut self, evaluation: &mut Evaluation, batch: &[(f64, TextEdit)]) {
        let passing = evaluation.try_texts(batch, |(_, edit)| self.edited(&edit.fix));
        for (at, outcome) in passing {
            let (search_rank, edit) = &batch[at];
            let suspicion = evaluation.statement(edit.statement);
            let tested = Tested {
                fix: edit.fix.clone(),
                kind: edit.kind,
                statement: edit.statement,
                search_rank: *search_rank,
                rank: suspicion.report_rank(edit.cost, outcome.remaining),
            };
            self.confirm(evaluation, tested);
        }
    }

    /// Confirms a candidate that passes, in addition to a first edit.
    fn confirm_candidate(
        &mut self,
        evaluation: &mut Evaluation,
        edit: &TriedEdit,
        first: Option<&Fix>,
    ) -> Option<()> {
        let (candidate, shader) = (&edit.candidate, evaluation.shader);
        let own = candidate.fix(shader)?;
        let (fix, kind) = match first {
            None => (own, candidate.kind(shader)),
            Some(first) => (compose(first, &own)?, EditKind::Two),
        };
        let tested = Tested {
            fix,
            kind,
            statement: candidate.statement(shader),
            search_rank: evaluation.search_rank(candidate),
            rank: evaluation.report_rank(edit),
        };
        self.confirm(evaluation, tested)
    }

    /// Confirms an edit, unless a better one of its statement is confirmed.
    fn confirm(&mut self, evaluation: &mut Evaluation, edit: Tested) -> Option<()> {
        let Tested {
            fix,
            kind,
            statement,
            search_rank,
            rank,
        } = edit;
        // Alternatives in the same statement would hide those elsewhere.
        let is_better =
            |found: &Found| found.statement == statement && found.repair.is_complete() && found.rank <= rank;
        if self.is_complete() || self.found.iter().any(is_better) {
            return None;
        }
        // An image takes the work of as many probes; in double precision, in f32, and in a second frame.
        let [width, height] = self.confirmer.case.frame.size.map(f64::from);
        let work = CONFIRMATION_FACTOR * width * height * evaluation.probe_work;
        self.budget.charge(work);
        if !self.found.is_empty() && self.budget.is_spent(CONFIRMATION_SHARE) {
            return None;
        }
        if self.confirmations >= SURE_ATTEMPTS && self.budget.is_spent(1.0) {
            self.is_cut = true;
            return None;
        }
        evaluation.budget.charge(work);
        self.attempts += 1;
        self.confirmations += 1;
        let mistake = kind.mistake();
        let (_, checked) = self.edited(&fix)?;
        let iterations = evaluation.max_iterations;
        let confirmation = match self.options.pass {
            None => self.confirmer.edited(&checked, iterations)?,
            // All frames of the project say more than another frame of the pass.
            Some(pass) => {
                self.confirmer.edited_in_frame(&checked, iterations)?;
                pass.confirm(&fix)?
            }
        };
        let repair = Repair {
            fix,
            mistake,
            agreeing: confirmation.agreeing,
            pixels: confirmation.pixels,
            by_means: confirmation.by_means,
            image: confirmation.image,
        };
        let margin = if repair.is_complete() {
            0.0
        } else {
            COMPLETE_MARGIN
        };
        self.best = self.best.min(search_rank + margin);
        self.found.retain(|found| found.statement != statement);
        self.found.push(Found {
            repair,
            rank,
            statement,
        });
        None
    }

    /// The shader after an edit, if it is valid.
    fn edited(&self, fix: &Fix) -> Option<(String, glsl::Checked)> {
        let text = apply(self.options.source, fix)?;
        if let Some(pass) = self.options.pass {
            let checked = pass.check(&text)?;
            return Some((text, checked));
        }
        let checked = self
            .confirmer
            .checked(&text, &self.confirmer.case.checked.options())?;
        Some((text, checked))
    }

    /// Tries a second edit after each of the most promising first ones.
    fn pairs(&mut self, whole: &Evaluation, probes: &Probes, partial: Vec<TriedEdit>) {
        let mut budget = whole.budget;
        let first_edits = first_edits(whole, partial);
        let count = first_edits.len();
        for (at, first) in first_edits.iter().enumerate() {
            self.is_cut |= budget.is_spent(1.0);
            if budget.is_spent(1.0) || budget.is_late() {
                break;
            }
            let Some((text, checked)) = self.edited(first) else {
                continue;
            };
            let shader = Shader::new(&checked, &text);
            let part = budget.part_of_rest(count - at);
            let frame = self.confirmer.case.frame;
            let Some(mut evaluation) = Evaluation::new(frame, &shader, probes, whole.max_iterations, part)
            else {
                continue;
            };
            self.explore(&mut evaluation, Vec::new(), Some(first), 1.0);
            budget.charge(evaluation.budget.spent());
            if !self.found.is_empty() {
                break;
            }
        }
    }

    /// The repairs that are reported, the most likely first.
    fn repairs(mut self) -> Vec<Repair> {
        self.found.sort_by(Found::preference);
        self.found
            .into_iter()
            .take(MAX_REPAIRS)
            .map(|found| found.repair)
            .collect()
    }
}

/// Edits in the order of their ranks.
fn sorted<T>(edits: impl Iterator<Item = (f64, T)>) -> Vec<(f64, T)> {
    let mut all: Vec<(f64, T)> = edits.collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

impl Found {
    /// One that leaves pixels wrong is not an alternative to one that leaves fewer; of equals, the smaller
    /// edit comes first.
    fn preference(&self, other: &Self) -> Ordering {
        let left = |found: &Self| found.repair.pixels - found.repair.agreeing;
        left(self)
            .cmp(&left(other))
            .then(self.rank.total_cmp(&other.rank))
    }
}

impl Repair {
    /// Whether no pixel is wrong any more.
    pub(crate) fn is_complete(&self) -> bool {
        self.agreeing == self.pixels
    }

    /// Whether it corrects one mistake.
    pub(crate) fn is_single(&self) -> bool {
        corrects_one_mistake(self.mistake.id)
    }
}

/// Whether a repair that is named by this mistake corrects no second one.
#[must_use]
pub fn corrects_one_mistake(id: &str) -> bool {
    id != EditKind::Two.mistake().id
}

/// The edits that repair most of the wrong pixels, or remove most of the difference, without breaking others.
fn first_edits(evaluation: &Evaluation, mut partial: Vec<TriedEdit>) -> Vec<Fix> {
    let progress = |TriedEdit { outcome, .. }: &TriedEdit| {
        let pixels = outcome.repaired as f64 - 2.0 * outcome.broken as f64;
        pixels / outcome.evaluated.max(1) as f64 + 0.5 * (1.0 - outcome.remaining).clamp(0.0, 1.0)
    };
    let rank = |edit: &TriedEdit| evaluation.search_rank(&edit.candidate);
    partial.sort_by(|a, b| {
        progress(b)
            .total_cmp(&progress(a))
            .then(rank(a).total_cmp(&rank(b)))
    });
    let shader = evaluation.shader;
    let mut statements: Vec<usize> = Vec::new();
    let mut first_edits = Vec::new();
    for TriedEdit { candidate, .. } in partial {
        let statement = candidate.statement(shader);
        let known = statements.iter().filter(|&&known| known == statement).count();
        if first_edits.len() == MAX_FIRST_EDITS {
            break;
        }
        if known < MAX_FIRST_EDITS_OF_STATEMENT
            && let Some(fix) = candidate.fix(shader)
        {
            statements.push(statement);
            first_edits.push(fix);
        }
    }
    first_edits
}
