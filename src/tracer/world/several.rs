//! What several rays meet, each for itself: side by side where that is faster, and the same to the bit.

use super::super::lanes::{Columns, Level, MOST_LANES};
use super::super::ray::{First, Hit, Ray};
use super::super::real::{Real, Vector};
use super::super::shape::{Primitive, Surfaces};
use super::super::spheres::{Found, PACKET, Packet};
use super::super::style::Style;
use super::World;
use super::walk::{Branch, Walk};

/// Fewer rays go one by one, each past eight spheres at a time.
const FEW: usize = 8;

impl<T: Real, P: Primitive<T>> World<T, P> {
    /// The instruction set for so many of something.
    pub(super) fn level(&self, count: usize) -> Level {
        if count == 1 { Level::Base } else { self.level }
    }

    fn goes_together(&self, count: usize) -> bool {
        count >= FEW && !self.spheres.has_tree()
    }

    /// Looks for what some samples' rays meet first, at most [`PACKET`], all secondary.
    pub(super) fn look(&self, walks: &mut [Walk<T>], some: &[usize], style: &impl Style<T>) {
        if !self.goes_together(some.len()) {
            let own_met = style.acne().own_met;
            for &at in some {
                let Branch { ray, segments, .. } = &walks[at].branch;
                walks[at].first = match ray.from {
                    Some(own) if own_met != 0 && own_met >> (segments - 2).min(31) & 1 != 0 => {
                        First::new(T::zero(), own as u32)
                    }
                    _ => self.nearest(ray, style),
                };
            }
            return;
        }
        let rays = some.iter().map(|&at| &walks[at].branch.ray);
        let packet = Packet::some(rays.map(|ray| (ray, Self::own(ray, style))), style.t_min(true));
        let mut found = Found::nothing();
        self.spheres.nearest_of_packet(&packet, &mut found);
        for (ray, &at) in some.iter().enumerate() {
            walks[at].first = found.of(ray);
        }
        if self.others.is_empty() {
            return;
        }
        for &at in some {
            let walk = &mut walks[at];
            let ray = &walk.branch.ray;
            let own = Self::own(ray, style).filter(|&own| self.shapes[own].sphere().is_none());
            if let Some(own) = own {
                walk.first.take(self.shapes[own].intersect_own(ray, style), own);
            }
            self.nearest_other(ray, &mut walk.first, style);
        }
    }

    /// [`World::occluded`] of secondary rays, at most [`PACKET`], and the distances of what they go to, which is perhaps the surface
    /// `light`: bit i tells of ray i.
    pub(super) fn occluded_of(
        &self,
        rays: &[(Ray<T>, T)],
        light: Option<usize>,
        style: &impl Style<T>,
    ) -> u64 {
        let mut hidden = 0;
        if !self.goes_together(rays.len()) || light.is_some() {
            for (at, (ray, distance)) in rays.iter().enumerate() {
                hidden |= u64::from(self.occluded(ray, *distance, light, style)) << at;
            }
            return hidden;
        }
        let of_own = rays.iter().map(|(ray, _)| (ray, Self::own(ray, style)));
        let packet = Packet::some(of_own, style.t_min(true));
        let mut found = Found::before(rays.iter().map(|&(_, distance)| distance));
        self.spheres.nearest_of_packet(&packet, &mut found);
        for (at, (ray, distance)) in rays.iter().enumerate() {
            let is_hidden =
                found.is_before(at, *distance) || self.occluded_by_other(ray, *distance, None, style);
            hidden |= u64::from(is_hidden) << at;
        }
        hidden
    }

    /// Puts where some samples' rays meet spheres, at most [`MOST_LANES`]: the points and the normals there.
    pub(super) fn put_surfaces(&self, walks: &[Walk<T>], some: &[usize], surfaces: &mut [Columns<T>; 2]) {
        let [mut origins, mut directions, mut centers] = [(); 3].map(|()| Columns::splat([T::zero(); 3]));
        let mut ts = [T::zero(); MOST_LANES];
        for (lane, &at) in some.iter().enumerate() {
            let Walk { branch, first, .. } = &walks[at];
            let Some((t, surface)) = first.get() else { continue };
            if let Some(sphere) = self.shapes[surface].sphere() {
                origins.set(lane, branch.ray.origin.to_array());
                directions.set(lane, branch.ray.direction.to_array());
                centers.set(lane, sphere.center.to_array());
                ts[lane] = t;
            }
        }
        let surfaces = Surfaces {
            count: some.len(),
            origins: &origins,
            directions: &directions,
            t: &ts,
            centers: &centers,
            out: surfaces,
        };
        T::run(self.level, surfaces);
    }

    /// [`World::hit`] of one of them.
    #[inline]
    pub(super) fn hit_among(
        &self,
        [points, normals]: &[Columns<T>; 2],
        lane: usize,
        walk: &Walk<T>,
    ) -> Option<Hit<T>> {
        let (_, surface) = walk.first.get()?;
        if self.shapes[surface].sphere().is_none() {
            return self.hit(&walk.branch.ray, walk.first);
        }
        Some(Hit {
            point: T::Vec3::from_array(points.get(lane)),
            normal: T::Vec3::from_array(normals.get(lane)),
            surface,
        })
    }
}

const _: () = assert!(PACKET == u64::BITS as usize);
