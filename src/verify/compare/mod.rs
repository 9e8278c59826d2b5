//! Compares two images pixel by pixel: the three checks.
//!
//! | check | expected | actual | a difference means |
//! |---|---|---|---|
//! | [`algorithm`] | the reference in f64 | the shader in f64 | the algorithm is wrong |
//! | [`precision`] | the shader in f64 | the GPU in f32 | float32 is not enough here |
//! | [`toolchain`] | the shader in f32 on the CPU | the GPU in f32 | naga, toyproof or the driver broke it |

mod agreement;
mod algorithm;
mod check;
mod images;
mod legend;
mod pair;
mod precision_map;
mod region;
mod result;

pub use agreement::{Agreement, Quantization};
pub use algorithm::{
    Band, EpsilonColors, EpsilonSearch, PERTURBATIONS, Reference, Undefined, accept_epsilons, algorithm,
};
pub(crate) use algorithm::{changed_by_rounding, count_tied, exclude_tied};
pub use check::{
    CheckSummary, EXACT_TOLERANCE, PixelStatus, SEEN, Share, TOLERANCE, diff_levels, precision, toolchain,
    visible_pixels,
};
pub use images::{Comparison, Pixel, compare, compare_within};
pub use legend::{DiffLevel, IN_BITS, Legend, SEEN_BY_EYE, difference};
pub use pair::{Criteria, MaxDiffering, PairDifference, PairError, Rectangle, compare_pair};
pub use precision_map::{ErrorUnit, PrecisionMap};
pub use region::{Region, Regions};
pub use result::CheckResult;
pub(crate) use result::spread;
