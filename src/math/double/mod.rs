//! Functions of f64 for several arguments at once: the accuracy of libm, without a call for each argument.
//!
//! Most arguments take one path without branches, calls or tables, so that loops over them are vectorized. The
//! others are computed one by one: infinite, denormal and very large ones, and results that overflow. A result
//! does not depend on the other arguments, nor on the processor: products and sums are never fused.
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

mod exponential;
mod power;
mod trigonometric;

#[cfg(test)]
mod tests;

pub use self::exponential::{exp, log};
pub use self::power::pow;
pub use self::trigonometric::{cos, sin, sin_cos};

/// A float to which an integer of less than 51 bits is added to convert it: the sum has the integer, in two's
/// complement, in its lowest bits. Rounding to the nearest integer is the same sum.
const INTEGER: f64 = 1.5 * (1_u64 << 52) as f64;

/// The lower half of the encoding.
const LOW_WORD: u64 = 0xFFFF_FFFF;
/// The part of the encoding that is the fraction.
const FRACTION: u64 = (1 << 52) - 1;

/// The value with its lowest 32 bits cleared: the product of two such values is exact.
#[inline(always)]
fn head(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & !LOW_WORD)
}

/// `x·2ⁿ`, for an integer n in [`INTEGER`]'s form, if both numbers are normal.
#[inline(always)]
fn scaled(x: f64, n: f64) -> f64 {
    f64::from_bits(x.to_bits().wrapping_add((n + INTEGER).to_bits() << 52))
}

/// The biased exponent as a float, for positive numbers.
#[inline(always)]
fn exponent(x: f64) -> f64 {
    const TWO_52: u64 = 0x4330_0000_0000_0000;
    f64::from_bits(x.to_bits() >> 52 | TWO_52) - f64::from_bits(TWO_52)
}

/// Whether it is positive, and neither denormal nor infinite.
#[inline(always)]
fn is_normal_positive(x: f64) -> bool {
    (x >= f64::MIN_POSITIVE) & (x < f64::INFINITY)
}

/// Computes all results by the path without branches, and those of irregular arguments again. A macro, since a
/// closure is a call in the loop if it is large.
macro_rules! each {
    ($lane:ident, $is_regular:expr, $regular:expr, $other:expr) => {{
        let mut results = [0.0; L];
        let mut irregular = 0_u64;
        for $lane in 0..L {
            results[$lane] = $regular;
            let is_regular: bool = $is_regular;
            irregular += u64::from(!is_regular);
        }
        if irregular > 0 {
            for $lane in 0..L {
                let is_regular: bool = $is_regular;
                if !is_regular {
                    results[$lane] = $other;
                }
            }
        }
        results
    }};
}
use each;
