//! Ray queries in lanes. Rays are traced one by one where there is a tree of spheres, or one lane only.

use super::World;
use crate::lanes::{Lanes, MAX_LANES, Wide, lanes_of};
use crate::ray::{FirstHit, RayKind};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::Real;
use crate::shape::Primitive;
use crate::spheres::{LaneHits, LaneRays, NO_SURFACE};

impl<T: Real, P: Primitive<T>> World<T, P> {
    #[inline(always)]
    fn traces_single_rays<S: Lanes<T>>(&self) -> bool {
        S::COUNT == 1 || self.spheres.has_tree()
    }

    /// Returns rays without the surface on which they start if the policy moves their origins.
    #[inline(always)]
    fn owned_rays<S: Lanes<T>>(
        simd: S,
        rays: &LaneRays<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> LaneRays<T, S> {
        let mut rays = *rays;
        if !policy.starts_on_surface() {
            rays.from = Wide::splat(simd, T::tag(NO_SURFACE));
        }
        rays
    }

    /// Finds the nearest surfaces along the secondary rays in `active` lanes; at equal t, those with the
    /// smallest index.
    #[inline(always)]
    pub(super) fn nearest_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
        active: u32,
    ) -> LaneHits<T, S> {
        if self.traces_single_rays::<S>() {
            let rays = rays.spill();
            let [mut ts, mut surfaces] = [[T::infinity(); MAX_LANES], [T::tag(NO_SURFACE); MAX_LANES]];
            for lane in lanes_of(active) {
                let first = self.nearest(&rays.get(lane), policy);
                [ts[lane], surfaces[lane]] = first.tagged();
            }
            let [t, surface] = [ts, surfaces].map(|numbers| Wide::load(simd, &numbers));
            return LaneHits { t, surface };
        }
        let rays = &Self::owned_rays(simd, rays, policy);
        let t_min = Wide::splat(simd, policy.t_min(RayKind::Secondary));
        let mut hits = self.spheres.nearest_in_lanes(simd, rays, t_min, active);
        for &other in &self.others {
            let t = self.intersect_other(simd, other, rays, policy, active);
            hits.update(simd, t, other as u32);
        }
        hits
    }

    /// Intersects secondary rays with a surface that is not a sphere. t is infinite where there is no hit.
    #[inline(always)]
    fn intersect_other<S: Lanes<T>>(
        &self,
        simd: S,
        other: usize,
        rays: &LaneRays<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
        active: u32,
    ) -> Wide<T, S> {
        let shape = &self.shapes[other];
        let [t_min, infinity] =
            [policy.t_min(RayKind::Secondary), T::infinity()].map(|number| Wide::splat(simd, number));
        let own = simd.bits(rays.from.equal(Wide::splat(simd, T::tag(other as u32)))) & active;
        let mut t = infinity;
        if own != active {
            t = shape.intersect_in_lanes(simd, rays, policy, active & !own);
        }
        if own != 0 {
            let (rays, mut ts) = (rays.spill(), t.to_array());
            for lane in lanes_of(own) {
                ts[lane] = shape
                    .intersect_own(&rays.get(lane), policy)
                    .unwrap_or(T::infinity());
            }
            t = Wide::load(simd, &ts);
        }
        t.select(t_min.less(t), infinity)
    }

    /// Returns the `active` lanes in which anything except the surface `light` lies strictly between the
    /// origin of the ray and `distance`, or in which the ray misses that surface and the policy requires a
    /// hit. `light` is encoded by [`Real::tag`].
    #[inline(always)]
    pub(super) fn occluded_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        distance: Wide<T, S>,
        light: Wide<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
        active: u32,
    ) -> u32 {
        let mut hidden = 0;
        if self.traces_single_rays::<S>() {
            let (rays, distances, lights) = (rays.spill(), distance.to_array(), light.to_array());
            for lane in lanes_of(active) {
                let light = Some(lights[lane].untag()).filter(|&light| light != NO_SURFACE);
                let light = light.map(|light| light as usize);
                let is_occluded = self.occluded(&rays.get(lane), distances[lane], light, policy);
                hidden |= u32::from(is_occluded) << lane;
            }
            return hidden;
        }
        if policy.light_policy().requires_hit {
            let (rays, lights) = (rays.spill(), light.to_array());
            for lane in lanes_of(active) {
                let light = self.shapes.get(lights[lane].untag() as usize);
                let misses = light.is_some_and(|light| light.intersect(&rays.get(lane), policy).is_none());
                hidden |= u32::from(misses) << lane;
            }
        }
        let rays = &Self::owned_rays(simd, rays, policy);
        let t_min = Wide::splat(simd, policy.t_min(RayKind::Secondary));
        hidden |= self
            .spheres
            .any_in_lanes(simd, rays, [t_min, distance], light, active);
        for &other in &self.others {
            if hidden == active {
                break;
            }
            let t = self.intersect_other(simd, other, rays, policy, active);
            let is_light = simd.bits(light.equal(Wide::splat(simd, T::tag(other as u32))));
            hidden |= active & t.is_less(distance) & !is_light;
        }
        hidden
    }

    /// Lets the rays that the policy selects hit the surface on which they start: those that continue from a
    /// surface by its number in the path. `segments` counts the segments up to the ends of the rays.
    #[inline(always)]
    pub(super) fn hit_own_surfaces<S: Lanes<T>>(
        simd: S,
        hits: &mut LaneHits<T, S>,
        rays: &LaneRays<T, S>,
        segments: Wide<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
        active: u32,
    ) {
        let bounces = policy.acne().self_hit_bounces;
        if bounces == 0 {
            return;
        }
        let segments = segments.to_array();
        let mut own = 0;
        for lane in lanes_of(active) {
            let bounce = segments[lane].to_u32().unwrap_or(2) - 2;
            own |= (bounces >> bounce.min(31) & 1) << lane;
        }
        let mask = simd.mask(own);
        hits.t = Wide::splat(simd, T::zero()).select(mask, hits.t);
        hits.surface = rays.from.select(mask, hits.surface);
    }
}

impl<T: Real> FirstHit<T> {
    /// Returns t and the surface, encoded by [`Real::tag`].
    #[inline]
    pub(super) fn tagged(self) -> [T; 2] {
        self.get()
            .map_or([T::infinity(), T::tag(NO_SURFACE)], |(t, surface)| {
                [t, T::tag(surface as u32)]
            })
    }
}
