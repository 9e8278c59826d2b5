//! What happens to a pixel's mean.

use toyproof_scene::{Film, ToneMap};

use super::real::Real;

/// The tone map, then the gamma, for one component. It never falls where its argument rises.
pub(super) fn develop<T: Real>(film: &Film, component: T) -> T {
    let mapped = match film.tone_map {
        ToneMap::None => component,
        ToneMap::Reinhard => component / (component + T::one()),
    };
    if film.gamma == 1.0 {
        mapped
    } else {
        mapped.power(T::from_f64(film.gamma.recip()))
    }
}

/// What a component was before it was developed; infinite for what no component becomes.
pub(super) fn undevelop(film: &Film, developed: f64) -> f64 {
    let mapped = if film.gamma == 1.0 {
        developed
    } else {
        developed.max(0.0).powf(film.gamma)
    };
    match film.tone_map {
        ToneMap::None => mapped,
        ToneMap::Reinhard if mapped < 1.0 => mapped / (1.0 - mapped),
        ToneMap::Reinhard => f64::INFINITY,
    }
}

/// By how much more than a component its developed value rises. Below this, where a gamma rises without end, it is that of this.
pub(super) fn slope(film: &Film, component: f64) -> f64 {
    const LEAST: f64 = 1e-3;
    const STEP: f64 = 1e-4;
    let at = component.max(LEAST);
    let [low, high] = [at * (1.0 - STEP), at * (1.0 + STEP)].map(|component| develop(film, component));
    (high - low) / (2.0 * STEP * at)
}

#[cfg(test)]
mod tests {
    use toyproof_scene::{Integrator, Sampler};

    use super::*;

    #[test]
    fn undeveloping_undoes_developing_and_the_slope_is_the_derivative() {
        for (tone_map, gamma) in [
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
                tone_map,
                gamma,
            };
            for component in [0.01, 0.3, 1.0, 7.0] {
                let developed = develop(&film, component);
                assert!((undevelop(&film, developed) - component).abs() < 1e-9 * component);
                let rise = develop(&film, component + 1e-6) - developed;
                assert!((rise / 1e-6 / slope(&film, component) - 1.0).abs() < 1e-3);
            }
        }
    }
}
