//! Exponential, logarithmic and hyperbolic functions (§8.2, §8.1).
//!
//! `exp` and `exp2` are 2ⁿ·eʳ with |r| ≤ ln 2 / 2 (Muller, "Elementary Functions", ch. 11; Cody and Waite's
//! split of ln 2).

use std::f64::consts::LN_2;

use super::algebraic::dot;
use super::float::{
    Bits, Float, Number, flushed, infinity, is_below, is_finite, is_nan, is_zero, magnitude, nan, negate_if,
    polynomial,
};
use super::two_float::TwoFloat;

/// ln 2 to 16 bits, so that multiples by 8-bit integers are exact; and the remainder.
const LN_2_SPLIT: [f32; 2] = [0.693_145_75, 1.428_606_8e-6];

/// `eˣ`
#[inline(always)]
pub fn exp<F: Float>(x: F) -> F {
    let (value, n) = exp_parts(x);
    let value = scaled(value.value(), n);
    let value = F::select(x.less(x.literal((-87.336_55_f32).into())), x.literal(0.0), value);
    let value = F::select(x.literal(88.722_83_f32.into()).less(x), infinity(x), value);
    F::select(is_nan(x), x, value)
}

/// `2ˣ`
#[inline(always)]
pub fn exp2<F: Float>(x: F) -> F {
    let value = exp2_of(TwoFloat::from_float(x));
    F::select(is_nan(x), x, value)
}

/// 2 to a power of more than 24 bits; undefined for NaN.
#[inline(always)]
fn exp2_of<F: Float>(x: TwoFloat<F>) -> F {
    let (whole, n) = round_to_integer(x.hi);
    let fraction = TwoFloat::ordered_sum(x.hi - whole, x.lo);
    let ln2 = TwoFloat::constant(x.hi, LN_2);
    let r = TwoFloat {
        hi: fraction.hi * ln2.hi,
        lo: fraction.hi * ln2.lo + fraction.lo * ln2.hi,
    };
    let value = scaled(exp_kernel(r).value(), n);
    let zero = x.hi.literal(0.0);
    let value = F::select((x.hi + 126.0 + x.lo).less(zero), zero, value);
    F::select((x.hi - 128.0 + x.lo).less(zero), value, infinity(zero))
}

/// eˣ as v·2ⁿ with v in [0.7, 1.5], for |x| ≤ 100.
#[inline(always)]
fn exp_parts<F: Float>(x: F) -> (TwoFloat<F>, F::Bits) {
    let (whole, n) = round_to_integer(x * std::f32::consts::LOG2_E);
    let high = x - whole * LN_2_SPLIT[0];
    let r = TwoFloat::sum(high, -(whole * LN_2_SPLIT[1]));
    (exp_kernel(r), n)
}

/// The nearest integer, as a float and as the low bits of an integer, for |x| ≤ 2²².
#[inline(always)]
fn round_to_integer<F: Float>(x: F) -> (F, F::Bits) {
    // Around 1.5·2²³, floats are the integers.
    const SHIFT: f32 = 12_582_912.0;
    let shifted = x + SHIFT;
    (shifted - SHIFT, shifted.to_bits() - SHIFT.to_bits())
}

/// eʳ for |r| ≤ ln 2 / 2: 1 + r + r²·P(r), within 2⁻²⁸.
#[inline(always)]
fn exp_kernel<F: Float>(r: TwoFloat<F>) -> TwoFloat<F> {
    const P: [f32; 5] = [
        0.499_999_94,
        0.166_665_12,
        0.041_668_043,
        0.008_369_717,
        0.001_384_566_9,
    ];
    let sum = TwoFloat::ordered_sum(r.hi.literal(1.0), r.hi);
    sum.add_low(r.hi * r.hi * polynomial(r.hi, P) + r.lo)
}

/// `x·2ⁿ` for x in [0.7, 1.5]; 0 if the result is denormal.
#[inline(always)]
fn scaled<F: Float>(x: F, n: F::Bits) -> F {
    let bits = x.to_bits() + (n << 23);
    let zero = bits.literal(0);
    F::from_bits(F::Bits::select(bits.less(zero.literal(0x0080_0000)), zero, bits))
}

/// 2ⁿ for n in −126 to 127.
#[inline(always)]
fn power_of_two<F: Float>(n: F::Bits) -> F {
    F::from_bits((n + 127) << 23)
}

// Logarithms and `pow` (§8.2). The inverse hyperbolic functions share `ln_of`.
//
// x = 2ᵏ·(1 + f) with 1 + f in [√½, √2], and ln(1 + f) = 2·atanh(s) with s = f / (2 + f) (Muller,
// "Elementary Functions", ch. 11; the arrangement of the sums is fdlibm's).

/// `ln x`; −∞ for zero, NaN below.
#[inline(always)]
pub fn log<F: Float>(x: F) -> F {
    let value = ln_of(TwoFloat::from_float(x), x.literal(0.0));
    F::select(is_positive_normal(x), value, log_of_special(x))
}

/// The binary logarithm of x; −∞ for zero, NaN below.
#[inline(always)]
pub fn log2<F: Float>(x: F) -> F {
    let value = log2_of(x).value();
    F::select(is_positive_normal(x), value, log_of_special(x))
}

/// The level of the mipmaps (OpenGL ES 3.0.6, equation 3.17): log₂ of the longer of two vectors, the
/// derivatives of the coordinates in texels along x and y.
///
/// # Panics
/// If a vector has no components.
pub fn level_of_detail<F: Float>(along_x: &[F], along_y: &[F]) -> F {
    let square = longer_square(along_x, along_y);
    log2(square) * square.literal(0.5)
}

/// The square of the length of the longer of two vectors.
///
/// # Panics
/// If a vector has no components.
pub fn longer_square<N: Number>(a: &[N], b: &[N]) -> N {
    dot(a, a).max(dot(b, b))
}

/// `x` to the power of `y`. NaN for x < 0; for zero and infinite x, and for y = 0, as in C.
#[inline(always)]
pub fn pow<F: Float>(x: F, y: F) -> F {
    let is_normal = is_positive_normal(x);
    let log = log2_of(x);
    let log = TwoFloat {
        hi: F::select(is_normal, log.hi, log_of_special(x)),
        lo: F::select(is_normal, log.lo, x.literal(0.0)),
    };
    let product = TwoFloat::product(y, log.hi);
    // If |product| > 1000, its low part may be NaN, and only the sign of the product matters.
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

/// Whether it is positive, finite and normal.
#[inline(always)]
fn is_positive_normal<F: Float>(x: F) -> F::Bool {
    let bits = x.to_bits() - 0x0080_0000;
    bits.less(bits.literal(0x7F00_0000))
}

/// The logarithm of numbers that are not positive and normal, in any base.
#[inline(always)]
fn log_of_special<F: Float>(x: F) -> F {
    // The square root agrees there: NaN below zero and for NaN, infinite for infinity.
    F::select(is_zero(x), -infinity(x), x.sqrt())
}

/// Splits x = 2ᵏ·(1 + f) into k and 1 + f in [√½, √2].
#[inline(always)]
fn split<F: Float>(x: F) -> (F, F) {
    const SQRT_HALF_BITS: u32 = 0x3F35_04F3;
    let bits = x.to_bits() + (0x3F80_0000 - SQRT_HALF_BITS);
    let k = F::from_signed((bits >> 23) - 127);
    let m = F::from_bits((bits & 0x007F_FFFF) + SQRT_HALF_BITS);
    (k, m)
}

/// `ln x + octaves·ln 2` for positive normal x; at most the last bit is wrong.
#[inline(always)]
fn ln_of<F: Float>(x: TwoFloat<F>, octaves: F) -> F {
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

/// The binary logarithm of a positive normal number, with a relative error of about 2⁻³⁵.
#[inline(always)]
fn log2_of<F: Float>(x: F) -> TwoFloat<F> {
    /// atanh(s) = s + s·z·(1/3 + z·P(z)) with z = s², within 2⁻³⁶.
    const P: [f32; 3] = [0.200_000_76, 0.142_735_42, 0.117_099_5];
    let (k, m) = split(x);
    let one = x.literal(1.0);
    let s = TwoFloat::from_float(m - one).divided_by(TwoFloat::ordered_sum(one, m));
    let z = s.times(s);
    let third = TwoFloat::constant(x, 1.0 / 3.0);
    let inner = TwoFloat::ordered_sum(third.hi, z.hi * polynomial(z.hi, P)).add_low(third.lo);
    let series = z.times(inner).add_to_larger(one);
    let log = s.times(series).times(TwoFloat::constant(x, 2.0 / LN_2));
    log.add_to_larger(k)
}

// `sinh`, `cosh`, `tanh` and their inverses (§8.1): polynomials where the formulas in eˣ and ln suffer
// cancellation.

/// From this value on, √(x² ± 1) is x, to far more than 24 bits.
const LARGE_ARGUMENT: f32 = 16_384.0;
/// Below this value, asinh(x) and atanh(x) are x to 24 bits, and intermediate results would be denormal.
const SMALL_ARGUMENT: f32 = 1.0 / 4096.0;

/// `(eˣ − e⁻ˣ)/2`
#[inline(always)]
pub fn sinh<F: Float>(x: F) -> F {
    /// (sinh(x) − x)/x³ as a polynomial of x², |x| ≤ 1, within 2⁻³¹ of sinh(x).
    const P: [f32; 4] = [0.166_666_67, 0.008_333_31, 0.000_198_428_91, 2.782_267e-6];
    let (up, down) = quarter_exponentials(x);
    let difference = TwoFloat::ordered_sum(up.hi, -down).add_low(up.lo).value();
    let z = x * x;
    let a = x.abs();
    let near = a + a * (z * polynomial(z, P));
    let value = F::select(is_below(x, 1.0), near, difference + difference);
    let value = negate_if(value, x.to_bits());
    F::select(is_nan(x), x, value)
}

/// `(eˣ + e⁻ˣ)/2`
#[inline(always)]
pub fn cosh<F: Float>(x: F) -> F {
    let (up, down) = quarter_exponentials(x);
    let sum = TwoFloat::ordered_sum(up.hi, down).add_low(up.lo).value();
    F::select(is_nan(x), x, sum + sum)
}

/// `sinh(x)/cosh(x)`
#[inline(always)]
pub fn tanh<F: Float>(x: F) -> F {
    /// (tanh(x) − x)/x³ as a polynomial of x², |x| ≤ 0.36, within 2⁻³⁰ of tanh(x).
    const P: [f32; 4] = [-0.333_333_2, 0.133_322_31, -0.053_701_587, 0.019_314_993];
    let a = x.abs();
    // From 10 on, tanh is 1 to 24 bits.
    let bounded = a.min(a.literal(10.0));
    let (e, n) = exp_parts(bounded + bounded);
    let scale = power_of_two::<F>(n);
    let (hi, lo) = (e.hi * scale, e.lo * scale);
    let one = a.literal(1.0);
    let above = TwoFloat::ordered_sum(hi, -one).add_low(lo).normalized();
    let below = TwoFloat::ordered_sum(hi, one).add_low(lo).normalized();
    let z = a * a;
    let near = a + a * (z * polynomial(z, P));
    let value = F::select(is_below(x, 0.35), near, above.divided_by(below).value());
    let value = negate_if(value, x.to_bits());
    F::select(is_nan(x), x, value)
}

/// e^|x|/4 and e^−|x|/4, since half of e^|x| may overflow.
#[inline(always)]
fn quarter_exponentials<F: Float>(x: F) -> (TwoFloat<F>, F) {
    let a = x.abs();
    // From 89.5 on, both functions are infinite.
    let (e, n) = exp_parts(a.min(a.literal(89.5)));
    let scale = power_of_two::<F>(n - 2);
    let up = TwoFloat {
        hi: e.hi * scale,
        lo: e.lo * scale,
    };
    (up, x.literal(1.0 / 16.0) / up.value())
}

/// `ln(x + √(x² + 1))`
#[inline(always)]
pub fn asinh<F: Float>(x: F) -> F {
    let a = x.abs();
    let one = a.literal(1.0);
    let square = a * a;
    let more = square / ((square + one).sqrt() + one);
    let value = negate_if(ln_beyond_one(TwoFloat::ordered_sum(a, more), a), x.to_bits());
    F::select(is_finite(x) & !is_below(x, SMALL_ARGUMENT), value, flushed(x))
}

/// `ln(x + √(x² − 1))`; NaN for x < 1.
#[inline(always)]
pub fn acosh<F: Float>(x: F) -> F {
    let one = x.literal(1.0);
    let t = x - one;
    // x² − 1 is 2t + t².
    let square = TwoFloat::product(t, t);
    let root = TwoFloat::sum(t + t, square.hi).add_low(square.lo).sqrt();
    let sum = TwoFloat::sum(t, root.hi).add_low(root.lo);
    let value = ln_beyond_one(sum, x);
    let value = F::select(one.less(x), value, x.literal(0.0));
    let value = F::select(x.less(one), nan(x), value);
    F::select(is_finite(x) | x.less(one), value, x)
}

/// `ln((1 + x)/(1 − x))/2`; NaN for |x| > 1.
#[inline(always)]
pub fn atanh<F: Float>(x: F) -> F {
    let a = x.abs();
    let one = a.literal(1.0);
    let quotient = TwoFloat::from_float(a + a).divided_by(TwoFloat::ordered_sum(one, -a));
    let sum = quotient.add_to(one);
    let value = ln_of(sum, a.literal(0.0)) * 0.5;
    let value = F::select(a.less(one), value, infinity(a));
    let value = F::select(one.less(a) | is_nan(a), nan(a), value);
    let value = negate_if(value, x.to_bits());
    F::select(is_below(x, SMALL_ARGUMENT), flushed(x), value)
}

/// `ln(1 + t)`, or `ln(2·large)` if `large` is at least `LARGE_ARGUMENT`.
#[inline(always)]
fn ln_beyond_one<F: Float>(t: TwoFloat<F>, large: F) -> F {
    let one = large.literal(1.0);
    let is_large = !is_below(large, LARGE_ARGUMENT);
    let sum = TwoFloat::select(is_large, TwoFloat::from_float(large), t.add_to(one));
    ln_of(sum, F::select(is_large, one, one.literal(0.0)))
}
