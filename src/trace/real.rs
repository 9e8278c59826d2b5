//! The number types that a scene is traced in.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::{DVec3, Vec3};
use num_traits::Float;

/// f32 or f64, with the vector of glam's that carries it.
pub trait Real: Float + Debug + Send + Sync + 'static {
    /// Three components of this type.
    type Vec3: Vector<Self>;

    /// The nearest value of this type.
    fn from_f64(value: f64) -> Self;

    /// The same value; exact.
    fn to_f64(self) -> f64;

    /// sin by libm: the same bits on every platform, unlike the system's.
    #[must_use]
    fn sine(self) -> Self;
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

    /// The components.
    fn to_array(self) -> [T; 3];

    /// The scalar product.
    fn dot(self, other: Self) -> T;

    /// Of length 1, in the same direction.
    #[must_use]
    fn normalize(self) -> Self;
}

macro_rules! real {
    ($scalar:ty, $vector:ty, $sine:path) => {
        impl Real for $scalar {
            type Vec3 = $vector;

            fn from_f64(value: f64) -> Self {
                value as Self
            }

            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            fn sine(self) -> Self {
                $sine(self)
            }
        }

        impl Vector<$scalar> for $vector {
            const ZERO: Self = Self::ZERO;

            fn from_f64(components: [f64; 3]) -> Self {
                Self::from_array(components.map(<$scalar>::from_f64))
            }

            fn new(x: $scalar, y: $scalar, z: $scalar) -> Self {
                Self::new(x, y, z)
            }

            fn to_array(self) -> [$scalar; 3] {
                Self::to_array(&self)
            }

            fn dot(self, other: Self) -> $scalar {
                Self::dot(self, other)
            }

            fn normalize(self) -> Self {
                self / Self::length(self)
            }
        }
    };
}

real!(f32, Vec3, libm::sinf);
real!(f64, DVec3, libm::sin);
