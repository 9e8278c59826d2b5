//! `sin`, `cos`, `tan` (§8.1).
//!
//! One way for all arguments: x·2/π in integers, with as many bits of 2/π as the exponent of x asks for (Payne and Hanek, "Radian
//! reduction for trigonometric functions", 1983; Muller, "Elementary Functions", ch. 11). A shorter way for small
//! arguments would save nothing where both sides of a choice are computed, as SIMD machines do.

use std::f32::consts::FRAC_PI_4;
use std::f64::consts::FRAC_PI_2;

use super::float::{Bits, Float};
use super::kernel::{flushed, is_below, is_finite, magnitude, nan, negate_if, polynomial};
use super::two_float::TwoFloat;

/// `sin(x)`, x in radians; NaN of infinities.
#[inline(always)]
#[must_use]
pub fn sin<F: Float>(x: F) -> F {
    let (r, quadrant) = reduce(x);
    let value = TwoFloat::select(is_odd::<F>(quadrant), cosine(r), sine(r)).value();
    let value = negate_if(negate_if(value, quadrant << 30), x.to_bits());
    F::select(is_finite(x), value, nan(x))
}

/// `cos(x)`, x in radians; NaN of infinities.
#[inline(always)]
#[must_use]
pub fn cos<F: Float>(x: F) -> F {
    let (r, quadrant) = reduce(x);
    let value = TwoFloat::select(is_odd::<F>(quadrant), sine(r), cosine(r)).value();
    let value = negate_if(value, (quadrant + 1) << 30);
    F::select(is_finite(x), value, nan(x))
}

/// `tan(x)`, x in radians; NaN of infinities.
#[inline(always)]
#[must_use]
pub fn tan<F: Float>(x: F) -> F {
    let (r, quadrant) = reduce(x);
    let (sine, cosine) = (sine(r).normalised(), cosine(r).normalised());
    let odd = is_odd::<F>(quadrant);
    let above = TwoFloat::select(odd, cosine, sine);
    let below = TwoFloat::select(odd, sine, cosine);
    let value = above.over(below).value();
    let value = negate_if(negate_if(value, quadrant << 31), x.to_bits());
    // tan x is x to 24 bits there, and parts of the quotient would be denormals.
    let value = F::select(is_below(x, 1.0 / 4096.0), flushed(x), value);
    F::select(is_finite(x), value, nan(x))
}

#[inline(always)]
fn is_odd<F: Float>(quadrant: F::Bits) -> F::Truth {
    let even = quadrant & 1;
    even.literal(0).less(even)
}

/// 2/π, 26 zeros before its first digit.
const TWO_OVER_PI: [u32; 7] = [
    0x0000_0028,
    0xBE60_DB93,
    0x9105_4A7F,
    0x09D5_F47D,
    0x4D37_7036,
    0xD8A5_664F,
    0x10E4_107F,
];

/// |x| = r + n·π/2 with |r| ≤ π/4 (and a little): r, and n mod 4 in the lowest bits.
#[inline(always)]
fn reduce<F: Float>(x: F) -> (TwoFloat<F>, F::Bits) {
    let magnitude = magnitude(x);
    let significand = (magnitude & 0x007F_FFFF) + 0x0080_0000;
    // |x| is significand·2^(position − 24). Digits of 2/π that stand for multiples of 4 after the product are left out:
    // the first that counts is at `position` in the table above.
    let position = (magnitude >> 23) - 126;
    let [w0, w1, w2] = window::<F>(position);
    // The product's 96 highest bits but for what stands for multiples of 4; of these, the upper 64.
    let (h1, l1) = wide_product::<F>(w1, significand);
    let (h2, _) = wide_product::<F>(w2, significand);
    let low = l1 + h2;
    let carry = F::Bits::select(low.less(l1), low.literal(1), low.literal(0));
    let high = w0 * significand + h1 + carry;
    // Two bits before the binary point: the nearest integer is n, the rest at most a half in magnitude.
    let n = (high + 0x2000_0000) >> 30;
    let rest = fraction::<F>(high - (n << 30), low);
    let reduced = rest.times(TwoFloat::constant(x, FRAC_PI_2));
    let small = magnitude.less(magnitude.literal(FRAC_PI_4.to_bits()));
    let r = TwoFloat::select(small, TwoFloat::of(x.abs()), reduced);
    (r, F::Bits::select(small, n.literal(0), n))
}

/// 96 bits of 2/π from that position on.
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
    // A shift by 32 has no meaning, two by 1 and 31 have.
    let back = bit.literal(31) - bit;
    [0, 1, 2].map(|i: usize| words[i].left(bit) | (words[i + 1] >> 1).right(back))
}

/// `a·b` as two words; b has 24 bits at most.
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
    // Each piece fits 24 bits. Where the first two are of opposite signs and nearly equal, their sum is exact.
    let pieces = [high & !63, ((high & 63) << 18) | (low >> 14), low & 0x3FFF];
    let [a, b, c] = [0, 1, 2].map(|i| F::from_signed(pieces[i]) * SCALE[i]);
    let sum = TwoFloat::ordered_sum(a, b);
    TwoFloat::ordered_sum(sum.hi, sum.lo + c)
}

/// sin of |r| ≤ π/4: r + r³·P(r²), P within 2⁻²⁸.
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

/// cos of |r| ≤ π/4: 1 − r²/2 + r⁴·Q(r²), Q within 2⁻³³.
#[inline(always)]
fn cosine<F: Float>(r: TwoFloat<F>) -> TwoFloat<F> {
    const Q: [f32; 3] = [0.041_666_646, -0.001_388_731, 2.443_232_7e-5];
    let z = r.hi * r.hi;
    let half = z * 0.5;
    let sum = TwoFloat::ordered_sum(half.literal(1.0), -half);
    sum.plus(z * z * polynomial(z, Q) - r.hi * r.lo)
}
