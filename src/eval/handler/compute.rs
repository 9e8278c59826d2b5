//! Operations on components, for rows and for scalars.

use std::marker::PhantomData;

use super::{Handler, Instruction, Level, One, Row, Run, Sink, Source, for_each_chunk, handler};
use crate::elementary::native::flush;
use crate::eval::batch::{Batch, LANES, Lanes};
use crate::eval::number::Number;
use crate::eval::operation::{Operation, for_each_operation};

/// An operation with one operand.
trait Of1<N: Number, A, R> {
    fn apply(a: A, noise: N::Noise) -> R;
}

/// An operation with two.
trait Of2<N: Number, A, B, R> {
    fn apply(a: A, b: B, noise: N::Noise) -> R;
}

/// An operation with three.
trait Of3<N: Number, A, B, C, R> {
    fn apply(a: A, b: B, c: C, noise: N::Noise) -> R;
}

macro_rules! ty {
    (F) => {
        N
    };
    (W) => {
        u32
    };
}

macro_rules! apply {
    ($($name:ident($($operand:ident: $kind:ident),+) $result:ident = |$noise:pat_param| $value:expr;)*) => {$(
        apply!(@ $name ($($operand: $kind),+) $result $noise, $value);
    )*};
    (@ $name:ident ($a:ident: $ka:ident) $result:ident $noise:pat_param, $value:expr) => {
        struct $name;
        impl<N: Number> Of1<N, ty!($ka), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
    (@ $name:ident ($a:ident: $ka:ident, $b:ident: $kb:ident) $result:ident $noise:pat_param, $value:expr) => {
        struct $name;
        impl<N: Number> Of2<N, ty!($ka), ty!($kb), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $b: ty!($kb), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
    (@ $name:ident ($a:ident: $ka:ident, $b:ident: $kb:ident, $c:ident: $kc:ident) $result:ident $noise:pat_param, $value:expr) => {
        struct $name;
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

/// One operand from `A`.
struct Rows1<O, A, T, R>(PhantomData<(O, A, T, R)>);

impl<N: Number, O: Of1<N, T, R>, A: Source<N, T>, T: Copy, R: Sink<N>> Run<N> for Rows1<O, A, T, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            let a = A::chunk(a, chunk);
            let mut result = [R::default(); LANES];
            for lane in 0..LANES {
                result[lane] = O::apply(a[lane], noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Two operands.
struct Rows2<O, A, B, T, U, R>(PhantomData<(O, A, B, T, U, R)>);

impl<N, O, A, B, T, U, R> Run<N> for Rows2<O, A, B, T, U, R>
where
    N: Number,
    O: Of2<N, T, U, R>,
    A: Source<N, T>,
    B: Source<N, U>,
    T: Copy,
    U: Copy,
    R: Sink<N>,
{
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let b = B::open(batch, instruction.operands[1]);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (a, b) = (A::chunk(a, chunk), B::chunk(b, chunk));
            let mut result = [R::default(); LANES];
            for lane in 0..LANES {
                result[lane] = O::apply(a[lane], b[lane], noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Three operands.
struct Rows3<O, A, B, C, T, U, R>(PhantomData<(O, A, B, C, T, U, R)>);

impl<N, O, A, B, C, T, U, R> Run<N> for Rows3<O, A, B, C, T, U, R>
where
    N: Number,
    O: Of3<N, T, U, U, R>,
    A: Source<N, T>,
    B: Source<N, U>,
    C: Source<N, U>,
    T: Copy,
    U: Copy,
    R: Sink<N>,
{
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let b = B::open(batch, instruction.operands[1]);
        let c = C::open(batch, instruction.operands[2]);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (a, b, c) = (A::chunk(a, chunk), B::chunk(b, chunk), C::chunk(c, chunk));
            let mut result = [R::default(); LANES];
            for lane in 0..LANES {
                result[lane] = O::apply(a[lane], b[lane], c[lane], noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Scalars.
struct Scalar1<O, T, R>(PhantomData<(O, T, R)>);

impl<N: Number, O: Of1<N, T, R>, T: Sink<N>, R: Sink<N>> Run<N> for Scalar1<O, T, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = T::scalar(batch, instruction.operands[0]).get();
        R::scalar(batch, instruction.out).set(O::apply(a, batch.noise));
        at + 1
    }
}

struct Scalar2<O, T, U, R>(PhantomData<(O, T, U, R)>);

impl<N: Number, O: Of2<N, T, U, R>, T: Sink<N>, U: Sink<N>, R: Sink<N>> Run<N> for Scalar2<O, T, U, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = T::scalar(batch, instruction.operands[0]).get();
        let b = U::scalar(batch, instruction.operands[1]).get();
        R::scalar(batch, instruction.out).set(O::apply(a, b, batch.noise));
        at + 1
    }
}

struct Scalar3<O, T, U, R>(PhantomData<(O, T, U, R)>);

impl<N: Number, O: Of3<N, T, U, U, R>, T: Sink<N>, U: Sink<N>, R: Sink<N>> Run<N> for Scalar3<O, T, U, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = T::scalar(batch, instruction.operands[0]).get();
        let b = U::scalar(batch, instruction.operands[1]).get();
        let c = U::scalar(batch, instruction.operands[2]).get();
        R::scalar(batch, instruction.out).set(O::apply(a, b, c, batch.noise));
        at + 1
    }
}

/// Differences along x (1) or y (2) in each quad: those of its own row or column, as lavapipe takes them.
struct Difference<const AXIS: usize>;

impl<N: Number, const AXIS: usize> Run<N> for Difference<AXIS> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = batch.float_row(instruction.operands[0]);
        let out = batch.float_row(instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let a = a[chunk].get();
            let mut result: Lanes<N> = [N::default(); LANES];
            for lane in 0..LANES {
                result[lane] = a[lane | AXIS].sub(a[lane & !AXIS], batch.noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// The handler of an operation whose operands are rows or not; the result is a row if any of them is.
pub(crate) fn compute<N: Number>(level: Level, operation: Operation, rows: [bool; 3]) -> Handler<N> {
    macro_rules! forms {
        ($name:ident($a:ident) $r:ident) => {
            match rows {
                [true, ..] => handler::<N, Rows1<$name, Row, ty!($a), ty!($r)>>(level),
                _ => handler::<N, Scalar1<$name, ty!($a), ty!($r)>>(Level::Base),
            }
        };
        ($name:ident($a:ident, $b:ident) $r:ident) => {
            match rows {
                [true, true, _] => handler::<N, Rows2<$name, Row, Row, ty!($a), ty!($b), ty!($r)>>(level),
                [true, false, _] => handler::<N, Rows2<$name, Row, One, ty!($a), ty!($b), ty!($r)>>(level),
                [false, true, _] => handler::<N, Rows2<$name, One, Row, ty!($a), ty!($b), ty!($r)>>(level),
                _ => handler::<N, Scalar2<$name, ty!($a), ty!($b), ty!($r)>>(Level::Base),
            }
        };
        ($name:ident($a:ident, $b:ident, $c:ident) $r:ident) => {{
            match rows {
                [true, true, true] => {
                    handler::<N, Rows3<$name, Row, Row, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [true, true, false] => {
                    handler::<N, Rows3<$name, Row, Row, One, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [true, false, true] => {
                    handler::<N, Rows3<$name, Row, One, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [true, false, false] => {
                    handler::<N, Rows3<$name, Row, One, One, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, true, true] => {
                    handler::<N, Rows3<$name, One, Row, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, true, false] => {
                    handler::<N, Rows3<$name, One, Row, One, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, false, true] => {
                    handler::<N, Rows3<$name, One, One, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, false, false] => handler::<N, Scalar3<$name, ty!($a), ty!($b), ty!($r)>>(Level::Base),
            }
        }};
    }
    macro_rules! select {
        ($($name:ident($($operand:ident),+) $value:ident,)*) => {
            match (operation, rows[0]) {
                (Operation::DFdx, true) => handler::<N, Difference<1>>(level),
                (Operation::DFdy, true) => handler::<N, Difference<2>>(level),
                $((Operation::$name, _) => forms!($name($($operand),+) $value),)*
            }
        };
    }
    for_each_operation!(select)
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

/// Half-precision floats (IEEE 754 binary16).
mod half {
    /// To the nearest, ties to even; what is too large becomes infinite.
    pub(super) fn to_bits(x: f32) -> u16 {
        let bits = x.to_bits();
        let sign = (bits >> 16) as u16 & 0x8000;
        let magnitude = bits & 0x7fff_ffff;
        if magnitude > 0x7f80_0000 {
            return sign | 0x7e00;
        }
        // From 65,520 on, halfway past the largest.
        if magnitude >= 0x477f_f000 {
            return sign | 0x7c00;
        }
        if magnitude < 0x3880_0000 {
            // Below the smallest normal: units of 2⁻²⁴. Exact, for the scale is a power of two.
            let units = (f32::from_bits(magnitude) * 16_777_216.0).round_ties_even();
            return sign | units as u16;
        }
        let rounded = magnitude + 0xfff + (magnitude >> 13 & 1);
        sign | ((rounded - 0x3800_0000) >> 13) as u16
    }

    /// Exact.
    pub(super) fn from_bits(half: u16) -> f32 {
        let sign = u32::from(half & 0x8000) << 16;
        let (exponent, fraction) = (u32::from(half >> 10 & 0x1f), u32::from(half & 0x3ff));
        let magnitude = match exponent {
            0 => (fraction as f32 / 16_777_216.0).to_bits(),
            31 => 0x7f80_0000 | fraction << 13,
            _ => (exponent + 112) << 23 | fraction << 13,
        };
        f32::from_bits(sign | magnitude)
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn every_half_comes_back_and_what_lies_between_goes_to_the_nearest() {
            for half in 0..=u16::MAX {
                let float = from_bits(half);
                if !float.is_nan() {
                    assert_eq!(to_bits(float), half, "{float}");
                }
            }
            let above_one = from_bits(0x3c01);
            assert_eq!(to_bits(f32::midpoint(1.0, above_one)), 0x3c00, "ties go to even");
            assert_eq!(to_bits(65_519.0), 0x7bff);
            assert_eq!(to_bits(65_520.0), 0x7c00);
        }
    }
}
