//! `sinh`, `cosh`, `tanh` and their inverses (§8.1): polynomials where the formulas by eˣ and ln cancel.

use super::exponential::{exp_parts, power_of_two};
use super::float::Float;
use super::kernel::{flushed, infinity, is_below, is_finite, is_nan, nan, negate_if, polynomial};
use super::logarithmic::ln_of;
use super::two_float::TwoFloat;

/// From here on √(x² ± 1) is x, to far more than 24 bits.
const LARGE: f32 = 16_384.0;
/// Below, asinh(x) and atanh(x) are x to 24 bits, and parts of the formulas would be denormals.
const SMALL: f32 = 1.0 / 4096.0;

/// `(eˣ − e⁻ˣ)/2`
#[inline(always)]
#[must_use]
pub fn sinh<F: Float>(x: F) -> F {
    /// (sinh(x) − x)/x³ as a polynomial of x², |x| ≤ 1, within 2⁻³¹ of sinh(x).
    const P: [f32; 4] = [0.166_666_67, 0.008_333_31, 0.000_198_428_91, 2.782_267e-6];
    let (up, down) = quarters(x);
    let difference = TwoFloat::ordered_sum(up.hi, -down).plus(up.lo).value();
    let z = x * x;
    let a = x.abs();
    let near = a + a * (z * polynomial(z, P));
    let value = F::select(is_below(x, 1.0), near, difference + difference);
    let value = negate_if(value, x.to_bits());
    F::select(is_nan(x), x, value)
}

/// `(eˣ + e⁻ˣ)/2`
#[inline(always)]
#[must_use]
pub fn cosh<F: Float>(x: F) -> F {
    let (up, down) = quarters(x);
    let sum = TwoFloat::ordered_sum(up.hi, down).plus(up.lo).value();
    F::select(is_nan(x), x, sum + sum)
}

/// `sinh(x)/cosh(x)`
#[inline(always)]
#[must_use]
pub fn tanh<F: Float>(x: F) -> F {
    /// (tanh(x) − x)/x³ as a polynomial of x², |x| ≤ 0.36, within 2⁻³⁰ of tanh(x).
    const P: [f32; 4] = [-0.333_333_2, 0.133_322_31, -0.053_701_587, 0.019_314_993];
    let a = x.abs();
    // From there on, tanh is 1 to 24 bits.
    let bounded = a.min(a.literal(10.0));
    let (e, n) = exp_parts(bounded + bounded);
    let scale = power_of_two::<F>(n);
    let (hi, lo) = (e.hi * scale, e.lo * scale);
    let one = a.literal(1.0);
    let above = TwoFloat::ordered_sum(hi, -one).plus(lo).normalised();
    let below = TwoFloat::ordered_sum(hi, one).plus(lo).normalised();
    let z = a * a;
    let near = a + a * (z * polynomial(z, P));
    let value = F::select(is_below(x, 0.35), near, above.over(below).value());
    let value = negate_if(value, x.to_bits());
    F::select(is_nan(x), x, value)
}

/// e^|x|/4 and e^−|x|/4: halves of it can be too large.
#[inline(always)]
fn quarters<F: Float>(x: F) -> (TwoFloat<F>, F) {
    let a = x.abs();
    // From there on both functions are infinite.
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
#[must_use]
pub fn asinh<F: Float>(x: F) -> F {
    let a = x.abs();
    let one = a.literal(1.0);
    let square = a * a;
    let more = square / ((square + one).sqrt() + one);
    let value = negate_if(ln_beyond_one(TwoFloat::ordered_sum(a, more), a), x.to_bits());
    F::select(is_finite(x) & !is_below(x, SMALL), value, flushed(x))
}

/// `ln(x + √(x² − 1))`; NaN where x < 1.
#[inline(always)]
#[must_use]
pub fn acosh<F: Float>(x: F) -> F {
    let one = x.literal(1.0);
    let t = x - one;
    // x² − 1 is 2t + t².
    let square = TwoFloat::product(t, t);
    let root = TwoFloat::sum(t + t, square.hi).plus(square.lo).sqrt();
    let sum = TwoFloat::sum(t, root.hi).plus(root.lo);
    let value = ln_beyond_one(sum, x);
    let value = F::select(one.less(x), value, x.literal(0.0));
    let value = F::select(x.less(one), nan(x), value);
    F::select(is_finite(x) | x.less(one), value, x)
}

/// `ln((1 + x)/(1 − x))/2`; NaN where |x| > 1.
#[inline(always)]
#[must_use]
pub fn atanh<F: Float>(x: F) -> F {
    let a = x.abs();
    let one = a.literal(1.0);
    let quotient = TwoFloat::of(a + a).over(TwoFloat::ordered_sum(one, -a));
    let sum = quotient.below_or_above(one);
    let value = ln_of(sum, a.literal(0.0)) * 0.5;
    let value = F::select(a.less(one), value, infinity(a));
    let value = F::select(one.less(a) | is_nan(a), nan(a), value);
    let value = negate_if(value, x.to_bits());
    F::select(is_below(x, SMALL), flushed(x), value)
}

/// `ln(1 + t)`, or `ln(2·large)` where `large` is.
#[inline(always)]
fn ln_beyond_one<F: Float>(t: TwoFloat<F>, large: F) -> F {
    let one = large.literal(1.0);
    let is_large = !is_below(large, LARGE);
    let sum = TwoFloat::select(is_large, TwoFloat::of(large), t.below_or_above(one));
    ln_of(sum, F::select(is_large, one, one.literal(0.0)))
}
