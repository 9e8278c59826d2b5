//! From the samples of a pixel to its color: means over other sets of samples, adaptive sampling.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_scene::{Integrator, Sampler};

use crate::ray_epsilon::Exact;
use crate::real::{Real, Vector};
use crate::sampler::{Sample, SampleStream};
use crate::transfer::{inverse_tone_map, tone_map, tone_map_slope};
use crate::{Kernel, Tracer, tile};

impl Tracer<f64> {
    /// Returns the sampler of the scene, or `None` if it takes the pixel centers.
    #[must_use]
    pub fn sampler(&self) -> Option<Sampler> {
        Some(self.film.sampler).filter(|&sampler| sampler != Sampler::Center)
    }

    /// Returns the number of samples per pixel.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.film.samples
    }

    /// Returns whether the scene is path-traced.
    #[must_use]
    pub fn traces_paths(&self) -> bool {
        let integrator = match &self.kernel {
            Kernel::Spheres(world) => world.integrator,
            Kernel::Shapes(world) => world.integrator,
        };
        integrator == Integrator::Path
    }

    /// Computes the mean of the samples of the pixel at (x, y), y up, with the scene's number of samples and
    /// the `independent` sampler. Each `set` has different random numbers; set 0 is the scene's own. The
    /// result is not tone-mapped; see [`tone_mapped`](Self::tone_mapped).
    #[must_use]
    pub fn resampled_mean(&self, [x, y]: [u32; 2], set: u32) -> [f64; 3] {
        let count = self.film.samples;
        let mut sum = glam::DVec3::ZERO;
        for index in 0..count {
            let sample = Sample {
                pixel: [x, y],
                index,
                count,
                set,
            };
            let mut stream = SampleStream::new(Sampler::Independent, sample);
            let position = Self::sample_position(sample.pixel, stream.jitter());
            let primary = self.primary_hit(self.camera.screen(position));
            sum += self.radiance(primary, stream, &Exact);
        }
        (sum / f64::from(count)).to_array()
    }

    /// Like [`resampled_mean`](Self::resampled_mean), but tone-mapped.
    #[must_use]
    pub fn resampled(&self, pixel: [u32; 2], set: u32) -> [f64; 3] {
        self.tone_mapped(self.resampled_mean(pixel, set))
    }

    /// Computes [`resampled_mean`](Self::resampled_mean) for all pixels of up to [`RESAMPLED_ROWS`] rows from
    /// `bottom` on, row by row. The results are not tone-mapped; see [`tone_mapped`](Self::tone_mapped).
    #[must_use]
    pub fn resampled_rows(&self, bottom: u32, set: u32) -> Vec<[f64; 3]> {
        let means = self.means(bottom, Sampler::Independent, set);
        means.into_iter().map(Vector::to_array).collect()
    }

    /// Tone-maps the mean of a pixel's samples to a color in [0, 1].
    #[must_use]
    pub fn tone_mapped(&self, mean: [f64; 3]) -> [f64; 3] {
        mean.map(|component| tone_map(&self.film, component).clamp(0.0, 1.0))
    }

    /// Inverts the tone mapping; infinite for colors that it cannot produce.
    #[must_use]
    pub fn inverse_tone_mapped(&self, color: [f64; 3]) -> [f64; 3] {
        color.map(|component| inverse_tone_map(&self.film, component))
    }

    /// Computes the derivative of the tone-mapped color with respect to the mean.
    #[must_use]
    pub fn slope(&self, mean: [f64; 3]) -> [f64; 3] {
        mean.map(|component| tone_map_slope(&self.film, component))
    }

    /// Computes the tone-mapped color of one sample at a position in pixels from the bottom left, y up. Only scenes
    /// without a [sampler](Self::sampler) have a color at each position; others use the same random numbers
    /// everywhere.
    #[must_use]
    pub fn color_at(&self, position: [f64; 2]) -> [f64; 3] {
        let sample = Sample {
            pixel: [0; 2],
            index: 0,
            count: 1,
            set: 0,
        };
        let stream = SampleStream::new(self.film.sampler, sample);
        let primary = self.primary_hit(self.camera.screen(position));
        let color = self.radiance(primary, stream, &Exact).to_array();
        color.map(|component| tone_map(&self.film, component))
    }

    /// Renders an image of the pixels in these columns and rows only.
    #[must_use]
    pub fn sampled(&self, columns: &[u32], rows: &[u32]) -> Image {
        let width = columns.len();
        let pixels = (0..width * rows.len()).into_par_iter().map(|at| {
            let [r, g, b] = self.pixel(columns[at % width], rows[at / width]);
            [r as f32, g as f32, b as f32, 1.0]
        });
        Image::new(width as u32, rows.len() as u32, pixels.collect())
    }
}

/// The number of rows that are resampled at once.
pub const RESAMPLED_ROWS: u32 = tile::TILE_SIDE;

/// Side of an adaptive tile in pixels: large enough that its error is estimated from hundreds of values,
/// small enough that empty sky does not share the cost of a silhouette.
const ADAPTIVE_TILE_SIDE: u32 = 16;
/// Initial number of samples in each of the two independent sets of a tile, whose difference estimates the
/// error. It is doubled until the error is small enough or [`MAX_SAMPLES_PER_SET`] is reached.
const INITIAL_SAMPLES_PER_SET: u32 = 8;
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

/// A tile: its corner, size, colors in row order, and cost.
pub(super) type AdaptiveTile = ([u32; 2], [u32; 2], Vec<[f64; 3]>, SamplingCost);

impl<T: Real> Tracer<T> {
    /// Renders the image with enough samples in each tile of 16×16 pixels to bring its estimated error below
    /// `max_error`, up to 65,536 per pixel. The error is the root mean square, over the pixels and components
    /// of the tile, of half the difference of two independent sets of samples, both tone-mapped and clamped
    /// to [0, 1]. The number of samples of the scene's film is ignored. Its sampler must be stochastic.
    ///
    /// `row_done` is called once per row of the image.
    pub fn render_adaptive(&self, max_error: f64, row_done: impl Fn() + Sync) -> (Image, SamplingCost) {
        let [width, height] = self.film.size;
        let bands: Vec<Vec<AdaptiveTile>> = (0..height.div_ceil(ADAPTIVE_TILE_SIDE))
            .into_par_iter()
            .map(|band| {
                let tiles = (0..width.div_ceil(ADAPTIVE_TILE_SIDE))
                    .map(|column| {
                        let corner = [column * ADAPTIVE_TILE_SIDE, band * ADAPTIVE_TILE_SIDE];
                        T::adaptive_tile(self, corner, max_error)
                    })
                    .collect();
                (0..ADAPTIVE_TILE_SIDE.min(height - band * ADAPTIVE_TILE_SIDE)).for_each(|_| row_done());
                tiles
            })
            .collect();
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; width as usize * height as usize];
        let mut total = SamplingCost {
            samples: 0,
            per_pixel: [0, u32::MAX],
            error: 0.0,
        };
        for ([left, bottom], [across, _], colors, cost) in bands.into_iter().flatten() {
            for (at, color) in (0..).zip(colors) {
                let (x, y) = (left + at % across, bottom + at / across);
                let [r, g, b] = color.map(|c| c as f32);
                pixels[(y * width + x) as usize] = [r, g, b, 1.0];
            }
            total.samples += cost.samples;
            total.per_pixel[0] = total.per_pixel[0].max(cost.per_pixel[0]);
            total.per_pixel[1] = total.per_pixel[1].min(cost.per_pixel[1]);
            total.error = total.error.max(cost.error);
        }
        (Image::new(width, height, pixels), total)
    }

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
                    let [a, b] = [0, 1].map(|set| self.mean(pixel, count, set));
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
                return (corner, size, colors, cost);
            }
            count *= 2;
        }
    }

    /// Computes the mean of one set of samples.
    fn mean(&self, pixel: [u32; 2], count: u32, set: u32) -> [f64; 3] {
        let mut sum = T::Vec3::ZERO;
        for index in 0..count {
            let sample = Sample {
                pixel,
                index,
                count,
                set,
            };
            sum = sum + self.sample(sample, &Exact);
        }
        (sum / T::from_f64(f64::from(count))).to_array().map(Real::to_f64)
    }
}
