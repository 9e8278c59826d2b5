//! What a verdict depends on.

use toyproof_eval as eval;
use toyproof_scene::Sampler;

use crate::compare::{CheckSummary, Share};
use crate::failure::Failure;
use crate::project::growth::VisibleGrowth;
use crate::random::mean_test::MeanTest;
use crate::random::replicate_test::ReplicateTest;

/// Everything that a verdict depends on.
#[derive(Debug, Clone)]
pub enum Evidence {
    /// There is no image of the shader.
    NoImage(Failure),
    /// The GPU rendered the shader, but the evaluator failed, so that no check was run.
    NotEvaluated {
        /// Why the evaluator failed.
        failure: eval::Failure,
        /// Whether there is a reference to compare with.
        has_reference: bool,
    },
    /// The shader was checked.
    Checked(Box<CheckEvidence>),
}

impl From<CheckEvidence> for Evidence {
    fn from(evidence: CheckEvidence) -> Self {
        Self::Checked(Box::new(evidence))
    }
}

/// The results of the three checks; none for a check that was not run.
#[derive(Debug, Clone, Default)]
pub struct Checks {
    /// The shader in f64 against the reference in f64.
    pub algorithm: Option<CheckSummary>,
    /// The image in f32 against the shader in f64.
    pub precision: Option<CheckSummary>,
    /// The GPU in f32 against the CPU in f32, in bits.
    pub toolchain: Option<CheckSummary>,
}

/// The results of the checks, and of the tests that a difference calls for.
#[derive(Debug, Clone, Default)]
pub struct CheckEvidence {
    /// The three checks.
    pub checks: Checks,
    /// The visible difference that earlier frames cause between float32 and double precision.
    pub growth: Option<VisibleGrowth>,
    /// The comparison of means, where the shader differs from its scene only by its random numbers.
    pub random_numbers: Option<OtherRandomNumbers>,
    /// The pixels in which rounding decides whether a ray hits the surface that it starts from, where there
    /// are enough of them to explain the difference.
    pub self_intersection: Option<SelfIntersection>,
    /// The number of pixels in which float32 is precise enough for neither the shader nor the reference shader,
    /// and double precision is.
    pub imprecise_reference: u64,
}

/// Pixels in which rounding decides whether a ray hits the surface that it starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SelfIntersection {
    /// The pixels.
    pub pixels: Share,
    /// Whether rounding decides in double precision too.
    pub in_double: bool,
}

/// A shader that differs from a stochastic reference only in pixels that depend on random numbers.
#[derive(Debug, Clone)]
pub struct OtherRandomNumbers {
    /// The scene's sampler; none for other references.
    pub sampler: Option<Sampler>,
    /// The number of samples per pixel of the reference, if it is known.
    pub samples: Option<u32>,
    /// The comparison of the means.
    pub means: MeanComparison,
    /// The checks without the pixels that depend on random numbers.
    pub other_pixels: Checks,
}

/// How the means of a shader and of its reference were compared.
#[derive(Debug, Clone)]
pub enum MeanComparison {
    /// By replicates: evaluations of the shader with other random numbers.
    Replicates {
        /// The result.
        test: ReplicateTest,
        /// The number of pixels that were compared.
        pixels: u64,
        /// The shader's number of samples, if a smaller one than the scene's explains its noise.
        fewer_samples: Option<u32>,
    },
    /// By the one image of the shader, where its random numbers could not be changed.
    OneImage {
        /// The result.
        test: MeanTest,
        /// The number of pixels that were compared.
        pixels: u64,
    },
    /// Not at all: the reference, or the shader, cannot be rendered with other random numbers.
    UnknownNoise,
}
