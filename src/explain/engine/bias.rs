//! The bias of stochastic shaders, whose single pixels say nothing: their differences from expected means are
//! projected onto the shader's own bias, or onto the change that a mistake makes.

use std::ops::Range;

use toyproof_verify::random::{MEAN_SETS, NoisyPixel};

/// The significance of a pixel's bias, in standard deviations, and the least difference of a biased one.
const MIN_DEVIATIONS: f64 = 2.0;
const LEAST_DIFFERENCE: f64 = 1e-3;

/// The least variance of a pixel in weights: models of noise are not exact.
const LEAST_VARIANCE: f64 = 1e-4;

/// The largest amplitude and the largest share of the squared bias that a repair leaves, and the significance
/// of exceeding them, in standard deviations. The confirmation is stricter.
const MAX_AMPLITUDE: f64 = 0.15;
const MAX_REMAINING: f64 = 0.1;
const MAX_DEVIATIONS: f64 = 3.0;

/// The bias of a pixel of a stochastic shader.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bias {
    /// The expected mean of each component.
    mean: [f64; 3],
    /// The difference of the shader's mean from it.
    difference: [f64; 3],
    /// The variance of one evaluation of the pixel.
    variance: [f64; 3],
}

impl Bias {
    pub(crate) fn new(pixel: &NoisyPixel) -> Self {
        Self {
            mean: pixel.reference,
            difference: std::array::from_fn(|i| pixel.own[i] - pixel.reference[i]),
            // The means are over several sets of random numbers.
            variance: pixel.variance.map(|variance| variance * MEAN_SETS as f64),
        }
    }

    /// Whether the difference of the means is more than noise.
    pub(crate) fn is_significant(&self, pixel: &NoisyPixel) -> bool {
        (0..3).any(|i| {
            let deviation = pixel.variance[i].sqrt().max(LEAST_DIFFERENCE);
            self.difference[i].abs() > MIN_DEVIATIONS * deviation
        })
    }

    /// How much larger the bias is than the deviation of one evaluation.
    pub(crate) fn significance(self) -> f64 {
        (0..3)
            .map(|i| self.difference[i].powi(2) / (self.variance[i] + LEAST_VARIANCE))
            .sum()
    }
}

/// The differences of colors from expected means, compared with the shader's bias.
pub(crate) struct Projection {
    /// 1 for the shader itself, 0 for an unbiased one; and its standard deviation.
    pub(crate) amplitude: f64,
    deviation: f64,
    /// The squared bias as a share of the shader's, and its standard deviation.
    remaining: f64,
    remaining_deviation: f64,
}

impl Projection {
    /// The share of the squared bias that is left.
    pub(crate) fn remaining(&self) -> f64 {
        self.remaining.clamp(0.0, 2.0)
    }

    /// Whether there may be no bias.
    pub(crate) fn is_small(&self) -> bool {
        let limit = MAX_REMAINING + MAX_DEVIATIONS * self.remaining_deviation;
        self.amplitude.abs() <= MAX_AMPLITUDE + MAX_DEVIATIONS * self.deviation && self.remaining <= limit
    }
}

/// Projects colors, by a single evaluation of each pixel; `None` if they are not finite.
pub(crate) fn project<'a>(colors: impl Iterator<Item = (Option<Bias>, &'a [f64; 3])>) -> Option<Projection> {
    let [mut product, mut square, mut variance, mut left, mut left_variance] = [0.0; 5];
    for (bias, color) in colors {
        let bias = bias?;
        for (i, part) in color.iter().enumerate() {
            let rest = part.clamp(0.0, 1.0) - bias.mean[i];
            if !rest.is_finite() {
                return None;
            }
            let weight = 1.0 / (bias.variance[i] + LEAST_VARIANCE);
            product += weight * bias.difference[i] * rest;
            square += weight * bias.difference[i].powi(2);
            variance += weight.powi(2) * bias.difference[i].powi(2) * bias.variance[i];
            left += weight * (rest * rest - bias.variance[i]);
            left_variance += 2.0 * (weight * bias.variance[i]).powi(2);
        }
    }
    (square > 0.0).then(|| Projection {
        amplitude: product / square,
        deviation: variance.sqrt() / square,
        remaining: left / square,
        remaining_deviation: left_variance.sqrt() / square,
    })
}

// Known mistakes.

/// The smallest projection on a mistake that is significant, in standard deviations.
const MIN_Z_SCORE: f64 = 6.0;
/// The range of the mistake's estimated amplitude, 1 if the shader makes exactly this mistake.
const AMPLITUDES: Range<f64> = 0.75..1.33;
/// The largest share of the squared bias that may remain after the mistake's change is subtracted.
const MAX_REMAINING_BIAS: f64 = 0.25;

/// The lower bound of a pixel's standard deviation in weights, for the noise of the mutant's own image.
const MIN_STANDARD_DEVIATION: f64 = 0.01;

/// Returns the share of the squared bias that remains after a mistake's change is subtracted, which changes
/// each pixel by this; `None` if it is not that mistake.
pub(crate) fn remaining_bias(pixels: &[NoisyPixel], changes: impl Iterator<Item = [f64; 3]>) -> Option<f64> {
    let [mut product, mut square, mut variance, mut bias, mut remaining] = [0.0; 5];
    for (pixel, changes) in pixels.iter().zip(changes) {
        for (i, change) in changes.into_iter().enumerate() {
            if !change.is_finite() {
                return None;
            }
            let own = pixel.own[i] - pixel.reference[i];
            let weight = 1.0 / (pixel.variance[i] + MIN_STANDARD_DEVIATION * MIN_STANDARD_DEVIATION);
            product += weight * change * own;
            square += weight * change * change;
            variance += weight * weight * change * change * pixel.variance[i];
            bias += weight * (own * own - pixel.variance[i]);
            remaining += weight * ((own - change).powi(2) - pixel.variance[i]);
        }
    }
    let is_significant = product > MIN_Z_SCORE * variance.sqrt() && bias > 0.0;
    let is_explained =
        is_significant && AMPLITUDES.contains(&(product / square)) && remaining <= MAX_REMAINING_BIAS * bias;
    is_explained.then(|| remaining / bias)
}

#[cfg(test)]
mod tests {
    use toyproof_image::pcg;

    use super::*;

    #[test]
    fn a_mistake_below_the_noise_level_is_recognized_and_others_are_not() {
        let noise = |at: u32| 0.02 * (f64::from(pcg(at)) / f64::from(u32::MAX) - 0.5) * 12f64.sqrt();
        let wrong: Vec<f64> = (0..1000).map(|at| if at % 10 < 3 { 0.05 } else { 0.0 }).collect();
        let other: Vec<f64> = (0..1000).map(|at| if at % 10 > 6 { 0.05 } else { 0.0 }).collect();
        let pixels: Vec<NoisyPixel> = (0..1000)
            .map(|at| NoisyPixel {
                own: [0.5 + wrong[at] + noise(at as u32); 3],
                reference: [0.5; 3],
                variance: [0.0004; 3],
            })
            .collect();
        let remaining = |changes: &[f64]| remaining_bias(&pixels, changes.iter().map(|&change| [change; 3]));
        assert!(remaining(&wrong).is_some());
        assert!(remaining(&other).is_none());
        // A mistake of half the amplitude is another mistake.
        let twice: Vec<f64> = wrong.iter().map(|change| 2.0 * change).collect();
        assert!(remaining(&twice).is_none());
    }
}
