//! Intersection of rays with surfaces of second degree.

use toyproof_scene::{self as scene, Equation};

use super::super::ray::Ray;
use super::super::real::{Real, Vector};
use super::super::style::Style;
use super::{Primitive, roots};

/// A quadric q·p² + 2 g z + k = 0 in coordinates p = (x, y, z) of its own, whose unit is a power of two near its size;
/// the square is taken component by component.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Quadric<T: Real> {
    origin: T::Vec3,
    /// The directions of its own axes.
    axes: [T::Vec3; 3],
    /// Its own unit of length, in scene units, and one over it.
    unit: T,
    per_unit: T,
    q: T::Vec3,
    g: T,
    k: T,
    /// What z lies between; a closed surface has no ends.
    ends: Option<[T; 2]>,
}

impl<T: Real> Quadric<T> {
    pub(super) fn new(quadric: &scene::Quadric) -> Self {
        let size = quadric.kind.size();
        let unit = if size.is_normal() {
            size.power_of_two()
        } else {
            1.0
        };
        let Equation { q, g, k, ends } = quadric.kind.equation(unit);
        Self {
            origin: T::Vec3::from_f64(quadric.origin),
            axes: quadric.axes.map(T::Vec3::from_f64),
            unit: T::from_f64(unit),
            per_unit: T::from_f64(unit.recip()),
            q: T::Vec3::from_f64(q),
            g: T::from_f64(g),
            k: T::from_f64(k),
            ends: ends.map(|ends| ends.map(T::from_f64)),
        }
    }

    /// In its own coordinates.
    fn inward(&self, v: T::Vec3) -> T::Vec3 {
        let [x, y, z] = self.axes.map(|axis| axis.dot(v));
        T::Vec3::new(x, y, z)
    }

    /// In the scene's.
    fn outward(&self, v: T::Vec3) -> T::Vec3 {
        let [x, y, z] = v.to_array();
        self.axes[0] * x + self.axes[1] * y + self.axes[2] * z
    }

    /// Origin and direction in its own coordinates and unit.
    fn localise(&self, ray: &Ray<T>) -> [T::Vec3; 2] {
        [
            self.inward((ray.origin - self.origin) * self.per_unit),
            self.inward(ray.direction),
        ]
    }

    /// a, b and c of a t² − 2 b t + c = 0 for o + t·d.
    fn equation(&self, o: T::Vec3, d: T::Vec3) -> [T; 3] {
        let z = |v: T::Vec3| v.to_array()[2];
        let two = T::one() + T::one();
        [
            (self.q * d).dot(d),
            -((self.q * d).dot(o) + self.g * z(d)),
            (self.q * o).dot(o) + two * self.g * z(o) + self.k,
        ]
    }

    fn is_within_ends(&self, point: T::Vec3) -> bool {
        let [_, _, z] = point.to_array();
        self.ends.is_none_or(|[low, high]| z >= low && z <= high)
    }
}

impl<T: Real> Primitive<T> for Quadric<T> {
    /// The ray's origin is first moved to where it comes closest to the quadric's own, so that what is squared and
    /// subtracted is no larger than it must be.
    fn intersect(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let [far, d] = self.localise(ray);
        let ahead = -far.dot(d) / d.dot(d);
        let o = far + d * ahead;
        let [a, b, c] = self.equation(o, d);
        let disc = b * b - a * c;
        if disc.is_nan() || disc < T::zero() {
            return None;
        }
        let t_min = style.t_min(ray.from.is_some());
        roots(a, b, c, disc).into_iter().find_map(|t| {
            let local = o + d * t;
            let t = (ahead + t) * self.unit;
            (t > t_min && t.is_finite() && self.is_within_ends(local)).then_some(t)
        })
    }

    /// One root is 0, so that the other is −2 b/a.
    fn intersect_own(&self, ray: &Ray<T>, style: &impl Style<T>) -> Option<T> {
        let [o, d] = self.localise(ray);
        let [a, b, _] = self.equation(o, d);
        let own = (b + b) / a;
        let t = own * self.unit;
        (t > style.t_min(true) && t.is_finite() && self.is_within_ends(o + d * own)).then_some(t)
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let local = self.inward((point - self.origin) * self.per_unit);
        let gradient = self.q * local + T::Vec3::new(T::zero(), T::zero(), self.g);
        let normal = self.outward(gradient).normalize();
        let open = self.ends.is_some();
        let away = open && normal.dot(ray.direction) > T::zero();
        [point, if away { -normal } else { normal }]
    }
}
