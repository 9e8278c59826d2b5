//! What happens to a pixel's mean.

use super::real::Real;
use crate::scene::{Film, ToneMap};

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
