//! The course's own hash.

use super::super::real::Real;

/// Its multiplier, as the course's shaders write it.
const MULTIPLIER: f64 = 43_758.545_312_3;

/// Two draws a sample, x first, from a seed that runs on through the pixel's samples.
pub(super) fn jitter<T: Real>(sample: u32) -> [T; 2] {
    [0, 1].map(|axis| {
        let seed = f64::from(sample) * 2.0 + f64::from(axis);
        let (sine, _) = T::from_f64(seed).sine_and_cosine();
        let draw = sine * T::from_f64(MULTIPLIER);
        draw - draw.floor() - T::from_f64(0.5)
    })
}
