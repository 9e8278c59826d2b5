//! The findings of a verification, and the search for what explains a difference.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Diagnostic, Span};
use toyproof_eval::{self as eval, Fault, Places, Program};
use toyproof_image::{Image, Rgb8Image};

use crate::alternative::{Alternative, Alternatives, WrongShader};
use crate::bounds::explanation_deadline;
use crate::compare::{self, CheckSummary, Comparison, DiffLevel, PixelStatus, Regions};
use crate::contain::{Panic, Part, contain};
use crate::decide::{CheckEvidence, Checks, Evidence, MAX_UNSTABLE, Reason, Share, Verdict, decide};
use crate::mistake::{Diagnosis, Stage};
use crate::repair::{self, Before, NoisyImage, SearchResult};
use crate::reseed::Reseeding;
use crate::stochastic::Stochastic;
use crate::{Case, Expected, ReferenceKind, acne, alternative, notes};

/// The largest number of pairs of mistakes that are searched for in a wrong image: a few seconds' work.
const MAX_PAIRS: usize = 512;

/// The largest numbers of columns and of rows of pixels with which repairs of a stochastic shader are tried.
const NOISY_SIDE: u32 = 24;

/// The largest number of pixels that do not agree whose colors are kept.
const MAX_KEPT_COLORS: usize = 1 << 16;

/// The results of [`verify`](crate::verify).
#[derive(Debug)]
pub struct Findings {
    /// The verdict.
    pub verdict: Verdict,
    /// Why.
    pub reason: Reason,
    /// The algorithm check; none without a reference.
    pub algorithm: Option<CheckResult>,
    /// The precision check.
    pub precision: Option<CheckResult>,
    /// The toolchain check; only for strict runs on a GPU.
    pub toolchain: Option<CheckResult>,
    /// The comparison of the shader's image with the reference.
    pub comparison: Option<(Comparison, Vec<DiffLevel>)>,
    /// The reference's image.
    pub reference: Option<Rgb8Image>,
    /// What the reference is; none without one.
    pub reference_kind: Option<ReferenceKind>,
    /// The GPU's image, or the evaluator's in f32 without a GPU.
    pub actual: Rgb8Image,
    /// The GPU and its times; none if the evaluator rendered the image.
    pub gpu_run: Option<GpuRun>,
    /// Observations of the run, with their lines.
    pub notes: Vec<Diagnostic>,
    /// Where the shader loses precision, if float32 is not enough and the place could be found; a note or a
    /// warning describes it.
    pub cause: Option<Span>,
    /// The known mistake, or the two, that explain a wrong image.
    pub mistake: Option<Diagnosis>,
    /// The repairs of a wrong shader and its suspect lines; none if they were not searched for.
    pub search: Option<SearchResult>,
    /// The known mistake that explains the few differing pixels of a correct image.
    pub tolerated_mistake: Option<Diagnosis>,
    /// Whether what explains a difference was cut by the time limit of explanations, which only a hang reaches: the
    /// explanation may be another one elsewhere.
    pub is_cut_by_time: bool,
    /// Internal errors; the parts in which they occurred are missing here.
    pub panics: Vec<Panic>,
    /// The faults that the evaluator observed in f32, each at one place.
    pub(crate) faults: Vec<Fault>,
    /// The evaluator's time for all its images.
    pub eval: Duration,
    /// The time of rendering the reference; nearly 0 where it was cached.
    pub trace: Option<Duration>,
}

/// The GPU that rendered an image, and its times.
#[derive(Debug, Clone)]
pub struct GpuRun {
    /// Adapter and driver.
    pub device: String,
    /// Time for naga to parse, validate and write.
    pub translate: Duration,
    /// Time for the driver to compile.
    pub compile: Duration,
    /// Time to render and read back.
    pub draw: Duration,
}

/// The result of a check, and its difference image.
#[derive(Debug, Default)]
pub struct CheckResult {
    /// The counts.
    pub summary: CheckSummary,
    /// The difference level of each pixel, bottom row first.
    pub diff_levels: Vec<DiffLevel>,
    /// The status of each pixel.
    pub(super) statuses: Vec<PixelStatus>,
    /// The shader's colors in pixels that do not agree, by pixel index.
    pub(super) actual: HashMap<usize, [f32; 3]>,
}

impl CheckResult {
    /// The result of no band, with the memory for an image of that many pixels: growing step by step would leave
    /// unused parts behind.
    pub(super) fn of_pixels(count: usize) -> Self {
        Self {
            diff_levels: Vec::with_capacity(count),
            statuses: Vec::with_capacity(count),
            ..Self::default()
        }
    }

    /// Adds the band above the first `height` rows.
    pub(super) fn extend(&mut self, expected: &Image, actual: &Image, statuses: &[PixelStatus], height: u32) {
        self.summary
            .extend(&CheckSummary::new(expected, actual, statuses), height);
        self.diff_levels
            .extend(compare::diff_levels(expected, actual, statuses));
        let offset = self.statuses.len();
        let differing = statuses.iter().enumerate();
        let differing = differing
            .filter(|&(_, &status)| matches!(status, PixelStatus::Differs | PixelStatus::IllConditioned));
        let capacity = MAX_KEPT_COLORS.saturating_sub(self.actual.len());
        self.actual.extend(differing.take(capacity).map(|(at, _)| {
            let [r, g, b, _] = actual.pixels()[at];
            (offset + at, [r, g, b])
        }));
        self.statuses.extend(statuses);
    }

    /// The result with the regions of its differing pixels, once all bands of an image that many pixels wide
    /// were added.
    pub(super) fn with_regions(mut self, width: u32) -> Self {
        let regions = |status| Regions::of(status, &self.statuses, width);
        self.summary.regions = regions(PixelStatus::Differs);
        self.summary.undefined_region = regions(PixelStatus::Undefined).largest_compact;
        self
    }
}

impl Findings {
    /// Decides from the evidence so far.
    fn decide(&mut self, evidence: Evidence) {
        (self.verdict, self.reason) = decide(evidence);
    }

    /// Decides from the checks, and searches for what explains a difference. `stochastic` is there if
    /// the reference may be.
    pub(super) fn explain(&mut self, case: &Case, program: &Program, stochastic: Option<&Stochastic>) {
        let deadline = explanation_deadline(case.search.map_or(0.0, |search| search.budget));
        let summary = |check: &Option<CheckResult>| check.as_ref().map(|check| check.summary.clone());
        let mut evidence = CheckEvidence {
            checks: Checks {
                algorithm: summary(&self.algorithm),
                precision: summary(&self.precision),
                toolchain: summary(&self.toolchain),
            },
            growth: case.from_start.and_then(|from_start| from_start.growth),
            is_reference_shader: self.reference_kind == Some(ReferenceKind::Shader),
            ..CheckEvidence::default()
        };
        self.decide(evidence.clone().into());
        if self.is_permitted(case, program, &mut evidence) {
            return;
        }
        // A mistake that explains every pixel is reported whatever random numbers the shader uses. Pairs are
        // searched for only if the comparison of random pixels reaches no verdict: with other random numbers,
        // two mistakes do not render the image of the pair.
        self.search_for_mistake(Stage::Single, case, program);
        self.search_for_alternative(case, program, &evidence.checks, alternative::find);
        self.search_for_mistake(Stage::Number, case, program);
        // A wrong number, such as a light's intensity, says more than the curve that it amounts to.
        self.search_for_alternative(case, program, &evidence.checks, alternative::find_curve);
        if stochastic.is_none() {
            self.search_for_mistake(Stage::Pair(MAX_PAIRS), case, program);
        }
        let mut reseeding = None;
        if self.is_unexplained()
            && let Some(stochastic) = stochastic
        {
            reseeding = self.compare_means(&mut evidence, stochastic, case, program, deadline);
        }
        if self.is_unexplained()
            && let Some(tracer) = case.expected.and_then(Expected::tracer)
        {
            let (algorithm, precision) = (self.algorithm.as_ref(), self.precision.as_ref());
            evidence.self_intersection = acne::detect(tracer, case.frame.size, algorithm, precision);
            self.decide(evidence.clone().into());
            if matches!(self.reason, Reason::SelfIntersection(_)) {
                self.mistake = Some(Diagnosis::of(acne::mistake()));
            }
        }
        if stochastic.is_some() && evidence.random_numbers.is_none() {
            self.search_for_mistake(Stage::Pair(MAX_PAIRS), case, program);
        }
        if evidence.random_numbers.is_none() {
            self.explain_few_pixels(case, program);
        }
        self.search_for_repair(case, program, stochastic, reseeding, deadline);
        self.notes
            .extend(notes::unbound(case.checked, case.lints, case.frame));
        self.locate_loss_of_precision(case, program, deadline);
        // What gave up because of the deadline did so after it.
        self.is_cut_by_time = Instant::now() >= deadline;
    }

    /// Decides from the algorithm check in float32, where double precision cannot be evaluated. What explains a
    /// difference cannot be evaluated either.
    pub(super) fn decide_in_single(&mut self, failure: &eval::Failure) {
        let summary = |check: &Option<CheckResult>| check.as_ref().map(|check| check.summary.clone());
        let checks = Checks {
            algorithm: summary(&self.algorithm),
            precision: None,
            toolchain: summary(&self.toolchain),
        };
        self.decide(
            CheckEvidence {
                checks,
                ..CheckEvidence::default()
            }
            .into(),
        );
        self.notes.push(notes::only_single(failure));
    }

    /// Whether a wrong shader is right but for a permitted difference. Then the verdict and the algorithm
    /// check are those without it.
    fn is_permitted(&mut self, case: &Case, program: &Program, evidence: &mut CheckEvidence) -> bool {
        let permitted = case
            .alternatives
            .map_or(&[][..], |alternatives| alternatives.permitted);
        let (Verdict::Wrong, Some(algorithm)) = (self.verdict, &self.algorithm) else {
            return false;
        };
        if permitted.is_empty() {
            return false;
        }
        let found = contain(Part::Mistake, || {
            let wrong = WrongShader::new(case, program, algorithm, &evidence.checks)?;
            alternative::find_permitted(&wrong, permitted)
        });
        let Some((difference, found)) = self.contained(found) else {
            return false;
        };
        let differing = Share::differing(&found.algorithm);
        evidence.checks.algorithm = Some(found.algorithm.clone());
        self.decide(evidence.clone().into());
        if self.verdict == Verdict::Correct {
            let text = found.mistake.description.into_owned();
            self.reason = Reason::Permitted {
                difference,
                text,
                differing,
            };
        }
        if let Some(algorithm) = &mut self.algorithm {
            algorithm.summary = found.algorithm;
        }
        true
    }

    /// Searches for a difference that concerns the whole image, which says more than a symptom.
    fn search_for_alternative(
        &mut self,
        case: &Case,
        program: &Program,
        checks: &Checks,
        find: impl FnOnce(&WrongShader, &Alternatives) -> Option<Alternative>,
    ) {
        let is_symptom = |mistake: &Diagnosis| mistake.mistakes.iter().all(|mistake| mistake.is_symptom);
        if let (Some(alternatives), Some(algorithm)) = (case.alternatives, &self.algorithm)
            && matches!(self.reason, Reason::AlgorithmDiffers { .. })
            && self.mistake.as_ref().is_none_or(is_symptom)
        {
            let found = contain(Part::Mistake, || {
                let wrong = WrongShader::new(case, program, algorithm, checks)?;
                find(&wrong, &alternatives)
            });
            if let Some(found) = self.contained(found) {
                self.mistake = Some(Diagnosis::of(found.mistake));
            }
        }
    }

    /// Whether there is a fault, and no mistake is known that explains it.
    fn is_unexplained(&self) -> bool {
        matches!(self.verdict, Verdict::Wrong | Verdict::Unstable) && self.mistake.is_none()
    }

    /// Compares the means of a shader that differs only in pixels that depend on random numbers, and decides
    /// again. Returns how the shader's random numbers were changed, if they were.
    fn compare_means(
        &mut self,
        evidence: &mut CheckEvidence,
        stochastic: &Stochastic,
        case: &Case,
        program: &Program,
        deadline: Instant,
    ) -> Option<Reseeding> {
        let algorithm = self.algorithm.as_ref()?;
        let compared = stochastic.compare_means(algorithm, &evidence.checks, program, case, deadline)?;
        let precision = self.precision.as_ref();
        evidence.random_numbers = Some(compared.random_numbers);
        (self.verdict, self.reason) = decide(evidence.clone().into());
        // The precision of the pixels that do not depend on random numbers costs samples of the scene, and
        // counts only where everything else agrees.
        if let (Verdict::Correct, Some(random_numbers), Some(precision)) =
            (self.verdict, &mut evidence.random_numbers, precision)
        {
            random_numbers.other_pixels.precision =
                Some(stochastic.precision_of_others(algorithm, precision));
            self.decide(evidence.clone().into());
        }
        if let (Verdict::Wrong, Some(hypotheses), Some(reseeding)) =
            (self.verdict, case.hypotheses, compared.reseeding)
        {
            let diagnosis = contain(Part::Mistake, || {
                let pixels =
                    stochastic.noisy_pixels(program, case, reseeding, hypotheses.places(), deadline)?;
                hypotheses.recognize_noisy(&pixels)
            });
            self.mistake = self.contained(diagnosis);
        }
        compared.reseeding
    }

    /// Searches for the mistake that explains a wrong image, or for two.
    fn search_for_mistake(&mut self, stage: Stage, case: &Case, program: &Program) {
        if let (Verdict::Wrong, None, Some(hypotheses)) = (self.verdict, &self.mistake, case.hypotheses) {
            let diagnosis = contain(Part::Mistake, || {
                hypotheses.recognize_in(stage, program, case.frame)
            });
            self.mistake = self.contained(diagnosis);
        }
    }

    /// Searches for edits that repair a wrong image, and for the lines that it depends on. `reseeding` is
    /// there if the shader's means were compared.
    fn search_for_repair(
        &mut self,
        case: &Case,
        program: &Program,
        stochastic: Option<&Stochastic>,
        reseeding: Option<Reseeding>,
        deadline: Instant,
    ) {
        if let (Verdict::Wrong, Some(options), Some(algorithm)) = (self.verdict, case.search, &self.algorithm)
        {
            let compares_means = self.reason.compares_means();
            let image = || {
                let stochastic = stochastic?;
                // A shader that differs in other pixels, too, may have random numbers of its own.
                let reseeding =
                    reseeding.or_else(|| stochastic.reseeding(program, case, algorithm, deadline))?;
                let places = Places::spread(case.frame.size, [NOISY_SIDE; 2]);
                let pixels = stochastic.noisy_pixels(program, case, reseeding, &places, deadline)?;
                Some(NoisyImage { pixels, places })
            };
            let search = contain(Part::Repair, || {
                let before = Before {
                    check: algorithm,
                    faults: &self.faults,
                    compares_means,
                };
                repair::search(case, options, before, &image, deadline)
            });
            self.search = self.contained(search);
        }
    }

    /// Searches for the mistake that explains the few differing pixels of a correct image.
    fn explain_few_pixels(&mut self, case: &Case, program: &Program) {
        if let (Verdict::Correct, Some(hypotheses), Some(algorithm)) =
            (self.verdict, case.hypotheses, &self.algorithm)
            && algorithm.summary.differing > 0
        {
            let differing = notes::sample_pixels(algorithm, case.frame.size, usize::MAX);
            let diagnosis = contain(Part::Mistake, || hypotheses.explaining(program, &differing));
            self.tolerated_mistake = self.contained(diagnosis);
        }
    }

    /// Searches for the line in which float32 loses precision, where it is not enough.
    fn locate_loss_of_precision(&mut self, case: &Case, program: &Program, deadline: Instant) {
        let differs_often = |check: &CheckResult| Share::differing(&check.summary).ratio() > MAX_UNSTABLE;
        let loses_precision = match &self.reason {
            // The reference loses it at the same place.
            Reason::Agrees {
                imprecise_reference, ..
            } => *imprecise_reference > 0,
            Reason::NoReference => self.precision.as_ref().is_some_and(differs_often),
            _ => false,
        };
        if self.verdict != Verdict::Unstable && !loses_precision {
            return;
        }
        let cause = contain(Part::Cause, || {
            let mut checks = [&self.precision, &self.algorithm].into_iter().flatten();
            checks.find_map(|check| notes::cause(program, case, deadline, check))
        });
        let cause = self.contained(cause);
        self.cause = cause.as_ref().and_then(|cause| cause.span);
        let mut warnings = case.lints.warnings.iter();
        let is_reported = warnings.any(|warning| warning.span == self.cause);
        self.notes.extend(cause.filter(|_| !is_reported));
    }

    /// Returns a part's result, or the default if it panicked, which is recorded.
    pub(super) fn contained<T: Default>(&mut self, found: Result<T, Panic>) -> T {
        found.unwrap_or_else(|panic| {
            self.panics.push(panic);
            T::default()
        })
    }

    /// Decides where the evaluator failed: only the GPU's image is known.
    pub(super) fn evaluator_failed(&mut self, failure: eval::Failure) {
        self.decide(Evidence::NotEvaluated {
            failure,
            has_reference: self.reference.is_some(),
        });
    }
}
