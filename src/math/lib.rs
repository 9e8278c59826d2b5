//! GLSL's functions whose last bits are implementation-defined, composed of operations that every conforming
//! driver and every CPU rounds in the same way. One generic source has two interpretations: numbers, or a
//! graph of the operations.
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
//!
//! # Parts
//!
//! - `float`: the trait `Number`, the number types, and helpers for bits.
//! - `algebraic`, `exponential`, `trigonometric`: the functions of GLSL, generic over `Number`.
//! - `cube`: the faces of cube maps.
//! - `native`: the functions in f32 as drivers compute them, vectorized.
//! - `double`: sines, powers and logarithms in f64 for several arguments at once.
//! - `two_float`: sums of two floats, for intermediate results.
//! - `expr_graph`: the graph of operations that `toyproof_translate` prints.

#![expect(
    clippy::inline_always,
    reason = "a call would keep loops over arrays from becoming SIMD"
)]

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;

mod algebraic;
mod cube;
pub mod double;
mod exponential;
mod expr_graph;
mod float;
pub mod native;
mod trigonometric;
mod two_float;

pub use self::algebraic::{
    Matrix, clamp, cross, degrees, determinant, distance, dot, faceforward, fract, inverse, inverse_sqrt,
    length, mix, modulo, normalize, outer_product, radians, reflect, refract, sign, smoothstep, step,
};
pub use self::cube::{cube_gradient, cube_place};
pub use self::exponential::{
    acosh, asinh, atanh, cosh, exp, exp2, level_of_detail, log, log2, longer_square, pow, sinh, tanh,
};
pub use self::expr_graph::{Binary, ExprGraph, FloatTerm, Kind, Step, StepId, Unary};
pub use self::float::{Bits, Float, Number, Word};
pub use self::trigonometric::{acos, asin, atan, atan2, cos, sin, sin_cos, tan};

#[cfg(test)]
mod tests;
