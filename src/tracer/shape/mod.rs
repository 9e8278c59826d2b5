//! Where rays meet surfaces.

mod plane;
mod quadric;
mod sphere;
#[cfg(test)]
mod tests;

use std::fmt::Debug;

pub(super) use plane::Plane;
pub(super) use quadric::Quadric;
pub(super) use sphere::{Sphere, Surfaces};
use toyproof_scene as scene;

use super::ray::Ray;
use super::real::Real;
use super::style::Style;

/// What a ray can meet.
pub(super) trait Primitive<T: Real>: Debug + Send + Sync {
    /// The smallest t > `t_min` at which the ray, which starts elsewhere, meets it.
    fn intersect(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T>;

    /// The same for a ray that starts on it: that start is no hit.
    fn intersect_own(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T>;

    /// The point at t, and the normal there.
    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2];

    /// Itself, if it is a sphere.
    fn sphere(&self) -> Option<&Sphere<T>> {
        None
    }
}

/// Any shape, where a scene has several kinds.
#[derive(Debug)]
pub(super) enum Shape<T: Real> {
    Sphere(Sphere<T>),
    Quadric(Quadric<T>),
    Plane(Plane<T>),
}

impl<T: Real> Shape<T> {
    pub(super) fn new(shape: &scene::Shape) -> Self {
        match shape {
            scene::Shape::Sphere { center, radius } => Self::Sphere(Sphere::new(*center, *radius)),
            scene::Shape::Quadric(quadric) => Self::Quadric(Quadric::new(quadric)),
            scene::Shape::Plane { point, normal } => Self::Plane(Plane::new(*point, *normal)),
        }
    }
}

impl<T: Real> Primitive<T> for Shape<T> {
    fn intersect(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        match self {
            Self::Sphere(sphere) => sphere.intersect(ray, style),
            Self::Quadric(quadric) => quadric.intersect(ray, style),
            Self::Plane(plane) => plane.intersect(ray, style),
        }
    }

    fn intersect_own(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        match self {
            Self::Sphere(sphere) => sphere.intersect_own(ray, style),
            Self::Quadric(quadric) => quadric.intersect_own(ray, style),
            Self::Plane(plane) => plane.intersect_own(ray, style),
        }
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        match self {
            Self::Sphere(sphere) => sphere.surface(ray, t),
            Self::Quadric(quadric) => quadric.surface(ray, t),
            Self::Plane(plane) => plane.surface(ray, t),
        }
    }

    fn sphere(&self) -> Option<&Sphere<T>> {
        match self {
            Self::Sphere(sphere) => Some(sphere),
            Self::Quadric(_) | Self::Plane(_) => None,
        }
    }
}

/// The roots of a t² − 2 b t + c = 0, the smaller first; `disc` = b² − a c ≥ 0. The one of larger size comes from
/// q = b + sign(b) √disc, which does not cancel, the other from c/q. For a → 0 one root goes to infinity and the other,
/// c/q, stays; for a = b = 0 there is none, and both are infinite or NaN.
fn roots<T: Real>(a: T, b: T, c: T, disc: T) -> [T; 2] {
    let q = b + disc.sqrt().copysign(b);
    let (one, other) = (c / q, q / a);
    if one < other { [one, other] } else { [other, one] }
}
