//! What places on the screen show, and what the pixels of a quad see.

use super::ray::{First, Ray};
use super::real::{Real, Vector};
use super::sampler::{Draws, Sample};
use super::style::Exact;
use super::{Kernel, Tracer, figure};

/// What lies at a place of the screen.
#[derive(Debug, Clone, Copy)]
pub(super) enum Seen<T: Real> {
    /// A figure on the screen, by its number in the scene.
    Figure(usize),
    /// What the camera's ray meets first.
    Scene(Ray<T>, First<T>),
}

impl<T: Real> Seen<T> {
    /// Which figure or surface; both are none for the background.
    fn what(&self) -> [Option<usize>; 2] {
        match self {
            Self::Figure(figure) => [Some(*figure), None],
            Self::Scene(_, first) => [None, first.get().map(|(_, surface)| surface)],
        }
    }
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
        let mut seen = samples.map(|sample| {
            let place = Self::place(sample.pixel, Draws::new(self.film.sampler, sample).jitter());
            self.look(self.camera.screen(place)).what()
        });
        let first = seen.next();
        seen.any(|other| Some(other) != first)
    }

    /// The ray through the middle of a pixel: its origin and its direction.
    #[must_use]
    pub fn camera_ray(&self, x: u32, y: u32) -> [[T; 3]; 2] {
        let half = T::from_f64(0.5);
        let middle = [x, y].map(|along| T::from_f64(f64::from(along)) + half);
        let ray = self.camera.ray(self.camera.screen(middle));
        [ray.origin.to_array(), ray.direction.to_array()]
    }

    /// What a ray from anywhere meets first: how many times its direction away, and the surface, by its number in the scene.
    /// If it starts on a surface, that one is only met elsewhere.
    #[must_use]
    pub fn meet(&self, origin: [T; 3], direction: [T; 3], from: Option<usize>) -> Option<(T, usize)> {
        let ray = Ray {
            origin: T::Vec3::from_array(origin),
            direction: T::Vec3::from_array(direction),
            from,
        };
        self.nearest(&ray).get()
    }

    /// What lies at a place of the screen.
    pub(super) fn look(&self, screen: [T; 2]) -> Seen<T> {
        if let Some(figure) = figure::topmost(&self.figures, screen) {
            return Seen::Figure(figure);
        }
        let ray = self.camera.ray(screen);
        Seen::Scene(ray, self.nearest(&ray))
    }

    fn nearest(&self, ray: &Ray<T>) -> First<T> {
        match &self.kernel {
            Kernel::Spheres(world) => world.nearest(ray, &Exact),
            Kernel::Shapes(world) => world.nearest(ray, &Exact),
        }
    }
}
