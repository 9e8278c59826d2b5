//! The first hits of camera rays.

use crate::camera::topmost_figure;
use crate::ray::{PrimaryHit, Ray};
use crate::real::{Real, Vector};
use crate::sampler::Sample;
use crate::tracer::Tracer;

impl<T: Real> Tracer<T> {
    /// Returns whether the samples of the pixel's quad see different surfaces or figures. The quad is the
    /// block of 2×2 pixels within which GPUs compute derivatives; at the edge of the image it may extend
    /// beyond it.
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
        let mut hits = samples.map(|sample| {
            let (hit, _) = self.primary(self.film.sampler, sample);
            hit.id()
        });
        let first = hits.next();
        hits.any(|other| Some(other) != first)
    }

    /// Returns the origin and the direction of the camera ray through the center of a pixel.
    pub fn camera_ray(&self, x: u32, y: u32) -> [[T; 3]; 2] {
        let half = T::from_f64(0.5);
        let middle = [x, y].map(|along| T::from_f64(f64::from(along)) + half);
        let ray = self.camera.ray(self.camera.screen(middle));
        [ray.origin.to_array(), ray.direction.to_array()]
    }

    /// Finds the first hit of an arbitrary ray: the distance in units of the length of `direction`, and the
    /// index of the surface in the scene. `from` is the surface on which the ray starts, if any; its start is
    /// not a hit.
    pub fn intersect(&self, origin: [T; 3], direction: [T; 3], from: Option<usize>) -> Option<(T, usize)> {
        let ray = Ray {
            origin: T::Vec3::from_array(origin),
            direction: T::Vec3::from_array(direction),
            from,
        };
        self.world.nearest(&ray).get()
    }

    /// Finds what is visible at a point of the screen.
    pub(super) fn primary_hit(&self, screen: [T; 2]) -> PrimaryHit<T> {
        if let Some(figure) = topmost_figure(&self.figures, screen) {
            return PrimaryHit::Figure(figure);
        }
        let ray = self.camera.ray(screen);
        PrimaryHit::Scene(ray, self.world.nearest(&ray))
    }
}
