//! Vectors of lanes with arithmetic operators.

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_traits::Float;

use super::{Lanes, MAX_LANES};

/// One number per lane, with operators.
#[derive(Debug)]
pub(in super::super) struct Wide<T, S: Lanes<T>> {
    simd: S,
    pub(in super::super) numbers: S::Numbers,
}

impl<T, S: Lanes<T>> Clone for Wide<T, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<T, S: Lanes<T>> Copy for Wide<T, S> {}

impl<T, S: Lanes<T>> Wide<T, S> {
    #[inline(always)]
    fn with_numbers(self, numbers: S::Numbers) -> Self {
        Self {
            simd: self.simd,
            numbers,
        }
    }
    #[inline(always)]
    pub(in super::super) fn splat(simd: S, value: T) -> Self {
        Self {
            simd,
            numbers: simd.splat(value),
        }
    }
    /// Loads the first numbers of a slice, one per lane.
    #[inline(always)]
    pub(in super::super) fn load(simd: S, from: &[T]) -> Self {
        Self {
            simd,
            numbers: simd.load(from),
        }
    }
    #[inline(always)]
    pub(in super::super) fn store(self, to: &mut [T]) {
        self.simd.store(self.numbers, to);
    }
    /// Minimum over all lanes; any of them if one is NaN.
    #[inline(always)]
    pub(in super::super) fn reduce_min(self) -> T {
        self.simd.reduce_min(self.numbers)
    }
    /// Maximum over all lanes; any of them if one is NaN.
    #[inline(always)]
    pub(in super::super) fn reduce_max(self) -> T {
        self.simd.reduce_max(self.numbers)
    }
    /// Sum over all lanes, which may only be compared with 0.
    #[inline(always)]
    pub(in super::super) fn reduce_sum(self) -> T {
        self.simd.reduce_sum(self.numbers)
    }
    #[inline(always)]
    pub(in super::super) fn sqrt(self) -> Self {
        self.with_numbers(self.simd.sqrt(self.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn abs(self) -> Self {
        self.with_numbers(self.simd.abs(self.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn and(self, other: Self) -> Self {
        self.with_numbers(self.simd.and(self.numbers, other.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn or(self, other: Self) -> Self {
        self.with_numbers(self.simd.or(self.numbers, other.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn min(self, other: Self) -> Self {
        self.with_numbers(self.simd.min(self.numbers, other.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn max(self, other: Self) -> Self {
        self.with_numbers(self.simd.max(self.numbers, other.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn less(self, other: Self) -> S::Mask {
        self.simd.less(self.numbers, other.numbers)
    }
    #[inline(always)]
    pub(in super::super) fn less_or_equal(self, other: Self) -> S::Mask {
        self.simd.less_or_equal(self.numbers, other.numbers)
    }
    #[inline(always)]
    pub(in super::super) fn equal(self, other: Self) -> S::Mask {
        self.simd.equal(self.numbers, other.numbers)
    }
    /// Returns the lanes in which `self` < `other`, as bits.
    #[inline(always)]
    pub(in super::super) fn is_less(self, other: Self) -> u32 {
        self.simd.bits(self.less(other))
    }
    #[inline(always)]
    pub(in super::super) fn select(self, mask: S::Mask, no: Self) -> Self {
        self.with_numbers(self.simd.select(mask, self.numbers, no.numbers))
    }
}

impl<T: Float, S: Lanes<T>> Wide<T, S> {
    /// Returns the numbers; entries beyond the lanes are 0.
    #[inline(always)]
    pub(in super::super) fn to_array(self) -> [T; MAX_LANES] {
        let mut numbers = [T::zero(); MAX_LANES];
        self.store(&mut numbers);
        numbers
    }
    /// Returns the number itself if it is positive, else 0; 0 for NaN.
    #[inline(always)]
    pub(in super::super) fn positive(self) -> Self {
        let zero = Self::splat(self.simd, T::zero());
        self.select(zero.less(self), zero)
    }
    /// Replaces each number whose bit is set by a function of it.
    #[inline(always)]
    pub(in super::super) fn map(self, bits: u32, function: impl Fn(T) -> T) -> Self {
        let mut numbers = self.to_array();
        for lane in lanes_of(bits) {
            numbers[lane] = function(numbers[lane]);
        }
        Self::load(self.simd, &numbers)
    }
}

/// Iterates over the lanes whose bits are set.
#[inline(always)]
pub(in super::super) fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        // Within the bounds of arrays, which are not checked then.
        (lane < 32).then_some(lane % MAX_LANES)
    })
}

macro_rules! operator {
    ($($operator:ident $name:ident),*) => {
        $(impl<T, S: Lanes<T>> $operator for Wide<T, S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.with_numbers(self.simd.$name(self.numbers, other.numbers))
            }
        })*
    };
}
operator!(Add add, Sub sub, Mul mul, Div div);

impl<T, S: Lanes<T>> Neg for Wide<T, S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.with_numbers(self.simd.neg(self.numbers))
    }
}

/// A three-component vector per lane.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Wide3<T, S: Lanes<T>>(
    pub(in super::super) Wide<T, S>,
    pub(in super::super) Wide<T, S>,
    pub(in super::super) Wide<T, S>,
);

impl<T: Copy, S: Lanes<T>> Wide3<T, S> {
    #[inline(always)]
    pub(in super::super) fn splat(simd: S, [x, y, z]: [T; 3]) -> Self {
        Self(Wide::splat(simd, x), Wide::splat(simd, y), Wide::splat(simd, z))
    }
    /// Loads one vector per lane, from index `at` on.
    #[inline(always)]
    pub(in super::super) fn load<const N: usize>(simd: S, [x, y, z]: &[[T; N]; 3], at: usize) -> Self {
        Self(
            Wide::load(simd, &x[at..]),
            Wide::load(simd, &y[at..]),
            Wide::load(simd, &z[at..]),
        )
    }
    /// Loads one vector per lane from slices of components.
    #[inline(always)]
    pub(in super::super) fn load_slices(simd: S, [x, y, z]: [&[T]; 3]) -> Self {
        Self(Wide::load(simd, x), Wide::load(simd, y), Wide::load(simd, z))
    }
    /// Multiplies component by component.
    #[inline(always)]
    pub(in super::super) fn times(self, other: Self) -> Self {
        Self(self.0 * other.0, self.1 * other.1, self.2 * other.2)
    }
    /// The cross product, in the order of glam.
    #[inline(always)]
    pub(in super::super) fn cross(self, other: Self) -> Self {
        Self(
            self.1 * other.2 - other.1 * self.2,
            self.2 * other.0 - other.2 * self.0,
            self.0 * other.1 - other.0 * self.1,
        )
    }
    #[inline(always)]
    pub(in super::super) fn select(self, mask: S::Mask, no: Self) -> Self {
        Self(
            self.0.select(mask, no.0),
            self.1.select(mask, no.1),
            self.2.select(mask, no.2),
        )
    }
    /// (x·x + y·y) + z·z, in the order of glam.
    #[inline(always)]
    pub(in super::super) fn dot(self, other: Self) -> Wide<T, S> {
        self.0 * other.0 + self.1 * other.1 + self.2 * other.2
    }
}

impl<T, S: Lanes<T>> Neg for Wide3<T, S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1, -self.2)
    }
}

macro_rules! vector_operator {
    ($($operator:ident $name:ident),*) => {
        $(impl<T, S: Lanes<T>> $operator for Wide3<T, S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0.$name(other.0), self.1.$name(other.1), self.2.$name(other.2))
            }
        })*
    };
}
vector_operator!(Add add, Sub sub);

macro_rules! vector_scalar_operator {
    ($($operator:ident $name:ident),*) => {
        $(impl<T, S: Lanes<T>> $operator<Wide<T, S>> for Wide3<T, S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Wide<T, S>) -> Self {
                Self(self.0.$name(other), self.1.$name(other), self.2.$name(other))
            }
        })*
    };
}
vector_scalar_operator!(Mul mul, Div div);

impl<T: Float, S: Lanes<T>> Wide3<T, S> {
    /// Scales each vector near 1 by a power of two, so that no square overflows, and returns that power.
    /// Vectors whose size is zero, subnormal or not finite are not scaled.
    #[inline(always)]
    fn scaled(self, simd: S) -> (Self, Wide<T, S>) {
        let [one, smallest_normal, infinity] =
            [T::one(), T::min_positive_value(), T::infinity()].map(|number| Wide::splat(simd, number));
        let Self(x, y, z) = self;
        let size = x.max(-x).max(y.max(-y)).max(z.max(-z));
        // Keep the exponent bits only.
        let power = size.and(infinity);
        let power = power.select(smallest_normal.less_or_equal(size), one);
        let power = power.select(size.less(infinity), one);
        (self * (one / power), power)
    }

    /// Normalizes each vector; see [`Vector::normalize`](crate::real::Vector::normalize).
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

/// [`MAX_LANES`] vectors as a structure of arrays.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Columns<T>([[T; MAX_LANES]; 3]);

impl<T: Float, S: Lanes<T>> From<Wide3<T, S>> for Columns<T> {
    #[inline(always)]
    fn from(vectors: Wide3<T, S>) -> Self {
        Self([vectors.0.to_array(), vectors.1.to_array(), vectors.2.to_array()])
    }
}

impl<T: Copy> Columns<T> {
    /// Repeats one vector.
    pub(in super::super) fn splat([x, y, z]: [T; 3]) -> Self {
        Self([[x; MAX_LANES], [y; MAX_LANES], [z; MAX_LANES]])
    }

    #[inline]
    pub(in super::super) fn get(&self, at: usize) -> [T; 3] {
        [self.0[0][at], self.0[1][at], self.0[2][at]]
    }

    #[inline]
    pub(in super::super) fn set(&mut self, at: usize, [x, y, z]: [T; 3]) {
        self.0[0][at] = x;
        self.0[1][at] = y;
        self.0[2][at] = z;
    }

    /// Loads one vector per lane, from index `at` on.
    #[inline(always)]
    pub(in super::super) fn load<S: Lanes<T>>(&self, simd: S, at: usize) -> Wide3<T, S> {
        Wide3::load(simd, &self.0, at)
    }
}
