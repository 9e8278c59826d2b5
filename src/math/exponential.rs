//! `exp`, `exp2` (§8.2), and what `pow` and the hyperbolic functions need of them.
//!
//! 2ⁿ·eʳ with |r| ≤ ln 2 / 2 (Muller, "Elementary Functions", ch. 11; Cody and Waite's split of ln 2).

use std::f64::consts::LN_2;

use super::float::{Bits, Float};
use super::kernel::{infinity, is_nan, polynomial};
use super::two_float::TwoFloat;

/// `eˣ`
#[inline(always)]
#[must_use]
pub fn exp<F: Float>(x: F) -> F {
    let (value, n) = exp_parts(x);
    let value = scaled(value.value(), n);
    let value = F::select(x.less(x.literal((-87.336_55_f32).into())), x.literal(0.0), value);
    let value = F::select(x.literal(88.722_83_f32.into()).less(x), infinity(x), value);
    F::select(is_nan(x), x, value)
}

/// `2ˣ`
#[inline(always)]
#[must_use]
pub fn exp2<F: Float>(x: F) -> F {
    let value = exp2_of(TwoFloat::of(x));
    F::select(is_nan(x), x, value)
}

/// 2 to a power that is given to more than 24 bits; garbage of NaN.
#[inline(always)]
pub(super) fn exp2_of<F: Float>(x: TwoFloat<F>) -> F {
    let (whole, n) = nearest(x.hi);
    let fraction = TwoFloat::ordered_sum(x.hi - whole, x.lo);
    let ln2 = TwoFloat::constant(x.hi, LN_2);
    let r = TwoFloat {
        hi: fraction.hi * ln2.hi,
        lo: fraction.hi * ln2.lo + fraction.lo * ln2.hi,
    };
    let value = scaled(kernel(r).value(), n);
    let zero = x.hi.literal(0.0);
    let value = F::select((x.hi + 126.0 + x.lo).less(zero), zero, value);
    F::select((x.hi - 128.0 + x.lo).less(zero), value, infinity(zero))
}

/// eˣ as v·2ⁿ with v in [0.7, 1.5]; |x| at most 100.
#[inline(always)]
pub(super) fn exp_parts<F: Float>(x: F) -> (TwoFloat<F>, F::Bits) {
    /// ln 2 to 16 bits, so that multiples by 8 bits are exact; and the rest of it.
    const LN_2_SPLIT: [f32; 2] = [0.693_145_75, 1.428_606_8e-6];
    let (whole, n) = nearest(x * std::f32::consts::LOG2_E);
    let high = x - whole * LN_2_SPLIT[0];
    let r = TwoFloat::sum(high, -(whole * LN_2_SPLIT[1]));
    (kernel(r), n)
}

/// The nearest integer, as a float and as the low bits of an integer; |x| at most 2²².
#[inline(always)]
fn nearest<F: Float>(x: F) -> (F, F::Bits) {
    // Around 1.5·2²³ floats are integers.
    const SHIFT: f32 = 12_582_912.0;
    let shifted = x + SHIFT;
    (shifted - SHIFT, shifted.to_bits() - SHIFT.to_bits())
}

/// eʳ of |r| ≤ ln 2 / 2: 1 + r + r²·P(r), within 2⁻²⁸.
#[inline(always)]
fn kernel<F: Float>(r: TwoFloat<F>) -> TwoFloat<F> {
    const P: [f32; 5] = [
        0.499_999_94,
        0.166_665_12,
        0.041_668_043,
        0.008_369_717,
        0.001_384_566_9,
    ];
    let sum = TwoFloat::ordered_sum(r.hi.literal(1.0), r.hi);
    sum.plus(r.hi * r.hi * polynomial(r.hi, P) + r.lo)
}

/// `x·2ⁿ` of x in [0.7, 1.5]; 0 where that is a denormal.
#[inline(always)]
fn scaled<F: Float>(x: F, n: F::Bits) -> F {
    let bits = x.to_bits() + (n << 23);
    let zero = bits.literal(0);
    F::from_bits(F::Bits::select(bits.less(zero.literal(0x0080_0000)), zero, bits))
}

/// 2ⁿ of n in −126 to 127.
#[inline(always)]
pub(super) fn power_of_two<F: Float>(n: F::Bits) -> F {
    F::from_bits((n + 127) << 23)
}
