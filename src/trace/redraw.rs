//! What a pixel is when other numbers are drawn for its samples.

use super::sampler::{Draws, Sample};
use super::style::Exact;
use super::{Tracer, film};
use crate::scene::Sampler;

impl Tracer<f64> {
    /// The sampler by which the scene's samples are drawn; none if they lie where nothing is drawn.
    #[must_use]
    pub fn sampler(&self) -> Option<Sampler> {
        Some(self.film.sampler).filter(|&sampler| sampler != Sampler::Center)
    }

    /// The colour of the pixel at (x, y), y upwards, with as many samples as the scene asks for, drawn by the `independent` sampler: other
    /// ones for each `set`, of which 0 is the scene's own.
    #[must_use]
    pub fn redrawn(&self, x: u32, y: u32, set: u32) -> [f64; 3] {
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
        let mean = sum / f64::from(count);
        mean.to_array().map(|c| film::develop(&self.film, c))
    }
}
