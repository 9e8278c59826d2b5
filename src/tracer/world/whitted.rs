//! Whitted ray tracing: direct light, mirrors and glass; T. Whitted, “An Improved Illumination Model for
//! Shaded Display”, CACM 23(6), 1980. Each sample has a lane, and follows its rays in depth-first order,
//! reflection before refraction.

use super::World;
use super::points::Points;
use crate::glass::GlassHits;
use crate::lanes::{Lanes, MAX_LANES, Wide, Wide3};
use crate::light::{Cone, Light};
use crate::material::{Frame, Model};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::sampler::{SampleStream, next_disks};
use crate::shape::Primitive;
use crate::spheres::{LaneHits, LaneRays, NO_SURFACE};

/// The rays to trace, one per lane; their radiance is multiplied by their throughput.
#[derive(Debug, Clone, Copy)]
struct Branches<T, S: Lanes<T>> {
    rays: LaneRays<T, S>,
    throughput: Wide3<T, S>,
    /// Number of segments from the camera to the end of the ray.
    segments: Wide<T, S>,
}

impl<T: Real, S: Lanes<T>> Branches<T, S> {
    /// Replaces the rays of some lanes.
    #[inline(always)]
    fn replace(&mut self, mask: S::Mask, other: &Self) {
        self.rays.replace(mask, &other.rays);
        self.throughput = other.throughput.select(mask, self.throughput);
        self.segments = other.segments.select(mask, self.segments);
    }
}

/// The shadow rays from points to a light.
struct LightRays<T, S: Lanes<T>> {
    /// The direction to the light from the points, or from the origins of the rays, by the policy.
    direction: Wide3<T, S>,
    /// The cosine of the angle between the direction and the normal.
    cosine: Wide<T, S>,
    rays: LaneRays<T, S>,
    /// The lengths of the rays.
    distance: Wide<T, S>,
}

/// The refracted rays that are traced later. The rays of a sample form a stack with at most one ray for each
/// number of segments: a ray that splits comes back to its refracted part when all longer ones are done.
pub(super) struct DeferredRays<T, S: Lanes<T>> {
    /// By the number of segments of the ray that was split, with the lanes that have one.
    levels: Vec<(Branches<T, S>, u32)>,
}

impl<T: Real, S: Lanes<T>> DeferredRays<T, S> {
    pub(super) fn none() -> Self {
        Self { levels: Vec::new() }
    }

    /// Defers the rays in `lanes`, parts of rays with that many segments.
    #[inline(always)]
    fn push(&mut self, simd: S, branches: &Branches<T, S>, segments: Wide<T, S>, lanes: u32) {
        let numbers = segments.to_array();
        let mut rest = lanes;
        while rest != 0 {
            let number = numbers[rest.trailing_zeros() as usize % MAX_LANES];
            let equal = simd.bits(segments.equal(Wide::splat(simd, number))) & rest;
            rest &= !equal;
            let level = number.to_usize().unwrap_or(0);
            while self.levels.len() <= level {
                self.levels.push((*branches, 0));
            }
            let (there, occupied) = &mut self.levels[level];
            there.replace(simd.mask(equal), branches);
            *occupied |= equal;
        }
    }

    /// Continues with the rays that were deferred last. Returns which of the lanes have one.
    #[inline(always)]
    fn pop(&mut self, simd: S, branches: &mut Branches<T, S>, lanes: u32) -> u32 {
        let mut rest = lanes;
        for (there, occupied) in self.levels.iter_mut().rev() {
            let taken = *occupied & rest;
            if taken != 0 {
                branches.replace(simd.mask(taken), there);
                *occupied &= !taken;
                rest &= !taken;
                if rest == 0 {
                    break;
                }
            }
        }
        lanes & !rest
    }
}

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Returns the radiance along camera rays with the given first hits, in the `active` lanes. No ray is
    /// deferred before and after.
    #[inline(always)]
    pub(super) fn whitted<S: Lanes<T>>(
        &self,
        simd: S,
        rays: LaneRays<T, S>,
        mut hits: LaneHits<T, S>,
        (streams, deferred): (&mut [SampleStream], &mut DeferredRays<T, S>),
        mut active: u32,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> Wide3<T, S> {
        let [one, two, max_depth] =
            [1.0, 2.0, f64::from(self.max_depth)].map(|number| Wide::splat(simd, T::from_f64(number)));
        let black = Wide3::splat(simd, [T::zero(); 3]);
        let mut branches = Branches {
            rays,
            throughput: Wide3::splat(simd, [T::one(); 3]),
            segments: one,
        };
        let mut sum = black;
        loop {
            let Branches {
                rays,
                throughput,
                segments,
            } = branches;
            let direction = rays.direction;
            let mut light = self.background.color(simd, direction);
            let points = self.points(simd, &rays, &hits, active);
            let facing = direction.dot(points.normal);
            let is_last = simd.bits(max_depth.less_or_equal(segments));
            let [mut lit, mut specular, mut glass, mut schlick] = [0; 4];
            let mut ior = one;
            for (surface, lanes) in points.groups() {
                let mask = simd.mask(lanes);
                match &self.materials[surface].model {
                    Model::Facing => light = (points.color * facing.abs()).select(mask, light),
                    Model::Emitter => light = points.color.select(mask, light),
                    Model::Reflective(_) => lit |= lanes,
                    Model::Mirror => specular |= lanes,
                    Model::Glass(of) => {
                        specular |= lanes;
                        glass |= lanes & !is_last;
                        schlick |= if of.is_schlick() { lanes } else { 0 };
                        ior = Wide::splat(simd, of.ior).select(mask, ior);
                    }
                }
            }
            light = black.select(simd.mask(specular), light);
            if lit != 0 {
                let direct = self.direct_light(simd, &points, direction, streams, policy, lit);
                light = direct.select(simd.mask(lit), light);
            }
            specular &= !is_last;
            let ended = active & !specular;
            sum = (sum + throughput.times(light)).select(simd.mask(ended), sum);
            if specular != 0 {
                let mut color = points.color;
                let segments_after = segments + one;
                if glass != 0 {
                    let refraction = GlassHits {
                        direction,
                        normal: points.normal,
                        facing,
                        ior,
                        schlick,
                    }
                    .refract(simd);
                    let refracted = Branches {
                        rays: points.spawn_rays(simd, refraction.refracted, policy),
                        throughput: throughput.times(color * (one - refraction.reflectance)),
                        segments: segments_after,
                    };
                    deferred.push(simd, &refracted, segments, glass & !refraction.total);
                    color = (color * refraction.reflectance).select(simd.mask(glass), color);
                }
                let direction = direction - points.normal * (two * facing);
                let reflected = Branches {
                    rays: points.spawn_rays(simd, direction, policy),
                    throughput: throughput.times(color),
                    segments: segments_after,
                };
                branches.replace(simd.mask(specular), &reflected);
            }
            active = specular | deferred.pop(simd, &mut branches, ended);
            if active == 0 {
                return sum;
            }
            hits = self.nearest_in_lanes(simd, &branches.rays, policy, active);
            Self::hit_own_surfaces(simd, &mut hits, &branches.rays, branches.segments, policy, active);
        }
    }

    /// Returns the ambient light, and direct light from all visible lights, reflected at points to rays of
    /// the given directions, in the lanes `lit`.
    #[inline(always)]
    fn direct_light<S: Lanes<T>>(
        &self,
        simd: S,
        points: &Points<T, S>,
        direction: Wide3<T, S>,
        streams: &mut [SampleStream],
        policy: &impl RayEpsilonPolicy<T>,
        lit: u32,
    ) -> Wide3<T, S> {
        let policy = &policy.for_shadow_rays();
        let zero = Wide::splat(simd, T::zero());
        let frame = Frame {
            normal: points.normal,
            view: -direction,
        };
        let mut sum = points.color.times(Wide3::splat(simd, self.ambient.to_array()));
        for (number, light) in self.lights.iter().enumerate() {
            let LightRays {
                direction,
                cosine,
                rays,
                distance,
            } = if light.radius > T::zero() {
                let [center, from] = [
                    Wide3::splat(simd, light.position.to_array()),
                    points.light_ray_origin(simd, policy),
                ];
                let cone = Cone::new(simd, center, Wide::splat(simd, light.radius), from);
                let (direction, distance) = cone.sample(simd, next_disks(simd, streams, lit), lit);
                LightRays {
                    direction,
                    cosine: points.normal.dot(direction),
                    rays: points.spawn_rays(simd, direction, policy),
                    distance: distance - Wide::splat(simd, policy.along()),
                }
            } else {
                Self::point_light_rays(simd, points, light, policy)
            };
            let mut visible = zero.is_less(cosine) & lit;
            if policy.acne().shadowed_lights >> number.min(31) & 1 != 0 {
                visible = 0;
            } else if light.shadow && visible != 0 {
                let surface = light.surface.map_or(NO_SURFACE, |surface| surface as u32);
                let surface = Wide::splat(simd, T::tag(surface));
                visible &= !self.occluded_in_lanes(simd, &rays, distance, surface, policy, visible);
            }
            if visible != 0 {
                let reflected = self.scattering(simd, points, &frame, direction, visible).value;
                let color = Wide3::splat(simd, light.color.to_array());
                let more = sum + color.times(reflected) * cosine;
                sum = more.select(simd.mask(visible), sum);
            }
        }
        sum
    }

    #[inline(always)]
    fn point_light_rays<S: Lanes<T>>(
        simd: S,
        points: &Points<T, S>,
        light: &Light<T>,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> LightRays<T, S> {
        let [zero, offset, along] =
            [T::zero(), policy.offset(), policy.along()].map(|number| Wide::splat(simd, number));
        let light = Wide3::splat(simd, light.position.to_array());
        let mut direction = (light - points.point).normalize(simd);
        let mut cosine = points.normal.dot(direction);
        let offset = (-offset).select(cosine.less(zero), offset);
        let origin = points.point + points.normal * offset;
        let to_light = light - origin;
        let distance = to_light.length(simd);
        let ray_direction = to_light / distance;
        if policy.light_policy().from_ray_origin {
            direction = ray_direction;
            cosine = points.normal.dot(direction);
        }
        let mut rays = points.spawn_rays(simd, ray_direction, policy);
        rays.origin = origin + ray_direction * along;
        LightRays {
            direction,
            cosine,
            rays,
            distance: distance - along,
        }
    }
}
