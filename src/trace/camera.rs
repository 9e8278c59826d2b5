//! The course's cameras.

use super::ray::Ray;
use super::real::{Real, Vector};
use crate::scene::{Projection, Scene};

#[derive(Debug)]
pub(super) struct Camera<T: Real> {
    eye: T::Vec3,
    projection: View<T>,
    width: T,
    height: T,
}

#[derive(Debug)]
enum View<T> {
    Pinhole { screen_distance: T },
    Parallel { half_width: T },
}

impl<T: Real> Camera<T> {
    pub(super) fn new(scene: &Scene) -> Self {
        let [width, height] = scene.film.size.map(|side| T::from_f64(f64::from(side)));
        Self {
            eye: T::Vec3::from_f64(scene.camera.eye),
            projection: match scene.camera.projection {
                Projection::Pinhole { screen_distance } => View::Pinhole {
                    screen_distance: T::from_f64(screen_distance),
                },
                Projection::Parallel { width } => View::Parallel {
                    half_width: T::from_f64(0.5 * width),
                },
            },
            width,
            height,
        }
    }

    /// The place on the screen of the fragment coordinates (fx, fy), in pixels from the bottom left:
    /// `x = 2 fx / width − 1`, `y = (2 fy / height − 1) / aspect`.
    pub(super) fn screen(&self, fx: T, fy: T) -> [T; 2] {
        let two = T::from_f64(2.0);
        let x = fx / self.width * two - T::one();
        let y = (fy / self.height * two - T::one()) / (self.width / self.height);
        [x, y]
    }

    /// The ray through a place on the screen.
    pub(super) fn ray(&self, [x, y]: [T; 2]) -> Ray<T> {
        let (origin, direction) = match self.projection {
            View::Pinhole { screen_distance } => (self.eye, T::Vec3::new(x, y, -screen_distance).normalize()),
            View::Parallel { half_width } => {
                let across = T::Vec3::new(x * half_width, y * half_width, T::zero());
                (self.eye + across, T::Vec3::from_f64([0.0, 0.0, -1.0]))
            }
        };
        Ray {
            origin,
            direction,
            from: None,
        }
    }
}
