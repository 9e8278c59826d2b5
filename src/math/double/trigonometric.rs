//! Sine and cosine.
//!
//! The angle is reduced to at most π/4 in magnitude in two parts, by three parts of π/2 (Cody and Waite,
//! "Software Manual for the Elementary Functions", 1980; Muller, "Elementary Functions", ch. 11), and by as
//! many bits of 2/π as needed if it is large or almost a multiple of π/2 (Payne and Hanek, "Radian reduction
//! for trigonometric functions", 1983). The polynomials are fdlibm's (Sun Microsystems, 1993; `k_sin.c` and
//! `k_cos.c`).

use super::encoding::{FRACTION, INTEGER};

/// `sin(x)`, x in radians; NaN for infinities.
#[inline(always)]
pub fn sin<const L: usize>(x: [f64; L]) -> [f64; L] {
    sines(reduce_all(x), 0)
}

/// `cos(x)`, x in radians; NaN for infinities.
#[inline(always)]
pub fn cos<const L: usize>(x: [f64; L]) -> [f64; L] {
    sines(reduce_all(x), 1)
}

/// `sin(x)` and `cos(x)`, with the bits that they have alone.
#[inline(always)]
pub fn sin_cos<const L: usize>(x: [f64; L]) -> ([f64; L], [f64; L]) {
    let reduced = reduce_all(x);
    let (mut sin, mut cos) = ([0.0; L], [0.0; L]);
    for lane in 0..L {
        (sin[lane], cos[lane]) = (reduced[lane].sin(0), reduced[lane].sin(1));
    }
    (sin, cos)
}

/// The sines of the angles plus `quadrants·π/2`.
#[inline(always)]
fn sines<const L: usize>(reduced: [ReducedAngle; L], quadrants: u64) -> [f64; L] {
    let mut results = [0.0; L];
    for lane in 0..L {
        results[lane] = reduced[lane].sin(quadrants);
    }
    results
}

/// Reduces each angle.
#[inline(always)]
fn reduce_all<const L: usize>(x: [f64; L]) -> [ReducedAngle; L] {
    let mut reduced = [ReducedAngle::default(); L];
    let mut irregular = 0;
    for lane in 0..L {
        reduced[lane] = reduce(x[lane]);
        irregular += u64::from(!reduced[lane].is_accurate(x[lane]));
    }
    if irregular > 0 {
        for lane in 0..L {
            if !reduced[lane].is_accurate(x[lane]) {
                reduced[lane] = reduce_by_integers(x[lane]);
            }
        }
    }
    reduced
}

/// An angle `head + tail + quadrants·π/2`; only the lowest two bits of `quadrants` count.
#[derive(Debug, Clone, Copy, Default)]
struct ReducedAngle {
    quadrants: u64,
    head: f64,
    tail: f64,
}

/// Reduces an angle of at most 2²⁰·π/2 in magnitude.
#[inline(always)]
fn reduce(x: f64) -> ReducedAngle {
    /// π/2 in three parts: the first two have 33 bits, so that their products with 20 bits are exact.
    const HALF_PI: [f64; 3] = [
        f64::from_bits(0x3FF9_21FB_5440_0000),
        f64::from_bits(0x3DD0_B461_1A60_0000),
        f64::from_bits(0x3BA3_198A_2E03_7073),
    ];
    let sum = x * std::f64::consts::FRAC_2_PI + INTEGER;
    let n = sum - INTEGER;
    let first = x - n * HALF_PI[0];
    let product = n * HALF_PI[1];
    let second = first - product;
    let rest = n * HALF_PI[2] - ((first - second) - product);
    let head = second - rest;
    ReducedAngle {
        quadrants: sum.to_bits(),
        head,
        tail: (second - head) - rest,
    }
}

impl ReducedAngle {
    /// Whether [`reduce`] was accurate enough: the angle is not too large, and little of it canceled.
    #[inline(always)]
    fn is_accurate(self, x: f64) -> bool {
        const MAX: f64 = (1 << 20) as f64 * std::f64::consts::FRAC_PI_2;
        const MAX_CANCELLATION: f64 = 1.0 / (1_u64 << 49) as f64;
        (x.abs() < MAX) & (self.head.abs() >= x.abs() * MAX_CANCELLATION)
    }

    /// The sine of the angle plus `quadrants·π/2`.
    #[inline(always)]
    fn sin(self, quadrants: u64) -> f64 {
        let quadrants = quadrants.wrapping_add(self.quadrants);
        let (sine, cosine) = (sine(self.head, self.tail), cosine(self.head, self.tail));
        let value = if quadrants & 1 == 0 { sine } else { cosine };
        f64::from_bits(value.to_bits() ^ (quadrants & 2) << 62)
    }
}

/// sin(x + y) for |x| ≤ π/4 and y of less than a unit in the last place of x.
#[inline(always)]
fn sine(x: f64, y: f64) -> f64 {
    /// Coefficients of (sin x − x)/x³ as a polynomial of x².
    const S: [f64; 6] = [
        -1.666_666_666_666_663_2e-1,
        8.333_333_333_322_49e-3,
        -1.984_126_982_985_795e-4,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ];
    let z = x * x;
    let w = z * z;
    let series = S[1] + z * (S[2] + z * S[3]) + z * w * (S[4] + z * S[5]);
    let cube = z * x;
    x - ((z * (0.5 * y - cube * series) - y) - cube * S[0])
}

/// cos(x + y) for |x| ≤ π/4 and y of less than a unit in the last place of x.
#[inline(always)]
fn cosine(x: f64, y: f64) -> f64 {
    /// Coefficients of (cos x − 1 + x²/2)/x⁴ as a polynomial of x².
    const C: [f64; 6] = [
        4.166_666_666_666_66e-2,
        -1.388_888_888_887_411e-3,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ];
    let z = x * x;
    let w = z * z;
    let series = z * (C[0] + z * (C[1] + z * C[2])) + w * w * (C[3] + z * (C[4] + z * C[5]));
    let half = 0.5 * z;
    let near = 1.0 - half;
    near + (((1.0 - near) - half) + (z * series - x * y))
}

/// The bits of 2/π, after 64 bits of the integer part.
const TWO_OVER_PI: [u64; 21] = [
    0,
    0xA2F9_836E_4E44_1529,
    0xFC27_57D1_F534_DDC0,
    0xDB62_9599_3C43_9041,
    0xFE51_63AB_DEBB_C561,
    0xB724_6E3A_424D_D2E0,
    0x0649_2EEA_09D1_921C,
    0xFE1D_EB1C_B129_A73E,
    0xE882_35F5_2EBB_4484,
    0xE99C_7026_B45F_7E41,
    0x3991_D639_8353_39F4,
    0x9C84_5F8B_BDF9_283B,
    0x1FF8_97FF_DE05_980F,
    0xEF2F_118B_5A0A_6D1F,
    0x6D36_7ECF_27CB_09B7,
    0x4F46_3F66_9E5F_EA2D,
    0x7527_BAC7_EBE5_F17B,
    0x3D07_39F7_8A52_92EA,
    0x6BFB_5FB1_1F8D_5D08,
    0x5603_3046_FC7B_6BAB,
    0xF0CF_BC20_9AF4_361D,
];

/// Reduces any angle of at least π/4 in magnitude: x·2/π in integers, without the bits of 2/π whose products
/// are multiples of 4. No f64 is closer to a multiple of π/2 than 2⁻⁶¹ or so, so 64 bits remain.
#[inline(never)]
fn reduce_by_integers(x: f64) -> ReducedAngle {
    /// π/2·2⁶³
    const HALF_PI: u64 = 0xC90F_DAA2_2168_C235;
    /// The lowest bit of a significand with 53 bits in 64.
    const UNIT: u64 = 1 << 11;
    if !x.is_finite() {
        return ReducedAngle {
            head: f64::NAN,
            ..ReducedAngle::default()
        };
    }
    // |x| is significand·2^(position − 62); the bit of 2/π at `position` is the first one used.
    let bits = x.to_bits();
    let position = (bits >> 52 & 0x7FF) as usize - 1013;
    let significand = bits & FRACTION | (FRACTION + 1);
    let [w0, w1, w2] = window(position);
    let wide = |word: u64| u128::from(word) * u128::from(significand);
    let middle = wide(w1) + (wide(w2) >> 64);
    let high = w0.wrapping_mul(significand).wrapping_add((middle >> 64) as u64);
    let product = u128::from(high) << 64 | u128::from(middle as u64);
    // Two bits precede the binary point: the nearest integer is n, the remainder at most a half in magnitude.
    let n = product.wrapping_add(1 << 125) >> 126;
    let rest = product.wrapping_sub(n << 126).cast_signed();
    let shift = rest.unsigned_abs().leading_zeros();
    let leading = (rest.unsigned_abs() << shift >> 64) as u64;
    // The remainder is leading·2^(−62 − shift), the angle this product·2^(−125 − shift).
    let angle = u128::from(leading) * u128::from(HALF_PI);
    let (upper, lower) = ((angle >> 64) as u64, angle as u64);
    let scale = f64::from_bits(u64::from(1023 - 125 - shift) << 52);
    let head = (upper & !(UNIT - 1)) as f64 * (1_u128 << 64) as f64;
    let tail = ((upper & (UNIT - 1)) << 53 | lower >> 11) as f64 * UNIT as f64;
    let sign = if (rest < 0) == x.is_sign_negative() {
        scale
    } else {
        -scale
    };
    ReducedAngle {
        quadrants: if x.is_sign_negative() {
            (n as u64).wrapping_neg()
        } else {
            n as u64
        },
        head: head * sign,
        tail: tail * sign,
    }
}

/// 192 bits of 2/π from `position` on.
fn window(position: usize) -> [u64; 3] {
    let (word, bit) = (position / 64, position % 64);
    [0, 1, 2].map(|i| {
        let pair = u128::from(TWO_OVER_PI[word + i]) << 64 | u128::from(TWO_OVER_PI[word + i + 1]);
        (pair << bit >> 64) as u64
    })
}
