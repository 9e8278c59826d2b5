//! The course's pinhole camera.

use super::radiance::Ray;
use super::real::{Real, Vector};
use crate::scene::Scene;

#[derive(Debug)]
pub(super) struct Camera<T: Real> {
    eye: T::Vec3,
    screen_distance: T,
    width: T,
    height: T,
}

impl<T: Real> Camera<T> {
    pub(super) fn new(scene: &Scene) -> Self {
        let [width, height] = scene.film.size.map(|side| T::from_f64(f64::from(side)));
        Self {
            eye: T::Vec3::from_f64(scene.camera.eye),
            screen_distance: T::from_f64(scene.camera.screen_distance),
            width,
            height,
        }
    }

    /// The ray through the fragment coordinates (fx, fy), in pixels from the bottom left:
    /// `x = 2 fx / width − 1`, `y = (2 fy / height − 1) / aspect`.
    pub(super) fn ray(&self, fx: T, fy: T) -> Ray<T> {
        let two = T::from_f64(2.0);
        let x = fx / self.width * two - T::one();
        let y = (fy / self.height * two - T::one()) / (self.width / self.height);
        Ray {
            origin: self.eye,
            direction: T::Vec3::new(x, y, -self.screen_distance).normalize(),
            from: None,
        }
    }
}
