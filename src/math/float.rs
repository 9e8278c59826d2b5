//! Number types of the generic functions, and bit-level helpers.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Shl, Shr, Sub};

/// A number, or a term that represents one in a graph.
///
/// All operations are exact or correctly rounded. No context is passed: `literal` makes a constant in the
/// context of an existing value.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The result of a comparison.
    type Bool: Copy + BitAnd<Output = Self::Bool> + BitOr<Output = Self::Bool> + Not<Output = Self::Bool>;

    /// The constant `value`, rounded to this type.
    #[must_use]
    fn literal(self, value: f64) -> Self;

    /// The square root, correctly rounded; NaN below zero.
    #[must_use]
    fn sqrt(self) -> Self;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// The largest integer not greater than the value.
    #[must_use]
    fn floor(self) -> Self;

    /// `self < other`; false if one is NaN.
    fn less(self, other: Self) -> Self::Bool;

    /// `yes` if `condition` holds, otherwise `no`. Both have been computed.
    fn select(condition: Self::Bool, yes: Self, no: Self) -> Self;

    /// GLSL's `min`: `other` if it is less.
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(other.less(self), other, self)
    }

    /// GLSL's `max`: `other` if it is greater.
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(self.less(other), other, self)
    }
}

macro_rules! number {
    ($float:ty) => {
        impl Number for $float {
            type Bool = bool;

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
            fn select(condition: bool, yes: Self, no: Self) -> Self {
                if condition { yes } else { no }
            }
        }
    };
}

number!(f32);
number!(f64);

// 32-bit floats with access to their encoding, for the transcendental functions.

/// A 32-bit float.
///
/// No result depends on operations with denormal operands or results, since drivers flush them and Rust does
/// not; tests verify that.
pub trait Float:
    Number<Bool = <Self::Bits as Bits>::Bool>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
{
    /// The type of the encoding.
    type Bits: Bits;

    /// The encoding.
    fn to_bits(self) -> Self::Bits;

    /// The float with that encoding.
    fn from_bits(bits: Self::Bits) -> Self;

    /// The nearest float to an integer in two's complement.
    fn from_signed(bits: Self::Bits) -> Self;
}

/// 32-bit integers: arithmetic wraps, comparisons are unsigned, shifts are logical and by less than 32.
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
    /// The result of a comparison.
    type Bool: Copy + BitAnd<Output = Self::Bool> + BitOr<Output = Self::Bool> + Not<Output = Self::Bool>;

    /// The constant `value`.
    #[must_use]
    fn literal(self, value: u32) -> Self;

    /// Shifts left, by less than 32.
    #[must_use]
    fn left(self, by: Self) -> Self;

    /// Shifts right by less than 32, filling with zeros.
    #[must_use]
    fn right(self, by: Self) -> Self;

    /// `self < other`
    fn less(self, other: Self) -> Self::Bool;

    /// `yes` if `condition` holds, otherwise `no`.
    fn select(condition: Self::Bool, yes: Self, no: Self) -> Self;
}

/// A native 32-bit integer.
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
    type Bool = bool;

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
    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
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

// Shared helpers: polynomials, signs, and classification of floats by their bits.

const SIGN_BIT: u32 = 0x8000_0000;
const INFINITY_BITS: u32 = 0x7F80_0000;

/// `c₀ + x·(c₁ + x·(c₂ + …))`, by Horner's rule.
#[inline(always)]
pub(super) fn polynomial<F: Float, const N: usize>(x: F, coefficients: [f32; N]) -> F {
    let mut sum = x * coefficients[N - 1];
    for at in (1..N - 1).rev() {
        sum = (sum + coefficients[at]) * x;
    }
    sum + coefficients[0]
}

/// The encoding without the sign bit.
#[inline(always)]
pub(super) fn magnitude<F: Float>(x: F) -> F::Bits {
    x.to_bits() & !SIGN_BIT
}

/// `−x` if the highest bit of `bits` is set, otherwise `x`.
#[inline(always)]
pub(super) fn negate_if<F: Float>(x: F, bits: F::Bits) -> F {
    // The carry out of the highest bit is lost, so adding to it flips it.
    F::from_bits(x.to_bits() + (bits & SIGN_BIT))
}

/// Whether |x| < `limit`.
#[inline(always)]
pub(super) fn is_below<F: Float>(x: F, limit: f32) -> F::Bool {
    let magnitude = magnitude(x);
    magnitude.less(magnitude.literal(limit.to_bits()))
}

/// Whether it is zero or denormal.
#[inline(always)]
pub(super) fn is_zero<F: Float>(x: F) -> F::Bool {
    is_below(x, f32::MIN_POSITIVE)
}

/// Replaces a denormal by zero; a selection alone does not flush.
#[inline(always)]
pub(super) fn flushed<F: Float>(x: F) -> F {
    let bits = x.to_bits();
    F::from_bits(F::Bits::select(is_zero(x), bits & SIGN_BIT, bits))
}

/// Whether it is neither infinite nor NaN.
#[inline(always)]
pub(super) fn is_finite<F: Float>(x: F) -> F::Bool {
    is_below(x, f32::INFINITY)
}

/// Whether it is NaN.
#[inline(always)]
pub(super) fn is_nan<F: Float>(x: F) -> F::Bool {
    let magnitude = magnitude(x);
    magnitude.literal(INFINITY_BITS).less(magnitude)
}

/// NaN.
#[inline(always)]
pub(super) fn nan<F: Float>(beside: F) -> F {
    beside.literal(f64::NAN)
}

/// +∞.
#[inline(always)]
pub(super) fn infinity<F: Float>(beside: F) -> F {
    beside.literal(f64::INFINITY)
}
