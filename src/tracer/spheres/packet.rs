//! Rays side by side, and what they find.

use super::super::lanes::MOST_LANES;
use super::super::ray::{First, Ray};
use super::super::real::{Real, Vector};
use super::NONE;

/// How many rays are in a packet: those of 8×8 pixels.
pub(in super::super) const PACKET: usize = 64;

/// A number of each ray.
pub(super) type Each<T> = [T; PACKET];

/// Rays side by side.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Packet<T> {
    pub(in super::super) origins: Origins<T>,
    pub(in super::super) directions: [Each<T>; 3],
    /// The surface that each starts on, if it is not to meet it there; none of them starts on any where this is none.
    pub(super) from: Option<Each<T>>,
    /// Hits must lie beyond this t.
    pub(super) t_min: T,
    /// Only the first so many are looked at: a multiple of the number of lanes.
    pub(super) count: usize,
}

impl<T: Real> Packet<T> {
    /// As many rays as there are places, which start on no surface.
    pub(in super::super) fn full(origins: Origins<T>, directions: [Each<T>; 3]) -> Self {
        Self {
            origins,
            directions,
            from: None,
            t_min: T::zero(),
            count: PACKET,
        }
    }

    /// At least one ray and at most [`PACKET`], which start on those surfaces: for spheres without a tree. In the places that are
    /// left is the last one again.
    pub(in super::super) fn some<'a>(
        rays: impl Iterator<Item = (&'a Ray<T>, Option<usize>)>,
        t_min: T,
    ) -> Self {
        let mut origins = [[T::zero(); PACKET]; 3];
        let mut directions = origins;
        let mut from = [T::tag(NONE); PACKET];
        let mut put = |at: usize, [origin, direction]: [[T; 3]; 2]| {
            for axis in 0..3 {
                (origins[axis][at], directions[axis][at]) = (origin[axis], direction[axis]);
            }
        };
        let mut last = [[T::zero(); 3]; 2];
        let mut count = 0;
        for (ray, surface) in rays {
            last = [ray.origin.to_array(), ray.direction.to_array()];
            put(count, last);
            from[count] = T::tag(surface.map_or(NONE, |surface| surface as u32));
            count += 1;
        }
        let padded = count.next_multiple_of(MOST_LANES);
        (count..padded).for_each(|at| put(at, last));
        Self {
            origins: Origins::Each(origins),
            directions,
            from: Some(from),
            t_min,
            count: padded,
        }
    }

    /// One of its rays.
    #[inline]
    pub(in super::super) fn ray(&self, at: usize) -> Ray<T> {
        let of = |components: &[Each<T>; 3]| T::Vec3::from_array([0, 1, 2].map(|axis| components[axis][at]));
        Ray {
            origin: match &self.origins {
                Origins::One(origin) => T::Vec3::from_array(*origin),
                Origins::Each(origins) => of(origins),
            },
            direction: of(&self.directions),
            from: None,
        }
    }
}

/// Where rays start.
#[derive(Debug)]
pub(in super::super) enum Origins<T> {
    /// All in one point.
    One([T; 3]),
    Each([Each<T>; 3]),
}

/// What the rays of a packet found.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Found<T> {
    /// Infinite where nothing is met.
    pub(super) t: Each<T>,
    /// The number of the sphere, as [`Real::tag`] hides it.
    pub(super) tags: Each<T>,
}

impl<T: Real> Found<T> {
    /// Nothing so far.
    pub(in super::super) fn nothing() -> Self {
        Self {
            t: [T::infinity(); PACKET],
            tags: [T::tag(NONE); PACKET],
        }
    }

    /// Nothing so far, and nothing is to be found at these t's or beyond.
    pub(in super::super) fn before(limits: impl Iterator<Item = T>) -> Self {
        let mut found = Self {
            t: [T::zero(); PACKET],
            // No number is smaller, so that nothing takes this one's place at the same t.
            tags: [T::tag(0); PACKET],
        };
        found.t.iter_mut().zip(limits).for_each(|(t, limit)| *t = limit);
        found
    }

    /// Whether one ray found anything before that t.
    #[inline]
    pub(in super::super) fn is_before(&self, ray: usize, limit: T) -> bool {
        self.t[ray] < limit
    }

    /// What one ray found.
    #[inline]
    pub(in super::super) fn of(&self, ray: usize) -> First<T> {
        First::new(self.t[ray], self.tags[ray].untag())
    }
}
