//! As many samples as a stated error asks for.

use rayon::prelude::*;
use toyproof_image::Image;

use super::real::{Real, Vector};
use super::sampler::Sample;
use super::style::Exact;
use super::{Tracer, film};

/// The side of a tile in pixels: large enough that its error is told by hundreds of numbers, small enough that empty
/// sky does not pay for a silhouette.
const TILE: u32 = 16;
/// Each tile is looked at by two independent sets of samples, whose difference tells the error: so many in each at
/// first, then twice as many, and so on up to the most.
const FIRST: u32 = 8;
const MOST: u32 = 1 << 15;

/// What a picture cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spent {
    /// All samples taken, in all pixels.
    pub samples: u64,
    /// The most and the fewest that went into a pixel.
    pub per_pixel: [u32; 2],
    /// The largest estimated error of a tile.
    pub error: f64,
}

/// A tile's corner, size and colours, row by row, and what it cost.
type Tile = ([u32; 2], [u32; 2], Vec<[f64; 3]>, Spent);

impl<T: Real> Tracer<T> {
    /// The picture with as many samples in each tile of 16×16 pixels as bring its estimated error below `max_error`,
    /// or 65,536. The error is the root mean square over the tile's pixels and components of half the difference of
    /// two independent sets of samples, both developed and clamped to [0, 1]. The film's own number of samples is
    /// ignored; its sampler must draw.
    ///
    /// `row_done` is called as often as the picture has rows.
    pub fn picture_within(&self, max_error: f64, row_done: impl Fn() + Sync) -> (Image, Spent) {
        let [width, height] = self.film.size;
        let bands: Vec<Vec<Tile>> = (0..height.div_ceil(TILE))
            .into_par_iter()
            .map(|band| {
                let tiles = (0..width.div_ceil(TILE))
                    .map(|column| self.tile([column * TILE, band * TILE], max_error))
                    .collect();
                (0..TILE.min(height - band * TILE)).for_each(|_| row_done());
                tiles
            })
            .collect();
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; width as usize * height as usize];
        let mut spent = Spent {
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
            spent.samples += cost.samples;
            spent.per_pixel[0] = spent.per_pixel[0].max(cost.per_pixel[0]);
            spent.per_pixel[1] = spent.per_pixel[1].min(cost.per_pixel[1]);
            spent.error = spent.error.max(cost.error);
        }
        (Image::new(width, height, pixels), spent)
    }

    fn tile(&self, corner: [u32; 2], max_error: f64) -> Tile {
        let [width, height] = self.film.size;
        let size = [TILE.min(width - corner[0]), TILE.min(height - corner[1])];
        let number = size[0] * size[1];
        let mut samples = 0;
        let mut count = FIRST;
        loop {
            let mut square_sum = 0.0;
            let colors: Vec<_> = (0..number)
                .map(|at| {
                    let pixel = [corner[0] + at % size[0], corner[1] + at / size[0]];
                    let [a, b] = [0, 1].map(|set| self.mean(pixel, count, set));
                    let [x, y] =
                        [a, b].map(|mean| mean.map(|c| film::develop(&self.film, c).clamp(0.0, 1.0)));
                    square_sum += (0..3).map(|i| (0.5 * (x[i] - y[i])).powi(2)).sum::<f64>();
                    [0, 1, 2].map(|i| film::develop(&self.film, 0.5 * (a[i] + b[i])))
                })
                .collect();
            samples += u64::from(number) * 2 * u64::from(count);
            let error = (square_sum / f64::from(3 * number)).sqrt();
            if error <= max_error || count == MOST {
                let spent = Spent {
                    samples,
                    per_pixel: [2 * count; 2],
                    error,
                };
                return (corner, size, colors, spent);
            }
            count *= 2;
        }
    }

    /// The mean of one set of samples.
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
