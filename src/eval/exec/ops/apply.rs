//! The semantics of each operation on components.

use crate::exec::lanes::{LANES, Lanes};
use crate::exec::number::Arithmetic;
use crate::ir::{Operation, for_each_operation};

/// An operation with one operand.
pub(super) trait Of1<N: Arithmetic, A: Copy, R: Copy + Default> {
    fn apply(a: A, noise: N::Noise) -> R;

    /// Applies the operation to each lane.
    #[inline(always)]
    fn apply_to_lanes(a: Lanes<A>, noise: N::Noise) -> Lanes<R> {
        let mut results = [R::default(); LANES];
        for lane in 0..LANES {
            results[lane] = Self::apply(a[lane], noise);
        }
        results
    }
}

/// An operation with two operands.
pub(super) trait Of2<N: Arithmetic, A: Copy, B: Copy, R: Copy + Default> {
    fn apply(a: A, b: B, noise: N::Noise) -> R;

    /// Applies the operation to each lane.
    #[inline(always)]
    fn apply_to_lanes(a: Lanes<A>, b: Lanes<B>, noise: N::Noise) -> Lanes<R> {
        let mut results = [R::default(); LANES];
        for lane in 0..LANES {
            results[lane] = Self::apply(a[lane], b[lane], noise);
        }
        results
    }
}

/// An operation with three operands.
pub(super) trait Of3<N: Arithmetic, A, B, C, R> {
    fn apply(a: A, b: B, c: C, noise: N::Noise) -> R;
}

/// The Rust type of a kind of component, where `N` is the number type.
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
        impl<N: Arithmetic> Of1<N, ty!($ka), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
    (@ $name:ident ($a:ident: $ka:ident, $b:ident: $kb:ident) $result:ident $noise:pat_param, $value:expr) => {
        pub(super) struct $name;
        impl<N: Arithmetic> Of2<N, ty!($ka), ty!($kb), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $b: ty!($kb), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
    (@ $name:ident ($a:ident: $ka:ident, $b:ident: $kb:ident, $c:ident: $kc:ident) $result:ident $noise:pat_param, $value:expr) => {
        pub(super) struct $name;
        impl<N: Arithmetic> Of3<N, ty!($ka), ty!($kb), ty!($kc), ty!($result)> for $name {
            #[inline(always)]
            fn apply($a: ty!($ka), $b: ty!($kb), $c: ty!($kc), $noise: N::Noise) -> ty!($result) {
                $value
            }
        }
    };
}

/// Returns the word of a `bool`: all bits, or 0.
#[inline(always)]
fn bool_word(value: bool) -> u32 {
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
    // For zeros of different signs the second operand, and of NaN and a number the number, as in lavapipe.
    Min(a: F, b: F) F = |_| if a < b || b.is_nan() { a } else { b };
    Max(a: F, b: F) F = |_| if a > b || b.is_nan() { a } else { b };
    Neg(a: F) F = |_| a.neg();
    Abs(a: F) F = |_| a.abs();
    Sqrt(a: F) F = |noise| a.sqrt(noise);
    Floor(a: F) F = |_| a.floor();
    Ceil(a: F) F = |_| a.ceil();
    Trunc(a: F) F = |_| a.trunc();
    RoundEven(a: F) F = |_| a.round_even();
    Less(a: F, b: F) W = |_| bool_word(a < b);
    LessEqual(a: F, b: F) W = |_| bool_word(a <= b);
    Equal(a: F, b: F) W = |_| bool_word(a == b);
    NotEqual(a: F, b: F) W = |_| bool_word(a != b);
    IsNan(a: F) W = |_| bool_word(a.is_nan());
    IsInf(a: F) W = |_| bool_word(a.abs() == N::from_f64(f64::INFINITY));
    FromInt(a: W) F = |_| N::from_f64(f64::from(a.cast_signed()));
    FromUint(a: W) F = |_| N::from_f64(f64::from(a));
    ToInt(a: F) W = |_| to_int(a.trunc().to_f64()).cast_unsigned();
    ToUint(a: F) W = |_| to_uint(a.trunc().to_f64());
    FromBits(a: W) F = |_| N::from_f32(f32::from_bits(a));
    ToBits(a: F) W = |_| a.to_f32().to_bits();
    PackHalf(a: F, b: F) W = |_| u32::from(f32_to_f16(a.to_f32())) | u32::from(f32_to_f16(b.to_f32())) << 16;
    UnpackLow(a: W) F = |_| N::from_f64(f64::from(f16_to_f32(a as u16)));
    UnpackHigh(a: W) F = |_| N::from_f64(f64::from(f16_to_f32((a >> 16) as u16)));
    AddWord(a: W, b: W) W = |_| a.wrapping_add(b);
    SubWord(a: W, b: W) W = |_| a.wrapping_sub(b);
    MulWord(a: W, b: W) W = |_| a.wrapping_mul(b);
    // As naga guards them: a division by zero returns the dividend, a remainder by zero returns 0.
    DivInt(a: W, b: W) W = |_| if b == 0 { a } else { a.cast_signed().wrapping_div(b.cast_signed()).cast_unsigned() };
    DivUint(a: W, b: W) W = |_| a.checked_div(b).unwrap_or(a);
    // Floored remainder for operands of different signs, as in browsers; GLSL leaves it undefined.
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
    EqualWord(a: W, b: W) W = |_| bool_word(a == b);
    LessInt(a: W, b: W) W = |_| bool_word(a.cast_signed() < b.cast_signed());
    LessUint(a: W, b: W) W = |_| bool_word(a < b);
    Select(a: W, b: F, c: F) F = |_| if a != 0 { b } else { c };
    SelectWord(a: W, b: W, c: W) W = |_| if a != 0 { b } else { c };
    // Uniform operands only, so the derivative is 0 (or NaN); rows have their own handlers.
    DFdx(a: F) F = |noise| a.sub(a, noise);
    DFdy(a: F) F = |noise| a.sub(a, noise);
}

/// Functions of [`Arithmetic`] that compute several results at once.
macro_rules! functions {
    ($($name:ident $function:ident($($argument:ident),+): $of:ident<$($kind:ident),+>;)*) => {$(
        pub(super) struct $name;
        impl<N: Arithmetic> $of<$($kind),+> for $name {
            #[inline(always)]
            fn apply($($argument: N,)+ noise: N::Noise) -> N {
                let [result] = N::$function($([$argument],)+ noise);
                result
            }
            #[inline(always)]
            fn apply_to_lanes($($argument: Lanes<N>,)+ noise: N::Noise) -> Lanes<N> {
                N::$function($($argument,)+ noise)
            }
        }
    )*};
}

functions! {
    Sin sin(x): Of1<N, N, N>;
    Cos cos(x): Of1<N, N, N>;
    Tan tan(x): Of1<N, N, N>;
    Asin asin(x): Of1<N, N, N>;
    Acos acos(x): Of1<N, N, N>;
    Atan atan(x): Of1<N, N, N>;
    Sinh sinh(x): Of1<N, N, N>;
    Cosh cosh(x): Of1<N, N, N>;
    Tanh tanh(x): Of1<N, N, N>;
    Asinh asinh(x): Of1<N, N, N>;
    Acosh acosh(x): Of1<N, N, N>;
    Atanh atanh(x): Of1<N, N, N>;
    Exp exp(x): Of1<N, N, N>;
    Exp2 exp2(x): Of1<N, N, N>;
    Log log(x): Of1<N, N, N>;
    Log2 log2(x): Of1<N, N, N>;
    Atan2 atan2(y, x): Of2<N, N, N, N>;
    Pow pow(x, y): Of2<N, N, N, N>;
}

/// Rounds toward zero. Values that are too large become the largest f32 that fits an `int`: naga clamps to it
/// before it converts.
#[inline(always)]
fn to_int(x: f64) -> i32 {
    if x < 2_147_483_648.0 {
        x as i32
    } else {
        2_147_483_520
    }
}

/// Rounds toward zero. Values that are too large become the largest f32 that fits a `uint`, as in [`to_int`].
#[inline(always)]
fn to_uint(x: f64) -> u32 {
    if x < 4_294_967_296.0 {
        x as u32
    } else {
        4_294_967_040
    }
}

/// Evaluates an operation on words. Returns `None` for an operation on floats.
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

// Half-precision floats (IEEE 754 binary16).

/// Rounds to the nearest half-precision float, ties to even; overflow gives infinity.
fn f32_to_f16(x: f32) -> u16 {
    let bits = x.to_bits();
    let sign = (bits >> 16) as u16 & 0x8000;
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return sign | 0x7e00;
    }
    // From 65,520 on: half a unit above the largest finite value.
    if magnitude >= 0x477f_f000 {
        return sign | 0x7c00;
    }
    if magnitude < 0x3880_0000 {
        // Below the smallest normal: units of 2⁻²⁴. The scaling is exact, by a power of two.
        let units = (f32::from_bits(magnitude) * 16_777_216.0).round_ties_even();
        return sign | units as u16;
    }
    // The 13 bits of the fraction that are lost round to even.
    let rounded = magnitude + 0xfff + (magnitude >> 13 & 1);
    // The biases of the exponents differ by 112: 0x3800_0000 is 112 << 23.
    sign | ((rounded - 0x3800_0000) >> 13) as u16
}

/// Converts a half-precision float to f32, exactly.
fn f16_to_f32(half: u16) -> f32 {
    let sign = u32::from(half & 0x8000) << 16;
    let (exponent, fraction) = (u32::from(half >> 10 & 0x1f), u32::from(half & 0x3ff));
    let magnitude = match exponent {
        0 => (fraction as f32 / 16_777_216.0).to_bits(),
        // Infinity and NaN.
        31 => 0x7f80_0000 | fraction << 13,
        _ => (exponent + 112) << 23 | fraction << 13,
    };
    f32::from_bits(sign | magnitude)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_round_trip_and_others_round_to_nearest() {
        for half in 0..=u16::MAX {
            let float = f16_to_f32(half);
            if !float.is_nan() {
                assert_eq!(f32_to_f16(float), half, "{float}");
            }
        }
        let above_one = f16_to_f32(0x3c01);
        assert_eq!(
            f32_to_f16(f32::midpoint(1.0, above_one)),
            0x3c00,
            "ties go to even"
        );
        assert_eq!(f32_to_f16(65_519.0), 0x7bff);
        assert_eq!(f32_to_f16(65_520.0), 0x7c00);
    }
}
