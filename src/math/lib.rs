//! The functions of GLSL whose last bits are implementation-defined, composed of operations that every conforming driver
//! and every CPU rounds alike. One source has several interpretations: numbers, or a graph of the operations.
//!
//! ```
//! use toyproof_math::native;
//!
//! // The same bits on every machine, and as a shader that toyproof lowers computes them.
//! assert_eq!(native::sin(1.0).to_bits(), 0x3F57_6AA4);
//! ```
//!
//! `+ − × ÷` and `sqrt` round as IEEE 754 asks on the drivers that count, once nothing may be contracted; `floor`, comparisons,
//! selections and integers are exact everywhere. What is composed of them in a fixed order gives the same bits on
//! all drivers and on the CPU. A reading says what an operation does: computes (`f32`, `f64`), notes an
//! instruction, or writes GLSL.
//!
//! **Orders that are chosen here**, where the specification (GLSL ES 3.00.6 §8) leaves them open: sums run from left to
//! right; `normalize(v)` is `v / length(v)`; `mix(a, b, t)` is `a·(1 − t) + b·t`; the product of a matrix and a vector sums over the
//! columns; an inverse is the adjugate over the determinant.

#![expect(
    clippy::inline_always,
    reason = "a call would keep loops over arrays from becoming SIMD"
)]

mod common;
mod exponential;
mod float;
mod geometric;
mod hyperbolic;
mod inverse_trigonometric;
mod kernel;
mod logarithmic;
mod matrix;
pub mod native;
mod number;
mod program;
mod trigonometric;
mod two_float;

pub use common::{clamp, degrees, fract, inverse_sqrt, mix, modulo, radians, sign, smoothstep, step};
pub use exponential::{exp, exp2};
pub use float::{Bits, Float, Word};
pub use geometric::{cross, distance, dot, faceforward, length, normalize, reflect, refract};
pub use hyperbolic::{acosh, asinh, atanh, cosh, sinh, tanh};
pub use inverse_trigonometric::{acos, asin, atan, atan2};
pub use logarithmic::{log, log2, pow};
pub use matrix::{Matrix, determinant, inverse, outer_product};
pub use number::Number;
pub use program::{Binary, FloatTerm, Kind, Program, Step, StepId, Unary};
pub use trigonometric::{cos, sin, tan};

#[cfg(test)]
mod tests;
