//! The exponential and the logarithm.
//!
//! The methods and coefficients are those of fdlibm (Sun Microsystems, 1993; `e_exp.c` and `e_log.c`), so
//! that results have libm's bits.

use super::encoding::{FRACTION, each, exponent, is_normal_positive, scaled};

/// ln 2 in two parts; the product of the first with an integer of 20 bits is exact.
const LN_2: [f64; 2] = [f64::from_bits(0x3FE6_2E42_FEE0_0000), 1.908_214_929_270_587_7e-10];

/// `eˣ`
#[inline(always)]
pub fn exp<const L: usize>(x: [f64; L]) -> [f64; L] {
    /// Below, the result and its scale are normal.
    const LIMIT: f64 = 708.0;
    each!(
        lane,
        x[lane].abs() < LIMIT,
        regular_exp(x[lane]),
        libm::exp(x[lane])
    )
}

#[inline(always)]
fn regular_exp(x: f64) -> f64 {
    /// Coefficients of r·(eʳ + 1)/(eʳ − 1) = 2 + r²·(P₁ + r²·(…)).
    const P: [f64; 5] = [
        1.666_666_666_666_660_2e-1,
        -2.777_777_777_701_559_3e-3,
        6.613_756_321_437_934e-5,
        -1.653_390_220_546_525_2e-6,
        4.138_136_797_057_238_5e-8,
    ];
    /// 0.5·ln 2 and 1.5·ln 2, with as many bits as fdlibm compares.
    const HALF: u64 = 0x3FD6_2E43 << 32;
    const THREE_HALVES: u64 = 0x3FF0_A2B2 << 32;
    /// Below, eˣ rounds to 1 + x.
    const TINY: u64 = 0x3E30_0001 << 32;
    let size = x.abs().to_bits();
    let one = f64::copysign(1.0, x);
    let nearest = (x * std::f64::consts::LOG2_E + 0.5 * one).trunc();
    let n = if size < HALF {
        0.0
    } else if size < THREE_HALVES {
        one
    } else {
        nearest
    };
    let high = x - n * LN_2[0];
    let low = n * LN_2[1];
    let r = high - low;
    let z = r * r;
    let c = r - z * (P[0] + z * (P[1] + z * (P[2] + z * (P[3] + z * P[4]))));
    let value = 1.0 + (r * c / (2.0 - c) - low + high);
    if size < TINY { 1.0 + x } else { scaled(value, n) }
}

/// The natural logarithm; NaN below zero.
#[inline(always)]
pub fn log<const L: usize>(x: [f64; L]) -> [f64; L] {
    each!(
        lane,
        is_normal_positive(x[lane]),
        regular_log(x[lane]),
        libm::log(x[lane])
    )
}

#[inline(always)]
fn regular_log(x: f64) -> f64 {
    /// Coefficients of (ln(1 + f) − 2s)/s, s = f/(2 + f), as a polynomial of s².
    const G: [f64; 7] = [
        0.666_666_666_666_673_5,
        0.399_999_999_994_094_2,
        0.285_714_287_436_623_9,
        0.222_221_984_321_497_84,
        0.181_835_721_616_180_5,
        0.153_138_376_992_093_73,
        0.147_981_986_051_165_86,
    ];
    /// √½, with as many bits as fdlibm compares, and its distance to 1, in encodings.
    const SQRT_HALF: u64 = 0x3FE6_A09E << 32;
    const TO_ONE: u64 = (0x3FF0_0000 << 32) - SQRT_HALF;
    // x is 2ᵏ·m, m from √½ to √2.
    let bits = x.to_bits().wrapping_add(TO_ONE);
    let k = exponent(f64::from_bits(bits)) - 1023.0;
    let m = f64::from_bits((bits & FRACTION) + SQRT_HALF);
    let f = m - 1.0;
    let half_square = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (G[1] + w * (G[3] + w * G[5]));
    let odd = z * (G[0] + w * (G[2] + w * (G[4] + w * G[6])));
    let rest = odd + even;
    s * (half_square + rest) + k * LN_2[1] - half_square + f + k * LN_2[0]
}
