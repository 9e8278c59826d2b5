//! Evaluates a checked shader on the CPU, without a driver: in float32 with the bits of the strict GPU run,
//! in double precision, or in double precision with randomly rounded operations.
//!
//! ```text
//! tree ─► build ─► ir ─► opt (gvn, dce, divergence, fuse) ─► lower (linearize, regalloc, isel) ─► ops ─► render
//! ```
//!
//! Each instruction is applied to a batch of pixels, which amortizes the cost of dispatch; values that are
//! uniform in a batch are computed once. The input is the typed tree of the source, not the lowered one and
//! not naga's module, so that errors of the lowering, of naga and of drivers appear as differences.
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_eval::{Program, Settings};
//! use toyproof_image::Frame;
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0, 1); }";
//!     let file = files.add(File::new("gradient.glsl", text));
//!     let checked = toyproof_glsl::check(&files, file, &Default::default())?;
//!     let frame = Frame { size: [4, 2], ..Frame::default() };
//!     let rendered = Program::new(&checked)?.render(&frame, &Settings::<f64>::default())?;
//!     assert_eq!(rendered.framebuffer.image().get(3, 1), [0.875, 0.75, 0.0, 1.0]);
//!     Ok(())
//! }
//! ```
//!
//! # Number types
//!
//! [`Number`] is the type in which a shader is evaluated:
//!
//! - `f32` gives the bits of a strict GPU run: denormals are flushed, functions such as `sin` are those of
//!   `toyproof_math`, and sums have one order.
//! - `f64` shows what the formula means: literals are read as decimals in double precision, and two equivalent
//!   formulas agree far below what is visible.
//! - [`RandomRounding`] perturbs every f64 operation by a random unit in the last place (Monte Carlo
//!   arithmetic). A pixel whose color changes by it is ill-conditioned.
//!
//! # Undefined behavior
//!
//! GLSL leaves some operations undefined: an index out of bounds, an integer division by zero, a shift by 32 or
//! more, a conversion of a float that does not fit, `smoothstep` with equal edges, `pow` of a negative base.
//! [`UndefinedPolicy`] chooses what they give. The shader is rendered with different substitutes, and a pixel
//! depends on undefined behavior only if its color does: an element out of bounds that nobody uses excuses
//! nothing. [`Observations`] counts such operations by source position, as well as reads of uninitialized
//! variables, which give zero as in WebGL, and iterations of loops.
//!
//! # Traces
//!
//! [`PixelDebugger`] runs single pixels and records what they compute ([`ExecutionTrace`]). A [`ForcedPrefix`]
//! imposes recorded values on a run in another number type, which finds the operation that loses the digits.

#![expect(
    clippy::inline_always,
    clippy::needless_range_loop,
    reason = "per-pixel code must be inlined to vectorize, with loops over lane indices"
)]

mod batch;
mod build;
mod frame;
mod ir;
mod lower;
#[cfg_attr(not(target_arch = "x86_64"), path = "native/absent.rs")]
mod native;
mod number;
mod observe;
mod ops;
mod opt;
mod parametric;
mod passes;
mod program;
mod render;
#[cfg(test)]
mod tests;
mod texture;
mod tile;
mod trace;

pub use build::{MAX_VALUES, Refusal};
pub use frame::Framebuffer;
pub use number::{Number, RandomRounding, Seed};
pub use observe::{Fault, MESA_CAP, Observations, Observed, Site};
pub use parametric::{ParametricProgram, Point, PointEvaluator};
pub use passes::{PassFailure, PassRenderer, bound};
pub use program::Program;
pub use render::{Engine, Failure, Places, Rendered, RenderedF32, Settings, Substitute, UndefinedPolicy};
pub use trace::{
    Call, CallId, Event, EventId, EventKind, ExecutionTrace, ForcedPrefix, PixelDebugger, TraceEvent,
    TraceSchema, TraceValue,
};
