//! What pixels are when other numbers are drawn for their samples.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_scene::{Integrator, Sampler};

use super::sampler::{Draws, Sample};
use super::style::Exact;
use super::{Kernel, Tracer, film, tile};

impl Tracer<f64> {
    /// The sampler by which the scene's samples are drawn; none if they lie where nothing is drawn.
    #[must_use]
    pub fn sampler(&self) -> Option<Sampler> {
        Some(self.film.sampler).filter(|&sampler| sampler != Sampler::Center)
    }

    /// How many samples a pixel takes.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.film.samples
    }

    /// Whether each sample is a path of many rays.
    #[must_use]
    pub fn traces_paths(&self) -> bool {
        let integrator = match &self.kernel {
            Kernel::Spheres(world) => world.integrator,
            Kernel::Shapes(world) => world.integrator,
        };
        integrator == Integrator::Path
    }

    /// The mean of the samples of the pixel at (x, y), y upwards, as many as the scene asks for, drawn by the `independent` sampler: other
    /// ones for each `set`, of which 0 is the scene's own. It is yet to be [developed](Self::developed).
    #[must_use]
    pub fn redrawn_mean(&self, [x, y]: [u32; 2], set: u32) -> [f64; 3] {
        let count = self.film.samples;
        let mut sum = glam::DVec3::ZERO;
        for index in 0..count {
            let sample = Sample {
                pixel: [x, y],
                index,
                count,
                set,
            };
            let mut draws = Draws::new(Sampler::Independent, sample);
            let place = Self::place(sample.pixel, draws.jitter());
            let seen = self.look(self.camera.screen(place));
            sum += self.radiance(seen, draws, &Exact);
        }
        (sum / f64::from(count)).to_array()
    }

    /// The same, developed.
    #[must_use]
    pub fn redrawn(&self, pixel: [u32; 2], set: u32) -> [f64; 3] {
        self.developed(self.redrawn_mean(pixel, set))
    }

    /// The same of all pixels of [`REDRAWN_ROWS`] rows, or what is left of them, row by row; yet to be [developed](Self::developed).
    #[must_use]
    pub fn redrawn_rows(&self, bottom: u32, set: u32) -> Vec<[f64; 3]> {
        let means = self.means(bottom, Sampler::Independent, set);
        means.into_iter().map(|mean| mean.to_array()).collect()
    }

    /// The colour of a pixel from the mean of its samples, in [0, 1].
    #[must_use]
    pub fn developed(&self, mean: [f64; 3]) -> [f64; 3] {
        mean.map(|component| film::develop(&self.film, component).clamp(0.0, 1.0))
    }

    /// What the mean of a pixel's samples was before it was developed; infinite where that cannot be.
    #[must_use]
    pub fn undeveloped(&self, color: [f64; 3]) -> [f64; 3] {
        color.map(|component| film::undevelop(&self.film, component))
    }

    /// By how much more than a mean of samples the color rises.
    #[must_use]
    pub fn slope(&self, mean: [f64; 3]) -> [f64; 3] {
        mean.map(|component| film::slope(&self.film, component))
    }

    /// The colors of all pixels in these columns and rows, a pixel for each.
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

/// So many rows are drawn again at once.
pub const REDRAWN_ROWS: u32 = tile::SIDE;
