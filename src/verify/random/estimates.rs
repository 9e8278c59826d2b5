//! Stochastic references: their pixels with other random numbers.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;
use toyproof_eval::Places;
use toyproof_scene::Sampler;
use toyproof_tracer::Tracer;

use super::replicate_test::{REPLICATES, ReplicatedPixel};
use crate::compare::EXACT_TOLERANCE;

/// The sets of random numbers that select pixels and estimate their weights. They are disjoint from the sets
/// that estimate the means, and independent of the shader's image; otherwise pixels would be selected because
/// a set hit a small feature.
pub(crate) const SELECTION_SETS: Range<u32> = 1..9;

const _: () = assert!((SELECTION_SETS.end - SELECTION_SETS.start) as usize == REPLICATES);

/// The sets of random numbers that estimate the means.
pub(crate) const ESTIMATE_SETS: Range<u32> = 9..17;

/// The halves of [`ESTIMATE_SETS`].
const ESTIMATE_HALVES: [Range<u32>; 2] = [9..13, 13..17];

/// The number of sets in which a pixel is compared with itself. A feature that covers the part a of a pixel
/// is hit by a sample of a shader and missed by n other samples with a probability of a·(1 − a)ⁿ, which is
/// below 1/(e·n).
pub(crate) const RESAMPLES: u32 = 16;

/// The largest number of samples of a replicate.
const MAX_SAMPLES: u32 = 1 << 18;

/// The largest number of paths of a replicate.
const MAX_PATHS: u32 = 1 << 17;

/// The largest number of pixels of a replicate.
const MAX_PIXELS: u32 = 1 << 15;

/// The largest number of pixels of a replicate of a shader: seventeen replicates take about as long as an
/// image of 640×360.
const MAX_PIXELS_OF_SHADERS: u32 = 1 << 14;

/// A reference whose pixels may depend on random numbers. Colors are those of pixels; means are those of a
/// pixel's samples, before the tone map, as far as it is known.
pub(crate) trait StochasticReference: std::fmt::Debug + Sync {
    /// Whether some pixels depend on random numbers, or may do so.
    fn is_stochastic(&self) -> bool;
    /// The sampler of a scene.
    fn sampler(&self) -> Option<Sampler> {
        None
    }
    /// The number of samples of a pixel, if it is known.
    fn samples(&self) -> Option<u32> {
        None
    }
    /// The largest number of pixels for which many replicates are affordable.
    fn max_pixels(&self) -> u32 {
        MAX_PIXELS_OF_SHADERS
    }
    /// Estimates the pixels at these places; `None` if the reference cannot be rendered with other random
    /// numbers.
    fn estimates(&self, places: &Places) -> Option<Arc<Estimates>>;
    /// Whether each of the pixels depends on random numbers.
    fn are_random(&self, pixels: &[[u32; 2]]) -> Vec<bool>;
    /// The colors at these places with the sets of random numbers from 1 to `count`.
    fn sets(&self, places: &Places, count: u32) -> Option<Vec<Vec<[f64; 3]>>>;

    /// The smallest difference of two colors of a pixel that shows its dependence on random numbers.
    fn least_change(&self) -> f64 {
        EXACT_TOLERANCE
    }
    /// Tone-maps the mean of a pixel's samples to a color in [0, 1].
    fn tone_mapped(&self, mean: [f64; 3]) -> [f64; 3] {
        mean.map(|part| part.clamp(0.0, 1.0))
    }
    /// Inverts the tone mapping; infinite for colors that it cannot produce.
    fn inverse_tone_mapped(&self, color: [f64; 3]) -> [f64; 3] {
        color
    }
    /// The derivative of the tone-mapped color with respect to the mean.
    fn slope(&self, _mean: [f64; 3]) -> [f64; 3] {
        [1.0; 3]
    }
}

/// The estimates for some pixels, row by row.
#[derive(Debug)]
pub(crate) struct Estimates {
    pub(crate) pixels: Vec<Estimate>,
    /// Whether neighbors use the same random numbers, so that the variance of sums is unknown.
    pub(crate) are_correlated: bool,
    /// The correlation of the noise of neighbors in x or in y, whichever is less.
    pub(crate) axis_correlation: f64,
}

/// The estimates for a pixel.
#[derive(Debug)]
pub(crate) struct Estimate {
    /// The color with the reference's own random numbers.
    pub(crate) own: [f64; 3],
    /// The means of samples of each set in [`SELECTION_SETS`].
    pub(crate) selection: Vec<[f64; 3]>,
    /// The means over each half of [`ESTIMATE_SETS`].
    pub(crate) halves: [[f64; 3]; 2],
    /// The variance of one set of samples, estimated from the sets of the halves.
    pub(crate) variance: [f64; 3],
}

impl Estimate {
    /// Estimates a pixel with the `own` color, of which `set_mean` is the mean of the samples of a set.
    pub(crate) fn new(own: [f64; 3], set_mean: impl Fn(u32) -> [f64; 3]) -> Self {
        let sets = |sets: Range<u32>| -> Vec<[f64; 3]> { sets.map(&set_mean).collect() };
        let halves = ESTIMATE_HALVES.map(sets);
        Self {
            own,
            selection: sets(SELECTION_SETS),
            variance: variance(&halves.concat()),
            halves: halves.map(|half| mean(&half)),
        }
    }

    pub(crate) fn mean(&self) -> [f64; 3] {
        mean(&self.halves)
    }

    /// The selection sets as replicates of the pixel, all of the same weight.
    pub(crate) fn replicated(&self, at: [u32; 2]) -> ReplicatedPixel {
        ReplicatedPixel {
            at,
            weight: [1.0; 3],
            reference: self.halves,
            reference_variance: self.variance,
            single_variance: self.variance,
            own: std::array::from_fn(|set| self.selection[set]),
        }
    }

    /// Whether the pixel's color depends on random numbers.
    pub(crate) fn is_random(&self, reference: &dyn StochasticReference) -> bool {
        let first = reference.tone_mapped(self.selection[0]);
        let mut others = self.selection.iter().chain(&self.halves);
        others.any(|&other| differ_by(first, reference.tone_mapped(other), reference.least_change()))
    }
}

/// The values of a pixel in all sets.
pub(crate) fn of_pixel(sets: &[Vec<[f64; 3]>], at: usize) -> Vec<[f64; 3]> {
    sets.iter().map(|set| set[at]).collect()
}

pub(crate) fn mean(all: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|i| all.iter().map(|each| each[i]).sum::<f64>() / all.len() as f64)
}

/// The unbiased sample variance.
pub(crate) fn variance(all: &[[f64; 3]]) -> [f64; 3] {
    let mean = mean(all);
    [0, 1, 2].map(|i| {
        let squares = all.iter().map(|each| (each[i] - mean[i]).powi(2));
        squares.sum::<f64>() / (all.len() - 1) as f64
    })
}

/// Whether two colors differ.
pub(crate) fn differs(a: [f64; 3], b: [f64; 3]) -> bool {
    differ_by(a, b, EXACT_TOLERANCE)
}

/// Whether two colors differ by more than `least`.
pub(crate) fn differ_by(a: [f64; 3], b: [f64; 3], least: f64) -> bool {
    (0..3).any(|i| (a[i] - b[i]).abs() > least)
}

impl StochasticReference for Tracer<f64> {
    fn is_stochastic(&self) -> bool {
        self.sampler().is_some()
    }

    fn sampler(&self) -> Option<Sampler> {
        self.sampler()
    }

    fn samples(&self) -> Option<u32> {
        Some(self.samples())
    }

    fn max_pixels(&self) -> u32 {
        let samples = if self.traces_paths() {
            MAX_PATHS
        } else {
            MAX_SAMPLES
        };
        (samples / self.samples()).clamp(1, MAX_PIXELS)
    }

    fn estimates(&self, places: &Places) -> Option<Arc<Estimates>> {
        let estimate = |at: [u32; 2]| {
            let [x, y] = at;
            Estimate::new(self.pixel(x, y), |set| self.resampled_mean(at, set))
        };
        Some(Arc::new(Estimates {
            pixels: pixels(places).into_par_iter().map(estimate).collect(),
            are_correlated: false,
            axis_correlation: 0.0,
        }))
    }

    fn are_random(&self, pixels: &[[u32; 2]]) -> Vec<bool> {
        let is_random = |&at: &[u32; 2]| {
            let first = self.resampled(at, 1);
            (2..=RESAMPLES).any(|set| differs(first, self.resampled(at, set)))
        };
        pixels.par_iter().map(is_random).collect()
    }

    fn sets(&self, places: &Places, count: u32) -> Option<Vec<Vec<[f64; 3]>>> {
        let pixels = pixels(places);
        let set = |set| pixels.par_iter().map(|&at| self.resampled(at, set)).collect();
        Some((1..=count).map(set).collect())
    }

    fn tone_mapped(&self, mean: [f64; 3]) -> [f64; 3] {
        self.tone_mapped(mean)
    }

    fn inverse_tone_mapped(&self, color: [f64; 3]) -> [f64; 3] {
        self.inverse_tone_mapped(color)
    }

    fn slope(&self, mean: [f64; 3]) -> [f64; 3] {
        self.slope(mean)
    }
}

/// The pixels that contain the places, row by row.
pub(crate) fn pixels(places: &Places) -> Vec<[u32; 2]> {
    let [columns, rows] = places.pixels();
    let pixels = rows.iter().flat_map(|&y| columns.iter().map(move |&x| [x, y]));
    pixels.collect()
}
