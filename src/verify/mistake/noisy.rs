//! Mistakes of shaders with random numbers of their own, whose pixels no suspect shows: what such a shader differs by on the average is projected
//! on what each mistake changes, the most powerful way to see whether it is that one.

use rayon::prelude::*;
use toyproof_eval::Places;
use toyproof_image::Image;

use super::suspect::Suspect;
use super::{MANY, Named, Suspects};

/// A pixel of a stochastic shader, over several sets of random numbers. Components lie in [0, 1].
#[derive(Debug, Clone, Copy)]
pub struct NoisyPixel {
    /// The shader's mean.
    pub own: [f64; 3],
    /// The mean that it should have.
    pub reference: [f64; 3],
    /// The variance of the difference of the two, if both are of one mean.
    pub variance: [f64; 3],
}

/// A mistake is the shader's if its projection is so many standard deviations,
const LEAST_DEVIATIONS: f64 = 6.0;
/// the share of it that is seen is between these,
const SHARES: std::ops::Range<f64> = 0.75..1.33;
/// and no more than this share of the squared bias is left without it.
const LEFT: f64 = 0.25;
/// Of several, those count that leave no more than this more than the best.
const AS_GOOD: f64 = 0.05;

/// A pixel's noise is at least this, as that of a mistake's own picture.
const LEAST_NOISE: f64 = 0.01;

impl Suspects {
    /// Where the pixels lie that [`Self::recognise_noisy`] is to be told of.
    #[must_use]
    pub fn places(&self) -> &Places {
        &self.small.places
    }

    /// The mistake that a shader with random numbers of its own makes, from its pixels at [`Self::places`].
    #[must_use]
    pub fn recognise_noisy(&self, pixels: &[NoisyPixel]) -> Option<Vec<Named>> {
        let right = self.right.first()?.picture(&self.small)?;
        let all = self.general.par_iter().chain(&self.wrong);
        let fitting: Vec<(f64, &Suspect)> = all
            .filter_map(|suspect| Some((left(pixels, suspect.picture(&self.small)?, right)?, suspect)))
            .collect();
        let least = fitting.iter().map(|&(left, _)| left).min_by(f64::total_cmp)?;
        let mut best: Vec<&Suspect> = Vec::new();
        for (left, suspect) in fitting {
            let is_new = best.iter().all(|other| other.names().ne(suspect.names()));
            if left <= least + AS_GOOD && is_new {
                best.push(suspect);
            }
        }
        let (first, others) = best.split_first()?;
        (others.len() <= MANY).then(|| vec![first.mistakes[0].or(others)])
    }
}

/// The share of the squared bias that is left without a mistake; none if it is not that mistake.
fn left(pixels: &[NoisyPixel], wrong: &Image, right: &Image) -> Option<f64> {
    let [mut product, mut square, mut variance, mut bias, mut left] = [0.0; 5];
    for (at, pixel) in pixels.iter().enumerate() {
        for i in 0..3 {
            let [wrong, right] = [wrong, right].map(|image| f64::from(image.pixels()[at][i]).clamp(0.0, 1.0));
            let change = wrong - right;
            if !change.is_finite() {
                return None;
            }
            let own = pixel.own[i] - pixel.reference[i];
            let weight = 1.0 / (pixel.variance[i] + LEAST_NOISE * LEAST_NOISE);
            product += weight * change * own;
            square += weight * change * change;
            variance += weight * weight * change * change * pixel.variance[i];
            bias += weight * (own * own - pixel.variance[i]);
            left += weight * ((own - change).powi(2) - pixel.variance[i]);
        }
    }
    let is_seen = product > LEAST_DEVIATIONS * variance.sqrt() && bias > 0.0;
    let is_it = is_seen && SHARES.contains(&(product / square)) && left <= LEFT * bias;
    is_it.then(|| left / bias)
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
    fn a_mistake_is_seen_through_noise_and_another_is_not() {
        let noise = |at: u32| 0.02 * (f64::from(pcg(at)) / f64::from(u32::MAX) - 0.5) * 12f64.sqrt();
        let right = vec![0.5; 1000];
        let wrong: Vec<f64> = (0..1000).map(|at| if at % 10 < 3 { 0.55 } else { 0.5 }).collect();
        let other: Vec<f64> = (0..1000).map(|at| if at % 10 > 6 { 0.55 } else { 0.5 }).collect();
        let pixels: Vec<NoisyPixel> = (0..1000)
            .map(|at| NoisyPixel {
                own: [wrong[at] + noise(at as u32); 3],
                reference: [0.5; 3],
                variance: [0.0004; 3],
            })
            .collect();
        assert!(left(&pixels, &gray(&wrong), &gray(&right)).is_some());
        assert!(left(&pixels, &gray(&other), &gray(&right)).is_none());
        // Half of the mistake is another mistake.
        let twice: Vec<f64> = wrong.iter().map(|value| 2.0 * value - 0.5).collect();
        assert!(left(&pixels, &gray(&twice), &gray(&right)).is_none());
    }
}
