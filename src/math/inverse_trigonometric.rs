//! `asin`, `acos`, `atan` (§8.1).
//!
//! Near ±1, asin(x) is π/2 − 2·asin(√((1 − x)/2)); beyond 1, atan(x) is π/2 − atan(1/x) (Cody and Waite, "Software Manual for the
//! Elementary Functions", 1980).

use std::f64::consts::{FRAC_PI_2, PI};

use super::float::Float;
use super::kernel::{is_nan, negate_if, polynomial};
use super::two_float::TwoFloat;

/// `asin(x)`; NaN where |x| > 1.
#[inline(always)]
#[must_use]
pub fn asin<F: Float>(x: F) -> F {
    let Arcsine { outer, root, series } = arcsine(x);
    let twice = root.hi + root.hi;
    let far = minus(FRAC_PI_2, twice, (root.lo + series) * 2.0);
    let value = F::select(outer, far, x.abs() + series);
    negate_if(value, x.to_bits())
}

/// `acos(x)`; NaN where |x| > 1.
#[inline(always)]
#[must_use]
pub fn acos<F: Float>(x: F) -> F {
    let Arcsine { outer, root, series } = arcsine(x);
    let inner = minus(FRAC_PI_2, x, negate_if(series, x.to_bits()));
    let (twice, rest) = (root.hi + root.hi, (root.lo + series) * 2.0);
    let negative = x.less(x.literal(0.0));
    let far = F::select(negative, minus(PI, twice, rest), twice + rest);
    F::select(outer, far, inner)
}

/// `atan(x)`
#[inline(always)]
#[must_use]
pub fn atan<F: Float>(x: F) -> F {
    let a = x.abs();
    let one = a.literal(1.0);
    let beyond = one.less(a);
    let t = F::select(beyond, one / a, a);
    let series = arctangent(t);
    let value = F::select(beyond, minus(FRAC_PI_2, t, series), t + series);
    negate_if(value, x.to_bits())
}

/// `atan(y, x)`: the angle of (x, y) in [−π, π]; of zeros and infinities as in C.
#[inline(always)]
#[must_use]
pub fn atan2<F: Float>(y: F, x: F) -> F {
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ax.less(ay);
    let smaller = F::select(steep, ax, ay);
    let larger = F::select(steep, ay, ax);
    let t = smaller / larger;
    // Quotients that are denormal or next to it, and 0/0, are 0; ∞/∞ is 1.
    let t = F::select(t.literal(f32::MIN_POSITIVE.into()).less(t), t, t.literal(0.0));
    let t = F::select(t.literal(f32::MAX.into()).less(smaller), t.literal(1.0), t);
    let series = arctangent(t);
    let near = t + series;
    let quarter = minus(FRAC_PI_2, t, series);
    let past_quarter = minus(FRAC_PI_2, -t, -series);
    let half = minus(PI, t, series);
    // −0 lies on the left as well.
    let left = negate_if(x.literal(1.0), x.to_bits()).less(x.literal(0.0));
    let value = F::select(
        steep,
        F::select(left, past_quarter, quarter),
        F::select(left, half, near),
    );
    let value = negate_if(value, y.to_bits());
    F::select(is_nan(x) | is_nan(y), x + y, value)
}

/// The angle `whole − (hi + lo)`, where hi is not larger.
#[inline(always)]
fn minus<F: Float>(whole: f64, hi: F, lo: F) -> F {
    let whole = TwoFloat::constant(hi, whole);
    let sum = TwoFloat::ordered_sum(whole.hi, -hi);
    sum.plus(whole.lo - lo).value()
}

/// What asin and acos share.
struct Arcsine<F: Float> {
    /// Whether |x| > ½.
    outer: F::Truth,
    /// √((1 − |x|)/2)
    root: TwoFloat<F>,
    /// asin(t) − t, where t is `root` if `outer`, |x| else.
    series: F,
}

#[inline(always)]
fn arcsine<F: Float>(x: F) -> Arcsine<F> {
    /// (asin(t) − t)/t³ as a polynomial of t², t ≤ ½, within 2⁻²⁷ of asin(t).
    const P: [f32; 5] = [
        0.166_667_52,
        0.074_953_064,
        0.045_469_772,
        0.024_180_772,
        0.042_166_423,
    ];
    let a = x.abs();
    let outer = a.literal(0.5).less(a);
    let half = (a.literal(1.0) - a) * 0.5;
    let root = TwoFloat::of(half).sqrt();
    let t = F::select(outer, root.hi, a);
    let z = F::select(outer, half, a * a);
    let series = t * (z * polynomial(z, P));
    Arcsine { outer, root, series }
}

/// atan(t) − t of t in [0, 1], within 2⁻²⁶ of atan(t).
#[inline(always)]
fn arctangent<F: Float>(t: F) -> F {
    const P: [f32; 9] = [
        -0.333_333_02,
        0.199_985_5,
        -0.142_642_41,
        0.109_521_84,
        -0.084_034_47,
        0.057_957_556,
        -0.031_177_811,
        0.010_914_59,
        -0.001_793_618_2,
    ];
    let z = t * t;
    t * (z * polynomial(z, P))
}
