//! Functions of f64 for several arguments at once: the accuracy of libm, without a call for each argument.
//!
//! Most arguments take one path without branches, calls or tables, so that loops over them are vectorized.
//! The others are computed one by one: infinite, denormal and very large ones, and results that overflow. A
//! result does not depend on the other arguments, nor on the processor: products and sums are never fused.
//!
//! ```
//! use toyproof_math::double;
//!
//! assert_eq!(double::pow([2.0, 9.0], [3.0, 0.5]), [8.0, 3.0]);
//! ```

#![expect(
    clippy::needless_bitwise_bool,
    clippy::manual_range_contains,
    reason = "loops are vectorized without branches"
)]

mod encoding;
mod exponential;
mod power;
mod trigonometric;

#[cfg(test)]
mod tests;

pub use self::exponential::{exp, log};
pub use self::power::pow;
pub use self::trigonometric::{cos, sin, sin_cos};
