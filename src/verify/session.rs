//! The checks in progress, band by band; whole images are kept only in 8 bits, as they are shown.

use std::ops::Range;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

use toyproof_diagnostic::Diagnostic;
use toyproof_eval::{self as eval, Observations, Seed};
use toyproof_eval_native::Program;
use toyproof_image::{Image, Rgb8Image};
use toyproof_translate::FloatMode;

use crate::bounds::explanation_deadline;
use crate::case::Case;
use crate::compare::{self, CheckResult, Comparison, DiffLevel, EpsilonSearch, Reference, SEEN, Undefined};
use crate::contain::{Part, contain};
use crate::driver::GpuRun;
use crate::evaluator::{Band, DoubleBand, Evaluator};
use crate::expected::{Expected, NumberType, ReferenceBand, ReferenceKind};
use crate::failure::Failure;
use crate::loss::NotFinite;
use crate::notes;
use crate::pool::{join, timed};
use crate::random::stochastic::Stochastic;
use crate::verified::{CheckResults, Verified};

/// The message after each band.
#[derive(Debug, Clone, Copy)]
pub(super) struct IterationCount {
    /// The largest number of loop iterations of a pixel of the band, in f32.
    pub(super) most: u32,
    pub(super) is_last: bool,
}

/// The results so far.
pub(super) struct VerifySession<'a, 'e> {
    case: &'a Case<'a>,
    /// The evaluator, or its failure.
    pub(super) evaluator: Result<Evaluator<'e>, eval::Failure>,
    counts: Option<Sender<IterationCount>>,
    /// The observations of the evaluator in f32.
    pub(super) observed: Observations,
    excludes_pixels: bool,
    algorithm: CheckResult,
    mixed: EpsilonSearch,
    precision: CheckResult,
    imprecise_reference: u64,
    toolchain: Option<CheckResult>,
    comparison: Option<(Comparison, Vec<DiffLevel>)>,
    actual: Rgb8Image,
    reference: Option<Rgb8Image>,
    not_finite: NotFinite,
    /// Why double precision could not be evaluated, from some band on; the shader is then compared with its
    /// reference in float32.
    double_failure: Option<eval::Failure>,
    /// The record for comparing means, for a reference that may be stochastic.
    stochastic: Option<Stochastic<'a>>,
    eval: Duration,
    trace: Duration,
}

/// Returns the next band that a GPU rendered; `None` if the GPU failed.
pub(super) type NextBand<'a> = dyn FnMut() -> Result<Option<Image>, Failure> + 'a;

impl<'a, 'e> VerifySession<'a, 'e> {
    pub(super) fn new(
        case: &'a Case<'a>,
        evaluator: Result<Evaluator<'e>, eval::Failure>,
        counts: Sender<IterationCount>,
    ) -> Self {
        let [width, height] = case.frame.size;
        let empty = || Rgb8Image::empty(width, height);
        let pixels = width as usize * height as usize;
        Self {
            case,
            counts: evaluator.is_ok().then_some(counts),
            evaluator,
            observed: Observations::default(),
            excludes_pixels: false,
            algorithm: CheckResult::with_capacity(pixels),
            mixed: EpsilonSearch::new(pixels as u64),
            precision: CheckResult::with_capacity(pixels),
            imprecise_reference: 0,
            toolchain: None,
            comparison: None,
            actual: empty(),
            reference: case.expected.map(|_| empty()),
            not_finite: NotFinite::default(),
            double_failure: None,
            stochastic: case
                .expected
                .and_then(|expected| Stochastic::new(expected, case.frame.size)),
            eval: Duration::ZERO,
            trace: Duration::ZERO,
        }
    }

    /// Whether the evaluator takes the shader.
    pub(super) fn has_program(&self) -> bool {
        self.evaluator.is_ok()
    }

    /// Checks all bands. A GPU renders all of them before it returns them, one by one; if it fails, the
    /// evaluator continues alone, and there is no toolchain check.
    ///
    /// # Errors
    /// Returns why there is no image, where no GPU renders one, and the errors of `gpu`.
    pub(super) fn bands(&mut self, mut gpu: Option<&mut NextBand<'_>>) -> Result<(), Failure> {
        for rows in self.case.frame.bands() {
            let (band, reference) = self.render(&rows)?;
            let drawn = match &mut gpu {
                None => None,
                Some(next) => next()?,
            };
            if drawn.is_none() {
                gpu = None;
                self.toolchain = None;
                if let Err(failure) = &self.evaluator {
                    return Err(failure.clone().into());
                }
            }
            self.compare(&rows, band.as_ref(), reference.as_deref(), drawn.as_ref());
        }
        self.counts = None;
        Ok(())
    }

    /// Renders a band and its reference in parallel.
    fn render(&mut self, rows: &Range<u32>) -> Result<(Option<Band>, Option<Arc<ReferenceBand>>), Failure> {
        let height = self.case.frame.size[1];
        let counts = |most| {
            let is_last = rows.end == height;
            if let Some(sender) = &self.counts {
                // The receiver may be gone.
                let _ = sender.send(IterationCount { most, is_last });
            }
        };
        let evaluator = &self.evaluator;
        let ((band, eval), traced) = thread::scope(|scope| {
            let trace = |expected: &Expected| timed(|| expected.rows(rows));
            let traced = self
                .case
                .expected
                .map(|expected| scope.spawn(move || trace(expected)));
            let evaluated = timed(|| match evaluator {
                Ok(evaluator) => evaluator.render(rows, counts).map(Some),
                Err(_) => Ok(None),
            });
            (evaluated, traced.map(join))
        });
        self.eval += eval;
        let band = band.unwrap_or_else(|failure| {
            self.evaluator = Err(failure);
            // No more messages follow.
            self.counts = None;
            None
        });
        let Some((reference, trace)) = traced else {
            return Ok((band, None));
        };
        self.trace += trace;
        Ok((band, Some(reference.map_err(Failure::Reference)?)))
    }

    /// Compares a band; `drawn` is the GPU's.
    fn compare(
        &mut self,
        rows: &Range<u32>,
        band: Option<&Band>,
        reference: Option<&ReferenceBand>,
        drawn: Option<&Image>,
    ) {
        let offset = rows.start;
        let pixels = self.case.frame.size.map(|side| side as usize).iter().product();
        let single = band.map(|band| &band.single);
        // Strict runs have the evaluator's bits, unless the toolchain is at fault: then these are the
        // shader's.
        let judged = match self.case.float {
            FloatMode::Strict => single.or(drawn),
            FloatMode::Fast => drawn.or(single),
        };
        if let Some(judged) = judged {
            self.not_finite.record(judged, offset);
        }
        if let Some(actual) = drawn.or(single) {
            self.actual.extend(actual);
            if let (Some(reference), Some(image)) = (reference, &mut self.reference) {
                image.extend(&reference.image);
                let (comparison, mut levels) = compare::compare(&reference.image, actual);
                match &mut self.comparison {
                    None => {
                        levels.reserve_exact(pixels - levels.len());
                        self.comparison = Some((comparison, levels));
                    }
                    Some((whole, all)) => {
                        whole.extend(&comparison, offset);
                        all.extend(levels);
                    }
                }
            }
        }
        let (Some(band), Some(judged)) = (band, judged) else {
            return;
        };
        if let Some(reference) = reference {
            self.check_algorithm(rows, band, reference);
        }
        match &band.double {
            Ok(double) => {
                if let (Some(stochastic), Some(reference)) = (&mut self.stochastic, reference) {
                    stochastic.record(&double.image, &reference.image, offset);
                }
                self.check_precision(rows, double, judged, &band.undefined);
            }
            Err(failure) => {
                self.double_failure.get_or_insert_with(|| failure.clone());
                self.stochastic = None;
            }
        }
        if let (Some(drawn), FloatMode::Strict) = (drawn, self.case.float) {
            let statuses = compare::toolchain(&band.single, drawn, &band.undefined);
            let check = self
                .toolchain
                .get_or_insert_with(|| CheckResult::with_capacity(pixels));
            check.extend(&band.single, drawn, &statuses, offset);
        }
        self.excludes_pixels |= band.undefined.contains(&true);
        self.observed.merge(&band.observed);
    }

    /// Compares the shader with the reference in double precision, or in float32 where only that was
    /// evaluated.
    fn check_algorithm(&mut self, rows: &Range<u32>, band: &Band, reference: &ReferenceBand) {
        let (Some(expected), Ok(evaluator)) = (self.case.expected, &self.evaluator) else {
            return;
        };
        let (actual, substituted, number_type) = match &band.double {
            Ok(double) => (&double.image, double.substituted.as_deref(), NumberType::Double),
            Err(_) => (&band.single, None, NumberType::Single),
        };
        let band_reference = BandReference {
            expected,
            rows,
            number_type,
            derives: self.case.checked.takes_derivatives(),
        };
        let undefined = Undefined {
            pixels: &band.undefined,
            substituted,
            in_reference: &reference.undefined,
        };
        let mut failure = None;
        let (statuses, perturbing) = timed(|| {
            let perturbed = |seed, wanted: &[bool]| {
                if number_type == NumberType::Single {
                    return None;
                }
                let perturbed = evaluator.perturbed(rows, Seed::double(seed), wanted);
                perturbed.unwrap_or_else(|error| {
                    failure = Some(error);
                    None
                })
            };
            compare::algorithm(
                &reference.image,
                actual,
                &undefined,
                &band_reference,
                &mut self.mixed,
                perturbed,
            )
        });
        self.eval += perturbing;
        self.algorithm
            .extend(&reference.image, actual, &statuses, rows.start);
        if let Some(failure) = failure {
            self.evaluator = Err(failure);
        }
    }

    /// Compares the shader's image in float32 with double precision from the same buffers: errors that
    /// earlier frames amplify are not a fault of this one.
    fn check_precision(
        &mut self,
        rows: &Range<u32>,
        double: &DoubleBand,
        actual: &Image,
        undefined: &[bool],
    ) {
        let precise = double.step.as_ref().unwrap_or(&double.image);
        let mut statuses = compare::precision(precise, actual, undefined);
        if let Some(expected) = self.case.expected {
            compare::exclude_tied(&mut statuses, |wanted| {
                expected.tied(rows, wanted, NumberType::Single)
            });
            if expected.kind() == ReferenceKind::Shader {
                self.imprecise_reference += compare::count_tied(&statuses, |tied| {
                    let in_double = expected.tied(rows, tied, NumberType::Double);
                    in_double.into_iter().map(|tied| !tied).collect()
                });
            }
        }
        self.precision.extend(precise, actual, &statuses, rows.start);
    }

    /// Returns the results, still without the program. `drawn` is the GPU that rendered the image, or the note
    /// about the driver's failure; `program` is the evaluator's.
    pub(super) fn finish(
        self,
        drawn: Option<Result<GpuRun, Diagnostic>>,
        program: Option<&Program>,
    ) -> Verified<'a> {
        let case = self.case;
        let (gpu_run, mut driver_note) = match drawn {
            Some(Ok(gpu_run)) => (Some(gpu_run), None),
            Some(Err(note)) => (None, Some(note)),
            None => (None, None),
        };
        let mut panics = Vec::new();
        let (mut notes, mut faults) = (Vec::new(), Vec::new());
        let (mut algorithm, mut precision, mut toolchain) = (None, None, None);
        if self.evaluator.is_ok() {
            let complete = |check: CheckResult| check.with_regions(case.frame.size[0]);
            algorithm = case.expected.map(|_| complete(self.algorithm));
            precision = self.double_failure.is_none().then(|| complete(self.precision));
            toolchain = self.toolchain.map(complete);
            notes = notes::notes(&self.observed, self.excludes_pixels, case.lints);
            let not_finite = contain(Part::Notes, || {
                self.not_finite
                    .diagnostic(program?, case.frame, explanation_deadline(0.0))
            });
            match not_finite {
                Ok(note) => notes.extend(note),
                Err(panic) => panics.push(panic),
            }
            notes.extend(self.double_failure.as_ref().map(notes::only_single));
            notes.retain(|note| !case.lints.allows(note));
            let observed = self.observed.faults.iter();
            faults = observed.map(|observed| observed.site.fault).collect();
            // Without a reference, the toolchain is what is checked.
            if let Some(toolchain) = toolchain.as_ref().filter(|_| case.expected.is_some()) {
                let note = notes::toolchain_difference(&toolchain.summary);
                driver_note = driver_note.or(note.filter(|note| !case.lints.allows(note)));
            }
        }
        let results = CheckResults {
            algorithm,
            precision,
            imprecise_reference: self.imprecise_reference,
            toolchain,
            comparison: self.comparison,
            reference: self.reference,
            reference_kind: case.expected.map(Expected::kind),
            actual: self.actual,
            gpu_run,
            notes,
            driver_note,
            faults,
            panics,
            eval: self.eval,
            trace: case.expected.map(|_| self.trace),
        };
        Verified {
            results,
            case,
            program: None,
            failure: self.evaluator.err(),
            stochastic: self.stochastic,
        }
    }
}

/// The reference of a band, with which the algorithm check compares it.
#[derive(Debug, Clone, Copy)]
pub struct BandReference<'a> {
    /// The reference.
    pub expected: &'a Expected,
    /// The rows of the band.
    pub rows: &'a Range<u32>,
    /// The number type in which the shader was evaluated.
    pub number_type: NumberType,
    /// Whether the shader takes derivatives.
    pub derives: bool,
}

impl Reference for BandReference<'_> {
    fn tolerance(&self) -> f64 {
        match self.number_type {
            NumberType::Double => self.expected.tolerance(),
            NumberType::Single => self.expected.tolerance().max(SEEN),
        }
    }
    fn accept_epsilons(&self, band: &mut compare::Band, mixed: &mut EpsilonSearch) {
        self.expected.accept_epsilons(self.rows, band, mixed);
    }
    fn is_across_edge(&self, x: u32, y: u32) -> bool {
        self.derives && self.expected.is_across_edge(x, self.rows.start + y)
    }
    fn tied(&self, wanted: &[bool]) -> Vec<bool> {
        self.expected.tied(self.rows, wanted, self.number_type)
    }
}
