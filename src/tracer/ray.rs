//! Rays and the points where they meet surfaces.

use super::real::{Real, Vector};
use super::spheres::NONE;
use super::style::Style;

/// A ray o + t·d, t > 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray<T: Real> {
    pub(super) origin: T::Vec3,
    /// Of length 1, up to rounding.
    pub(super) direction: T::Vec3,
    /// The surface that the origin lies on.
    pub(super) from: Option<usize>,
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy)]
pub(super) struct First<T> {
    /// Infinite where nothing is met.
    t: T,
    /// The number of the surface.
    surface: u32,
}

impl<T: Real> First<T> {
    /// That surface at t; nothing where t is infinite.
    #[inline]
    pub(super) fn new(t: T, surface: u32) -> Self {
        Self { t, surface }
    }

    pub(super) fn nothing() -> Self {
        Self::new(T::infinity(), NONE)
    }

    /// At which t, and which surface.
    #[inline]
    pub(super) fn get(self) -> Option<(T, usize)> {
        (self.t < T::infinity()).then_some((self.t, self.surface as usize))
    }

    /// Takes a surface that is met at t where it comes before; of equal t's the smaller number wins.
    pub(super) fn take(&mut self, t: Option<T>, surface: usize) {
        if let Some(t) = t
            && (t < self.t || (t == self.t && t < T::infinity() && surface < self.surface as usize))
        {
            *self = Self::new(t, surface as u32);
        }
    }
}

/// A point on a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit<T: Real> {
    pub(super) point: T::Vec3,
    /// Of length 1: outward, or on an open surface to the side that the ray came from.
    pub(super) normal: T::Vec3,
    pub(super) surface: usize,
}

impl<T: Real> Hit<T> {
    /// The point from which lights are looked at, above the surface.
    pub(super) fn lit_from(&self, style: &impl Style<T>) -> T::Vec3 {
        if style.lamp().from_start {
            self.point + self.normal * style.offset()
        } else {
            self.point
        }
    }

    /// A secondary ray, to either side of the surface.
    pub(super) fn leave(&self, direction: T::Vec3, style: &impl Style<T>) -> Ray<T> {
        let offset = style.offset();
        let offset = if direction.dot(self.normal) < T::zero() {
            -offset
        } else {
            offset
        };
        Ray {
            origin: self.point + self.normal * offset + direction * style.along(),
            direction,
            from: Some(self.surface),
        }
    }
}

/// Two directions at right angles to a unit vector w and to each other: a = normalize(up × w), b = w × a, where up
/// is y, or x where |w.y| > 0.9.
pub(super) fn basis<T: Real>(w: T::Vec3) -> [T::Vec3; 2] {
    let [_, y, _] = w.to_array();
    let up = if y.abs() > T::from_f64(0.9) {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let a = T::Vec3::from_f64(up).cross(w).normalize();
    [a, w.cross(a)]
}

/// The direction at an angle to w, given by its cosine and sine, turned about w by `turn` of a full turn.
pub(super) fn around<T: Real>(w: T::Vec3, cosine: T, sine: T, turn: T) -> T::Vec3 {
    let [a, b] = basis::<T>(w);
    let (s, c) = (T::from_f64(std::f64::consts::TAU) * turn).sine_and_cosine();
    a * (sine * c) + b * (sine * s) + w * cosine
}
