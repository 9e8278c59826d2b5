//! What all surfaces can do, and the sphere.

use std::fmt::Debug;

use toyproof_scene::Shape;

use crate::lanes::{Columns, Kernel, Lanes, Level, MAX_LANES, Wide, Wide3, lanes_of};
use crate::ray::{Ray, RayKind};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::spheres::{IntersectSphere, LaneRays, Packet, PacketHits};

/// A surface that rays can intersect.
pub(crate) trait Primitive<T: Real>: Debug + Send + Sync {
    /// Returns the smallest t > `t_min` at which a ray that starts elsewhere intersects the surface.
    fn intersect(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T>;

    /// Like [`Primitive::intersect`] for a ray that starts on the surface; its start is not a hit.
    fn intersect_own(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T>;

    /// Returns the point at t and the normal there.
    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2];

    /// Updates the hits of the rays of a packet that do not start on the surface, if there is a kernel for
    /// it; otherwise returns false.
    fn update_packet(&self, _: Level, _: &Packet<T>, _: &mut PacketHits<T>, _number: u32) -> bool {
        false
    }

    /// Like [`Primitive::intersect`] for the rays of the `active` lanes; not finite where there is no hit.
    #[inline(always)]
    fn intersect_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
        active: u32,
    ) -> Wide<T, S> {
        let rays = rays.spill();
        let mut t = [T::infinity(); MAX_LANES];
        for lane in lanes_of(active) {
            t[lane] = self.intersect(&rays.get(lane), policy).unwrap_or(t[lane]);
        }
        Wide::load(simd, &t)
    }

    /// Returns the normals of [`Primitive::surface`] for the rays of the `active` lanes.
    #[inline(always)]
    fn normals_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        t: Wide<T, S>,
        active: u32,
    ) -> Wide3<T, S> {
        let (rays, t) = (rays.spill(), t.to_array());
        let mut normals = Columns::splat([T::zero(); 3]);
        for lane in lanes_of(active) {
            let [_, normal] = self.surface(&rays.get(lane), t[lane]);
            normals.set(lane, normal.to_array());
        }
        normals.load(simd, 0)
    }

    /// Returns the sphere if it is one.
    fn sphere(&self) -> Option<&Sphere<T>> {
        None
    }
}

/// A surface whose intersections are computed in lanes.
pub(super) trait LaneSurface<T: Real>: Copy {
    /// Returns t of rays in lanes, not finite where there is no hit. Only t > `t_min` count.
    fn lane_ts<S: Lanes<T>>(
        &self,
        simd: S,
        origin: Wide3<T, S>,
        direction: Wide3<T, S>,
        t_min: Wide<T, S>,
    ) -> Wide<T, S>;
}

/// [`Primitive::update_packet`] of a surface that has a kernel.
pub(super) fn update_hits<T: Real>(
    surface: impl LaneSurface<T>,
    level: Level,
    packet: &Packet<T>,
    found: &mut PacketHits<T>,
    number: u32,
) -> bool {
    T::run(
        level,
        UpdateHits {
            surface,
            packet,
            found,
            number,
        },
    );
    true
}

/// Kernel for [`update_hits`].
struct UpdateHits<'a, T: Real, P> {
    surface: P,
    packet: &'a Packet<T>,
    found: &'a mut PacketHits<T>,
    number: u32,
}

impl<T: Real, P: LaneSurface<T>> Kernel<T> for UpdateHits<'_, T, P> {
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<T>>(self, simd: S) {
        let surface = self.surface;
        let intersect = |origin, direction, t_min| surface.lane_ts(simd, origin, direction, t_min);
        self.found
            .update_packet(simd, self.packet, self.number, intersect);
    }
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Sphere<T: Real> {
    pub(crate) center: T::Vec3,
    pub(crate) radius: T,
}

impl<T: Real> Sphere<T> {
    pub(crate) fn new(center: [f64; 3], radius: f64) -> Self {
        Self {
            center: T::Vec3::from_f64(center),
            radius: T::from_f64(radius),
        }
    }

    /// Returns `None` for another shape.
    pub(crate) fn from_shape(shape: &Shape) -> Option<Self> {
        match shape {
            Shape::Sphere { center, radius } => Some(Self::new(*center, *radius)),
            _ => None,
        }
    }

    fn nearest_root(&self, ray: &Ray<T>, t_min: T, is_own: bool) -> Option<T> {
        let kernel = IntersectSphere {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            center: self.center.to_array(),
            radius: self.radius,
            t_min,
            is_own,
        };
        T::run(Level::Base, kernel)
    }
}

impl<T: Real> Primitive<T> for Sphere<T> {
    fn intersect(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        self.nearest_root(ray, policy.t_min(ray.kind()), false)
    }

    /// A ray that leaves the sphere does not hit it again; a ray that enters it hits the far side.
    fn intersect_own(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        self.nearest_root(ray, policy.t_min(RayKind::Secondary), true)
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
