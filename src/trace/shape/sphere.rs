//! A sphere by itself.

use super::super::lanes::Level;
use super::super::ray::Ray;
use super::super::real::{Real, Vector};
use super::super::spheres::{Meet, unit};
use super::super::style::Style;
use super::Primitive;

/// A sphere.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Sphere<T: Real> {
    pub(in super::super) center: T::Vec3,
    pub(in super::super) radius: T,
}

impl<T: Real> Sphere<T> {
    pub(in super::super) fn new(center: [f64; 3], radius: f64) -> Self {
        Self {
            center: T::Vec3::from_f64(center),
            radius: T::from_f64(radius),
        }
    }
}

impl<T: Real> Primitive<T> for Sphere<T> {
    fn intersect(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let meet = Meet {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            center: self.center.to_array(),
            radius: self.radius,
            t_min: style.t_min(ray.from.is_some()),
        };
        T::run(Level::Base, meet)
    }

    /// A ray that leaves the sphere (d·N > 0) meets it no more, one that goes in meets its far side at
    /// t = −2 d·(P − c) / a.
    fn intersect_own(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let unit = unit(self.radius);
        let f = (ray.origin - self.center) * unit.recip();
        let outward = ray.direction.dot(f);
        let a = ray.direction.dot(ray.direction);
        let t = T::from_f64(-2.0) * outward / a * unit;
        (t > style.t_min(true)).then_some(t)
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let normal = (point - self.center).normalize();
        [point, normal]
    }
}
