//! The transfer curve: tone mapping and gamma, from the mean of a pixel's samples to its color.

use toyproof_math::double;
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
struct Powers<'a, const N: usize> {
    values: &'a mut [f64; N],
    exponent: f64,
}

impl<const N: usize> Kernel<f64> for Powers<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<f64>>(self, _: S) {
        *self.values = double::pow(*self.values, [self.exponent; N]);
    }
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

    #[test]
    fn powers_are_those_of_libm_in_all_lanes() {
        const EXPONENTS: [f64; 6] = [1.0 / 2.2, 0.5, 1.0 / 3.0, 2.0, 0.01, 7.3];
        const SPECIAL: [f64; 8] = [0.0, -0.0, 1.0, -1e-9, 1e300, 1e-300, f64::INFINITY, f64::NAN];
        // As they occur in images, and over the whole range.
        let bases = (0..4000).map(|at| f64::from(at) / 1999.3).chain(SPECIAL).chain(
            (-1070..1024)
                .flat_map(|at| [1.0, 1.2, std::f64::consts::SQRT_2, 1.99].map(|m| m * 2f64.powi(at))),
        );
        let bases: Vec<_> = bases.collect();
        for (level, exponent) in Level::all().flat_map(|level| EXPONENTS.map(|exponent| (level, exponent))) {
            for bases in bases.as_chunks::<24>().0 {
                let mut values = *bases;
                f64::run(
                    level,
                    Powers {
                        values: &mut values,
                        exponent,
                    },
                );
                for (&base, value) in bases.iter().zip(values) {
                    let expected = if base < 0.0 {
                        f64::NAN
                    } else {
                        libm::pow(base, exponent)
                    };
                    let is_equal =
                        value.to_bits() == expected.to_bits() || value.is_nan() && expected.is_nan();
                    assert!(is_equal, "{level:?} {base} {exponent}: {value} {expected}");
                }
            }
        }
    }
}
