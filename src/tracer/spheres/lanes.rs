//! Rays in lanes: each lane has a ray of its own, and all are tested against one sphere after the other.

use super::Spheres;
use super::block::Block;
use super::formula::{NO_SURFACE, Roots, discriminant, other_root};
use crate::lanes::{Columns, Lanes, Wide, Wide3};
use crate::ray::Ray;
use crate::real::{Real, Vector};

/// A ray per lane.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct LaneRays<T, S: Lanes<T>> {
    pub(in super::super) origin: Wide3<T, S>,
    /// Of unit length, up to rounding.
    pub(in super::super) direction: Wide3<T, S>,
    /// The surface on which each ray starts, or [`NO_SURFACE`], encoded by [`Real::tag`].
    pub(in super::super) from: Wide<T, S>,
}

/// The first hit of the ray of each lane.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct LaneHits<T, S: Lanes<T>> {
    /// Infinite if there is no hit.
    pub(in super::super) t: Wide<T, S>,
    /// The surface, encoded by [`Real::tag`].
    pub(in super::super) surface: Wide<T, S>,
}

impl<T: Real, S: Lanes<T>> LaneRays<T, S> {
    /// Returns the rays as an array, for computations on one ray after the other.
    #[inline(always)]
    pub(in super::super) fn spill(&self) -> SpilledRays<T> {
        SpilledRays {
            origins: Columns::from(self.origin),
            directions: Columns::from(self.direction),
            from: self.from.to_array(),
        }
    }

    /// Replaces the rays of the lanes in `mask`.
    #[inline(always)]
    pub(in super::super) fn replace(&mut self, mask: S::Mask, other: &Self) {
        self.origin = other.origin.select(mask, self.origin);
        self.direction = other.direction.select(mask, self.direction);
        self.from = other.from.select(mask, self.from);
    }
}

/// [`LaneRays`] in memory.
#[derive(Debug)]
pub(in super::super) struct SpilledRays<T> {
    origins: Columns<T>,
    directions: Columns<T>,
    from: [T; crate::lanes::MAX_LANES],
}

impl<T: Real> SpilledRays<T> {
    #[inline]
    pub(in super::super) fn get(&self, lane: usize) -> Ray<T> {
        let from = self.from[lane].untag();
        Ray {
            origin: T::Vec3::from_array(self.origins.get(lane)),
            direction: T::Vec3::from_array(self.directions.get(lane)),
            from: (from != NO_SURFACE).then_some(from as usize),
        }
    }
}

impl<T: Real, S: Lanes<T>> LaneHits<T, S> {
    /// No hits.
    #[inline(always)]
    pub(in super::super) fn none(simd: S) -> Self {
        Self {
            t: Wide::splat(simd, T::infinity()),
            surface: Wide::splat(simd, T::tag(NO_SURFACE)),
        }
    }

    /// Replaces the hits where the given t of a surface is smaller; at equal t, the smaller index wins. An
    /// infinite t and NaN are not hits.
    #[inline(always)]
    pub(in super::super) fn update(&mut self, simd: S, t: Wide<T, S>, number: u32) {
        let tag = Wide::splat(simd, T::tag(number));
        let infinity = Wide::splat(simd, T::infinity());
        let ties = simd.bits(t.equal(self.t)) & t.is_less(infinity);
        if ties != 0 {
            let smaller = simd.mask(ties & tag.is_less(self.surface));
            self.surface = tag.select(smaller, self.surface);
        }
        let nearer = t.less(self.t);
        self.t = t.select(nearer, self.t);
        self.surface = tag.select(nearer, self.surface);
    }

    /// Returns the lanes that have a hit.
    #[inline(always)]
    pub(in super::super) fn bits(&self, simd: S) -> u32 {
        self.t.is_less(Wide::splat(simd, T::infinity()))
    }
}

impl<T: Real> Spheres<T> {
    /// Finds the first hits beyond `t_min` of the rays in `active` lanes. A ray's start is not a hit of the
    /// sphere that it starts on. For spheres without a tree.
    #[inline(always)]
    pub(in super::super) fn nearest_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        t_min: Wide<T, S>,
        active: u32,
    ) -> LaneHits<T, S> {
        let query = LaneQuery::new(simd, rays, t_min, active);
        let mut hits = LaneHits::none(simd);
        for (block, reach) in self.tree.blocks.iter().zip(&self.tree.reaches) {
            for slot in 0..reach.count {
                if let Some(t) = query.intersect(block, slot) {
                    hits.update(simd, t, block.numbers[slot]);
                }
            }
        }
        hits
    }

    /// Returns the `active` lanes whose rays hit anything but the sphere `ignored` beyond `t_min` and before
    /// `t_max`.
    #[inline(always)]
    pub(in super::super) fn any_in_lanes<S: Lanes<T>>(
        &self,
        simd: S,
        rays: &LaneRays<T, S>,
        [t_min, t_max]: [Wide<T, S>; 2],
        ignored: Wide<T, S>,
        active: u32,
    ) -> u32 {
        let query = LaneQuery::new(simd, rays, t_min, active);
        let mut hit = 0;
        for (block, reach) in self.tree.blocks.iter().zip(&self.tree.reaches) {
            for slot in 0..reach.count {
                if let Some(t) = query.intersect(block, slot) {
                    let tag = Wide::splat(simd, T::tag(block.numbers[slot]));
                    hit |= active & t.is_less(t_max) & !simd.bits(ignored.equal(tag));
                }
            }
            if hit == active {
                break;
            }
        }
        hit
    }
}

/// Rays in lanes, with what all spheres need of them.
struct LaneQuery<'a, T, S: Lanes<T>> {
    simd: S,
    rays: &'a LaneRays<T, S>,
    a: Wide<T, S>,
    inverse_a: Wide<T, S>,
    t_min: Wide<T, S>,
    active: u32,
}

impl<'a, T: Real, S: Lanes<T>> LaneQuery<'a, T, S> {
    #[inline(always)]
    fn new(simd: S, rays: &'a LaneRays<T, S>, t_min: Wide<T, S>, active: u32) -> Self {
        let a = rays.direction.dot(rays.direction);
        Self {
            simd,
            rays,
            a,
            inverse_a: Wide::splat(simd, T::one()) / a,
            t_min,
            active,
        }
    }

    /// Intersects all rays with one sphere. Returns t, which is infinite where there is no hit, or nothing if
    /// no active ray hits it.
    #[inline(always)]
    fn intersect(&self, block: &Block<T>, slot: usize) -> Option<Wide<T, S>> {
        let simd = self.simd;
        let [cx, cy, cz] = &block.center;
        let center = Wide3::splat(simd, [cx[slot], cy[slot], cz[slot]]);
        let radius2 = Wide::splat(simd, block.radius2[slot]);
        let f = (self.rays.origin - center) * Wide::splat(simd, block.inverse_unit[slot]);
        let [along, disc] = discriminant(f, self.rays.direction, self.inverse_a, radius2);
        let [zero, infinity] = [T::zero(), T::infinity()].map(|number| Wide::splat(simd, number));
        let tag = Wide::splat(simd, T::tag(block.numbers[slot]));
        let own = self.rays.from.equal(tag);
        let may_hit = zero.less_or_equal(disc);
        let from_here = simd.bits(own) & self.active;
        let from_elsewhere = simd.bits(may_hit) & self.active & !from_here;
        if from_here | from_elsewhere == 0 {
            return None;
        }
        let unit = Wide::splat(simd, block.inverse_unit[slot].recip());
        let mut t = infinity;
        if from_elsewhere != 0 {
            let roots = Roots {
                along,
                disc,
                a: self.a,
                c: f.dot(f) - radius2,
                unit,
            };
            t = roots.beyond(simd, self.t_min).select(may_hit, infinity);
        }
        if from_here != 0 {
            t = other_root(simd, along, self.a, unit).select(own, t);
        }
        Some(t.select(self.t_min.less(t), infinity))
    }
}
