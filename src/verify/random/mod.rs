//! Shaders that use other random numbers than their stochastic reference: their means are compared.
//!
//! - `stochastic`: when and how means are compared
//! - `estimates`, `reference`: the reference with other random numbers
//! - `reseed`, `pixel_dependence`: the shader with other random numbers
//! - `replicates`, `replicate_test`: the means over several evaluations of the shader
//! - `mean_test`: the means over many pixels of its one image
//! - `sample_count`: whether the shader takes fewer samples

pub(crate) mod estimates;
pub(crate) mod mean_test;
mod pixel_dependence;
mod reference;
pub(crate) mod replicate_test;
pub(crate) mod replicates;
pub(crate) mod reseed;
mod sample_count;
pub(crate) mod stochastic;

pub use self::mean_test::MeanTest;
pub use self::replicate_test::{Bias, ReplicateTest};
pub use self::replicates::{MEAN_SETS, NoisyPixel};
pub use self::reseed::{Reseeding, reachable_expressions};
