//! What several functions need: polynomials, signs, and classes of floats, told by their bits.

use super::float::{Bits, Float};

pub(super) const SIGN: u32 = 0x8000_0000;
const INFINITY: u32 = 0x7F80_0000;

/// `c₀ + x·(c₁ + x·(c₂ + …))`, by Horner's rule.
#[inline(always)]
pub(super) fn polynomial<F: Float, const N: usize>(x: F, coefficients: [f32; N]) -> F {
    let mut sum = x * coefficients[N - 1];
    for at in (1..N - 1).rev() {
        sum = (sum + coefficients[at]) * x;
    }
    sum + coefficients[0]
}

/// The encoding without its sign.
#[inline(always)]
pub(super) fn magnitude<F: Float>(x: F) -> F::Bits {
    x.to_bits() & !SIGN
}

/// `−x` where the highest of `bits` is set, `x` elsewhere.
#[inline(always)]
pub(super) fn negate_if<F: Float>(x: F, bits: F::Bits) -> F {
    // What is carried out of the highest bit is lost, so that adding there flips it.
    F::from_bits(x.to_bits() + (bits & SIGN))
}

/// Whether it is less than `limit` in magnitude.
#[inline(always)]
pub(super) fn is_below<F: Float>(x: F, limit: f32) -> F::Truth {
    let magnitude = magnitude(x);
    magnitude.less(magnitude.literal(limit.to_bits()))
}

/// Whether it is zero, or a denormal, which is as good.
#[inline(always)]
pub(super) fn is_zero<F: Float>(x: F) -> F::Truth {
    is_below(x, f32::MIN_POSITIVE)
}

/// Itself, but zero instead of a denormal: a choice alone does not flush.
#[inline(always)]
pub(super) fn flushed<F: Float>(x: F) -> F {
    let bits = x.to_bits();
    F::from_bits(F::Bits::select(is_zero(x), bits & SIGN, bits))
}

/// Whether it is neither infinite nor NaN.
#[inline(always)]
pub(super) fn is_finite<F: Float>(x: F) -> F::Truth {
    is_below(x, f32::INFINITY)
}

/// Whether it is NaN.
#[inline(always)]
pub(super) fn is_nan<F: Float>(x: F) -> F::Truth {
    let magnitude = magnitude(x);
    magnitude.literal(INFINITY).less(magnitude)
}

/// NaN.
#[inline(always)]
pub(super) fn nan<F: Float>(beside: F) -> F {
    beside.literal(f64::NAN)
}

/// +∞.
#[inline(always)]
pub(super) fn infinity<F: Float>(beside: F) -> F {
    beside.literal(f64::INFINITY)
}
