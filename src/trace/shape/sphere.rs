//! Ray–sphere intersection.

use super::super::ray::Ray;
use super::super::real::{Real, Vector};
use super::super::style::Style;
use super::{Primitive, roots};

/// A sphere.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Sphere<T: Real> {
    pub(in super::super) center: T::Vec3,
    /// The power of two at or below the radius. Lengths are divided by it before they are squared, which is exact, so
    /// that spheres of any size have the accuracy of one near 1.
    unit: T,
    /// 1/unit
    per_unit: T,
    /// (radius/unit)², in [1, 4)
    radius2: T,
}

impl<T: Real> Sphere<T> {
    pub(in super::super) fn new(center: [f64; 3], radius: f64) -> Self {
        let radius = T::from_f64(radius);
        let unit = if radius.is_normal() {
            radius.power_of_two()
        } else {
            T::one()
        };
        let scaled = radius / unit;
        Self {
            center: T::Vec3::from_f64(center),
            unit,
            per_unit: unit.recip(),
            radius2: scaled * scaled,
        }
    }
}

impl<T: Real> Primitive<T> for Sphere<T> {
    /// The recentred discriminant and the stable roots of Haines, Günther and Akenine-Möller, “Precision
    /// Improvements for Ray/Sphere Intersection”, Ray Tracing Gems (2019), chapter 7: with f = o − c and
    /// b = −f·d, disc = r² − |f + (b/a) d|², q = b + sign(b) √(a·disc), t₀ = (f·f − r²)/q, t₁ = q/a.
    fn intersect(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let f = (ray.origin - self.center) * self.per_unit;
        let a = ray.direction.dot(ray.direction);
        let b = -f.dot(ray.direction);
        let closest = f + ray.direction * (b / a);
        let f2 = f.dot(f);
        let disc = self.radius2 - closest.dot(closest);
        // NaN: too far away to tell, and no hit.
        if disc.is_nan() || disc < T::zero() {
            return None;
        }
        let t_min = style.t_min(ray.from.is_some());
        roots(a, b, f2 - self.radius2, a * disc)
            .map(|t| t * self.unit)
            .into_iter()
            .find(|&t| t > t_min)
    }

    /// A ray that leaves the sphere (d·N > 0) meets it no more, one that goes in meets its far side at
    /// t = −2 d·(P − c) / a.
    fn intersect_own(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let f = (ray.origin - self.center) * self.per_unit;
        let outward = ray.direction.dot(f);
        let a = ray.direction.dot(ray.direction);
        let t = T::from_f64(-2.0) * outward / a * self.unit;
        (t > style.t_min(true)).then_some(t)
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let normal = (point - self.center).normalize();
        [point, normal]
    }
}
