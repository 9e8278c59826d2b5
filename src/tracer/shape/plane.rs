//! Ray–plane intersection.

use super::super::ray::Ray;
use super::super::real::{Real, Vector};
use super::super::style::Style;
use super::Primitive;

/// An endless plane.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Plane<T: Real> {
    point: T::Vec3,
    /// Of length 1.
    normal: T::Vec3,
}

impl<T: Real> Plane<T> {
    pub(super) fn new(point: [f64; 3], normal: [f64; 3]) -> Self {
        Self {
            point: T::Vec3::from_f64(point),
            normal: T::Vec3::from_f64(normal),
        }
    }
}

impl<T: Real> Primitive<T> for Plane<T> {
    fn intersect(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let t = self.normal.dot(self.point - ray.origin) / self.normal.dot(ray.direction);
        // A ray along the plane divides by 0: t is infinite or NaN.
        (t > style.t_min(ray.from.is_some()) && t.is_finite()).then_some(t)
    }

    fn intersect_own(&self, _: &Ray<T>, _: &impl Style<T>) -> Option<T> {
        None
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let facing = self.normal.dot(ray.direction) < T::zero();
        [point, if facing { self.normal } else { -self.normal }]
    }
}
