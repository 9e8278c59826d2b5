//! Trigonometric functions and their inverses (§8.1).
//!
//! One path for all arguments: x·2/π in integers, with as many bits of 2/π as the exponent of x requires
//! (Payne and Hanek, "Radian reduction for trigonometric functions", 1983; Muller, "Elementary Functions",
//! ch. 11). A shorter path for small arguments would save nothing on SIMD machines, which compute both sides
//! of a branch.

use std::f32::consts::FRAC_PI_4;
use std::f64::consts::{FRAC_PI_2, PI};

use super::float::{
    Bits, Float, flushed, is_below, is_finite, is_nan, magnitude, nan, negate_if, polynomial,
};
use super::two_float::TwoFloat;

/// `sin(x)`, x in radians; NaN for infinities.
#[inline(always)]
pub fn sin<F: Float>(x: F) -> F {
    let (r, quadrant) = reduce(x);
    let value = TwoFloat::select(is_odd::<F>(quadrant), cosine(r), sine(r));
    signed_sine(x, quadrant, value)
}

/// `cos(x)`, x in radians; NaN for infinities.
#[inline(always)]
pub fn cos<F: Float>(x: F) -> F {
    let (r, quadrant) = reduce(x);
    let value = TwoFloat::select(is_odd::<F>(quadrant), sine(r), cosine(r));
    signed_cosine(x, quadrant, value)
}

/// `sin(x)` and `cos(x)`, with the bits that they have alone.
#[inline(always)]
pub fn sin_cos<F: Float>(x: F) -> (F, F) {
    let (r, quadrant) = reduce(x);
    let (odd, sine, cosine) = (is_odd::<F>(quadrant), sine(r), cosine(r));
    (
        signed_sine(x, quadrant, TwoFloat::select(odd, cosine, sine)),
        signed_cosine(x, quadrant, TwoFloat::select(odd, sine, cosine)),
    )
}

/// `sin(x)` with its sign, from the magnitude in x's quadrant.
#[inline(always)]
fn signed_sine<F: Float>(x: F, quadrant: F::Bits, value: TwoFloat<F>) -> F {
    let value = negate_if(negate_if(value.value(), quadrant << 30), x.to_bits());
    F::select(is_finite(x), value, nan(x))
}

/// `cos(x)` with its sign, from the magnitude in x's quadrant.
#[inline(always)]
fn signed_cosine<F: Float>(x: F, quadrant: F::Bits, value: TwoFloat<F>) -> F {
    let value = negate_if(value.value(), (quadrant + 1) << 30);
    F::select(is_finite(x), value, nan(x))
}

/// `tan(x)`, x in radians; NaN for infinities.
#[inline(always)]
pub fn tan<F: Float>(x: F) -> F {
    let (r, quadrant) = reduce(x);
    let (sine, cosine) = (sine(r).normalized(), cosine(r).normalized());
    let odd = is_odd::<F>(quadrant);
    let above = TwoFloat::select(odd, cosine, sine);
    let below = TwoFloat::select(odd, sine, cosine);
    let value = above.divided_by(below).value();
    let value = negate_if(negate_if(value, quadrant << 31), x.to_bits());
    // There tan x is x to 24 bits, and parts of the quotient would be denormal.
    let value = F::select(is_below(x, 1.0 / 4096.0), flushed(x), value);
    F::select(is_finite(x), value, nan(x))
}

#[inline(always)]
fn is_odd<F: Float>(quadrant: F::Bits) -> F::Bool {
    let even = quadrant & 1;
    even.literal(0).less(even)
}

/// The bits of 2/π, after 26 leading zeros.
const TWO_OVER_PI: [u32; 7] = [
    0x0000_0028,
    0xBE60_DB93,
    0x9105_4A7F,
    0x09D5_F47D,
    0x4D37_7036,
    0xD8A5_664F,
    0x10E4_107F,
];

/// Reduces |x| to r + n·π/2 with |r| slightly more than π/4 at most; returns r, and n mod 4 in the lowest
/// bits.
#[inline(always)]
fn reduce<F: Float>(x: F) -> (TwoFloat<F>, F::Bits) {
    let magnitude = magnitude(x);
    let significand = (magnitude & 0x007F_FFFF) + 0x0080_0000;
    // |x| is significand·2^(position − 24). Digits of 2/π whose products are multiples of 4 are dropped: the
    // first digit used is at `position` in the table above.
    let position = (magnitude >> 23) - 126;
    let [w0, w1, w2] = window::<F>(position);
    // The highest 96 bits of the product below multiples of 4; of these, the upper 64.
    let (h1, l1) = wide_product::<F>(w1, significand);
    let (h2, _) = wide_product::<F>(w2, significand);
    let low = l1 + h2;
    let carry = F::Bits::select(low.less(l1), low.literal(1), low.literal(0));
    let high = w0 * significand + h1 + carry;
    // Two bits precede the binary point: the nearest integer is n, the remainder at most a half in magnitude.
    let n = (high + 0x2000_0000) >> 30;
    let rest = fraction::<F>(high - (n << 30), low);
    let reduced = rest.times(TwoFloat::constant(x, FRAC_PI_2));
    let small = magnitude.less(magnitude.literal(FRAC_PI_4.to_bits()));
    let r = TwoFloat::select(small, TwoFloat::from_float(x.abs()), reduced);
    (r, F::Bits::select(small, n.literal(0), n))
}

/// 96 bits of 2/π from `position` on.
#[inline(always)]
fn window<F: Float>(position: F::Bits) -> [F::Bits; 3] {
    let (word, bit) = (position >> 5, position & 31);
    let at = |offset: usize| {
        let last = word.literal(TWO_OVER_PI.get(offset + 4).copied().unwrap_or(0));
        (0..4).rev().fold(last, |later, q: usize| {
            let is_earlier = word.less(word.literal(q as u32 + 1));
            F::Bits::select(is_earlier, word.literal(TWO_OVER_PI[offset + q]), later)
        })
    };
    let words = [at(0), at(1), at(2), at(3)];
    // A shift by 32 − bit could be by 32, which is undefined, so it is split into shifts by 1 and 31 − bit.
    let back = bit.literal(31) - bit;
    [0, 1, 2].map(|i: usize| words[i].left(bit) | (words[i + 1] >> 1).right(back))
}

/// `a·b` as its high and low 32 bits; b has at most 24 bits.
#[inline(always)]
fn wide_product<F: Float>(a: F::Bits, b: F::Bits) -> (F::Bits, F::Bits) {
    let (a_high, a_low) = (a >> 16, a & 0xFFFF);
    let (b_high, b_low) = (b >> 16, b & 0xFFFF);
    let low = a_low * b_low;
    let middle = a_high * b_low;
    // At most 2¹⁶ + 2¹⁶ + 2²⁴.
    let carried = (low >> 16) + (middle & 0xFFFF) + a_low * b_high;
    let high = a_high * b_high + (middle >> 16) + (carried >> 16);
    (high, a * b)
}

/// `high·2⁻³⁰ + low·2⁻⁶²`, `high` in two's complement.
#[inline(always)]
fn fraction<F: Float>(high: F::Bits, low: F::Bits) -> TwoFloat<F> {
    const SCALE: [f32; 3] = [
        1.0 / (1_u64 << 30) as f32,
        1.0 / (1_u64 << 48) as f32,
        1.0 / (1_u64 << 62) as f32,
    ];
    // Each piece fits 24 bits. If the first two have opposite signs and nearly equal magnitudes, their sum is
    // exact.
    let pieces = [high & !63, ((high & 63) << 18) | (low >> 14), low & 0x3FFF];
    let [a, b, c] = [0, 1, 2].map(|i| F::from_signed(pieces[i]) * SCALE[i]);
    let sum = TwoFloat::ordered_sum(a, b);
    TwoFloat::ordered_sum(sum.hi, sum.lo + c)
}

/// sin r for |r| ≤ π/4: r + r³·P(r²), P within 2⁻²⁸.
#[inline(always)]
fn sine<F: Float>(r: TwoFloat<F>) -> TwoFloat<F> {
    const P: [f32; 3] = [-0.166_666_55, 0.008_332_188, -0.000_195_180_94];
    let z = r.hi * r.hi;
    let cosine = r.hi.literal(1.0) - z * 0.5;
    TwoFloat {
        hi: r.hi,
        lo: r.hi * (z * polynomial(z, P)) + r.lo * cosine,
    }
}

/// cos r for |r| ≤ π/4: 1 − r²/2 + r⁴·Q(r²), Q within 2⁻³³.
#[inline(always)]
fn cosine<F: Float>(r: TwoFloat<F>) -> TwoFloat<F> {
    const Q: [f32; 3] = [0.041_666_646, -0.001_388_731, 2.443_232_7e-5];
    let z = r.hi * r.hi;
    let half = z * 0.5;
    let sum = TwoFloat::ordered_sum(half.literal(1.0), -half);
    sum.add_low(z * z * polynomial(z, Q) - r.hi * r.lo)
}

// `asin`, `acos`, `atan` (§8.1).
//
// Near ±1, asin(x) is π/2 − 2·asin(√((1 − x)/2)); beyond 1, atan(x) is π/2 − atan(1/x) (Cody and Waite,
// "Software Manual for the Elementary Functions", 1980).

/// `asin(x)`; NaN for |x| > 1.
#[inline(always)]
pub fn asin<F: Float>(x: F) -> F {
    let Arcsine { outer, root, series } = arcsine(x);
    let twice = root.hi + root.hi;
    let far = angle_minus(FRAC_PI_2, twice, (root.lo + series) * 2.0);
    let value = F::select(outer, far, x.abs() + series);
    negate_if(value, x.to_bits())
}

/// `acos(x)`; NaN for |x| > 1.
#[inline(always)]
pub fn acos<F: Float>(x: F) -> F {
    let Arcsine { outer, root, series } = arcsine(x);
    let inner = angle_minus(FRAC_PI_2, x, negate_if(series, x.to_bits()));
    let (twice, rest) = (root.hi + root.hi, (root.lo + series) * 2.0);
    let negative = x.less(x.literal(0.0));
    let far = F::select(negative, angle_minus(PI, twice, rest), twice + rest);
    F::select(outer, far, inner)
}

/// `atan(x)`
#[inline(always)]
pub fn atan<F: Float>(x: F) -> F {
    let a = x.abs();
    let one = a.literal(1.0);
    let beyond = one.less(a);
    let t = F::select(beyond, one / a, a);
    let series = arctangent(t);
    let value = F::select(beyond, angle_minus(FRAC_PI_2, t, series), t + series);
    negate_if(value, x.to_bits())
}

/// `atan(y, x)`: the angle of (x, y) in [−π, π]; for zeros and infinities as in C.
#[inline(always)]
pub fn atan2<F: Float>(y: F, x: F) -> F {
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ax.less(ay);
    let smaller = F::select(steep, ax, ay);
    let larger = F::select(steep, ay, ax);
    let t = smaller / larger;
    // Quotients that are denormal or the smallest normal, and 0/0, become 0; ∞/∞ becomes 1.
    let t = F::select(t.literal(f32::MIN_POSITIVE.into()).less(t), t, t.literal(0.0));
    let t = F::select(t.literal(f32::MAX.into()).less(smaller), t.literal(1.0), t);
    let series = arctangent(t);
    let near = t + series;
    let quarter = angle_minus(FRAC_PI_2, t, series);
    let past_quarter = angle_minus(FRAC_PI_2, -t, -series);
    let half = angle_minus(PI, t, series);
    // x = −0 also counts as left.
    let left = negate_if(x.literal(1.0), x.to_bits()).less(x.literal(0.0));
    let value = F::select(
        steep,
        F::select(left, past_quarter, quarter),
        F::select(left, half, near),
    );
    let value = negate_if(value, y.to_bits());
    F::select(is_nan(x) | is_nan(y), x + y, value)
}

/// The angle `whole − (hi + lo)`, for hi ≤ `whole`.
#[inline(always)]
fn angle_minus<F: Float>(whole: f64, hi: F, lo: F) -> F {
    let whole = TwoFloat::constant(hi, whole);
    let sum = TwoFloat::ordered_sum(whole.hi, -hi);
    sum.add_low(whole.lo - lo).value()
}

/// Intermediate results of asin and acos.
struct Arcsine<F: Float> {
    /// Whether |x| > ½.
    outer: F::Bool,
    /// √((1 − |x|)/2)
    root: TwoFloat<F>,
    /// asin(t) − t, where t is `root` if `outer`, otherwise |x|.
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
    let root = TwoFloat::from_float(half).sqrt();
    let t = F::select(outer, root.hi, a);
    let z = F::select(outer, half, a * a);
    let series = t * (z * polynomial(z, P));
    Arcsine { outer, root, series }
}

/// atan(t) − t for t in [0, 1], within 2⁻²⁶ of atan(t).
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
