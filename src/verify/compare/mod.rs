//! Two pictures, pixel by pixel, and what their difference means: the three questions.
//!
//! | question | expected | actual | a difference means |
//! |---|---|---|---|
//! | [`maths`] | the tracer in f64 | the shader in f64 | the algorithm is wrong |
//! | [`rounding`] | the shader in f64 | the GPU in f32 | float32 is not enough here |
//! | [`toolchain`] | the shader in f32 on the CPU | the GPU in f32 | naga, toyproof or the driver broke it |

mod answer;
mod fit;
mod judge;
mod legend;
mod maths;
mod mean;
mod picture;
mod replicate;
mod rounding;
mod tolerance;
mod toolchain;

pub use answer::{Answer, Standing, marks};
pub use judge::{
    Answers, MAX_DIFFERING, MAX_UNDEFINED, MAX_UNSTABLE, Verdict, differing, grouped, judge, magnitude,
    plural,
};
pub use legend::{Legend, Mark, difference};
pub use maths::{Mixed, Reference, SHAKES, maths};
pub use mean::{DrawnPixel, Means, follows_scene, means};
pub use picture::{Comparison, Pixel, compare};
pub use replicate::{RARE_EVENTS, REPLICATES, Replicated, ReplicatedPixel, replicated};
pub use rounding::{SEEN, rounding};
pub use tolerance::{EXACT_TOLERANCE, IN_BITS, SEEN_BY_EYE, TOLERANCE};
pub use toolchain::toolchain;
