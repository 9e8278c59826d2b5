//! Where all rays of a packet are between two planes at right angles to an axis, by interval arithmetic.

use super::super::lanes::{Lanes, Wide};
use super::super::real::Real;
use super::block::margin;

/// The number, or one of its sign that is as near to 0 as can be divided by.
#[inline(always)]
pub(super) fn away_from_zero<T: Real>(number: T) -> T {
    let tiny = T::min_positive_value();
    if number.abs() < tiny {
        tiny.copysign(number)
    } else {
        number
    }
}

/// One component of the origins and directions of rays.
///
/// With the planes at l and h from the origins, no ray is between them before
/// max(l·`low_near`, h·`high_near`) or after max(h·`high_far`, l·`low_far`) + `endless`. Where all
/// directions have one sign, two of the four factors are 0; where they do not, a ray may go along the planes for ever.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slab<T, S: Lanes<T>> {
    lowest_origin: Wide<T, S>,
    highest_origin: Wide<T, S>,
    low_near: Wide<T, S>,
    high_near: Wide<T, S>,
    high_far: Wide<T, S>,
    low_far: Wide<T, S>,
    endless: Wide<T, S>,
}

impl<T: Real, S: Lanes<T>> Slab<T, S> {
    /// For origins and directions from the lowest to the highest.
    #[inline(always)]
    pub(super) fn new(simd: S, origins: [T; 2], [low, high]: [T; 2]) -> Self {
        let (zero, tiny) = (T::zero(), T::min_positive_value());
        let (near, far) = (T::one() - margin(), T::one() + margin());
        let [low_near, high_near, high_far, low_far, endless] = if low >= tiny {
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
            endless: Wide::splat(simd, endless),
        }
    }

    /// Between which t's rays are between the planes.
    #[inline(always)]
    fn cross(&self, low: Wide<T, S>, high: Wide<T, S>) -> [Wide<T, S>; 2] {
        let (low, high) = (low - self.highest_origin, high - self.lowest_origin);
        [
            (low * self.low_near).max(high * self.high_near),
            (high * self.high_far).max(low * self.low_far) + self.endless,
        ]
    }
}

/// All three components.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slabs<T, S: Lanes<T>>(
    pub(super) Slab<T, S>,
    pub(super) Slab<T, S>,
    pub(super) Slab<T, S>,
);

impl<T: Real, S: Lanes<T>> Slabs<T, S> {
    /// The boxes that no ray crosses before `limit`, bit by bit, and the t's before which none comes to each.
    #[inline(always)]
    pub(super) fn misses(
        &self,
        simd: S,
        lows: [Wide<T, S>; 3],
        highs: [Wide<T, S>; 3],
        limit: Wide<T, S>,
    ) -> (u32, Wide<T, S>) {
        let [near_x, far_x] = self.0.cross(lows[0], highs[0]);
        let [near_y, far_y] = self.1.cross(lows[1], highs[1]);
        let [near_z, far_z] = self.2.cross(lows[2], highs[2]);
        let near = near_x.max(near_y).max(near_z.max(Wide::splat(simd, T::zero())));
        let far = far_x.min(far_y).min(far_z.min(limit));
        // What is NaN is not left out.
        (simd.bits(far.less(near)), near)
    }
}
