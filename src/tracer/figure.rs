//! Figures on the screen.

use toyproof_scene::{self as scene, Outline};

use super::real::{Real, Vector};

#[derive(Debug)]
pub(super) struct Figure<T: Real> {
    outline: Outline,
    pub(super) color: T::Vec3,
}

impl<T: Real> Figure<T> {
    pub(super) fn new(figure: &scene::Figure) -> Self {
        Self {
            outline: figure.outline,
            color: T::Vec3::from_f64(figure.color),
        }
    }

    /// The implicit function at a point of the screen: below 0 inside.
    fn value(&self, x: T, y: T) -> T {
        match self.outline {
            Outline::Disk { center, radius } => {
                let [cx, cy, radius] = [center[0], center[1], radius].map(T::from_f64);
                (x - cx) * (x - cx) + (y - cy) * (y - cy) - radius * radius
            }
            Outline::Wave {
                height,
                amplitude,
                frequency,
            } => {
                let [height, amplitude, frequency] = [height, amplitude, frequency].map(T::from_f64);
                let (sine, _) = (frequency * x).sine_and_cosine();
                y - height - amplitude * sine
            }
            Outline::Heart { center, size } => {
                let [cx, cy, size] = [center[0], center[1], size].map(T::from_f64);
                let (u, v) = ((x - cx) / size, (y - cy) / size);
                let ring = u * u + v * v - T::one();
                ring * ring * ring - u * u * (v * v * v)
            }
        }
    }
}

/// The number of the topmost figure at a point of the screen.
pub(super) fn topmost<T: Real>(figures: &[Figure<T>], [x, y]: [T; 2]) -> Option<usize> {
    figures.iter().rposition(|figure| figure.value(x, y) < T::zero())
}
