//! Number types for tracing.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::{DVec3, Vec3};
use num_traits::Float;

use crate::lanes::Vectorized;

/// A floating-point type, f32 or f64, with its glam vector.
pub trait Real: Float + Vectorized + Debug + Send + Sync + 'static {
    /// The three-component vector of this type.
    type Vec3: Vector<Self>;

    /// Rounds to the nearest value of this type.
    fn from_f64(value: f64) -> Self;

    /// Converts to f64 exactly.
    fn to_f64(self) -> f64;

    /// Computes sin and cos by libm, whose bits are the same on every platform, unlike the system library's.
    fn sine_and_cosine(self) -> (Self, Self);

    /// Computes pow by libm.
    #[must_use]
    fn power(self, exponent: Self) -> Self;

    /// Computes the natural logarithm by libm.
    #[must_use]
    fn logarithm(self) -> Self;

    /// Returns the largest power of two not above `self`, which must be positive, normal and finite.
    #[must_use]
    fn power_of_two(self) -> Self;

    /// Encodes an integer in the bits of a float, which is not valid for arithmetic.
    fn tag(number: u32) -> Self;

    /// Decodes the integer of [`Real::tag`].
    fn untag(self) -> u32;
}

/// A three-component vector.
pub trait Vector<T>:
    Copy
    + Debug
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<T, Output = Self>
    + Div<T, Output = Self>
    + Neg<Output = Self>
{
    /// The zero vector.
    const ZERO: Self;

    /// Rounds each component to the nearest value.
    fn from_f64(components: [f64; 3]) -> Self;

    /// Creates a vector from its components.
    fn new(x: T, y: T, z: T) -> Self;

    /// Creates a vector from an array.
    fn from_array(components: [T; 3]) -> Self;

    /// Returns the components.
    fn to_array(self) -> [T; 3];

    /// Computes the dot product.
    fn dot(self, other: Self) -> T;

    /// Computes the cross product.
    #[must_use]
    fn cross(self, other: Self) -> Self;

    /// Returns the largest absolute value of a component.
    fn size(self) -> T;

    /// Normalizes a vector of any nonzero length. It is first scaled by a power of two, so that no square
    /// overflows.
    #[must_use]
    fn normalize(self) -> Self;

    /// Computes the length, with the same scaling.
    fn length(self) -> T;
}

/// Returns the power of two that scales a vector of this size near 1, or 1 if `size` is not a normal number.
/// Its reciprocal is exact.
#[inline]
fn scale<T: Real>(size: T) -> T {
    if size.is_normal() {
        size.power_of_two()
    } else {
        T::one()
    }
}

macro_rules! real {
    ($scalar:ty, $vector:ty, $sine_and_cosine:path, $power:path, $logarithm:path) => {
        impl Real for $scalar {
            type Vec3 = $vector;

            #[inline]
            fn from_f64(value: f64) -> Self {
                value as Self
            }

            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline]
            fn sine_and_cosine(self) -> (Self, Self) {
                $sine_and_cosine(self)
            }

            #[inline]
            fn power(self, exponent: Self) -> Self {
                $power(self, exponent)
            }

            #[inline]
            fn logarithm(self) -> Self {
                $logarithm(self)
            }

            #[inline]
            fn power_of_two(self) -> Self {
                Self::from_bits(self.to_bits() & Self::INFINITY.to_bits())
            }

            #[inline]
            fn tag(number: u32) -> Self {
                Self::from_bits(number.into())
            }

            #[inline]
            fn untag(self) -> u32 {
                self.to_bits() as u32
            }
        }

        impl Vector<$scalar> for $vector {
            const ZERO: Self = Self::ZERO;

            #[inline]
            fn from_f64(components: [f64; 3]) -> Self {
                Self::from_array(components.map(<$scalar>::from_f64))
            }

            #[inline]
            fn new(x: $scalar, y: $scalar, z: $scalar) -> Self {
                Self::new(x, y, z)
            }

            #[inline]
            fn from_array(components: [$scalar; 3]) -> Self {
                Self::from_array(components)
            }

            #[inline]
            fn to_array(self) -> [$scalar; 3] {
                Self::to_array(&self)
            }

            #[inline]
            fn dot(self, other: Self) -> $scalar {
                Self::dot(self, other)
            }

            #[inline]
            fn cross(self, other: Self) -> Self {
                Self::cross(self, other)
            }

            #[inline]
            fn size(self) -> $scalar {
                self.abs().max_element()
            }

            #[inline]
            fn normalize(self) -> Self {
                let scaled = self * scale(self.size()).recip();
                scaled / Self::length(scaled)
            }

            #[inline]
            fn length(self) -> $scalar {
                let scale = scale(self.size());
                Self::length(self * scale.recip()) * scale
            }
        }
    };
}

real!(f32, Vec3, libm::sincosf, libm::powf, libm::logf);
real!(f64, DVec3, libm::sincos, libm::pow, libm::log);
