//! What pixels are when other numbers are drawn for their samples.

use super::sampler::{Draws, Sample};
use super::style::Exact;
use super::{Kernel, Tracer, film, tile};
use crate::scene::{Integrator, Sampler};

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

    /// The colour of the pixel at (x, y), y upwards, with as many samples as the scene asks for, drawn by the `independent` sampler: other
    /// ones for each `set`, of which 0 is the scene's own. Components lie in [0, 1].
    #[must_use]
    pub fn redrawn(&self, [x, y]: [u32; 2], set: u32) -> [f64; 3] {
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
        self.developed((sum / f64::from(count)).to_array())
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
}

/// So many rows are drawn again at once.
pub const REDRAWN_ROWS: u32 = tile::SIDE;
