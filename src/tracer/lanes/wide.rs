//! Lanes to reckon with as with numbers.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Lanes;

/// A number for each lane, to reckon with.
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
    fn of(self, numbers: S::Numbers) -> Self {
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
    /// The first of a slice, as many as there are lanes.
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
    /// The smallest of all lanes; any of them where one is NaN.
    #[inline(always)]
    pub(in super::super) fn least(self) -> T {
        self.simd.least(self.numbers)
    }
    /// The largest, likewise.
    #[inline(always)]
    pub(in super::super) fn greatest(self) -> T {
        self.simd.greatest(self.numbers)
    }
    /// The sum, to be asked only whether it is 0.
    #[inline(always)]
    pub(in super::super) fn sum(self) -> T {
        self.simd.sum(self.numbers)
    }
    #[inline(always)]
    pub(in super::super) fn sqrt(self) -> Self {
        self.of(self.simd.sqrt(self.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn and(self, other: Self) -> Self {
        self.of(self.simd.and(self.numbers, other.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn or(self, other: Self) -> Self {
        self.of(self.simd.or(self.numbers, other.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn min(self, other: Self) -> Self {
        self.of(self.simd.min(self.numbers, other.numbers))
    }
    #[inline(always)]
    pub(in super::super) fn max(self, other: Self) -> Self {
        self.of(self.simd.max(self.numbers, other.numbers))
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
    #[inline(always)]
    pub(in super::super) fn select(self, mask: S::Mask, no: Self) -> Self {
        self.of(self.simd.select(mask, self.numbers, no.numbers))
    }
}

macro_rules! operator {
    ($($operator:ident $name:ident),*) => {
        $(impl<T, S: Lanes<T>> $operator for Wide<T, S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.of(self.simd.$name(self.numbers, other.numbers))
            }
        })*
    };
}
operator!(Add add, Sub sub, Mul mul, Div div);

impl<T, S: Lanes<T>> Neg for Wide<T, S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.of(self.simd.neg(self.numbers))
    }
}

/// Three components for each lane.
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
    /// As many as there are lanes, from `at` on.
    #[inline(always)]
    pub(in super::super) fn load<const N: usize>(simd: S, [x, y, z]: &[[T; N]; 3], at: usize) -> Self {
        Self(
            Wide::load(simd, &x[at..]),
            Wide::load(simd, &y[at..]),
            Wide::load(simd, &z[at..]),
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
    /// (x·x + y·y) + z·z, as glam's.
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

macro_rules! of_vectors {
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
of_vectors!(Add add, Sub sub);

macro_rules! of_vectors_and_numbers {
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
of_vectors_and_numbers!(Mul mul, Div div);
