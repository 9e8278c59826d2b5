//! 32-bit floats that can be taken apart: what the transcendental functions are written over.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Shl, Shr, Sub};

use super::Number;

/// A 32-bit float.
///
/// Operations on denormal operands or with denormal results are never part of an answer (drivers flush them, and Rust does not):
/// the functions keep out of their way, and tests hold them to it.
pub trait Float:
    Number<Truth = <Self::Bits as Bits>::Truth>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
{
    /// 32-bit integers.
    type Bits: Bits;

    /// The encoding.
    fn to_bits(self) -> Self::Bits;

    /// The float that is so encoded.
    #[must_use]
    fn from_bits(bits: Self::Bits) -> Self;

    /// The nearest float to an integer in two's complement.
    #[must_use]
    fn from_signed(bits: Self::Bits) -> Self;
}

/// 32-bit integers: arithmetic wraps, comparisons are of unsigned numbers, shifts by less than 32
/// that bring in zeros.
pub trait Bits:
    Copy
    + Add<Output = Self>
    + Add<u32, Output = Self>
    + Sub<Output = Self>
    + Sub<u32, Output = Self>
    + Mul<Output = Self>
    + BitAnd<u32, Output = Self>
    + BitOr<Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
{
    /// What a comparison gives.
    type Truth: Copy + BitAnd<Output = Self::Truth> + BitOr<Output = Self::Truth> + Not<Output = Self::Truth>;

    /// `value`.
    #[must_use]
    fn literal(self, value: u32) -> Self;

    /// Shifted to the left, by less than 32.
    #[must_use]
    fn left(self, by: Self) -> Self;

    /// Shifted to the right, by less than 32; zeros come in.
    #[must_use]
    fn right(self, by: Self) -> Self;

    /// `self < other`
    fn less(self, other: Self) -> Self::Truth;

    /// `yes` where `truth` holds, `no` elsewhere.
    #[must_use]
    fn select(truth: Self::Truth, yes: Self, no: Self) -> Self;
}

/// A 32-bit integer of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word(pub u32);

impl Float for f32 {
    type Bits = Word;

    #[inline]
    fn to_bits(self) -> Word {
        Word(self.to_bits())
    }

    #[inline]
    fn from_bits(bits: Word) -> Self {
        f32::from_bits(bits.0)
    }

    #[inline]
    fn from_signed(bits: Word) -> Self {
        bits.0.cast_signed() as f32
    }
}

impl Bits for Word {
    type Truth = bool;

    #[inline]
    fn literal(self, value: u32) -> Self {
        Self(value)
    }

    #[inline]
    fn left(self, by: Self) -> Self {
        self << by.0
    }

    #[inline]
    fn right(self, by: Self) -> Self {
        self >> by.0
    }

    #[inline]
    fn less(self, other: Self) -> bool {
        self.0 < other.0
    }

    #[inline]
    fn select(truth: bool, yes: Self, no: Self) -> Self {
        if truth { yes } else { no }
    }
}

macro_rules! operators {
    ($($operator:ident $name:ident $native:path;)*) => {$(
        impl $operator for Word {
            type Output = Self;

            #[inline]
            fn $name(self, other: Self) -> Self {
                Self($native(self.0, other.0))
            }
        }

        impl $operator<u32> for Word {
            type Output = Self;

            #[inline]
            fn $name(self, other: u32) -> Self {
                Self($native(self.0, other))
            }
        }
    )*};
}

operators! {
    Add add u32::wrapping_add;
    Sub sub u32::wrapping_sub;
    Mul mul u32::wrapping_mul;
    BitAnd bitand BitAnd::bitand;
    BitOr bitor BitOr::bitor;
}

impl Shl<u32> for Word {
    type Output = Self;

    #[inline]
    fn shl(self, by: u32) -> Self {
        Self(self.0.wrapping_shl(by))
    }
}

impl Shr<u32> for Word {
    type Output = Self;

    #[inline]
    fn shr(self, by: u32) -> Self {
        Self(self.0.wrapping_shr(by))
    }
}
