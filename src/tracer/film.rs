//! From the samples of a pixel to its color, and means over other sets of samples.

use toyproof_scene::{Integrator, Sampler};

use crate::ray_epsilon::Exact;
use crate::real::Vector;
use crate::sampler::{Sample, SampleStream};
use crate::tile::TILE_SIDE;
use crate::tracer::Tracer;
use crate::transfer::{inverse_tone_map, tone_map, tone_map_slope};

/// The number of rows that are resampled at once.
pub const RESAMPLED_ROWS: u32 = TILE_SIDE;

impl Tracer<f64> {
    /// Returns the sampler of the scene, or `None` if it takes the pixel centers.
    pub fn sampler(&self) -> Option<Sampler> {
        Some(self.film.sampler).filter(|&sampler| sampler != Sampler::Center)
    }

    /// Returns the number of samples per pixel.
    pub fn samples(&self) -> u32 {
        self.film.samples
    }

    /// Returns whether the scene is path-traced.
    pub fn traces_paths(&self) -> bool {
        self.world.integrator() == Integrator::Path
    }

    /// Computes the mean of the samples of a pixel `[x, y]`, y up, with the scene's number of samples and
    /// the `independent` sampler. Each `set` has different random numbers; set 0 is the scene's own. The
    /// result is not tone-mapped; see [`tone_mapped`](Self::tone_mapped).
    pub fn resampled_mean(&self, pixel: [u32; 2], set: u32) -> [f64; 3] {
        let radiance = |sample| {
            let (primary, stream) = self.primary(Sampler::Independent, sample);
            self.radiance(primary, stream, &Exact)
        };
        Self::mean(pixel, self.film.samples, set, radiance).to_array()
    }

    /// Like [`resampled_mean`](Self::resampled_mean), but tone-mapped.
    pub fn resampled(&self, pixel: [u32; 2], set: u32) -> [f64; 3] {
        self.tone_mapped(self.resampled_mean(pixel, set))
    }

    /// Computes [`resampled_mean`](Self::resampled_mean) for all pixels of up to [`RESAMPLED_ROWS`] rows from
    /// `bottom` on, row by row. The results are not tone-mapped; see [`tone_mapped`](Self::tone_mapped).
    pub fn resampled_rows(&self, bottom: u32, set: u32) -> Vec<[f64; 3]> {
        let means = self.means(bottom, Sampler::Independent, set);
        means.into_iter().map(Vector::to_array).collect()
    }

    /// Tone-maps the mean of a pixel's samples to a color in [0, 1].
    pub fn tone_mapped(&self, mean: [f64; 3]) -> [f64; 3] {
        mean.map(|component| tone_map(&self.film, component).clamp(0.0, 1.0))
    }

    /// Inverts the tone mapping; infinite for colors that it cannot produce.
    pub fn inverse_tone_mapped(&self, color: [f64; 3]) -> [f64; 3] {
        color.map(|component| inverse_tone_map(&self.film, component))
    }

    /// Computes the derivative of the tone-mapped color with respect to the mean.
    pub fn slope(&self, mean: [f64; 3]) -> [f64; 3] {
        mean.map(|component| tone_map_slope(&self.film, component))
    }

    /// Computes the tone-mapped color of one sample at a position in pixels from the bottom left, y up. Only
    /// scenes without a [sampler](Self::sampler) have a color at each position; others use the same random
    /// numbers everywhere.
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
}
