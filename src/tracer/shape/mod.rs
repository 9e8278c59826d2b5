//! Intersection of rays with surfaces.

mod cuboid;
mod primitive;
#[cfg(test)]
mod tests;

use toyproof_scene::{self as scene, Equation};

use self::cuboid::Cuboid;
use self::primitive::{LaneSurface, update_hits};
pub(super) use self::primitive::{Primitive, Sphere};
use crate::lanes::{Lanes, Level, Wide, Wide3};
use crate::ray::{Ray, RayKind};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::spheres::{LaneRays, Packet, PacketHits};

/// A shape of any kind, for scenes that mix them.
#[derive(Debug)]
pub(super) enum Shape<T: Real> {
    Sphere(Sphere<T>),
    Quadric(Quadric<T>),
    Plane(Plane<T>),
    Box(Cuboid<T>),
}

impl<T: Real> Shape<T> {
    pub(super) fn new(shape: &scene::Shape) -> Self {
        match shape {
            scene::Shape::Sphere { center, radius } => Self::Sphere(Sphere::new(*center, *radius)),
            scene::Shape::Quadric(quadric) => Self::Quadric(Quadric::new(quadric)),
            scene::Shape::Plane { point, normal } => Self::Plane(Plane::new(*point, *normal)),
            scene::Shape::Box(cuboid) => Self::Box(Cuboid::new(cuboid)),
        }
    }
}

/// Evaluates an expression for the surface of any kind.
macro_rules! each {
    ($shape:expr, $surface:ident => $value:expr) => {
        match $shape {
            Shape::Sphere($surface) => $value,
            Shape::Quadric($surface) => $value,
            Shape::Plane($surface) => $value,
            Shape::Box($surface) => $value,
        }
    };
}

impl<T: Real> Primitive<T> for Shape<T> {
    fn intersect(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        each!(self, surface => surface.intersect(ray, policy))
    }

    fn intersect_own(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        each!(self, surface => surface.intersect_own(ray, policy))
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        each!(self, surface => surface.surface(ray, t))
    }

    fn update_packet(
        &self,
        level: Level,
        packet: &Packet<T>,
        found: &mut PacketHits<T>,
        number: u32,
    ) -> bool {
        each!(self, surface => surface.update_packet(level, packet, found, number))
    }

    #[inline(always)]
    fn intersect_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
        active: u32,
    ) -> Wide<T, S> {
        each!(self, surface => surface.intersect_in_lanes(simd, rays, policy, active))
    }

    #[inline(always)]
    fn normals_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        t: Wide<T, S>,
        active: u32,
    ) -> Wide3<T, S> {
        each!(self, surface => surface.normals_in_lanes(simd, rays, t, active))
    }

    fn sphere(&self) -> Option<&Sphere<T>> {
        each!(self, surface => surface.sphere())
    }
}

/// Solves a t² − 2 b t + c = 0, smaller root first; `disc` = b² − a c ≥ 0. The root of larger magnitude is
/// q/a with q = b + sign(b) √disc, which does not cancel; the other is c/q. For a → 0 one root goes to
/// infinity and the other, c/q, remains. For a = b = 0 there is no root, and both results are infinite or
/// NaN.
fn roots<T: Real>(a: T, b: T, c: T, disc: T) -> [T; 2] {
    let q = b + disc.sqrt().copysign(b);
    let (one, other) = (c / q, q / a);
    if one < other { [one, other] } else { [other, one] }
}

/// A quadric q·p² + 2 g z + k = 0 in local coordinates p = (x, y, z), whose unit is a power of two near the
/// size of the surface. p² is taken component by component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quadric<T: Real> {
    origin: T::Vec3,
    /// Directions of the local axes.
    axes: [T::Vec3; 3],
    /// Local unit of length, in scene units.
    unit: T,
    /// Reciprocal of `unit`.
    inverse_unit: T,
    q: T::Vec3,
    g: T,
    k: T,
    /// Range of z; `None` for a closed surface.
    ends: Option<[T; 2]>,
}

impl<T: Real> Quadric<T> {
    fn new(quadric: &scene::Quadric) -> Self {
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
            inverse_unit: T::from_f64(unit.recip()),
            q: T::Vec3::from_f64(q),
            g: T::from_f64(g),
            k: T::from_f64(k),
            ends: ends.map(|ends| ends.map(T::from_f64)),
        }
    }

    /// Rotates a vector to local axes.
    fn rotate_to_local(&self, v: T::Vec3) -> T::Vec3 {
        let [x, y, z] = self.axes.map(|axis| axis.dot(v));
        T::Vec3::new(x, y, z)
    }

    /// Rotates a vector to scene axes.
    fn rotate_to_scene(&self, v: T::Vec3) -> T::Vec3 {
        let [x, y, z] = v.to_array();
        self.axes[0] * x + self.axes[1] * y + self.axes[2] * z
    }

    /// Transforms origin and direction to local coordinates.
    fn localize(&self, ray: &Ray<T>) -> [T::Vec3; 2] {
        [
            self.rotate_to_local((ray.origin - self.origin) * self.inverse_unit),
            self.rotate_to_local(ray.direction),
        ]
    }

    /// Returns a, b and c of a t² − 2 b t + c = 0 for o + t·d.
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
    /// The origin of the ray is first moved to its point closest to the local origin, which keeps the terms
    /// that are squared and subtracted small.
    fn intersect(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        let [far, d] = self.localize(ray);
        let ahead = -far.dot(d) / d.dot(d);
        let o = far + d * ahead;
        let [a, b, c] = self.equation(o, d);
        let disc = b * b - a * c;
        if disc.is_nan() || disc < T::zero() {
            return None;
        }
        let t_min = policy.t_min(ray.kind());
        roots(a, b, c, disc).into_iter().find_map(|t| {
            let local = o + d * t;
            let t = (ahead + t) * self.unit;
            (t > t_min && t.is_finite() && self.is_within_ends(local)).then_some(t)
        })
    }

    /// One root is 0, so the other is 2 b/a.
    fn intersect_own(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        let [o, d] = self.localize(ray);
        let [a, b, _] = self.equation(o, d);
        let own = (b + b) / a;
        let t = own * self.unit;
        (t > policy.t_min(RayKind::Secondary) && t.is_finite() && self.is_within_ends(o + d * own))
            .then_some(t)
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let local = self.rotate_to_local((point - self.origin) * self.inverse_unit);
        let gradient = self.q * local + T::Vec3::new(T::zero(), T::zero(), self.g);
        let normal = self.rotate_to_scene(gradient).normalize();
        let open = self.ends.is_some();
        let away = open && normal.dot(ray.direction) > T::zero();
        [point, if away { -normal } else { normal }]
    }
}

/// An infinite plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane<T: Real> {
    point: T::Vec3,
    /// Of unit length.
    normal: T::Vec3,
}

impl<T: Real> Plane<T> {
    fn new(point: [f64; 3], normal: [f64; 3]) -> Self {
        Self {
            point: T::Vec3::from_f64(point),
            normal: T::Vec3::from_f64(normal),
        }
    }
}

impl<T: Real> LaneSurface<T> for Plane<T> {
    #[inline(always)]
    fn lane_ts<S: Lanes<T>>(
        &self,
        simd: S,
        origin: Wide3<T, S>,
        direction: Wide3<T, S>,
        _: Wide<T, S>,
    ) -> Wide<T, S> {
        let normal = Wide3::splat(simd, self.normal.to_array());
        let point = Wide3::splat(simd, self.point.to_array());
        normal.dot(point - origin) / normal.dot(direction)
    }
}

impl<T: Real> Primitive<T> for Plane<T> {
    fn intersect(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        let t = self.normal.dot(self.point - ray.origin) / self.normal.dot(ray.direction);
        // A ray parallel to the plane divides by 0: t is infinite or NaN.
        (t > policy.t_min(ray.kind()) && t.is_finite()).then_some(t)
    }

    fn intersect_own(&self, _: &Ray<T>, _: &impl RayEpsilonPolicy<T>) -> Option<T> {
        None
    }

    fn update_packet(
        &self,
        level: Level,
        packet: &Packet<T>,
        found: &mut PacketHits<T>,
        number: u32,
    ) -> bool {
        update_hits(*self, level, packet, found, number)
    }

    #[inline(always)]
    fn intersect_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
        _: u32,
    ) -> Wide<T, S> {
        let t_min = Wide::splat(simd, policy.t_min(RayKind::Secondary));
        self.lane_ts(simd, rays.origin, rays.direction, t_min)
    }

    #[inline(always)]
    fn normals_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        _: Wide<T, S>,
        _: u32,
    ) -> Wide3<T, S> {
        let normal = Wide3::splat(simd, self.normal.to_array());
        let facing = normal.dot(rays.direction).less(Wide::splat(simd, T::zero()));
        normal.select(facing, -normal)
    }

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let facing = self.normal.dot(ray.direction) < T::zero();
        [point, if facing { self.normal } else { -self.normal }]
    }
}
