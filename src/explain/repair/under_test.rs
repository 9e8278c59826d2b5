//! A shader under test: its probes, the suspicion of its parts, and the trials of all candidates.

use std::time::Instant;

use rayon::prelude::*;
use toyproof_eval::{ParametricProgram, Refusal, Settings};
use toyproof_verify::Case;
use toyproof_verify::bounds::iterations_of_edited;

use super::Suspect;
use super::edit::{Candidate, Change};
use super::group::{Group, Run};
use super::localize::{DISTURBANCES, Suspicion, disturbed, of_statements, suspicion, suspicions};
use super::probe::Probes;
use super::schema::compile;
use super::shader::Shader;
use super::term::Numbers;
use super::trials::{Trial, try_group};

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
const WAVE_SHARE: f64 = 0.1;
const TRIAL_PROBES: f64 = 24.0;
const MIN_WAVE: usize = 8;

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

/// The work of compiling an instruction, in terms of instructions that are executed for one chunk of pixels.
const COMPILE_FACTOR: f64 = 200.0;

/// The share of the budget for measuring suspicion, the least number of probes, and the share at which it
/// ends.
const LOCALIZATION_SHARE: f64 = 0.12;
const MIN_LOCALIZATION_PROBES: usize = 48;
const MAX_LOCALIZATION_SHARE: f64 = 0.3;

/// The largest number of suspects.
const MAX_SUSPECTS: usize = 3;

/// A shader with its probes.
pub(super) struct ShaderUnderTest<'a> {
    case: &'a Case<'a>,
    pub(super) shader: &'a Shader<'a>,
    probes: Probes,
    deadline: Instant,
    /// The budget of all work.
    budget: f64,
    /// The colors of the shader at the probes.
    before: Vec<[f64; 3]>,
    /// The number of loop iterations after which an edited pixel is abandoned.
    pub(super) max_iterations: u32,
    /// The suspicion of each site and of each statement.
    sites: Vec<Suspicion>,
    statements: Vec<Suspicion>,
    /// The work so far.
    pub(super) work: f64,
    /// The work of one probe.
    pub(super) probe_work: f64,
}

/// A part of the work with its results.
type Worked<T> = (Vec<T>, f64);

impl<'a> ShaderUnderTest<'a> {
    /// Evaluates the shader at the probes, with at most `max_iterations` per pixel, and measures how
    /// suspicious its parts are; `None` if it cannot be evaluated, or is right at all probes.
    pub(super) fn new(
        case: &'a Case<'a>,
        shader: &'a Shader<'a>,
        probes: &Probes,
        max_iterations: u32,
        budget: f64,
        deadline: Instant,
    ) -> Option<Self> {
        let mut tested = Self {
            case,
            shader,
            probes: probes.clone(),
            deadline,
            budget,
            before: Vec::new(),
            max_iterations,
            sites: Vec::new(),
            statements: Vec::new(),
            work: 0.0,
            probe_work: 0.0,
        };
        let program = tested.compile(&[]).ok()?;
        let colors = |probes: &Probes| {
            tested.evaluate(&program, 0, |group| {
                let run = Run {
                    candidate: None,
                    numbers: Numbers::default(),
                    probes: 0..probes.all.len(),
                };
                let colors = group.run(probes, run)?;
                Some((colors, group.iterations(), group.work()))
            })
        };
        // Fewer probes of a shader whose pixels take long.
        let few = probes.truncated(MIN_PROBES);
        let (.., work) = colors(&few)?;
        let share = BEFORE_SHARE * budget / (2.0 * work);
        let count = (share * few.all.len() as f64) as usize;
        let probes = probes.truncated(count.max(MIN_PROBES));
        let (before, ..) = colors(&probes)?;
        let probes = probes.with_colors(&before)?;
        let (before, iterations, work) = colors(&probes)?;
        tested.probes = probes;
        tested.before = before;
        tested.max_iterations = iterations_of_edited(iterations, MIN_ITERATIONS);
        tested.probe_work = work / tested.probes.all.len() as f64;
        // Fewer probes, if evaluating all of them once for each site would cost too much.
        let share = LOCALIZATION_SHARE * budget / (work * shader.sites.len() as f64);
        let count = (share.min(1.0) * tested.probes.all.len() as f64) as usize;
        tested.localize(
            count.max(MIN_LOCALIZATION_PROBES),
            MAX_LOCALIZATION_SHARE * budget,
        );
        Some(tested)
    }

    fn compile(&self, candidates: &[&Candidate]) -> Result<ParametricProgram, Refusal> {
        let left = self.deadline.saturating_duration_since(Instant::now());
        compile(self.shader, candidates, self.case.frame, MAX_GROUP_VALUES, left)
    }

    fn evaluate<T>(
        &self,
        program: &ParametricProgram,
        count: usize,
        work: impl FnOnce(&mut Group) -> T,
    ) -> T {
        let settings = Settings::<f64> {
            max_iterations: self.max_iterations,
            deadline: Some(self.deadline),
            ..Settings::default()
        };
        program.evaluate(self.case.frame, &settings, |evaluator| {
            work(&mut Group::new(evaluator, count))
        })
    }

    /// Compiles some candidates and runs `work` with them.
    fn with_group<T>(&self, candidates: &[&Candidate], work: impl FnOnce(&mut Group) -> Vec<T>) -> Worked<T> {
        let Ok(program) = self.compile(candidates) else {
            return (Vec::new(), REFUSED_WORK);
        };
        self.evaluate(&program, candidates.len(), |group| {
            let results = work(group);
            (
                results,
                group.work() + COMPILE_FACTOR * program.instructions() as f64,
            )
        })
    }

    /// Collects the results of groups, in their order.
    fn collect<T>(&mut self, groups: Vec<Worked<T>>) -> Vec<T> {
        self.work += groups.iter().map(|(_, work)| work).sum::<f64>();
        groups.into_iter().flat_map(|(results, _)| results).collect()
    }

    /// Whether a budget is spent.
    pub(super) fn is_spent(&self, budget: f64) -> bool {
        self.work > budget
    }

    /// Whether the time is over.
    pub(super) fn is_late(&self) -> bool {
        Instant::now() >= self.deadline
    }

    /// The number of candidates between two decisions on how to continue, if each takes the work of this many
    /// probes.
    fn wave_of(&self, probes: f64) -> usize {
        let affordable = WAVE_SHARE * self.budget / (probes * self.probe_work);
        (affordable as usize).clamp(MIN_WAVE, GROUPS * GROUP)
    }

    /// The number of candidates that are tried between two decisions on how to continue.
    pub(super) fn wave(&self) -> usize {
        self.wave_of(TRIAL_PROBES)
    }

    // Suspicion.

    /// Measures how suspicious each site and each statement is, at that number of probes. Sites beyond
    /// the budget get suspicion 0.
    fn localize(&mut self, count: usize, budget: f64) {
        let count = count.min(self.probes.all.len());
        let mut measured: Vec<Option<Suspicion>> = vec![None; self.shader.sites.len()];
        for by in DISTURBANCES {
            let disturbed: Vec<(usize, Candidate)> = (0..self.shader.sites.len())
                .filter(|&site| measured[site].unwrap_or_default().coverage == 0.0)
                .filter_map(|site| Some((site, disturbed(self.shader, site, by)?)))
                .collect();
            let size = self.wave_of(count as f64);
            for wave in disturbed.chunks(size) {
                if self.is_spent(budget) || self.is_late() {
                    break;
                }
                let groups = wave
                    .par_chunks(size.div_ceil(GROUPS))
                    .map(|group| self.influences(group, count, by.weight));
                let groups = groups.collect();
                for (site, suspicion) in self.collect(groups) {
                    measured[site] = Some(suspicion);
                }
            }
        }
        self.sites = suspicions(self.shader, &measured);
        self.statements = of_statements(self.shader, &self.sites);
    }

    /// The suspicion of each site of a group of disturbances.
    fn influences(
        &self,
        group: &[(usize, Candidate)],
        count: usize,
        weight: f64,
    ) -> Worked<(usize, Suspicion)> {
        let candidates: Vec<&Candidate> = group.iter().map(|(_, candidate)| candidate).collect();
        let runs: Vec<Run> = (0..group.len())
            .map(|at| Run {
                candidate: Some(at),
                numbers: Numbers::default(),
                probes: 0..count,
            })
            .collect();
        self.with_group(&candidates, |evaluated| {
            let colors = evaluated.colors(&self.probes, &runs);
            let influence = |((site, _), colors): (&(usize, Candidate), Option<Vec<[f64; 3]>>)| {
                let suspicion = suspicion(&self.probes.all[..count], &self.before, &colors?, weight);
                Some((*site, suspicion))
            };
            group.iter().zip(colors).filter_map(influence).collect()
        })
    }

    /// The place of a candidate in the order of trials: the smaller, the earlier.
    pub(super) fn trial_rank(&self, candidate: &Candidate) -> f64 {
        let Suspicion { ochiai, coverage } = self.suspicion(candidate);
        f64::from(candidate.cost) + PLACE_WEIGHT * (1.0 - ochiai) + COVERAGE_WEIGHT * (1.0 - coverage)
    }

    /// The rank of a passing candidate among the repairs: if the fit is not exact, its place counts less and
    /// the quality of the fit more.
    pub(super) fn report_rank(&self, trial: &Trial) -> f64 {
        let candidate = &trial.candidate;
        let place = REPAIR_PLACE_WEIGHT * (1.0 - self.suspicion(candidate).ochiai);
        f64::from(candidate.cost) + place + REMAINING_WEIGHT * trial.outcome.remaining
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
    pub(super) fn in_order(&self) -> (Vec<usize>, Vec<usize>) {
        let order = |all: &[Suspicion]| {
            let mut order: Vec<usize> = (0..all.len()).collect();
            order.sort_by(|&a, &b| all[b].ochiai.total_cmp(&all[a].ochiai));
            order
        };
        (order(&self.sites), order(&self.statements))
    }

    /// The most suspicious sites of at least one operation, name or number.
    pub(super) fn suspicious_sites(&self, count: usize) -> Vec<usize> {
        let mut sites: Vec<usize> = (0..self.sites.len())
            .filter(|&site| self.sites[site].ochiai > 0.0 && self.shader.sites[site].exprs.len() == 1)
            .collect();
        // Of equals, whole expressions first.
        let length = |site: usize| self.shader.text(self.shader.sites[site].span).len();
        sites.sort_by(|&a, &b| {
            let ochiai = |site: usize| self.sites[site].ochiai;
            ochiai(b).total_cmp(&ochiai(a)).then(length(b).cmp(&length(a)))
        });
        sites.truncate(count);
        sites
    }

    /// The most suspicious statements, on different lines. If edits make progress there, the mistake is more
    /// likely: of statements with the same coefficient, those count more (mutation-based localization;
    /// Papadakis and Le Traon, "Metallaxis-FL", 2015).
    pub(super) fn suspects(&self, progress: &[Trial]) -> Vec<Suspect> {
        let mut improved = vec![0.0_f64; self.statements.len()];
        for trial in progress {
            let outcome = &trial.outcome;
            let repaired = outcome.repaired as f64 / (outcome.evaluated.max(1) as f64);
            let best = &mut improved[trial.candidate.statement(self.shader)];
            *best = best.max(1.0 - outcome.remaining).max(repaired);
        }
        let score = |at: usize| self.statements[at].ochiai * f64::midpoint(1.0, improved[at].min(1.0));
        let mut order: Vec<usize> = (0..self.statements.len()).collect();
        order.sort_by(|&a, &b| score(b).total_cmp(&score(a)));
        let line = |at: usize| {
            let before = self
                .shader
                .source
                .get(..self.shader.statements[at].span.start as usize);
            before.unwrap_or("").matches('\n').count()
        };
        let mut lines = Vec::new();
        let mut suspects = Vec::new();
        for at in order {
            if suspects.len() == MAX_SUSPECTS || self.statements[at].ochiai == 0.0 {
                break;
            }
            if !lines.contains(&line(at)) {
                lines.push(line(at));
                suspects.push(Suspect {
                    span: self.shader.statements[at].span,
                    score: score(at),
                });
            }
        }
        suspects
    }

    // Trials.

    /// Tries candidates, and returns those that pass or make progress.
    pub(super) fn try_all(&mut self, candidates: &[(f64, Candidate)]) -> Vec<Trial> {
        let groups = candidates
            .par_chunks(self.wave().div_ceil(GROUPS))
            .map(|group| self.try_group(group))
            .collect();
        self.collect(groups)
    }

    fn try_group(&self, group: &[(f64, Candidate)]) -> Worked<Trial> {
        let candidates: Vec<&Candidate> = group.iter().map(|(_, candidate)| candidate).collect();
        self.with_group(&candidates, |group| {
            try_group(group, &candidates, &self.probes, &self.before)
        })
    }
}
