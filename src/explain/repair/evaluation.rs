//! Evaluates a shader and its edits at the probes: how suspicious its parts are, and which edits pass.

use rayon::prelude::*;
use toyproof_eval::{ParametricProgram, Refusal, Settings};
use toyproof_glsl::Checked;
use toyproof_image::Frame;
use toyproof_verify::bounds::iterations_of_edited;

use super::Suspect;
use super::edit::{Candidate, Change};
use super::localize::{DISTURBANCES, Suspicion, disturbed, suspicion, suspicions, suspicions_of_statements};
use super::schema::{SchemaField, compile};
use super::shader::Shader;
use crate::engine::budget::Budget;
use crate::engine::probes::{Outcome, Probes};
use crate::engine::tournament::{Entrant, play};
use crate::engine::{Colors, Field, Numbers, Run};

/// How much the cost of an edit in the least suspicious place exceeds that in the most suspicious one, when
/// edits are tried and when they are reported; and the cost of a place on which no wrong pixel depends.
const PLACE_WEIGHT: f64 = 14.0;
const COVERAGE_WEIGHT: f64 = 10.0;
const REPAIR_PLACE_WEIGHT: f64 = 5.0;

/// The cost of leaving the whole difference.
const REMAINING_WEIGHT: f64 = 20.0;

/// The largest number of candidates that are compiled together, and of such groups between two decisions on
/// how to continue.
const GROUP: usize = 32;
const GROUPS: usize = 8;

/// The share of the budget that all groups between two decisions may take, if each candidate takes the work
/// of this many probes; and the smallest number of candidates.
const BATCH_SHARE: f64 = 0.1;
const PROBES_PER_CANDIDATE: f64 = 24.0;
const MIN_BATCH: usize = 8;

/// The share of the budget for evaluating the shader itself, and the smallest number of probes.
const BEFORE_SHARE: f64 = 0.2;
const MIN_PROBES: usize = 32;

/// A number of loop iterations that an edited pixel may always have.
const MIN_ITERATIONS: u32 = 2000;

/// A number of loop iterations that is not a limit.
pub(super) const UNLIMITED: u32 = u32::MAX >> 4;

/// The largest number of values of a group after inlining. Compiling them takes about two seconds.
const MAX_GROUP_VALUES: usize = 400_000;

/// The work of a group that is too large.
const REFUSED_WORK: f64 = 3e8;

/// The work of parsing a byte of an edited text.
const PARSE_FACTOR: f64 = 100.0;

/// The work of compiling an instruction, in terms of instructions that are executed for one chunk of pixels.
const COMPILE_FACTOR: f64 = 200.0;

/// The share of the budget for measuring suspicion, the least number of probes, and the share at which it
/// ends.
const LOCALIZATION_SHARE: f64 = 0.12;
const MIN_LOCALIZATION_PROBES: usize = 48;
const MAX_LOCALIZATION_SHARE: f64 = 0.3;

/// The largest number of suspects.
const MAX_SUSPECTS: usize = 3;

/// A shader with its probes, the suspicion of its parts, and the work that may be done with it.
pub(super) struct Evaluation<'a> {
    frame: &'a Frame,
    pub(super) shader: &'a Shader<'a>,
    pub(super) probes: Probes,
    pub(super) budget: Budget,
    /// The number of loop iterations after which an edited pixel is abandoned.
    pub(super) max_iterations: u32,
    /// The suspicion of each site and of each statement.
    sites: Vec<Suspicion>,
    statements: Vec<Suspicion>,
    /// The work of one probe.
    pub(super) probe_work: f64,
}

impl Suspicion {
    /// The rank of an edit of this cost in the order in which edits are tried.
    pub(super) fn search_rank(self, cost: u32) -> f64 {
        f64::from(cost) + PLACE_WEIGHT * (1.0 - self.ochiai) + COVERAGE_WEIGHT * (1.0 - self.coverage)
    }

    /// Its rank among the repairs, if it leaves this share of the difference.
    pub(super) fn report_rank(self, cost: u32, remaining: f64) -> f64 {
        f64::from(cost) + REPAIR_PLACE_WEIGHT * (1.0 - self.ochiai) + REMAINING_WEIGHT * remaining
    }
}

/// A candidate that passes or makes progress, with its numbers.
#[derive(Debug, Clone)]
pub(super) struct TriedEdit {
    pub(super) candidate: Candidate,
    pub(super) outcome: Outcome,
}

/// A part of the work with its results.
type Worked<T> = (Vec<T>, f64);

impl<'a> Evaluation<'a> {
    /// Evaluates the shader at the probes, with at most `max_iterations` per pixel, and measures how
    /// suspicious its parts are; `None` if it cannot be evaluated, or is right at all probes.
    pub(super) fn new(
        frame: &'a Frame,
        shader: &'a Shader<'a>,
        probes: &Probes,
        max_iterations: u32,
        budget: Budget,
    ) -> Option<Self> {
        let mut evaluation = Self {
            frame,
            shader,
            probes: probes.clone(),
            budget,
            max_iterations,
            sites: Vec::new(),
            statements: Vec::new(),
            probe_work: 0.0,
        };
        let program = evaluation.compile(&[]).ok()?;
        // Not charged: `BEFORE_SHARE` limits this work.
        let colors = |probes: &Probes| {
            let (colors, iterations, work) = evaluation.evaluate(&program, 0, |field| {
                let run = Run {
                    hypothesis: None,
                    numbers: Numbers::default(),
                    probes: 0..probes.all.len(),
                };
                (field.run(probes, run), field.iterations(), field.work())
            });
            Some((colors?, iterations, work))
        };
        // Fewer probes of a shader whose pixels take long.
        let few = MIN_PROBES.min(probes.all.len());
        let (.., work) = colors(&probes.part(0..few))?;
        let share = BEFORE_SHARE * budget.total() / (2.0 * work);
        let count = ((share * few as f64) as usize)
            .max(MIN_PROBES)
            .min(probes.all.len());
        let probes = probes.part(0..count);
        let (before, ..) = colors(&probes)?;
        let probes = probes.into_owned().with_colors(&before)?;
        let (before, iterations, work) = colors(&probes)?;
        evaluation.probes = probes.with_before(&before);
        evaluation.max_iterations = iterations_of_edited(iterations, MIN_ITERATIONS);
        evaluation.probe_work = work / evaluation.probes.all.len() as f64;
        // Fewer probes, if evaluating all of them once for each site would cost too much.
        let share = LOCALIZATION_SHARE * budget.total() / (work * shader.sites.len() as f64);
        let count = (share.min(1.0) * evaluation.probes.all.len() as f64) as usize;
        evaluation.localize(count.max(MIN_LOCALIZATION_PROBES));
        Some(evaluation)
    }

    fn compile(&self, candidates: &[&Candidate]) -> Result<ParametricProgram, Refusal> {
        compile(
            self.shader,
            candidates,
            self.frame,
            MAX_GROUP_VALUES,
            self.budget.time_left(),
        )
    }

    fn evaluate<T>(
        &self,
        program: &ParametricProgram,
        count: usize,
        work: impl FnOnce(&mut SchemaField) -> T,
    ) -> T {
        let settings = Settings::<f64> {
            max_iterations: self.max_iterations,
            deadline: Some(self.budget.deadline()),
            ..Settings::default()
        };
        program.evaluate(self.frame, &settings, |evaluator| {
            work(&mut SchemaField::new(evaluator, count))
        })
    }

    /// Tries edited texts, each compiled on its own, and returns the outcomes of those that pass, with their
    /// indices. `checked` parses a text.
    pub(super) fn try_texts<E: Sync>(
        &mut self,
        edits: &[E],
        checked: impl Fn(&E) -> Option<(String, Checked)> + Sync,
    ) -> Vec<(usize, Outcome)> {
        let of_edit = |edit: &E| -> (Option<Outcome>, f64) {
            let parsing = PARSE_FACTOR * self.shader.source.len() as f64;
            let Some((text, checked)) = checked(edit) else {
                return (None, parsing);
            };
            let shader = Shader::new(&checked, &text);
            let limit = self.budget.time_left();
            let Ok(program) = compile(&shader, &[], self.frame, MAX_GROUP_VALUES, limit) else {
                return (None, REFUSED_WORK);
            };
            self.evaluate(&program, 0, |field| {
                let mut colors = |probes| {
                    let (hypothesis, numbers) = (None, Numbers::default());
                    field.run(
                        &self.probes,
                        Run {
                            hypothesis,
                            numbers,
                            probes,
                        },
                    )
                };
                let first = colors(0..self.probes.screening());
                let first = first.and_then(|colors| self.probes.outcome(&colors));
                let is_promising = first.is_some_and(|outcome| outcome.passes || outcome.is_progress());
                let outcome = if is_promising {
                    self.probes.test(colors)
                } else {
                    None
                };
                let compiling = COMPILE_FACTOR * program.instructions() as f64;
                (outcome, field.work() + compiling + parsing)
            })
        };
        let outcomes: Vec<(Option<Outcome>, f64)> = edits.par_iter().map(of_edit).collect();
        self.budget.charge(outcomes.iter().map(|(_, work)| work).sum());
        let passing = outcomes
            .into_iter()
            .map(|(outcome, _)| outcome.filter(|outcome| outcome.passes));
        let passing = passing
            .enumerate()
            .filter_map(|(at, outcome)| Some((at, outcome?)));
        passing.collect()
    }

    /// How suspicious a statement is.
    pub(super) fn statement(&self, statement: usize) -> Suspicion {
        self.statements[statement]
    }

    /// Compiles groups of candidates, runs `work` with each, and collects the results in their order.
    fn in_groups<C: Sync, T: Send>(
        &mut self,
        candidates: &[C],
        size: usize,
        candidate: impl Fn(&C) -> &Candidate + Sync,
        work: impl Fn(&[C], &mut SchemaField) -> Vec<T> + Sync,
    ) -> Vec<T> {
        let of_group = |group: &[C]| -> Worked<T> {
            let compiled: Vec<&Candidate> = group.iter().map(&candidate).collect();
            let Ok(program) = self.compile(&compiled) else {
                return (Vec::new(), REFUSED_WORK);
            };
            self.evaluate(&program, group.len(), |field| {
                let results = work(group, field);
                (
                    results,
                    field.work() + COMPILE_FACTOR * program.instructions() as f64,
                )
            })
        };
        let groups: Vec<Worked<T>> = candidates
            .par_chunks(size.div_ceil(GROUPS))
            .map(of_group)
            .collect();
        self.budget.charge(groups.iter().map(|(_, work)| work).sum());
        groups.into_iter().flat_map(|(results, _)| results).collect()
    }

    /// The number of candidates between two decisions on how to continue, if each takes the work of this many
    /// probes.
    fn batch_of(&self, probes: f64) -> usize {
        let affordable = BATCH_SHARE * self.budget.total() / (probes * self.probe_work);
        (affordable as usize).clamp(MIN_BATCH, GROUPS * GROUP)
    }

    /// The number of candidates that are tried between two decisions on how to continue.
    pub(super) fn batch(&self) -> usize {
        self.batch_of(PROBES_PER_CANDIDATE)
    }

    // Suspicion.

    /// Measures how suspicious each site and each statement is, at that number of probes. Sites beyond
    /// the budget get suspicion 0.
    fn localize(&mut self, count: usize) {
        let (shader, probes) = (self.shader, self.probes.clone());
        let count = count.min(probes.all.len());
        let mut measured: Vec<Option<Suspicion>> = vec![None; shader.sites.len()];
        for by in DISTURBANCES {
            let disturbed: Vec<(usize, Candidate)> = (0..shader.sites.len())
                .filter(|&site| measured[site].unwrap_or_default().coverage == 0.0)
                .filter_map(|site| Some((site, disturbed(shader, site, by)?)))
                .collect();
            let influences = |group: &[(usize, Candidate)], field: &mut SchemaField| {
                let run = |at| Run {
                    hypothesis: Some(at),
                    numbers: Numbers::default(),
                    probes: 0..count,
                };
                let runs: Vec<Run> = (0..group.len()).map(run).collect();
                let colors = field.colors(&probes, &runs).into_iter();
                let influence = |((site, _), colors): (&(usize, Candidate), Option<Colors>)| {
                    Some((*site, suspicion(&probes.all[..count], &colors?, by.weight)))
                };
                group.iter().zip(colors).filter_map(influence).collect()
            };
            let size = self.batch_of(count as f64);
            for batch in disturbed.chunks(size) {
                if self.budget.is_spent(MAX_LOCALIZATION_SHARE) || self.budget.is_late() {
                    break;
                }
                for (site, suspicion) in self.in_groups(batch, size, |(_, candidate)| candidate, influences) {
                    measured[site] = Some(suspicion);
                }
            }
        }
        self.sites = suspicions(shader, &measured);
        self.statements = suspicions_of_statements(shader, &self.sites);
    }

    /// The place of a candidate in the order in which they are tried: the smaller, the earlier.
    pub(super) fn search_rank(&self, candidate: &Candidate) -> f64 {
        self.suspicion(candidate).search_rank(candidate.cost)
    }

    /// The rank of a passing candidate among the repairs: if the fit is not exact, its place counts less and
    /// the quality of the fit more.
    pub(super) fn report_rank(&self, edit: &TriedEdit) -> f64 {
        let suspicion = self.suspicion(&edit.candidate);
        suspicion.report_rank(edit.candidate.cost, edit.outcome.remaining)
    }

    /// The suspicion of the code that a candidate changes.
    fn suspicion(&self, candidate: &Candidate) -> Suspicion {
        match &candidate.change {
            Change::Expression { site, .. } => self.sites[*site],
            Change::Statements(actions) => {
                let all = actions.iter().map(|&(at, _)| self.statements[at]);
                all.reduce(Suspicion::max).unwrap_or_default()
            }
        }
    }

    /// The sites and the statements, the most suspicious first.
    pub(super) fn in_order(&self) -> [Vec<usize>; 2] {
        [&self.sites, &self.statements].map(|all| {
            let mut order: Vec<usize> = (0..all.len()).collect();
            order.sort_by(|&a, &b| all[b].ochiai.total_cmp(&all[a].ochiai));
            order
        })
    }

    /// The most suspicious sites of at least one operation, name or number.
    pub(super) fn suspicious_sites(&self, count: usize) -> Vec<usize> {
        let shader = self.shader;
        let is_suspicious =
            |&site: &usize| self.sites[site].ochiai > 0.0 && shader.sites[site].exprs.len() == 1;
        let mut sites: Vec<usize> = (0..self.sites.len()).filter(is_suspicious).collect();
        // Of equals, whole expressions first.
        let length = |site: usize| shader.text(shader.sites[site].span).len();
        let ochiai = |site: usize| self.sites[site].ochiai;
        sites.sort_by(|&a, &b| ochiai(b).total_cmp(&ochiai(a)).then(length(b).cmp(&length(a))));
        sites.truncate(count);
        sites
    }

    /// The most suspicious statements, on different lines. If edits make progress there, the mistake is more
    /// likely: of statements with the same coefficient, those count more (mutation-based localization;
    /// Papadakis and Le Traon, "Metallaxis-FL", 2015).
    pub(super) fn suspects(&self, progress: &[TriedEdit]) -> Vec<Suspect> {
        let shader = self.shader;
        let mut improved = vec![0.0_f64; self.statements.len()];
        for TriedEdit { candidate, outcome } in progress {
            let repaired = outcome.repaired as f64 / (outcome.evaluated.max(1) as f64);
            let best = &mut improved[candidate.statement(shader)];
            *best = best.max(1.0 - outcome.remaining).max(repaired);
        }
        let score = |at: usize| self.statements[at].ochiai * f64::midpoint(1.0, improved[at].min(1.0));
        let mut order: Vec<usize> = (0..self.statements.len()).collect();
        order.sort_by(|&a, &b| score(b).total_cmp(&score(a)));
        let line = |span: toyproof_diagnostic::Span| {
            let before = shader.source.get(..span.start as usize);
            before.unwrap_or("").matches('\n').count()
        };
        let mut suspects: Vec<Suspect> = Vec::new();
        for at in order {
            let span = shader.statements[at].span;
            if suspects.len() == MAX_SUSPECTS || self.statements[at].ochiai == 0.0 {
                break;
            }
            if suspects.iter().all(|suspect| line(suspect.span) != line(span)) {
                suspects.push(Suspect {
                    span,
                    score: score(at),
                });
            }
        }
        suspects
    }

    // Edits.

    /// Tries candidates, and returns those that pass or make progress.
    pub(super) fn try_all(&mut self, candidates: &[(f64, Candidate)]) -> Vec<TriedEdit> {
        let probes = self.probes.clone();
        let play = |group: &[(f64, Candidate)], field: &mut SchemaField| {
            let entrants = group.iter().map(|(_, candidate)| candidate.entrant());
            let entrants: Vec<Entrant> = entrants.collect();
            let finalists = play(field, &entrants, &probes).into_iter();
            let tried = finalists.map(|finalist| TriedEdit {
                candidate: group[finalist.hypothesis]
                    .1
                    .with_numbers(&finalist.numbers, finalist.cost),
                outcome: finalist.outcome,
            });
            tried.collect()
        };
        self.in_groups(candidates, self.batch(), |(_, candidate)| candidate, play)
    }
}
