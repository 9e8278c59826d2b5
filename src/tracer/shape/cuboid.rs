//! Boxes.

use toyproof_scene as scene;

use super::primitive::{LaneSurface, Primitive, update_hits};
use crate::lanes::{Lanes, Level, Wide, Wide3};
use crate::ray::{Ray, RayKind};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::spheres::{LaneRays, Packet, PacketHits};

/// A box: the intersection of three slabs, each of the points p with `|p[i]| ≤ half[i]` in local coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cuboid<T: Real> {
    center: T::Vec3,
    /// Directions of the local axes.
    axes: [T::Vec3; 3],
    /// Half the lengths of the edges.
    half: [T; 3],
}

impl<T: Real> Cuboid<T> {
    pub(super) fn new(cuboid: &scene::Cuboid) -> Self {
        Self {
            center: T::Vec3::from_f64(cuboid.center),
            axes: cuboid.axes.map(T::Vec3::from_f64),
            half: cuboid.size.map(|side| T::from_f64(0.5 * side)),
        }
    }

    /// Returns a point in local coordinates.
    fn localize(&self, point: T::Vec3) -> [T; 3] {
        let relative = point - self.center;
        self.axes.map(|axis| axis.dot(relative))
    }

    /// Returns the interval of t within the box of the line o + t·d, in local coordinates; `None` if it is
    /// empty. A line in a face's plane only touches the box, and is outside.
    fn interval(&self, o: [T; 3], d: [T; 3]) -> Option<[T; 2]> {
        let (mut enter, mut leave) = (T::neg_infinity(), T::infinity());
        for ((o, d), half) in o.into_iter().zip(d).zip(self.half) {
            if d == T::zero() {
                if o.abs() >= half {
                    return None;
                }
                continue;
            }
            let side = half.copysign(d);
            enter = enter.max((-side - o) / d);
            leave = leave.min((side - o) / d);
        }
        (enter < leave).then_some([enter, leave])
    }

    /// Returns the axis of the face on which a local point lies, up to rounding: the one whose face is
    /// nearest.
    fn face(&self, point: [T; 3]) -> usize {
        let depth = |axis: usize| self.half[axis] - point[axis].abs();
        let nearer = |best: usize, axis: usize| if depth(axis) < depth(best) { axis } else { best };
        (1..3).fold(0, nearer)
    }
}

impl<T: Real> LaneSurface<T> for Cuboid<T> {
    /// By the operations of [`Cuboid::interval`].
    #[inline(always)]
    fn lane_ts<S: Lanes<T>>(
        &self,
        simd: S,
        origin: Wide3<T, S>,
        direction: Wide3<T, S>,
        t_min: Wide<T, S>,
    ) -> Wide<T, S> {
        let [zero, infinity] = [T::zero(), T::infinity()].map(|number| Wide::splat(simd, number));
        let relative = origin - Wide3::splat(simd, self.center.to_array());
        let (mut enter, mut leave) = (-infinity, infinity);
        for (axis, half) in self.axes.into_iter().zip(self.half) {
            let axis = Wide3::splat(simd, axis.to_array());
            let half = Wide::splat(simd, half);
            let (o, d) = (axis.dot(relative), axis.dot(direction));
            let side = (-half).select(d.less(zero), half);
            let (near, far) = ((-side - o) / d, (side - o) / d);
            // A line parallel to the slab is within it or misses the box.
            let within = o.max(-o).less(half);
            let parallel = d.equal(zero);
            let near = (-infinity).select(within, infinity).select(parallel, near);
            enter = enter.max(near);
            leave = leave.min(infinity.select(parallel, far));
        }
        let t = enter.select(t_min.less(enter), leave);
        t.select(enter.less(leave), infinity)
    }
}

impl<T: Real> Primitive<T> for Cuboid<T> {
    fn intersect(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        let d = self.axes.map(|axis| axis.dot(ray.direction));
        let t_min = policy.t_min(ray.kind());
        let interval = self.interval(self.localize(ray.origin), d)?;
        interval.into_iter().find(|t| *t > t_min && t.is_finite())
    }

    /// The ray starts on a face, which it does not hit again: it leaves the box there, or passes through it
    /// to another face. The normal of [`Primitive::surface`] at that point is the same face's.
    fn intersect_own(&self, ray: &Ray<T>, policy: &impl RayEpsilonPolicy<T>) -> Option<T> {
        let o = self.localize(ray.origin);
        let d = self.axes.map(|axis| axis.dot(ray.direction));
        let own = self.face(o);
        if d[own] == T::zero() || o[own].is_sign_negative() == d[own].is_sign_negative() {
            return None;
        }
        let leave = |axis: usize| (self.half[axis].copysign(d[axis]) - o[axis]) / d[axis];
        // 0 / 0 for a ray within the plane of a face: that face is ignored.
        let t = (0..3).map(leave).fold(T::infinity(), T::min);
        (t > policy.t_min(RayKind::Secondary) && t.is_finite()).then_some(t)
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

    fn surface(&self, ray: &Ray<T>, t: T) -> [T::Vec3; 2] {
        let point = ray.origin + ray.direction * t;
        let local = self.localize(point);
        let face = self.face(local);
        let outward = self.axes[face];
        [
            point,
            if local[face] < T::zero() {
                -outward
            } else {
                outward
            },
        ]
    }
}
