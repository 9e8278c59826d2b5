//! Powers.
//!
//! The method and coefficients are those of fdlibm (Sun Microsystems, 1993; `e_pow.c`), so that results have
//! libm's bits: the binary logarithm of the base in two parts, times the exponent, and two to the power of
//! that.

use super::encoding::{FRACTION, each, exponent, head, is_normal_positive, scaled};

/// `xʸ`; NaN for x < 0, as GLSL leaves it undefined.
#[inline(always)]
pub fn pow<const L: usize>(x: [f64; L], y: [f64; L]) -> [f64; L] {
    let mut products = [Sum::default(); L];
    let mut is_regular = [false; L];
    for lane in 0..L {
        products[lane] = log2(x[lane]).times(y[lane]);
        let is_usual = is_normal_positive(x[lane]) & is_regular_exponent(y[lane]);
        is_regular[lane] = is_usual & products[lane].is_small();
    }
    each!(
        lane,
        is_regular[lane],
        products[lane].exp2(),
        other_pow(x[lane], y[lane])
    )
}

fn other_pow(x: f64, y: f64) -> f64 {
    if x < 0.0 { f64::NAN } else { libm::pow(x, y) }
}

/// Returns false for exponents that libm special-cases (±1, 2, ½) and for |y| ≥ 2³¹.
#[inline(always)]
fn is_regular_exponent(y: f64) -> bool {
    const MAX: f64 = (1_u64 << 31) as f64;
    (y.abs() < MAX) & (y.abs() != 1.0) & (y != 2.0) & (y != 0.5)
}

/// A number in two parts; the first has its lowest 32 bits clear, except in a product.
#[derive(Clone, Copy, Default)]
struct Sum {
    head: f64,
    tail: f64,
}

/// log₂ x
#[inline(always)]
fn log2(x: f64) -> Sum {
    /// Coefficients of 3/2·(ln((1 + s)/(1 − s)) − 2s − 2/3·s³)/s³ as a polynomial of s².
    const L: [f64; 6] = [
        0.599_999_999_999_994_6,
        0.428_571_428_578_550_2,
        0.333_333_329_818_377_43,
        0.272_728_123_808_534,
        0.230_660_745_775_561_75,
        0.206_975_017_800_338_42,
    ];
    /// 2/(3·ln 2), and its two parts.
    const SCALE: f64 = f64::from_bits(0x3FEE_C709_DC3A_03FD);
    const SCALE_HEAD: f64 = f64::from_bits(0x3FEE_C709_E000_0000);
    const SCALE_TAIL: f64 = f64::from_bits(0xBE3E_2FE0_145B_01F5);
    /// log₂ 1.5 in two parts.
    const LOG2_HEAD: f64 = f64::from_bits(0x3FE2_B803_4000_0000);
    const LOG2_TAIL: f64 = f64::from_bits(0x3E4C_FDEB_43CF_D006);
    /// The fractions of √1.5 and √3, with as many bits as fdlibm compares.
    const SQRT_3_2: u64 = 0x3988F << 32;
    const SQRT_3: u64 = 0xBB67A << 32;
    const ONE: u64 = 0x3FF0_0000 << 32;

    // x is 2ⁿ·m, and m is close to a center, which is 1 or 1.5.
    let fraction = x.to_bits() & FRACTION;
    let is_above = fraction >= SQRT_3;
    let is_middle = (fraction >= SQRT_3_2) & !is_above;
    let n = exponent(x) - if is_above { 1022.0 } else { 1023.0 };
    let m = f64::from_bits(fraction | ONE) * if is_above { 0.5 } else { 1.0 };
    let center = if is_middle { 1.5 } else { 1.0 };
    let center_log = Sum {
        head: if is_middle { LOG2_HEAD } else { 0.0 },
        tail: if is_middle { LOG2_TAIL } else { 0.0 },
    };

    // s = (m − center)/(m + center)
    let (above, below) = (m - center, 1.0 / (m + center));
    let s = above * below;
    let s_head = head(s);
    let sum_head = head(m + center);
    let sum_tail = m - (sum_head - center);
    let s_tail = below * ((above - s_head * sum_head) - s_head * sum_tail);

    // 3/2·ln((1 + s)/(1 − s)) = s·(3 + s² + …)
    let z = s * s;
    let series = z * z * (L[0] + z * (L[1] + z * (L[2] + z * (L[3] + z * (L[4] + z * L[5])))));
    let series = series + s_tail * (s_head + s);
    let square = s_head * s_head;
    let factor_head = head(3.0 + square + series);
    let factor_tail = series - ((factor_head - 3.0) - square);
    let product = s_head * factor_head;
    let rest = s_tail * factor_head + factor_tail * s;
    let log_head = head(product + rest);
    let log_tail = rest - (log_head - product);

    let scaled_head = SCALE_HEAD * log_head;
    let scaled_tail = SCALE_TAIL * log_head + log_tail * SCALE + center_log.tail;
    let total = head(((scaled_head + scaled_tail) + center_log.head) + n);
    Sum {
        head: total,
        tail: scaled_tail - (((total - n) - center_log.head) - scaled_head),
    }
}

impl Sum {
    #[inline(always)]
    fn times(self, y: f64) -> Self {
        let y_head = head(y);
        Self {
            head: y_head * self.head,
            tail: (y - y_head) * self.head + y * self.tail,
        }
    }

    /// Whether two to its power is a normal number.
    #[inline(always)]
    fn is_small(self) -> bool {
        (self.head + self.tail).abs() < 1021.0
    }

    /// Two to its power.
    #[inline(always)]
    fn exp2(self) -> f64 {
        /// Coefficients of z·(eᶻ + 1)/(eᶻ − 1) = 2 + z²·(P₁ + z²·(…)).
        const P: [f64; 5] = [
            1.666_666_666_666_660_2e-1,
            -2.777_777_777_701_559_3e-3,
            6.613_756_321_437_934e-5,
            -1.653_390_220_546_525_2e-6,
            4.138_136_797_057_238_5e-8,
        ];
        /// ln 2, and its two parts.
        const LN_2: f64 = std::f64::consts::LN_2;
        const LN_2_HEAD: f64 = f64::from_bits(0x3FE6_2E43_0000_0000);
        const LN_2_TAIL: f64 = f64::from_bits(0xBE20_5C61_0CA8_6C39);
        // The nearest integer, for halves the one farther from zero.
        let whole = self.tail + self.head;
        let size = head(whole).abs();
        let n = if size > 0.5 { (size + 0.5).floor() } else { 0.0 };
        let n = n.copysign(whole);
        let rest = self.head - n;
        let t = head(self.tail + rest);
        let product = t * LN_2_HEAD;
        let tail = (self.tail - (t - rest)) * LN_2 + t * LN_2_TAIL;
        let z = product + tail;
        let low = tail - (z - product);
        let square = z * z;
        let c = z - square * (P[0] + square * (P[1] + square * (P[2] + square * (P[3] + square * P[4]))));
        let r = (z * c) / (c - 2.0) - (low + z * low);
        scaled(1.0 - (r - z), n)
    }
}
