//! Sampling a tile until its estimated error is small enough.

use crate::ray_epsilon::Exact;
use crate::real::{Real, Vector};
use crate::tracer::Tracer;
use crate::transfer::tone_map;

/// Side of an adaptive tile in pixels: large enough that its error is estimated from hundreds of values,
/// small enough that empty sky does not share the cost of a silhouette.
pub(super) const ADAPTIVE_TILE_SIDE: u32 = 16;

/// Initial number of samples in each of the two independent sets of a tile, whose difference estimates the
/// error. The number is doubled until the error is small enough or [`MAX_SAMPLES_PER_SET`] is reached.
const INITIAL_SAMPLES_PER_SET: u32 = 8;

/// Largest number of samples in each of the two sets.
const MAX_SAMPLES_PER_SET: u32 = 1 << 15;

/// The cost of an adaptively sampled image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SamplingCost {
    /// Total number of samples over all pixels.
    pub samples: u64,
    /// Largest and smallest number of samples in a pixel.
    pub per_pixel: [u32; 2],
    /// Largest estimated error of a tile.
    pub error: f64,
}

/// A tile.
pub struct AdaptiveTile {
    pub(super) corner: [u32; 2],
    pub(super) size: [u32; 2],
    /// In the order of the rows.
    pub(super) colors: Vec<[f64; 3]>,
    pub(super) cost: SamplingCost,
}

impl<T: Real> Tracer<T> {
    pub(super) fn adaptive_tile(&self, corner: [u32; 2], max_error: f64) -> AdaptiveTile {
        let [width, height] = self.film.size;
        let size = [
            ADAPTIVE_TILE_SIDE.min(width - corner[0]),
            ADAPTIVE_TILE_SIDE.min(height - corner[1]),
        ];
        let number = size[0] * size[1];
        let mut samples = 0;
        let mut count = INITIAL_SAMPLES_PER_SET;
        loop {
            let mut square_sum = 0.0;
            let colors: Vec<_> = (0..number)
                .map(|at| {
                    let pixel = [corner[0] + at % size[0], corner[1] + at / size[0]];
                    let [a, b] = [0, 1].map(|set| {
                        let mean = Self::mean(pixel, count, set, |sample| self.sample(sample, &Exact));
                        mean.to_array().map(Real::to_f64)
                    });
                    let [x, y] = [a, b].map(|mean| mean.map(|c| tone_map(&self.film, c).clamp(0.0, 1.0)));
                    square_sum += (0..3).map(|i| (0.5 * (x[i] - y[i])).powi(2)).sum::<f64>();
                    [0, 1, 2].map(|i| tone_map(&self.film, 0.5 * (a[i] + b[i])))
                })
                .collect();
            samples += u64::from(number) * 2 * u64::from(count);
            let error = (square_sum / f64::from(3 * number)).sqrt();
            if error <= max_error || count == MAX_SAMPLES_PER_SET {
                let cost = SamplingCost {
                    samples,
                    per_pixel: [2 * count; 2],
                    error,
                };
                return AdaptiveTile {
                    corner,
                    size,
                    colors,
                    cost,
                };
            }
            count *= 2;
        }
    }
}
