//! The results of the three checks, and the verdict that follows from them.

use std::convert::Infallible;
use std::time::{Duration, Instant};

use toyproof_diagnostic::Diagnostic;
use toyproof_eval::{self as eval, Fault, Places};
use toyproof_eval_native::Program;
use toyproof_image::Rgb8Image;

use crate::bounds::explanation_deadline;
use crate::case::Case;
use crate::compare::{CheckResult, Comparison, DiffLevel};
use crate::contain::Panic;
use crate::decide::{Ruling, decide};
use crate::driver::GpuRun;
use crate::evidence::{CheckEvidence, Checks, Evidence};
use crate::expected::ReferenceKind;
use crate::random::replicates::ReplicatedShader;
use crate::random::stochastic::Stochastic;
use crate::random::{NoisyPixel, Reseeding};

/// The images of a shader and the results of its checks.
#[derive(Debug)]
pub struct CheckResults {
    /// The algorithm check; `None` without a reference.
    pub algorithm: Option<CheckResult>,
    /// The precision check.
    pub precision: Option<CheckResult>,
    /// The number of pixels in which float32 is precise enough for neither the shader nor the reference shader,
    /// and double precision is.
    pub imprecise_reference: u64,
    /// The toolchain check; only for strict runs on a GPU.
    pub toolchain: Option<CheckResult>,
    /// The comparison of the shader's image with the reference.
    pub comparison: Option<(Comparison, Vec<DiffLevel>)>,
    /// The reference's image.
    pub reference: Option<Rgb8Image>,
    /// What the reference is; `None` without one.
    pub reference_kind: Option<ReferenceKind>,
    /// The GPU's image, or the evaluator's in f32 without a GPU.
    pub actual: Rgb8Image,
    /// The GPU and its times; `None` if the evaluator rendered the image.
    pub gpu_run: Option<GpuRun>,
    /// Observations of the run, with their lines.
    pub notes: Vec<Diagnostic>,
    /// How the driver's image differs from the evaluator's, or why there is none.
    pub driver_note: Option<Diagnostic>,
    /// The faults that the evaluator observed in f32, each at one place.
    pub faults: Vec<Fault>,
    /// Internal errors; the notes in which they occurred are missing.
    pub panics: Vec<Panic>,
    /// The evaluator's time for all its images.
    pub eval: Duration,
    /// The time of rendering the reference; nearly 0 where it was cached.
    pub trace: Option<Duration>,
}

/// A shader whose three checks have been run.
#[derive(Debug)]
pub struct Verified<'a> {
    /// The results.
    pub results: CheckResults,
    pub(crate) case: &'a Case<'a>,
    pub(crate) program: Option<Program>,
    /// Why the evaluator failed, if it did.
    pub(crate) failure: Option<eval::Failure>,
    /// What is recorded to compare means, for a reference that may be stochastic.
    pub(crate) stochastic: Option<Stochastic<'a>>,
}

/// A shader that was evaluated in double precision, so that the cause of a difference can be searched for.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The shader and its frame.
    pub case: &'a Case<'a>,
    /// The evaluator's program.
    pub program: &'a Program,
    /// The results of the checks.
    pub results: &'a CheckResults,
    pub(crate) stochastic: Option<&'a Stochastic<'a>>,
}

impl<'a> Verified<'a> {
    /// The shader, unless it could not be evaluated in double precision.
    #[must_use]
    pub fn subject(&'a self) -> Option<Subject<'a>> {
        let is_complete = self.failure.is_none() && self.results.precision.is_some();
        let program = self.program.as_ref().filter(|_| is_complete)?;
        Some(Subject {
            case: self.case,
            program,
            results: &self.results,
            stochastic: self.stochastic.as_ref(),
        })
    }

    /// The evidence of the three checks.
    #[must_use]
    pub fn evidence(&self) -> Evidence {
        if let Some(failure) = &self.failure {
            return Evidence::NotEvaluated {
                failure: failure.clone(),
                has_reference: self.results.reference.is_some(),
            };
        }
        let evidence = match self.subject() {
            Some(subject) => subject.evidence(),
            // Only float32 was evaluated: nothing is known of earlier frames.
            None => CheckEvidence {
                checks: self.results.checks(),
                ..CheckEvidence::default()
            },
        };
        evidence.into()
    }

    /// The verdict without any search for a mistake: that of the checks, of the comparison of means if the
    /// shader has other random numbers than its reference, and of the test for self-intersection.
    #[must_use]
    pub fn ruling(&self) -> Ruling {
        match self.subject() {
            Some(subject) => {
                let settlement = subject.settle(explanation_deadline(0.0), |_, _| None::<Infallible>);
                settlement.ruling
            }
            None => decide(self.evidence()),
        }
    }
}

impl CheckResults {
    /// The summaries of the checks.
    #[must_use]
    pub fn checks(&self) -> Checks {
        let summary = |check: &Option<CheckResult>| check.as_ref().map(|check| check.summary.clone());
        Checks {
            algorithm: summary(&self.algorithm),
            precision: summary(&self.precision),
            toolchain: summary(&self.toolchain),
        }
    }
}

impl Subject<'_> {
    /// The evidence of the three checks.
    #[must_use]
    pub fn evidence(&self) -> CheckEvidence {
        CheckEvidence {
            checks: self.results.checks(),
            growth: self.case.from_start.and_then(|from_start| from_start.growth),
            imprecise_reference: self.results.imprecise_reference,
            ..CheckEvidence::default()
        }
    }

    /// Whether the reference may be stochastic.
    #[must_use]
    pub fn may_be_stochastic(&self) -> bool {
        self.stochastic.is_some()
    }

    /// The shader, to be evaluated with other random numbers, if the reference may be stochastic.
    pub(crate) fn replicated_shader(&self, deadline: Instant) -> Option<ReplicatedShader<'_>> {
        Some(ReplicatedShader {
            program: self.program,
            case: self.case,
            reference: self.stochastic?.reference(),
            deadline,
        })
    }

    /// A reseeding that changes pixels of a shader that differs; `None` if the shader has no random numbers,
    /// or the reference has none.
    #[must_use]
    pub fn reseeding(&self, deadline: Instant) -> Option<Reseeding> {
        let shader = self.replicated_shader(deadline)?;
        let algorithm = self.results.algorithm.as_ref()?;
        shader
            .reference
            .is_stochastic()
            .then(|| shader.effective_reseeding(algorithm, 0.0))?
    }

    /// Returns the means of the shader with other random numbers, and of the reference, at these places.
    #[must_use]
    pub fn noisy_pixels(
        &self,
        reseeding: Reseeding,
        places: &Places,
        deadline: Instant,
    ) -> Option<Vec<NoisyPixel>> {
        self.replicated_shader(deadline)?.noisy_pixels(reseeding, places)
    }
}
