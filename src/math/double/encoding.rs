//! The parts of a float's encoding, and the loop over several arguments.

/// A float to which an integer of less than 51 bits is added to convert it: the sum has the integer, in two's
/// complement, in its lowest bits. Rounding to the nearest integer is the same sum.
pub(super) const INTEGER: f64 = 1.5 * (1_u64 << 52) as f64;

/// The lower half of the encoding.
pub(super) const LOW_WORD: u64 = 0xFFFF_FFFF;
/// The part of the encoding that is the fraction.
pub(super) const FRACTION: u64 = (1 << 52) - 1;

/// The value with its lowest 32 bits cleared: the product of two such values is exact.
#[inline(always)]
pub(super) fn head(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & !LOW_WORD)
}

/// `x·2ⁿ`, for an integer n in [`INTEGER`]'s form, if both numbers are normal.
#[inline(always)]
pub(super) fn scaled(x: f64, n: f64) -> f64 {
    f64::from_bits(x.to_bits().wrapping_add((n + INTEGER).to_bits() << 52))
}

/// The biased exponent as a float, for positive numbers.
#[inline(always)]
pub(super) fn exponent(x: f64) -> f64 {
    const TWO_52: u64 = 0x4330_0000_0000_0000;
    f64::from_bits(x.to_bits() >> 52 | TWO_52) - f64::from_bits(TWO_52)
}

/// Whether it is positive, and neither denormal nor infinite.
#[inline(always)]
pub(super) fn is_normal_positive(x: f64) -> bool {
    (x >= f64::MIN_POSITIVE) & (x < f64::INFINITY)
}

/// Computes all results by the path without branches, and those of irregular arguments again. A macro, since
/// a closure is a call in the loop if it is large.
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
pub(super) use each;
