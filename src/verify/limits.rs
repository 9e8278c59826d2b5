//! The limits by which differences decide a verdict.

use crate::compare::{CheckSummary, SEEN};

/// The largest share of differing pixels in f64 of a shader that is not wrong. Only legal ray epsilons cause
/// such differences: a ray that grazes an edge between two of the tested epsilons may have the color of
/// neither. Such rays form lines, so that a compact region of differing pixels is a mistake however small.
pub const MAX_DIFFERING: f64 = 0.001;

/// Whether the differing pixels of the algorithm check are a mistake: they are many, or form a compact
/// region.
#[must_use]
pub fn is_different(algorithm: &CheckSummary) -> bool {
    algorithm.share(algorithm.differing) > MAX_DIFFERING || algorithm.regions.largest_compact.is_some()
}

/// The largest share of pixels that visibly change with the number type, or are ill-conditioned in f64, of a
/// shader that is not unstable. Silhouettes of a well-written shader in float32 cause less than a tenth of
/// it.
pub const MAX_UNSTABLE: f64 = 0.003;

/// The largest share of undefined pixels, and of pixels that are ill-conditioned in the reference, for which
/// there is a verdict: a check that excludes everything proves nothing.
pub const MAX_UNDEFINED: f64 = 0.05;

/// The ratio of variances above which the noise of a stochastic shader is reported.
pub(crate) const MAX_VARIANCE_RATIO: f64 = 1.2;

/// The largest undetected difference of means, two and a half 8-bit levels; above it the verdict is
/// inconclusive.
pub(crate) const MAX_BIAS_BOUND: f64 = 0.01;

/// The smallest number of random pixels whose means are compared: with fewer, a mistake in some of them is
/// not detected.
pub(crate) const MIN_RANDOM_PIXELS: u64 = 1000;

/// Whether the driver's image visibly differs from the evaluator's, so that naga, the driver or toyproof is
/// at fault. Not every pixel that depends on undefined behavior is detected: where most pixels do, a few
/// others prove nothing.
#[must_use]
pub(crate) fn is_toolchain_fault(toolchain: &CheckSummary) -> bool {
    toolchain.max_abs > SEEN
        && toolchain.share(toolchain.differing) > MAX_DIFFERING
        && toolchain.differing > toolchain.undefined
}
