//! Mistakes of stochastic shaders, whose pixels equal no mutant's: the mean difference of such a shader is
//! projected onto the change of each mistake, which is the most powerful test for it.

use rayon::prelude::*;
use toyproof_eval::Places;
use toyproof_image::Image;
use toyproof_verify::random::NoisyPixel;

use crate::known::mutant::Mutant;
use crate::known::{Diagnosis, Hypotheses, MAX_OTHER_MISTAKES};

/// The smallest projection on a mistake that is significant, in standard deviations.
const MIN_Z_SCORE: f64 = 6.0;
/// The range of the mistake's estimated amplitude, 1 if the shader makes exactly this mistake.
const AMPLITUDES: std::ops::Range<f64> = 0.75..1.33;
/// The largest share of the squared bias that may remain after the mistake's change is subtracted.
const MAX_REMAINING_BIAS: f64 = 0.25;
/// The largest difference of this share from the best one's of mistakes that explain the shader as well.
const MAX_REMAINING_DIFFERENCE: f64 = 0.05;

/// The lower bound of a pixel's standard deviation in weights, for the noise of the mutant's own image.
const MIN_STANDARD_DEVIATION: f64 = 0.01;

impl Hypotheses {
    /// The pixels that [`Self::recognize_noisy`] takes.
    #[must_use]
    pub fn places(&self) -> &Places {
        &self.small.places
    }

    /// Returns the mistake of a stochastic shader, from its pixels at [`Self::places`].
    #[must_use]
    pub fn recognize_noisy(&self, pixels: &[NoisyPixel]) -> Option<Diagnosis> {
        let correct = self.correct.first()?.image(&self.small)?;
        let all = self.general.par_iter().chain(&self.wrong);
        let fitting: Vec<(f64, &Mutant)> = all
            .filter_map(|mutant| {
                Some((
                    remaining_bias(pixels, mutant.image(&self.small)?, correct)?,
                    mutant,
                ))
            })
            .collect();
        let least = fitting
            .iter()
            .map(|&(remaining_bias, _)| remaining_bias)
            .min_by(f64::total_cmp)?;
        let mut best: Vec<&Mutant> = Vec::new();
        for (remaining_bias, mutant) in fitting {
            let is_new = best.iter().all(|other| other.ids().ne(mutant.ids()));
            if remaining_bias <= least + MAX_REMAINING_DIFFERENCE && is_new {
                best.push(mutant);
            }
        }
        let (first, others) = best.split_first()?;
        (others.len() <= MAX_OTHER_MISTAKES).then(|| Diagnosis::new(first, others))
    }
}

/// Returns the share of the squared bias that remains after the mistake's change is subtracted; `None` if it
/// is not that mistake.
fn remaining_bias(pixels: &[NoisyPixel], wrong: &Image, correct: &Image) -> Option<f64> {
    let [mut product, mut square, mut variance, mut bias, mut remaining] = [0.0; 5];
    for (at, pixel) in pixels.iter().enumerate() {
        for i in 0..3 {
            let [wrong, correct] =
                [wrong, correct].map(|image| f64::from(image.pixels()[at][i]).clamp(0.0, 1.0));
            let change = wrong - correct;
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

    fn gray(values: &[f64]) -> Image {
        let pixels = values
            .iter()
            .map(|&value| [value as f32, value as f32, value as f32, 1.0]);
        Image::new(values.len() as u32, 1, pixels.collect())
    }

    #[test]
    fn a_mistake_below_the_noise_level_is_recognized_and_others_are_not() {
        let noise = |at: u32| 0.02 * (f64::from(pcg(at)) / f64::from(u32::MAX) - 0.5) * 12f64.sqrt();
        let correct = vec![0.5; 1000];
        let wrong: Vec<f64> = (0..1000).map(|at| if at % 10 < 3 { 0.55 } else { 0.5 }).collect();
        let other: Vec<f64> = (0..1000).map(|at| if at % 10 > 6 { 0.55 } else { 0.5 }).collect();
        let pixels: Vec<NoisyPixel> = (0..1000)
            .map(|at| NoisyPixel {
                own: [wrong[at] + noise(at as u32); 3],
                reference: [0.5; 3],
                variance: [0.0004; 3],
            })
            .collect();
        assert!(remaining_bias(&pixels, &gray(&wrong), &gray(&correct)).is_some());
        assert!(remaining_bias(&pixels, &gray(&other), &gray(&correct)).is_none());
        // A mistake of half the amplitude is another mistake.
        let twice: Vec<f64> = wrong.iter().map(|value| 2.0 * value - 0.5).collect();
        assert!(remaining_bias(&pixels, &gray(&twice), &gray(&correct)).is_none());
    }
}
