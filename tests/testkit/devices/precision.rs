//! The results that Vulkan permits: intervals of reals, widened by each operation as the specification
//! requires ("Precision and Operation of SPIR-V Instructions" in the appendix "Vulkan Environment for
//! SPIR-V").
//!
//! Where a function's precision is inherited from a formula, the formula is computed with intervals. An
//! implementation may also use an equivalent formula, of which the functions list some, so a result outside
//! of the interval need not be a fault of the driver.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The largest finite f32.
const MAX: f64 = f32::MAX as f64;
/// The smallest normal f32.
const MIN_NORMAL: f64 = f32::MIN_POSITIVE as f64;

/// The distance between the floats next to a real number, in f32, as Vulkan defines it: at a power of two
/// that of the floats below it. It is 2⁻¹⁴⁹ for denormals, and 2¹⁰⁴ beyond the largest float.
pub fn ulp(exact: f64) -> f64 {
    let magnitude = exact.abs().clamp(MIN_NORMAL, MAX);
    let exponent = libm::ilogb(magnitude);
    let is_power = magnitude == libm::ldexp(1.0, exponent) && magnitude > MIN_NORMAL;
    libm::ldexp(1.0, exponent - 23 - i32::from(is_power))
}

/// The error of a finite result in units in the last place of an f32 next to the exact value. A denormal
/// value that was flushed to zero counts as exact, since Vulkan allows it. An exact value that rounds to
/// infinity has no error if the result is infinite.
pub fn error(result: f32, exact: f64) -> f64 {
    let rounded = exact as f32;
    if is_rounded(result, exact) || exact.is_nan() && result.is_nan() {
        return 0.0;
    }
    if !result.is_finite() || !rounded.is_finite() || exact.is_nan() {
        return f64::INFINITY;
    }
    (f64::from(result) - exact).abs() / ulp(exact)
}

/// Whether a result is the float next to the exact value, of either sign of zero, or zero instead of a
/// denormal.
pub fn is_rounded(result: f32, exact: f64) -> bool {
    result == exact as f32 || result == 0.0 && exact.abs() < MIN_NORMAL
}

/// A set of permitted results: an interval of reals, or any result.
#[must_use]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Permitted {
    /// NaN if any result is permitted.
    low: f64,
    high: f64,
}

/// Any result, also NaN.
const ANY: Permitted = Permitted {
    low: f64::NAN,
    high: f64::NAN,
};

impl Permitted {
    /// The values of an operand: a denormal may be flushed to zero. Infinities and NaN may be assumed not to
    /// occur.
    pub fn operand(value: f32) -> Self {
        if value.is_finite() {
            Self::exactly(f64::from(value)).flushed()
        } else {
            ANY
        }
    }

    /// One value.
    pub fn exactly(value: f64) -> Self {
        Self {
            low: value,
            high: value,
        }
    }

    /// Whether any result is permitted.
    pub fn is_any(self) -> bool {
        self.low.is_nan() || self.high.is_nan()
    }

    /// The largest permitted error for this exact value: the distance to the farthest value of the interval.
    /// NaN if any result is permitted.
    pub fn largest_error(self, exact: f64) -> f64 {
        if self.is_any() {
            return f64::NAN;
        }
        f64::max((exact - self.low).abs(), (exact - self.high).abs())
    }

    /// Whether a result is in the interval, or, if the precision is inherited from a formula, at most as far
    /// from the exact value as the farthest value of the interval.
    pub fn contains(self, result: f32, exact: f64, is_inherited: bool) -> bool {
        if self.is_any() {
            return true;
        }
        let flushed = self.flushed();
        let result = f64::from(result);
        let is_as_near = is_inherited && (result - exact).abs() <= self.largest_error(exact);
        // An infinite limit means that the range exceeds the largest float.
        is_as_near || flushed.low <= result && result <= flushed.high
    }

    /// Adds zero to denormals.
    fn flushed(self) -> Self {
        let is_denormal = |value: f64| value != 0.0 && value.abs() < MIN_NORMAL;
        if is_denormal(self.low) || is_denormal(self.high) {
            return Self {
                low: self.low.min(0.0),
                high: self.high.max(0.0),
            };
        }
        self
    }

    /// The interval of some values; any result if one of them is NaN.
    fn hull(values: &[f64]) -> Self {
        if values.iter().any(|value| value.is_nan()) {
            return ANY;
        }
        Self {
            low: values.iter().copied().fold(f64::INFINITY, f64::min),
            high: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// The results of an operation that is rounded correctly, in either direction.
    fn rounded(self) -> Self {
        if self.is_any() {
            return ANY;
        }
        let down = |value: f64| match value as f32 {
            float if f64::from(float) > value => f64::from(float.next_down()),
            float => f64::from(float),
        };
        Self {
            low: down(self.low),
            high: -down(-self.high),
        }
        .flushed()
    }

    /// The results of an operation with a limit of its error.
    fn within(self, error: impl Fn(f64) -> f64) -> Self {
        if self.is_any() {
            return ANY;
        }
        let (low, high) = (self.low - error(self.low), self.high + error(self.high));
        Self {
            low: if low < -MAX {
                f64::NEG_INFINITY
            } else {
                low.min(MAX)
            },
            high: if high > MAX { f64::INFINITY } else { high.max(-MAX) },
        }
        .flushed()
    }

    fn within_ulps(self, count: f64) -> Self {
        self.within(|value| count * ulp(value))
    }

    /// The values of a function that is monotonic.
    fn monotonic(self, function: fn(f64) -> f64) -> Self {
        Self::hull(&[function(self.low), function(self.high)])
    }

    /// `exp` and `exp2`: 3 + 2·|x| ULP.
    fn exponential(self, function: fn(f64) -> f64) -> Self {
        let largest = self.low.abs().max(self.high.abs());
        self.monotonic(function).within_ulps(3.0 + 2.0 * largest)
    }

    /// 3 + 2·|x| ULP.
    pub fn exp(self) -> Self {
        self.exponential(libm::exp)
    }

    /// 3 + 2·|x| ULP.
    pub fn exp2(self) -> Self {
        self.exponential(libm::exp2)
    }

    /// `log` and `log2`: 3 ULP, or 2⁻²¹ for arguments in [0.5, 2].
    fn logarithm(self, function: fn(f64) -> f64) -> Self {
        if self.is_any() || self.low <= 0.0 {
            return ANY;
        }
        let end = |argument: f64| {
            let value = Self::exactly(function(argument));
            if (0.5..=2.0).contains(&argument) {
                value.within(|_| libm::ldexp(1.0, -21))
            } else {
                value.within_ulps(3.0)
            }
        };
        let (low, high) = (end(self.low), end(self.high));
        Self::hull(&[low.low, high.low, low.high, high.high])
    }

    /// 3 ULP, or 2⁻²¹ for arguments in [0.5, 2].
    pub fn log(self) -> Self {
        self.logarithm(libm::log)
    }

    /// 3 ULP, or 2⁻²¹ for arguments in [0.5, 2].
    pub fn log2(self) -> Self {
        self.logarithm(libm::log2)
    }

    /// 2 ULP.
    pub fn inverse_sqrt(self) -> Self {
        if self.is_any() || self.low <= 0.0 {
            return ANY;
        }
        self.monotonic(|value| 1.0 / value.sqrt()).within_ulps(2.0)
    }

    /// Inherited from `1.0 / inversesqrt(x)`.
    pub fn sqrt(self) -> Self {
        if self == Self::exactly(0.0) {
            return self;
        }
        Self::exactly(1.0) / self.inverse_sqrt()
    }

    /// `sin` and `cos` of an operand: an absolute error of 2⁻¹¹ in [−π, π].
    fn wave(self, function: fn(f64) -> f64) -> Self {
        if self.is_any() || self.low < -PI || self.high > PI {
            return ANY;
        }
        self.monotonic(function).within(|_| libm::ldexp(1.0, -11))
    }

    /// An absolute error of 2⁻¹¹ in [−π, π].
    pub fn sin(self) -> Self {
        self.wave(libm::sin)
    }

    /// An absolute error of 2⁻¹¹ in [−π, π].
    pub fn cos(self) -> Self {
        self.wave(libm::cos)
    }

    /// 4096 ULP.
    pub fn atan(self) -> Self {
        self.monotonic(libm::atan).within_ulps(4096.0)
    }

    /// The angle of (x, y), where this is y: 4096 ULP.
    pub fn atan2(self, x: Self) -> Self {
        let is_around_zero = |value: Self| value.low <= 0.0 && value.high >= 0.0;
        if self.is_any() || x.is_any() || is_around_zero(self) && is_around_zero(x) {
            return ANY;
        }
        let corners = [
            libm::atan2(self.low, x.low),
            libm::atan2(self.low, x.high),
            libm::atan2(self.high, x.low),
            libm::atan2(self.high, x.high),
        ];
        // Beside the cut, either sign of a zero or of a flushed denormal is possible.
        let is_at_cut = is_around_zero(self) && x.low < 0.0;
        let values = if is_at_cut {
            Self::hull(&[-PI, PI])
        } else if is_around_zero(x) {
            // The extreme is on the axis.
            let axis = FRAC_PI_2.copysign(self.low);
            Self::hull(&[corners[0], corners[1], corners[2], corners[3], axis])
        } else {
            Self::hull(&corners)
        };
        values.within_ulps(4096.0)
    }

    /// Rounded correctly, that is, exact.
    pub fn floor(self) -> Self {
        self.monotonic(f64::floor)
    }

    /// The values in a range: exact.
    pub fn clamp(self, low: f64, high: f64) -> Self {
        // `max` and `min` would drop NaN.
        if self.is_any() {
            return ANY;
        }
        Self::hull(&[self.low, self.high].map(|value| value.max(low).min(high)))
    }

    /// The union of both intervals.
    pub fn or(self, other: Self) -> Self {
        Self::hull(&[self.low, self.high, other.low, other.high])
    }
}

impl Neg for Permitted {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
}

impl Add for Permitted {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let may_overflow = |down: Self, up: Self| down.low == f64::NEG_INFINITY && up.high == f64::INFINITY;
        if may_overflow(self, other) || may_overflow(other, self) {
            // The sum of both infinities is NaN.
            return ANY;
        }
        let low = -ceiling(-self.low, -other.low);
        Self::hull(&[low, ceiling(self.high, other.high)]).rounded()
    }
}

/// A sum in f64 that is not below the exact sum: a small operand must not vanish before the sum is rounded.
fn ceiling(a: f64, b: f64) -> f64 {
    let sum = a + b;
    // The error of a sum is a float (Knuth, TAOCP 4.2.2, theorem B).
    let rest = sum - a;
    let error = (a - (sum - rest)) + (b - rest);
    if error > 0.0 { sum.next_up() } else { sum }
}

impl Sub for Permitted {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Permitted {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let is_infinite = |value: Self| value.low.is_infinite() || value.high.is_infinite();
        let has_zero = |value: Self| value.low <= 0.0 && value.high >= 0.0;
        if is_infinite(self) && has_zero(other) || is_infinite(other) && has_zero(self) {
            // The product is NaN.
            return ANY;
        }
        Self::hull(&[
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ])
        .rounded()
    }
}

/// 2.5 ULP if the magnitude of the divisor is in [2⁻¹²⁶, 2¹²⁶].
impl Div for Permitted {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let (nearest, farthest) = (
            other.low.abs().min(other.high.abs()),
            other.low.abs().max(other.high.abs()),
        );
        let is_defined =
            other.low * other.high > 0.0 && nearest >= MIN_NORMAL && farthest <= libm::ldexp(1.0, 126);
        if self.is_any() || other.is_any() || !is_defined {
            return ANY;
        }
        Self::hull(&[
            self.low / other.low,
            self.low / other.high,
            self.high / other.low,
            self.high / other.high,
        ])
        .within_ulps(2.5)
    }
}
