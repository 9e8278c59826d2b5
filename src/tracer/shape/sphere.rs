//! A sphere by itself, and where rays meet several.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

use super::super::lanes::{Columns, Kernel, Lanes, Level, MOST_LANES, Wide};
use super::super::ray::Ray;
use super::super::real::{Real, Vector};
use super::super::spheres::Meet;
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

impl<T: Real> Sphere<T> {
    fn meet(&self, ray: &Ray<T>, t_min: T, is_own: bool) -> Option<T> {
        let meet = Meet {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            center: self.center.to_array(),
            radius: self.radius,
            t_min,
            is_own,
        };
        T::run(Level::Base, meet)
    }
}

impl<T: Real> Primitive<T> for Sphere<T> {
    fn intersect(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        self.meet(ray, style.t_min(ray.from.is_some()), false)
    }

    /// A ray that leaves the sphere meets it no more, one that goes in meets its far side.
    fn intersect_own(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        self.meet(ray, style.t_min(true), true)
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let normal = (point - self.center).normalize();
        [point, normal]
    }

    fn sphere(&self) -> Option<&Self> {
        Some(self)
    }
}

/// Where rays meet spheres of those centres: [`Primitive::surface`] of the first `count` of them.
#[derive(Debug)]
pub(in super::super) struct Surfaces<'a, T> {
    pub(in super::super) count: usize,
    pub(in super::super) origins: &'a Columns<T>,
    pub(in super::super) directions: &'a Columns<T>,
    pub(in super::super) t: &'a [T; MOST_LANES],
    pub(in super::super) centers: &'a Columns<T>,
    /// Where the points and the normals there are put.
    pub(in super::super) out: &'a mut [Columns<T>; 2],
}

impl<T: Real> Kernel<T> for Surfaces<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let [points, normals] = self.out;
        let mut at = 0;
        while at < self.count {
            let t = Wide::load(simd, &self.t[at..]);
            let point = self.origins.load(simd, at) + self.directions.load(simd, at) * t;
            points.store(point, at);
            normals.store((point - self.centers.load(simd, at)).normalize(simd), at);
            at += S::COUNT;
        }
    }
}
