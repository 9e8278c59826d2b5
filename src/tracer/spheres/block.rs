//! Blocks of eight spheres, their bounding boxes, and conservative tests of packets against boxes.

use super::formula::{BLOCK_SIZE, Eight, NumberedSphere, unit};
use crate::lanes::{Lanes, Wide};
use crate::real::Real;

/// Up to eight spheres: the data for intersection, in three cache lines in f32. Empty slots hold NaN, which
/// no ray hits.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Block<T> {
    pub(super) center: [Eight<T>; 3],
    /// The reciprocal of each sphere's unit of length, a power of two in scene units.
    pub(super) inverse_unit: Eight<T>,
    /// (radius/unit)², in [1, 4).
    pub(super) radius2: Eight<T>,
    /// The numbers of the spheres.
    pub(super) numbers: [u32; BLOCK_SIZE],
}

/// Bounds of the spheres of a block.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Reach<T> {
    /// Distance from the center, along each axis, within which a ray may pass that [`super::discriminant`]
    /// reports as a hit: slightly more than the radius. See [`margin`].
    pub(super) reach: Eight<T>,
    /// Number of spheres.
    pub(super) count: usize,
}

/// Returns the relative margin that makes box tests conservative: it extends boxes relative to the radius,
/// and t at their sides relative to t, so that no box excludes a ray for which the formula finds a hit.
///
/// The formula computes the point P at f·d/a along the ray and finds a hit if the computed squared distance
/// of P from the center is at most r². Let u be half of epsilon. Each component of P − c has an error of at
/// most u (2 |o − c| + 3 r) along its own axis, from rounding f, the product with d and the sum. The square
/// and the sum of squares have a relative error of 4 u, hence the distance an error of 2 u r. So P lies on
/// the ray, and within r + u (2 |o − c| + 5 r) of the center along each axis. The ray crosses the side of a
/// box at (side − o)/d, with a relative error of 4 u. Therefore t at the sides needs a relative margin of
/// (4 + 2) u, and the radius one of (5 + 2 + 4) u. Both get 32 u.
pub(super) fn margin<T: Real>() -> T {
    // 32 u.
    T::from_f64(16.0) * T::epsilon()
}

/// Builds a block of at most eight spheres, and its bounds.
pub(super) fn block<T: Real>(spheres: &[NumberedSphere<T>]) -> (Block<T>, Reach<T>) {
    let nan = [T::nan(); BLOCK_SIZE];
    let mut block = Block {
        center: [nan; 3],
        inverse_unit: nan,
        radius2: nan,
        numbers: [super::formula::NO_SURFACE; BLOCK_SIZE],
    };
    let mut reach = Reach {
        reach: nan,
        count: spheres.len(),
    };
    for (at, sphere) in spheres.iter().enumerate() {
        let radius = sphere.radius;
        let inverse_unit = unit(radius).recip();
        let scaled = radius * inverse_unit;
        let size = sphere.center.iter().fold(T::zero(), |size, c| size.max(c.abs()));
        for (axis, component) in sphere.center.into_iter().enumerate() {
            block.center[axis][at] = component;
        }
        block.inverse_unit[at] = inverse_unit;
        block.radius2[at] = scaled * scaled;
        block.numbers[at] = sphere.number;
        // The sides of boxes are rounded too, by at most one epsilon of the center's magnitude.
        reach.reach[at] = radius
            + (margin::<T>() * radius + (T::epsilon() + T::epsilon()) * size)
            + T::min_positive_value();
    }
    (block, reach)
}

impl<T: Real> Reach<T> {
    /// Returns the lowest and the highest corner of the bounding box.
    pub(super) fn bounds(&self, block: &Block<T>) -> [[T; 3]; 2] {
        let side = |axis: usize, sign: T| {
            (0..self.count).map(move |at| block.center[axis][at] + sign * self.reach[at])
        };
        [
            [0, 1, 2].map(|axis| side(axis, -T::one()).fold(T::infinity(), T::min)),
            [0, 1, 2].map(|axis| side(axis, T::one()).fold(T::neg_infinity(), T::max)),
        ]
    }
}

/// Interval of t in which the rays of a packet are between two planes perpendicular to an axis, by interval
/// arithmetic over the origins and directions.
///
/// For planes at l and h relative to the origins, no ray is between them before max(l·`low_near`,
/// h·`high_near`) or after max(h·`high_far`, l·`low_far`) + `unbounded`. If all directions have the same
/// sign, two of the four factors are 0; otherwise a ray may be parallel to the planes and stay between them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slab<T, S: Lanes<T>> {
    lowest_origin: Wide<T, S>,
    highest_origin: Wide<T, S>,
    low_near: Wide<T, S>,
    high_near: Wide<T, S>,
    high_far: Wide<T, S>,
    low_far: Wide<T, S>,
    unbounded: Wide<T, S>,
}

impl<T: Real, S: Lanes<T>> Slab<T, S> {
    /// Creates the slab for origins and directions in the given ranges.
    #[inline(always)]
    pub(super) fn new(simd: S, origins: [T; 2], [low, high]: [T; 2]) -> Self {
        let (zero, tiny) = (T::zero(), T::min_positive_value());
        let (near, far) = (T::one() - margin(), T::one() + margin());
        let [low_near, high_near, high_far, low_far, unbounded] = if low >= tiny {
            [high.recip() * near, zero, low.recip() * far, zero, zero]
        } else if high <= -tiny {
            [zero, low.recip() * near, zero, high.recip() * far, zero]
        } else {
            let (low, high) = (low.min(-tiny), high.max(tiny));
            [high.recip() * near, low.recip() * near, zero, zero, T::infinity()]
        };
        Self {
            lowest_origin: Wide::splat(simd, origins[0]),
            highest_origin: Wide::splat(simd, origins[1]),
            low_near: Wide::splat(simd, low_near),
            high_near: Wide::splat(simd, high_near),
            high_far: Wide::splat(simd, high_far),
            low_far: Wide::splat(simd, low_far),
            unbounded: Wide::splat(simd, unbounded),
        }
    }

    /// Returns bounds of t between which rays are between the planes.
    #[inline(always)]
    fn interval(&self, low: Wide<T, S>, high: Wide<T, S>) -> [Wide<T, S>; 2] {
        let (low, high) = (low - self.highest_origin, high - self.lowest_origin);
        [
            (low * self.low_near).max(high * self.high_near),
            (high * self.high_far).max(low * self.low_far) + self.unbounded,
        ]
    }
}

/// The slabs of all three axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slabs<T, S: Lanes<T>>(
    pub(super) Slab<T, S>,
    pub(super) Slab<T, S>,
    pub(super) Slab<T, S>,
);

impl<T: Real, S: Lanes<T>> Slabs<T, S> {
    /// Returns a mask of the boxes that no ray enters before `limit`, and a lower bound of t for entering
    /// each box.
    #[inline(always)]
    pub(super) fn misses(
        &self,
        simd: S,
        lows: [Wide<T, S>; 3],
        highs: [Wide<T, S>; 3],
        limit: Wide<T, S>,
    ) -> (u32, Wide<T, S>) {
        let [near_x, far_x] = self.0.interval(lows[0], highs[0]);
        let [near_y, far_y] = self.1.interval(lows[1], highs[1]);
        let [near_z, far_z] = self.2.interval(lows[2], highs[2]);
        let near = near_x.max(near_y).max(near_z.max(Wide::splat(simd, T::zero())));
        let far = far_x.min(far_y).min(far_z.min(limit));
        // NaN does not exclude a box.
        (simd.bits(far.less(near)), near)
    }
}
