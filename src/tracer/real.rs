//! The number types that a scene is traced in.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::{DVec3, Vec3};
use num_traits::Float;

use super::lanes::Vectorised;

/// f32 or f64, with the vector of glam's that carries it.
pub trait Real: Float + Vectorised + Debug + Send + Sync + 'static {
    /// Three components of this type.
    type Vec3: Vector<Self>;

    /// The nearest value of this type.
    fn from_f64(value: f64) -> Self;

    /// The same value; exact.
    fn to_f64(self) -> f64;

    /// sin and cos by libm: the same bits on every platform, unlike the system's.
    #[must_use]
    fn sine_and_cosine(self) -> (Self, Self);

    /// pow by libm.
    #[must_use]
    fn power(self, exponent: Self) -> Self;

    /// ln by libm.
    #[must_use]
    fn logarithm(self) -> Self;

    /// The largest power of two that is not above this, which is positive, normal and finite.
    #[must_use]
    fn power_of_two(self) -> Self;

    /// Bits that stand for a number of something. They are not to be reckoned with.
    #[must_use]
    fn tag(number: u32) -> Self;

    /// What [`Real::tag`] was given.
    #[must_use]
    fn untag(self) -> u32;
}

/// Three components.
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
    /// All components 0.
    const ZERO: Self;

    /// Each component rounded to the nearest value.
    fn from_f64(components: [f64; 3]) -> Self;

    /// From components.
    fn new(x: T, y: T, z: T) -> Self;

    /// From components.
    fn from_array(components: [T; 3]) -> Self;

    /// The components.
    fn to_array(self) -> [T; 3];

    /// The scalar product.
    fn dot(self, other: Self) -> T;

    /// The vector product.
    #[must_use]
    fn cross(self, other: Self) -> Self;

    /// The largest absolute value of a component.
    fn size(self) -> T;

    /// Of length 1, in the same direction, for any length that is not 0: it is scaled by a power of two first,
    /// so that no square overflows.
    #[must_use]
    fn normalize(self) -> Self;

    /// The length, likewise.
    fn length(self) -> T;
}

/// The power of two that brings a vector of that size near 1; 1 for what has no size. Its reciprocal is exact.
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
