//! The analyser of Web Audio (W3C Recommendation of 17 June 2021, §1.8) with the values that it has if
//! nothing is set, as on the site.

use std::sync::LazyLock;

use toyproof_math::double;

use super::WIDTH;
pub(super) use super::fft::SIZE;
use super::fft::transform;

/// `smoothingTimeConstant`
pub(super) const SMOOTHING: f64 = 0.8;
/// `minDecibels` and `maxDecibels`
const DECIBELS: [f64; 2] = [-100.0, -30.0];

/// The magnitudes of the lowest frequencies.
pub(super) type Magnitudes = [f64; WIDTH];

/// The Blackman window with α = 0.16, which sinks to 0 at both ends (§1.8.6, “Applying a Blackman window”).
static WINDOW: LazyLock<Vec<f64>> = LazyLock::new(|| {
    const ALPHA: f64 = 0.16;
    let weight = |n: usize| {
        let turn = std::f64::consts::TAU * n as f64 / SIZE as f64;
        let [once, twice] = double::cos([turn, 2.0 * turn]);
        (1.0 - ALPHA) / 2.0 - 0.5 * once + ALPHA / 2.0 * twice
    };
    (0..SIZE).map(weight).collect()
});

/// The magnitudes of windowed samples, without smoothing (§1.8.6, “Applying a Fourier transform”).
pub(super) fn magnitudes(samples: &[f32; SIZE]) -> Magnitudes {
    let windowed = std::array::from_fn(|n| f64::from(samples[n]) * WINDOW[n]);
    let transformed = transform(&windowed);
    std::array::from_fn(|k| {
        let [real, imaginary] = transformed[k].map(|part| part / SIZE as f64);
        (real * real + imaginary * imaginary).sqrt()
    })
}

/// The byte of a magnitude (§1.8.6, “Conversion to dB”, and §1.8.3, `getByteFrequencyData`).
pub(super) fn spectrum_level(magnitude: f64) -> u8 {
    if magnitude <= 0.0 {
        return 0;
    }
    let [logarithm] = double::log([magnitude]);
    let decibels = 20.0 * logarithm / std::f64::consts::LN_10;
    let [low, high] = DECIBELS;
    // The conversion to u8 clamps.
    (255.0 / (high - low) * (decibels - low)).floor() as u8
}

/// The byte of a sample (§1.8.3, `getByteTimeDomainData`).
pub(super) fn wave_level(sample: f32) -> u8 {
    // In f32, as browsers compute it.
    (128.0 * (1.0 + sample)).floor() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_those_of_the_specification() {
        let magnitude = |decibels: f64| 10_f64.powf(decibels / 20.0);
        let levels =
            [-120.0, -100.1, -99.5, -65.0, -30.1, -30.0 + 1e-9, 0.0].map(|d| spectrum_level(magnitude(d)));
        assert_eq!(levels, [0, 0, 1, 127, 254, 255, 255]);
        assert_eq!([0.0, f64::NAN].map(spectrum_level), [0, 0]);
        assert_eq!(
            [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0].map(wave_level),
            [0, 0, 64, 128, 192, 255, 255]
        );
    }

    #[test]
    fn a_constant_has_the_gain_of_the_window() {
        let [first, second, third, fourth, ..] = magnitudes(&[1.0; SIZE]);
        for (magnitude, expected) in [(first, 0.42), (second, 0.25), (third, 0.04), (fourth, 0.0)] {
            assert!((magnitude - expected).abs() < 1e-12, "{magnitude}");
        }
    }
}
