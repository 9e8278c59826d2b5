//! Ray–sphere intersection.

use super::doubt::Doubt;
use super::radiance::Ray;
use super::real::{Real, Vector};

/// A sphere's shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape<T: Real> {
    pub(super) center: T::Vec3,
    pub(super) radius: T,
}

impl<T: Real> Shape<T> {
    /// The smallest t > `t_min` at which the ray meets the sphere.
    ///
    /// The recentred discriminant and the stable roots of Haines, Günther and Akenine-Möller, “Precision
    /// Improvements for Ray/Sphere Intersection”, Ray Tracing Gems (2019), chapter 7: with f = o − c and
    /// b = −f·d, disc = r² − |f + (b/a) d|², q = b + sign(b) √(a·disc), t₀ = (f·f − r²)/q, t₁ = q/a.
    pub(super) fn intersect(&self, ray: &Ray<T>, doubt: &impl Doubt<T>) -> Option<T> {
        let f = ray.origin - self.center;
        let a = doubt.squared_length(ray.direction.dot(ray.direction));
        let b = -f.dot(ray.direction);
        let r2 = self.radius * self.radius;
        let closest = f + ray.direction * (b / a);
        let disc = doubt.discriminant(r2 - closest.dot(closest), f.dot(f));
        if disc < T::zero() {
            return None;
        }
        let q = b + (a * disc).sqrt().copysign(b);
        let c = f.dot(f) - r2;
        // The root of smaller size first; q = 0 only where both roots are 0.
        let (one, other) = (c / q, q / a);
        let (near, far) = if one < other { (one, other) } else { (other, one) };
        let t_min = doubt.t_min(ray.from.is_some());
        [near, far].into_iter().find(|&t| t > t_min)
    }

    /// The same for a ray that starts on this sphere: one that leaves it (d·N > 0) meets it no more, one
    /// that goes in meets its far side at t = −2 d·(P − c) / a.
    pub(super) fn intersect_own(&self, ray: &Ray<T>, doubt: &impl Doubt<T>) -> Option<T> {
        let outward = ray.direction.dot(ray.origin - self.center);
        let t = T::from_f64(-2.0) * outward / doubt.squared_length(ray.direction.dot(ray.direction));
        (t > doubt.t_min(true)).then_some(t)
    }
}
