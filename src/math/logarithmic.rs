//! `log`, `log2`, `pow` (§8.2), and what the inverse hyperbolic functions need of them.
//!
//! x = 2ᵏ·(1 + f) with 1 + f in [√½, √2], and ln(1 + f) = 2·atanh(s) with s = f / (2 + f) (Muller, "Elementary Functions", ch. 11;
//! the arrangement of the sums is fdlibm's).

use std::f64::consts::LN_2;

use super::exponential::exp2_of;
use super::float::{Bits, Float};
use super::kernel::{infinity, is_nan, is_zero, magnitude, nan, polynomial};
use super::two_float::TwoFloat;

/// `ln x`; −∞ of zero, NaN below.
#[inline(always)]
#[must_use]
pub fn log<F: Float>(x: F) -> F {
    let value = ln_of(TwoFloat::of(x), x.literal(0.0));
    F::select(is_regular(x), value, of_irregular(x))
}

/// The binary logarithm of x; −∞ of zero, NaN below.
#[inline(always)]
#[must_use]
pub fn log2<F: Float>(x: F) -> F {
    let value = log2_of(x).value();
    F::select(is_regular(x), value, of_irregular(x))
}

/// `x` to the power of `y`. Of x < 0 NaN; of 0 and infinities, and where y is 0, as in C.
#[inline(always)]
#[must_use]
pub fn pow<F: Float>(x: F, y: F) -> F {
    let regular = is_regular(x);
    let log = log2_of(x);
    let log = TwoFloat {
        hi: F::select(regular, log.hi, of_irregular(x)),
        lo: F::select(regular, log.lo, x.literal(0.0)),
    };
    let product = TwoFloat::product(y, log.hi);
    // Where y is huge, the product's low part is NaN, and what counts is on which side it is.
    let huge = magnitude(product.hi.literal(1e3).max(product.hi.abs()));
    let is_huge = huge.literal(1e3_f32.to_bits()).less(huge);
    let low = F::select(is_huge, y.literal(0.0), product.lo + y * log.lo);
    let power = exp2_of(TwoFloat {
        hi: product.hi,
        lo: low,
    });
    let power = F::select(is_nan(product.hi), nan(x), power);
    let one = x.literal(1.0);
    let is_one = !(x.less(one) | one.less(x) | is_nan(x));
    F::select(is_zero(y) | is_one, one, power)
}

/// Whether it is positive, finite and no denormal.
#[inline(always)]
fn is_regular<F: Float>(x: F) -> F::Truth {
    let bits = x.to_bits() - 0x0080_0000;
    bits.less(bits.literal(0x7F00_0000))
}

/// The logarithms of what is not regular.
#[inline(always)]
fn of_irregular<F: Float>(x: F) -> F {
    // The square root is the same there: NaN below zero and of NaN, infinite of infinity.
    F::select(is_zero(x), -infinity(x), x.sqrt())
}

/// x = 2ᵏ·(1 + f): k, and 1 + f in [√½, √2].
#[inline(always)]
fn split<F: Float>(x: F) -> (F, F) {
    const ROOT_HALF: u32 = 0x3F35_04F3;
    let bits = x.to_bits() + (0x3F80_0000 - ROOT_HALF);
    let k = F::from_signed((bits >> 23) - 127);
    let m = F::from_bits((bits & 0x007F_FFFF) + ROOT_HALF);
    (k, m)
}

/// `ln x + octaves·ln 2` of a sum; for regular numbers. No more than the last bit is wrong.
#[inline(always)]
pub(super) fn ln_of<F: Float>(x: TwoFloat<F>, octaves: F) -> F {
    /// ln 2 to 16 bits, so that multiples by 8 bits are exact; and the rest of it.
    const LN_2_SPLIT: [f32; 2] = [0.693_145_75, 1.428_606_8e-6];
    /// 2·atanh(s) = 2s + s·z·P(z) with z = s², within 2⁻³⁰.
    const P: [f32; 3] = [0.666_667_76, 0.399_775_74, 0.298_712_37];
    let (k, m) = split(x.hi);
    let k = k + octaves;
    let f = m - 1.0;
    let s = f / (f + 2.0);
    let z = s * s;
    let half_square = f * f * 0.5;
    let rest = s * (half_square + z * polynomial(z, P)) + (k * LN_2_SPLIT[1] + x.lo / x.hi);
    k * LN_2_SPLIT[0] - ((half_square - rest) - f)
}

/// The binary logarithm of a regular number, to some 2⁻³⁵ of it.
#[inline(always)]
fn log2_of<F: Float>(x: F) -> TwoFloat<F> {
    /// atanh(s) = s + s·z·(1/3 + z·P(z)) with z = s², within 2⁻³⁶.
    const P: [f32; 3] = [0.200_000_76, 0.142_735_42, 0.117_099_5];
    let (k, m) = split(x);
    let one = x.literal(1.0);
    let s = TwoFloat::of(m - one).over(TwoFloat::ordered_sum(one, m));
    let z = s.times(s);
    let third = TwoFloat::constant(x, 1.0 / 3.0);
    let inner = TwoFloat::ordered_sum(third.hi, z.hi * polynomial(z.hi, P)).plus(third.lo);
    let series = z.times(inner).below(one);
    let log = s.times(series).times(TwoFloat::constant(x, 2.0 / LN_2));
    log.below(k)
}
