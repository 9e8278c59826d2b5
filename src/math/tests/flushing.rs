//! A reading for tests: f32 whose denormals are flushed on the way into and out of every operation.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::super::{Float, Number, Word};

#[derive(Debug, Clone, Copy)]
pub(super) struct Flushing(f32);

pub(super) fn flush(x: f32) -> f32 {
    if x.is_subnormal() { 0.0_f32.copysign(x) } else { x }
}

impl Flushing {
    pub(super) fn new(x: f32) -> Self {
        Self(flush(x))
    }

    pub(super) fn get(self) -> f32 {
        flush(self.0)
    }
}

macro_rules! operators {
    ($($operator:ident $name:ident;)*) => {$(
        impl $operator for Flushing {
            type Output = Self;

            fn $name(self, other: Self) -> Self {
                Self::new(self.get().$name(other.get()))
            }
        }

        impl $operator<f32> for Flushing {
            type Output = Self;

            fn $name(self, other: f32) -> Self {
                self.$name(Self(other))
            }
        }
    )*};
}

operators! {
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

impl Neg for Flushing {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.0)
    }
}

impl Number for Flushing {
    type Truth = bool;

    fn literal(self, value: f64) -> Self {
        Self(value as f32)
    }

    fn sqrt(self) -> Self {
        Self::new(self.get().sqrt())
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn floor(self) -> Self {
        Self(self.get().floor())
    }

    fn less(self, other: Self) -> bool {
        self.get() < other.get()
    }

    fn select(truth: bool, yes: Self, no: Self) -> Self {
        if truth { yes } else { no }
    }
}

impl Float for Flushing {
    type Bits = Word;

    fn to_bits(self) -> Word {
        Word(self.0.to_bits())
    }

    fn from_bits(bits: Word) -> Self {
        Self(f32::from_bits(bits.0))
    }

    fn from_signed(bits: Word) -> Self {
        Self(bits.0.cast_signed() as f32)
    }
}
