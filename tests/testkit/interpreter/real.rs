//! The number types of the interpreter: f32 as in strict shaders, and f64.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use toyproof::math::native::{self, flush};
use toyproof::math::{Number, double};

/// A number type. Arithmetic and the functions of §8 that `toyproof::math` composes come from [`Number`].
pub trait Real: Number<Bool = bool> + Debug + PartialOrd {
    /// The nearest number of this type.
    #[must_use]
    fn from_f64(value: f64) -> Self;
    /// The value, exactly.
    fn to_f64(self) -> f64;
    /// The nearest f32.
    fn to_f32(self) -> f32;
    /// What operations take it for: a denormal f32 is zero.
    #[must_use]
    fn operand(self) -> Self;
    /// Rounds up.
    #[must_use]
    fn ceil(self) -> Self;
    /// Rounds toward zero.
    #[must_use]
    fn trunc(self) -> Self;
    /// Rounds to the nearest integer, ties to even.
    #[must_use]
    fn round_even(self) -> Self;
    /// A function of one argument whose last bits are implementation-defined.
    #[must_use]
    fn transcendental(self, function: Transcendental) -> Self;
    /// The angle of the point (other, self), in radians.
    #[must_use]
    fn atan2(self, other: Self) -> Self;
    /// `self` to the power of `other`; NaN for a negative base.
    #[must_use]
    fn pow(self, other: Self) -> Self;

    /// Whether it is NaN.
    #[must_use]
    fn is_nan(self) -> bool {
        self.to_f64().is_nan()
    }
}

macro_rules! transcendental {
    ($($variant:ident $name:ident, $double:expr;)*) => {
        /// The functions of one argument whose last bits are implementation-defined.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Transcendental {
            $(#[doc = concat!("`", stringify!($name), "`")] $variant,)*
        }

        impl Transcendental {
            fn single(self, x: f32) -> f32 {
                match self {
                    $(Self::$variant => native::$name(x),)*
                }
            }

            fn double(self, x: f64) -> f64 {
                match self {
                    $(Self::$variant => $double(x),)*
                }
            }
        }
    };
}

/// A function of several numbers, for one.
fn in_one_lane(function: impl Fn([f64; 1]) -> [f64; 1]) -> impl Fn(f64) -> f64 {
    move |x| function([x])[0]
}

transcendental! {
    Sin sin, in_one_lane(double::sin);
    Cos cos, in_one_lane(double::cos);
    Tan tan, libm::tan;
    Asin asin, libm::asin;
    Acos acos, libm::acos;
    Atan atan, libm::atan;
    Sinh sinh, libm::sinh;
    Cosh cosh, libm::cosh;
    Tanh tanh, libm::tanh;
    Asinh asinh, libm::asinh;
    Acosh acosh, libm::acosh;
    Atanh atanh, libm::atanh;
    Exp exp, libm::exp;
    Exp2 exp2, libm::exp2;
    Log log, libm::log;
    Log2 log2, libm::log2;
}

/// An f32 whose denormals are zeros as operands, and become zeros as results; where it is moved, they keep their bits.
#[derive(Debug, Clone, Copy)]
pub struct Single(pub f32);

impl PartialEq for Single {
    fn eq(&self, other: &Self) -> bool {
        flush(self.0) == flush(other.0)
    }
}

impl PartialOrd for Single {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        flush(self.0).partial_cmp(&flush(other.0))
    }
}

macro_rules! arithmetic {
    ($($operator:ident $name:ident;)*) => {$(
        impl $operator for Single {
            type Output = Self;

            fn $name(self, other: Self) -> Self {
                Self(flush(flush(self.0).$name(flush(other.0))))
            }
        }
    )*};
}

arithmetic! {
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

impl Neg for Single {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Number for Single {
    type Bool = bool;

    fn literal(self, value: f64) -> Self {
        Self(value as f32)
    }

    fn sqrt(self) -> Self {
        Self(flush(self.0).sqrt())
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn floor(self) -> Self {
        Self(flush(self.0).floor())
    }

    fn less(self, other: Self) -> bool {
        self < other
    }

    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }
}

impl Real for Single {
    fn from_f64(value: f64) -> Self {
        Self(value as f32)
    }

    fn to_f64(self) -> f64 {
        self.0.into()
    }

    fn to_f32(self) -> f32 {
        self.0
    }

    fn operand(self) -> Self {
        Self(flush(self.0))
    }

    fn ceil(self) -> Self {
        Self(flush(self.0).ceil())
    }

    fn trunc(self) -> Self {
        Self(flush(self.0).trunc())
    }

    fn round_even(self) -> Self {
        Self(flush(self.0).round_ties_even())
    }

    fn transcendental(self, function: Transcendental) -> Self {
        Self(function.single(self.0))
    }

    fn atan2(self, other: Self) -> Self {
        Self(native::atan2(self.0, other.0))
    }

    fn pow(self, other: Self) -> Self {
        Self(native::pow(self.0, other.0))
    }
}

impl Real for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn to_f64(self) -> f64 {
        self
    }

    fn to_f32(self) -> f32 {
        self as f32
    }

    fn operand(self) -> Self {
        self
    }

    fn ceil(self) -> Self {
        f64::ceil(self)
    }

    fn trunc(self) -> Self {
        f64::trunc(self)
    }

    fn round_even(self) -> Self {
        self.round_ties_even()
    }

    fn transcendental(self, function: Transcendental) -> Self {
        function.double(self)
    }

    fn atan2(self, other: Self) -> Self {
        libm::atan2(self, other)
    }

    fn pow(self, other: Self) -> Self {
        if self < 0.0 {
            f64::NAN
        } else {
            libm::pow(self, other)
        }
    }
}
