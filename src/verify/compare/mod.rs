//! Compares two images pixel by pixel: the three checks.
//!
//! | check | expected | actual | a difference means |
//! |---|---|---|---|
//! | [`algorithm`] | the reference in f64 | the shader in f64 | the algorithm is wrong |
//! | [`precision`] | the shader in f64 | the GPU in f32 | float32 is not enough here |
//! | [`toolchain`] | the shader in f32 on the CPU | the GPU in f32 | naga, toyproof or the driver broke it |

mod algorithm;
mod check;
mod images;
mod legend;
mod mean;
mod region;
mod replicate;

pub use algorithm::{
    Band, EpsilonColors, Mixed, PERTURBATIONS, Reference, Undefined, accept_epsilons, algorithm,
};
pub(crate) use algorithm::{changed_by_rounding, exclude_tied};
pub use check::{
    CheckSummary, EXACT_TOLERANCE, PixelStatus, SEEN, TOLERANCE, diff_levels, precision, toolchain,
};
pub use images::{Comparison, Pixel, compare, compare_in_8_bits};
pub use legend::{DiffLevel, IN_BITS, Legend, SEEN_BY_EYE, difference};
pub(crate) use mean::{MIN_SHARED_CORRELATION, MIN_STANDARD_DEVIATION};
pub use mean::{MeanTest, RandomPixel, means, uses_scene_numbers};
pub use region::{Region, Regions};
pub use replicate::{
    RARE_EVENT_VARIANCE_RATIO, REPLICATES, ReplicateTest, ReplicatedPixel, compare_replicates,
};
pub(crate) use replicate::{is_correlated, neighbor_correlations};
