//! The hits of rays in lanes: points, normals and colors.

use super::World;
use crate::lanes::{Columns, Lanes, MAX_LANES, Wide, Wide3, lanes_of};
use crate::material::{Brdf, Frame, Model, Scattering};
use crate::ray_epsilon::RayEpsilonPolicy;
use crate::real::{Real, Vector};
use crate::shape::Primitive;
use crate::spheres::{LaneHits, LaneRays};

/// The points that rays hit, one per lane.
#[derive(Debug)]
pub(super) struct Points<T, S: Lanes<T>> {
    pub(super) point: Wide3<T, S>,
    /// The normal, of unit length: it points outward, or on an open surface toward the side of the incoming
    /// ray.
    pub(super) normal: Wide3<T, S>,
    pub(super) color: Wide3<T, S>,
    /// The surface, encoded by [`Real::tag`].
    surface: Wide<T, S>,
    groups: Groups,
}

/// Surfaces, each with the lanes whose rays hit it.
#[derive(Debug)]
struct Groups {
    entries: [(u32, u32); MAX_LANES],
    count: usize,
}

impl Groups {
    /// Groups the lanes in `active` by their surfaces.
    #[inline(always)]
    fn new<T: Real, S: Lanes<T>>(simd: S, surface: Wide<T, S>, active: u32) -> Self {
        let mut groups = Self {
            entries: [(0, 0); MAX_LANES],
            count: 0,
        };
        let numbers = surface.to_array();
        let mut rest = active;
        while rest != 0 {
            let number = numbers[rest.trailing_zeros() as usize % MAX_LANES];
            let lanes = simd.bits(surface.equal(Wide::splat(simd, number))) & rest;
            rest &= !lanes;
            groups.entries[groups.count % MAX_LANES] = (number.untag(), lanes);
            groups.count += 1;
        }
        groups
    }
}

impl<T: Real, S: Lanes<T>> Points<T, S> {
    /// Iterates over the surfaces, with their lanes.
    #[inline(always)]
    pub(super) fn groups(&self) -> impl Iterator<Item = (usize, u32)> + '_ {
        let groups = self.groups.entries.iter().take(self.groups.count);
        groups.map(|&(surface, lanes)| (surface as usize, lanes))
    }

    /// Creates secondary rays to either side of the surface.
    #[inline(always)]
    pub(super) fn spawn_rays(
        &self,
        simd: S,
        direction: Wide3<T, S>,
        policy: &impl RayEpsilonPolicy<T>,
    ) -> LaneRays<T, S> {
        let [zero, offset, along] =
            [T::zero(), policy.offset(), policy.along()].map(|number| Wide::splat(simd, number));
        let offset = (-offset).select(direction.dot(self.normal).less(zero), offset);
        LaneRays {
            origin: self.point + self.normal * offset + direction * along,
            direction,
            from: self.surface,
        }
    }

    /// Returns the points, above the surface, from which directions to lights are computed.
    #[inline(always)]
    pub(super) fn light_ray_origin(&self, simd: S, policy: &impl RayEpsilonPolicy<T>) -> Wide3<T, S> {
        if policy.light_policy().from_ray_origin {
            self.point + self.normal * Wide::splat(simd, policy.offset())
        } else {
            self.point
        }
    }
}

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// Computes the points where the rays in `active` lanes hit something; other lanes are meaningless.
    #[inline(always)]
    pub(super) fn points<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        hits: &LaneHits<T, S>,
        active: u32,
    ) -> Points<T, S> {
        let mut center = Wide3::splat(simd, [T::zero(); 3]);
        let mut points = Points {
            point: rays.origin + rays.direction * hits.t,
            normal: center,
            color: center,
            surface: hits.surface,
            groups: Groups::new(simd, hits.surface, active & hits.bits(simd)),
        };
        for (surface, lanes) in points.groups() {
            if let Some(sphere) = self.shapes[surface].sphere() {
                center = Wide3::splat(simd, sphere.center.to_array()).select(simd.mask(lanes), center);
            }
        }
        points.normal = (points.point - center).normalize(simd);
        for at in 0..points.groups.count {
            let (surface, lanes) = points.groups.entries[at % MAX_LANES];
            let (shape, mask) = (&self.shapes[surface as usize], simd.mask(lanes));
            if shape.sphere().is_none() {
                let normals = shape.normals_in_lanes(simd, rays, hits.t, lanes);
                points.normal = normals.select(mask, points.normal);
            }
            let material = &self.materials[surface as usize];
            let color = if let Some(color) = material.uniform_color() {
                Wide3::splat(simd, color.to_array())
            } else {
                let [places, normals] = [points.point, points.normal].map(Columns::from);
                let mut colors = Columns::splat([T::zero(); 3]);
                for lane in lanes_of(lanes) {
                    let at = || [&places, &normals].map(|of| T::Vec3::from_array(of.get(lane)));
                    colors.set(lane, material.color(at).to_array());
                }
                colors.load(simd, 0)
            };
            points.color = color.select(mask, points.color);
        }
        points
    }

    /// Evaluates the BRDFs at points, for light from one direction per lane, in the `active` lanes.
    #[inline(always)]
    pub(super) fn scattering<S: Lanes<T>>(
        &self,
        simd: S,
        points: &Points<T, S>,
        frame: &Frame<T, S>,
        light: Wide3<T, S>,
        active: u32,
    ) -> Scattering<T, S> {
        let mut all = Scattering {
            value: Wide3::splat(simd, [T::zero(); 3]),
            density: Wide::splat(simd, T::zero()),
        };
        for (brdf, lanes) in self.brdfs(points, active) {
            let scattering = brdf.scattering(simd, points.color, frame, light, lanes);
            let mask = simd.mask(lanes);
            all.value = scattering.value.select(mask, all.value);
            all.density = scattering.density.select(mask, all.density);
        }
        all
    }

    /// Iterates over the BRDFs at points, with the `active` lanes that have it.
    #[inline(always)]
    pub(super) fn brdfs<'a, S: Lanes<T>>(
        &'a self,
        points: &'a Points<T, S>,
        active: u32,
    ) -> impl Iterator<Item = (&'a Brdf<T>, u32)> {
        points
            .groups()
            .filter_map(move |(surface, lanes)| match &self.materials[surface].model {
                Model::Reflective(brdf) if lanes & active != 0 => Some((brdf, lanes & active)),
                _ => None,
            })
    }
}
