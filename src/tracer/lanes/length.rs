//! Lengths of vectors, in lanes: what [`Vector`](super::super::real::Vector) says of one.

use num_traits::Float;

use super::{Lanes, Wide, Wide3};

impl<T: Float, S: Lanes<T>> Wide3<T, S> {
    /// Each vector brought near 1 by a power of two, so that no square overflows, and that power; what has no size stays
    /// as it is.
    #[inline(always)]
    fn scaled(self, simd: S) -> (Self, Wide<T, S>) {
        let [one, least, infinity] =
            [T::one(), T::min_positive_value(), T::infinity()].map(|number| Wide::splat(simd, number));
        let Self(x, y, z) = self;
        let size = x.max(-x).max(y.max(-y)).max(z.max(-z));
        // The exponent alone.
        let power = size.and(infinity);
        let power = power.select(least.less_or_equal(size), one);
        let power = power.select(size.less(infinity), one);
        (self * (one / power), power)
    }

    /// Of length 1, in the same direction.
    #[inline(always)]
    pub(in super::super) fn normalize(self, simd: S) -> Self {
        let (scaled, _) = self.scaled(simd);
        scaled / scaled.dot(scaled).sqrt()
    }

    #[inline(always)]
    pub(in super::super) fn length(self, simd: S) -> Wide<T, S> {
        let (scaled, power) = self.scaled(simd);
        scaled.dot(scaled).sqrt() * power
    }
}
