//! GLSL's functions whose last bits are implementation-defined, composed of operations that every conforming
//! driver and every CPU rounds alike. One generic source has two interpretations: numbers, or a graph of the
//! operations.
//!
//! ```
//! use toyproof_math::native;
//!
//! // The same bits on every machine, and in every shader that toyproof lowers.
//! assert_eq!(native::sin(1.0).to_bits(), 0x3F57_6AA4);
//! ```
//!
//! `+ − × ÷` and `sqrt` round as IEEE 754 requires on all supported drivers, provided that no operations are
//! contracted; `floor`, comparisons, selections and integer operations are exact everywhere. A composition of
//! them in a fixed order gives the same bits on all drivers and on the CPU. An implementation of [`Number`]
//! either computes (`f32`, `f64`) or records each operation ([`ExprGraph`]).
//!
//! **Order of operations**, where the specification (GLSL ES 3.00.6 §8) does not fix it: sums run from left
//! to right; `normalize(v)` is `v / length(v)`; `mix(a, b, t)` is `a·(1 − t) + b·t`; the product of a matrix
//! and a vector sums over the columns; an inverse is the adjugate divided by the determinant.

#![expect(
    clippy::inline_always,
    reason = "a call would keep loops over arrays from becoming SIMD"
)]

mod algebraic;
pub mod double;
mod exponential;
mod expr_graph;
mod float;
mod trigonometric;
mod two_float;

pub use self::algebraic::{
    Matrix, clamp, cross, degrees, determinant, distance, dot, faceforward, fract, inverse, inverse_sqrt,
    length, mix, modulo, normalize, outer_product, radians, reflect, refract, sign, smoothstep, step,
};
pub use self::exponential::{
    acosh, asinh, atanh, cosh, exp, exp2, level_of_detail, log, log2, longer_square, pow, sinh, tanh,
};
pub use self::expr_graph::{Binary, ExprGraph, FloatTerm, Kind, Step, StepId, Unary};
pub use self::float::{Bits, Float, Number, Word};
pub use self::trigonometric::{acos, asin, atan, atan2, cos, sin, sin_cos, tan};

/// Transcendental functions of f32 that flush denormal arguments and results, as drivers do.
///
/// The code has no branches, calls or tables, so that loops over arrays are vectorized (with AVX2, 0.9 ns for
/// each `exp` and 3 ns for each `sin`).
pub mod native {
    /// Replaces a denormal by zero with the same sign.
    #[inline(always)]
    #[must_use]
    pub fn flush(x: f32) -> f32 {
        let bits = x.to_bits();
        let kept = if bits & 0x7F80_0000 == 0 {
            bits & 0x8000_0000
        } else {
            bits
        };
        f32::from_bits(kept)
    }

    /// `sin` and `cos`
    #[inline(always)]
    #[must_use]
    pub fn sin_cos(x: f32) -> (f32, f32) {
        let (sine, cosine) = super::sin_cos(flush(x));
        (flush(sine), flush(cosine))
    }

    macro_rules! flushing {
        ($($name:ident($($argument:ident),*);)*) => {$(
            #[doc = concat!("`", stringify!($name), "`")]
            #[inline(always)]
            #[must_use]
            pub fn $name($($argument: f32),*) -> f32 {
                flush(super::$name($(flush($argument)),*))
            }
        )*};
    }

    flushing! {
        sin(x);
        cos(x);
        tan(x);
        asin(x);
        acos(x);
        atan(x);
        sinh(x);
        cosh(x);
        tanh(x);
        asinh(x);
        acosh(x);
        atanh(x);
        exp(x);
        exp2(x);
        log(x);
        log2(x);
        pow(x, y);
        atan2(y, x);
    }
}

#[cfg(test)]
mod tests;
