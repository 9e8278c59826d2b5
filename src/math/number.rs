//! What the functions are written over.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or what stands for one in a program that is being written.
///
/// All operations are exact or correctly rounded. No context is passed: a literal is made beside a value that there is already.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// What a comparison gives.
    type Truth: Copy + BitAnd<Output = Self::Truth> + BitOr<Output = Self::Truth> + Not<Output = Self::Truth>;

    /// `value`, rounded to this type.
    #[must_use]
    fn literal(self, value: f64) -> Self;

    /// The square root, correctly rounded; NaN below zero.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Without its sign.
    #[must_use]
    fn abs(self) -> Self;

    /// The largest integer that is not larger.
    #[must_use]
    fn floor(self) -> Self;

    /// `self < other`; false where one is NaN.
    fn less(self, other: Self) -> Self::Truth;

    /// `yes` where `truth` holds, `no` elsewhere. Both have been computed.
    #[must_use]
    fn select(truth: Self::Truth, yes: Self, no: Self) -> Self;

    /// GLSL's `min`: the other one if it is less.
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(other.less(self), other, self)
    }

    /// GLSL's `max`: the other one if it is greater.
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(self.less(other), other, self)
    }
}

macro_rules! number {
    ($float:ty) => {
        impl Number for $float {
            type Truth = bool;

            #[inline]
            fn literal(self, value: f64) -> Self {
                value as Self
            }

            #[inline]
            fn sqrt(self) -> Self {
                <$float>::sqrt(self)
            }

            #[inline]
            fn abs(self) -> Self {
                <$float>::abs(self)
            }

            #[inline]
            fn floor(self) -> Self {
                <$float>::floor(self)
            }

            #[inline]
            fn less(self, other: Self) -> bool {
                self < other
            }

            #[inline]
            fn select(truth: bool, yes: Self, no: Self) -> Self {
                if truth { yes } else { no }
            }
        }
    };
}

number!(f32);
number!(f64);
