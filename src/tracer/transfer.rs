//! The transfer curve: tone mapping and gamma, from the mean of a pixel's samples to its color.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use toyproof_scene::{Film, ToneMap};

use crate::lanes::{Kernel, Lanes, Level, Vectorized};
use crate::real::Real;

/// Applies the tone mapping operator and then gamma to one component. The result is monotonic up to rounding.
pub(super) fn tone_map<T: Real>(film: &Film, component: T) -> T {
    let mut components = [component];
    tone_map_all(film, Level::Base, &mut components);
    components[0]
}

/// Evaluates [`tone_map`] for many components.
pub(super) fn tone_map_all<T: Real, const N: usize>(film: &Film, level: Level, components: &mut [T; N]) {
    if film.tone_map == ToneMap::Reinhard {
        for component in components.iter_mut() {
            *component = *component / (*component + T::one());
        }
    }
    if film.gamma != 1.0 {
        let mut powers = components.map(Real::to_f64);
        let exponent = film.gamma.recip();
        let values = &mut powers;
        f64::run(level, Powers { values, exponent });
        *components = powers.map(T::from_f64);
    }
}

/// Kernel that raises each value to the same positive power.
struct Powers<'a> {
    values: &'a mut [f64],
    exponent: f64,
}

impl Kernel<f64> for Powers<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<f64>>(self, _: S) {
        // Without branches, so the compiler vectorizes it.
        for value in self.values {
            *value = power(*value, self.exponent);
        }
    }
}

/// Computes `base` to the power of `exponent` > 0 as 2^(exponent · log₂ base), with a relative error below
/// 1e-15 · (2 + |log₂ result|). Denormal bases and results are zero, results from 2^1023.5 on
/// infinite; NaN for a negative base.
#[inline(always)]
fn power(base: f64, exponent: f64) -> f64 {
    let result = exp2(exponent * log2(base));
    // Where the logarithm is meaningless.
    let result = if base < f64::MIN_POSITIVE { 0.0 } else { result };
    let result = if base == f64::INFINITY { base } else { result };
    if base >= 0.0 { result } else { f64::NAN }
}

/// 2^52: the bits of this float plus an integer in [0, 2^52) are those of their sum.
const TWO_52: f64 = 4_503_599_627_370_496.0;

/// The coefficients of s², s⁴ … in atanh(s) / s; the remainder is below 2^-55 for |s| ≤ 3 − √8.
const ATANH: [f64; 10] = [
    1.0 / 21.0,
    1.0 / 19.0,
    1.0 / 17.0,
    1.0 / 15.0,
    1.0 / 13.0,
    1.0 / 11.0,
    1.0 / 9.0,
    1.0 / 7.0,
    1.0 / 5.0,
    1.0 / 3.0,
];

/// The base-2 logarithm of a positive, normal and finite number: of x = m · 2^e with m in [√½, √2),
/// log₂ x = e + 2 atanh((m − 1) / (m + 1)) / ln 2.
#[inline(always)]
fn log2(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    let bits = x.to_bits();
    let biased = f64::from_bits(bits >> 52 | TWO_52.to_bits()) - TWO_52;
    let mantissa = f64::from_bits(bits & MANTISSA | 1f64.to_bits());
    let is_high = mantissa >= std::f64::consts::SQRT_2;
    let m = if is_high { 0.5 * mantissa } else { mantissa };
    let e = biased - if is_high { 1022.0 } else { 1023.0 };
    let s = (m - 1.0) / (m + 1.0);
    let square = s * s;
    let series = ATANH
        .into_iter()
        .fold(0.0, |sum, coefficient| (sum + coefficient) * square);
    e + (s + s * series) * (2.0 * std::f64::consts::LOG2_E)
}

/// The coefficients of x¹³ … x⁰ in exp(x); the remainder is below 2^-57 for |x| ≤ ln(2) / 2.
const EXP: [f64; 14] = [
    1.0 / 6_227_020_800.0,
    1.0 / 479_001_600.0,
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];

/// 2^x; zero where the result is denormal, infinite from 2^1023.5 on.
#[inline(always)]
fn exp2(x: f64) -> f64 {
    const MIN: f64 = -1022.0;
    const MAX: f64 = 1023.5;
    let within = if x > MIN { x } else { MIN };
    let within = if within < MAX { within } else { MAX };
    // Rounds to an integer n, whose lowest bits are those of the sum.
    let sum = within + (1.5 * TWO_52 + 1023.0);
    let n = sum - (1.5 * TWO_52 + 1023.0);
    let scale = f64::from_bits(sum.to_bits() << 52);
    let fraction = (within - n) * std::f64::consts::LN_2;
    let result = EXP
        .into_iter()
        .fold(0.0, |sum, coefficient| sum * fraction + coefficient)
        * scale;
    let result = if x < MIN { 0.0 } else { result };
    if x >= MAX { f64::INFINITY } else { result }
}

/// Inverts [`tone_map`]; infinite for values that the operator cannot produce.
pub(super) fn inverse_tone_map(film: &Film, tone_mapped: f64) -> f64 {
    let mapped = if film.gamma == 1.0 {
        tone_mapped
    } else {
        tone_mapped.max(0.0).powf(film.gamma)
    };
    match film.tone_map {
        ToneMap::None => mapped,
        ToneMap::Reinhard if mapped < 1.0 => mapped / (1.0 - mapped),
        ToneMap::Reinhard => f64::INFINITY,
    }
}

/// Computes the derivative of [`tone_map`] by central differences. Components below `MIN_COMPONENT`, where
/// the derivative of the gamma curve is unbounded, get the derivative at `MIN_COMPONENT`.
pub(super) fn tone_map_slope(film: &Film, component: f64) -> f64 {
    const MIN_COMPONENT: f64 = 1e-3;
    const RELATIVE_STEP: f64 = 1e-4;
    let at = component.max(MIN_COMPONENT);
    let [low, high] =
        [at * (1.0 - RELATIVE_STEP), at * (1.0 + RELATIVE_STEP)].map(|component| tone_map(film, component));
    (high - low) / (2.0 * RELATIVE_STEP * at)
}

#[cfg(test)]
mod tests {
    use toyproof_scene::{Integrator, Sampler};

    use super::*;

    #[test]
    fn inverse_tone_map_inverts_and_slope_is_the_derivative() {
        for (operator, gamma) in [
            (ToneMap::None, 1.0),
            (ToneMap::Reinhard, 1.0),
            (ToneMap::Reinhard, 2.2),
        ] {
            let film = Film {
                size: [1, 1],
                samples: 1,
                sampler: Sampler::Center,
                max_depth: 1,
                integrator: Integrator::Whitted,
                tone_map: operator,
                gamma,
            };
            for component in [0.01, 0.3, 1.0, 7.0] {
                let tone_mapped = tone_map(&film, component);
                assert!((inverse_tone_map(&film, tone_mapped) - component).abs() < 1e-9 * component);
                let rise = tone_map(&film, component + 1e-6) - tone_mapped;
                assert!((rise / 1e-6 / tone_map_slope(&film, component) - 1.0).abs() < 1e-3);
            }
        }
    }

    /// Bases and exponents over the whole range, most of them as they occur in images.
    fn cases() -> impl Iterator<Item = (f64, f64)> {
        let bases = (0..4000).map(|at| f64::from(at) / 1999.3).chain(
            (-1070..1024)
                .flat_map(|at| [1.0, 1.2, std::f64::consts::SQRT_2, 1.99].map(|m| m * 2f64.powi(at))),
        );
        bases.flat_map(|base| [1.0 / 2.2, 0.5, 1.0 / 3.0, 2.0, 0.01, 7.3].map(|exponent| (base, exponent)))
    }

    #[test]
    fn powers_are_those_of_libm_in_all_lanes() {
        for (base, exponent) in cases() {
            let expected = libm::pow(base, exponent);
            let result = power(base, exponent);
            if expected >= 2f64.powf(1023.5) {
                assert_eq!(result, f64::INFINITY);
                continue;
            }
            if base < f64::MIN_POSITIVE || expected < f64::MIN_POSITIVE {
                assert!(result <= 4.0 * f64::MIN_POSITIVE, "{base} {exponent}: {result}");
                continue;
            }
            let bound = 1e-15 * (2.0 + expected.log2().abs());
            let is_near = result == expected || (result / expected - 1.0).abs() < bound;
            assert!(is_near, "{base} {exponent}: {result} {expected}");
        }
        for level in Level::all() {
            let bases: Vec<f64> = cases().map(|(base, _)| base).collect();
            let mut values = bases.clone();
            let exponent = 1.0 / 2.2;
            let kernel = Powers {
                values: &mut values,
                exponent,
            };
            f64::run(level, kernel);
            for (base, value) in bases.into_iter().zip(values) {
                assert_eq!(
                    value.to_bits(),
                    power(base, exponent).to_bits(),
                    "{level:?} {base}"
                );
            }
        }
    }

    #[test]
    fn powers_of_special_numbers() {
        assert_eq!(power(0.0, 0.5), 0.0);
        assert_eq!(power(-0.0, 0.5), 0.0);
        assert_eq!(power(1.0, 0.3), 1.0);
        assert_eq!(power(f64::INFINITY, 0.5), f64::INFINITY);
        assert_eq!(power(1e300, 3.0), f64::INFINITY);
        assert_eq!(power(1e-300, 3.0), 0.0);
        assert!(power(-1e-9, 0.5).is_nan() && power(f64::NAN, 0.5).is_nan());
    }
}
