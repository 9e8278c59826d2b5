//! What the pixels of a quad see.

use super::real::Real;
use super::sampler::{Draws, Sample};
use super::{Kernel, Tracer, figure};

/// What lies at a place of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Seen {
    Background,
    /// A figure on the screen, by its number in the scene.
    Figure(usize),
    /// A surface, likewise.
    Surface(usize),
}

impl<T: Real> Tracer<T> {
    /// Whether the samples of the pixel's quad, the block of 2×2 pixels within which GPUs take differences, see different
    /// things. A quad at the picture's edge may reach beyond it.
    #[must_use]
    pub fn is_quad_mixed(&self, x: u32, y: u32) -> bool {
        let quad = [x & !1, y & !1];
        let lanes = [[0, 0], [1, 0], [0, 1], [1, 1]];
        let pixels = lanes.map(|lane| [quad[0] + lane[0], quad[1] + lane[1]]);
        let count = self.film.samples;
        let samples = (0..count).flat_map(|index| {
            pixels.map(|pixel| Sample {
                pixel,
                index,
                count,
                set: 0,
            })
        });
        let mut seen = samples.map(|sample| self.seen(sample));
        let first = seen.next();
        seen.any(|other| Some(other) != first)
    }

    fn seen(&self, sample: Sample) -> Seen {
        let [x, y] = Self::place(sample, &mut Draws::new(self.film.sampler, sample));
        let screen = self.camera.screen(x, y);
        if let Some(figure) = figure::topmost(&self.figures, screen) {
            return Seen::Figure(figure);
        }
        let ray = self.camera.ray(screen);
        let surface = match &self.kernel {
            Kernel::Spheres(world) => world.seen(&ray),
            Kernel::Shapes(world) => world.seen(&ray),
        };
        surface.map_or(Seen::Background, Seen::Surface)
    }
}
