//! The course's own hash.

use super::super::doubt::Doubt;
use super::super::real::Real;

/// Its multiplier, as the course's shaders write it.
const MULTIPLIER: f64 = 43_758.545_312_3;

/// Two draws a sample, x first, from a seed that runs on through the pixel's samples.
pub(super) fn jitter<T: Real>(sample: u32, doubt: &impl Doubt<T>) -> [T; 2] {
    [0, 1].map(|axis| {
        let seed = f64::from(sample) * 2.0 + f64::from(axis);
        let (sine, _) = T::from_f64(seed).sine_and_cosine();
        let draw = doubt.draw(sine * T::from_f64(MULTIPLIER), seed, sine, axis);
        draw - draw.floor() - T::from_f64(0.5)
    })
}

/// Bounds in float32 on the product that the hash takes the fraction of, in pixels.
///
/// The sine's absolute error on lavapipe is 1.4 units of 2⁻²⁴ on [−π, π] and 450 at 10⁵ (measured; the driver
/// reduces its argument in float32), which the multiplier enlarges; the product is rounded once, and so is the
/// multiplier, 43758.5453123 → 43758.546875 (relative 3.6e−8). sin(0) = 0 has no error.
pub(in super::super) fn draw_bound(seed: f64, sine: f64) -> f64 {
    const UNIT: f64 = 1.0 / (1 << 24) as f64;
    if seed == 0.0 {
        return 0.0;
    }
    let sine_error = (1.4 + 450.0e-5 * seed) * UNIT;
    MULTIPLIER * (sine_error + sine.abs() * (UNIT + 3.6e-8))
}
