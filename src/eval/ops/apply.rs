//! What each operation makes of components.

use toyproof_math::native::flush;

use super::half;
use crate::ir::operation::{Operation, for_each_operation};
use crate::number::Number;

/// An operation with one operand.
pub(super) trait Of1<N: Number, A, R> {
    fn apply(a: A, noise: N::Noise) -> R;
}

/// An operation with two.
pub(super) trait Of2<N: Number, A, B, R> {
    fn apply(a: A, b: B, noise: N::Noise) -> R;
}

/// An operation with three.
pub(super) trait Of3<N: Number, A, B, C, R> {
    fn apply(a: A, b: B, c: C, noise: N::Noise) -> R;
}

/// The type of a kind of component, where `N` is the number type.
macro_rules! ty {
    (F) => {
        N
    };
    (W) => {
        u32
    };
}
pub(super) use ty;

macro_rules! apply {
    ($($name:ident($($operand:ident: $kind:ident),+) $result:ident = |$noise:pat_param| $value:expr;)*) => {$(
        apply!(@ $name ($($operand: $kind),+) $result $noise, $value);
    )*};
    (@ $name:ident ($a:ident: $ka:ident) $result:ident $noise:pat_param, $value:expr) => {
        pub(super) struct $name;
        impl<N: Number> Of1<N, ty!($ka), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
    (@ $name:ident ($a:ident: $ka:ident, $b:ident: $kb:ident) $result:ident $noise:pat_param, $value:expr) => {
        pub(super) struct $name;
        impl<N: Number> Of2<N, ty!($ka), ty!($kb), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $b: ty!($kb), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
    (@ $name:ident ($a:ident: $ka:ident, $b:ident: $kb:ident, $c:ident: $kc:ident) $result:ident $noise:pat_param, $value:expr) => {
        pub(super) struct $name;
        impl<N: Number> Of3<N, ty!($ka), ty!($kb), ty!($kc), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $b: ty!($kb), $c: ty!($kc), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
}

/// A `bool`: all bits, or none.
#[inline(always)]
fn truth(value: bool) -> u32 {
    u32::from(value).wrapping_neg()
}

apply! {
    Add(a: F, b: F) F = |noise| a.add(b, noise);
    Sub(a: F, b: F) F = |noise| a.sub(b, noise);
    Mul(a: F, b: F) F = |noise| a.mul(b, noise);
    Div(a: F, b: F) F = |noise| a.div(b, noise);
    MulAdd(a: F, b: F, c: F) F = |noise| a.mul(b, noise).add(c, noise);
    MulSub(a: F, b: F, c: F) F = |noise| a.mul(b, noise).sub(c, noise);
    SubMul(a: F, b: F, c: F) F = |noise| c.sub(a.mul(b, noise), noise);
    // Of NaN, and of zeros of different signs, the second: as lavapipe and SwiftShader.
    Min(a: F, b: F) F = |_| if a < b { a } else { b };
    Max(a: F, b: F) F = |_| if a > b { a } else { b };
    Neg(a: F) F = |_| a.neg();
    Abs(a: F) F = |_| a.abs();
    Sqrt(a: F) F = |noise| a.sqrt(noise);
    Floor(a: F) F = |_| a.floor();
    Ceil(a: F) F = |_| a.ceil();
    Trunc(a: F) F = |_| a.trunc();
    RoundEven(a: F) F = |_| a.round_even();
    Sin(a: F) F = |noise| a.sin(noise);
    Cos(a: F) F = |noise| a.cos(noise);
    Tan(a: F) F = |noise| a.tan(noise);
    Asin(a: F) F = |noise| a.asin(noise);
    Acos(a: F) F = |noise| a.acos(noise);
    Atan(a: F) F = |noise| a.atan(noise);
    Atan2(a: F, b: F) F = |noise| a.atan2(b, noise);
    Sinh(a: F) F = |noise| a.sinh(noise);
    Cosh(a: F) F = |noise| a.cosh(noise);
    Tanh(a: F) F = |noise| a.tanh(noise);
    Asinh(a: F) F = |noise| a.asinh(noise);
    Acosh(a: F) F = |noise| a.acosh(noise);
    Atanh(a: F) F = |noise| a.atanh(noise);
    Exp(a: F) F = |noise| a.exp(noise);
    Exp2(a: F) F = |noise| a.exp2(noise);
    Log(a: F) F = |noise| a.log(noise);
    Log2(a: F) F = |noise| a.log2(noise);
    Pow(a: F, b: F) F = |noise| a.pow(b, noise);
    Less(a: F, b: F) W = |_| truth(a < b);
    LessEqual(a: F, b: F) W = |_| truth(a <= b);
    Equal(a: F, b: F) W = |_| truth(a == b);
    NotEqual(a: F, b: F) W = |_| truth(a != b);
    IsNan(a: F) W = |_| truth(a.is_nan());
    IsInf(a: F) W = |_| truth(a.abs() == N::from_f64(f64::INFINITY));
    FromInt(a: W) F = |_| N::from_f64(f64::from(a.cast_signed()));
    FromUint(a: W) F = |_| N::from_f64(f64::from(a));
    ToInt(a: F) W = |_| to_int(a.to_f64()).cast_unsigned();
    ToUint(a: F) W = |_| to_uint(a.to_f64());
    FromBits(a: W) F = |_| N::from_f64(f64::from(flush(f32::from_bits(a))));
    ToBits(a: F) W = |_| a.to_f32().to_bits();
    PackHalf(a: F, b: F) W = |_| u32::from(half::to_bits(a.to_f32())) | u32::from(half::to_bits(b.to_f32())) << 16;
    UnpackLow(a: W) F = |_| N::from_f64(f64::from(half::from_bits(a as u16)));
    UnpackHigh(a: W) F = |_| N::from_f64(f64::from(half::from_bits((a >> 16) as u16)));
    AddWord(a: W, b: W) W = |_| a.wrapping_add(b);
    SubWord(a: W, b: W) W = |_| a.wrapping_sub(b);
    MulWord(a: W, b: W) W = |_| a.wrapping_mul(b);
    // As naga guards them: by zero the quotient is the dividend, the remainder zero.
    DivInt(a: W, b: W) W = |_| if b == 0 { a } else { a.cast_signed().wrapping_div(b.cast_signed()).cast_unsigned() };
    DivUint(a: W, b: W) W = |_| a.checked_div(b).unwrap_or(a);
    // Floors, as browsers do where GLSL leaves it open.
    RemInt(a: W, b: W) W = |_| {
        let remainder = if b == 0 { 0 } else { a.cast_signed().wrapping_rem(b.cast_signed()).cast_unsigned() };
        if remainder != 0 && (remainder ^ b).cast_signed() < 0 { remainder.wrapping_add(b) } else { remainder }
    };
    RemUint(a: W, b: W) W = |_| a.checked_rem(b).unwrap_or(0);
    And(a: W, b: W) W = |_| a & b;
    Or(a: W, b: W) W = |_| a | b;
    Xor(a: W, b: W) W = |_| a ^ b;
    Not(a: W) W = |_| !a;
    NegWord(a: W) W = |_| a.wrapping_neg();
    ShiftLeft(a: W, b: W) W = |_| a.wrapping_shl(b);
    ShiftRightInt(a: W, b: W) W = |_| a.cast_signed().wrapping_shr(b).cast_unsigned();
    ShiftRightUint(a: W, b: W) W = |_| a.wrapping_shr(b);
    MinInt(a: W, b: W) W = |_| a.cast_signed().min(b.cast_signed()).cast_unsigned();
    MaxInt(a: W, b: W) W = |_| a.cast_signed().max(b.cast_signed()).cast_unsigned();
    MinUint(a: W, b: W) W = |_| a.min(b);
    MaxUint(a: W, b: W) W = |_| a.max(b);
    EqualWord(a: W, b: W) W = |_| truth(a == b);
    LessInt(a: W, b: W) W = |_| truth(a.cast_signed() < b.cast_signed());
    LessUint(a: W, b: W) W = |_| truth(a < b);
    Select(a: W, b: F, c: F) F = |_| if a != 0 { b } else { c };
    SelectWord(a: W, b: W, c: W) W = |_| if a != 0 { b } else { c };
    // Of one value for all pixels; rows have handlers of their own.
    DFdx(a: F) F = |noise| a.sub(a, noise);
    DFdy(a: F) F = |noise| a.sub(a, noise);
}

/// Towards zero; of what is too large, the largest f32 that an `int` holds: naga clamps to it before it converts.
#[inline(always)]
fn to_int(x: f64) -> i32 {
    if x < 2_147_483_648.0 {
        x as i32
    } else {
        2_147_483_520
    }
}

/// The same of `uint`.
#[inline(always)]
fn to_uint(x: f64) -> u32 {
    if x < 4_294_967_296.0 {
        x as u32
    } else {
        4_294_967_040
    }
}

/// What an operation on words makes of them, if it is one.
pub(crate) fn fold(operation: Operation, [a, b, c]: [u32; 3]) -> Option<u32> {
    macro_rules! word {
        ($name:ident(W) W) => {
            Some(<$name as Of1<f32, u32, u32>>::apply(a, ()))
        };
        ($name:ident(W, W) W) => {
            Some(<$name as Of2<f32, u32, u32, u32>>::apply(a, b, ()))
        };
        ($name:ident(W, W, W) W) => {
            Some(<$name as Of3<f32, u32, u32, u32, u32>>::apply(a, b, c, ()))
        };
        ($name:ident($($operand:ident),+) $value:ident) => {
            None
        };
    }
    macro_rules! select {
        ($($name:ident($($operand:ident),+) $value:ident,)*) => {
            match operation {
                $(Operation::$name => word!($name($($operand),+) $value),)*
            }
        };
    }
    for_each_operation!(select)
}
