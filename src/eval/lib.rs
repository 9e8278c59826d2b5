//! Evaluates a checked shader on the CPU, without a driver: in float32 with the bits of the strict GPU run,
//! in double precision, or in double precision with randomly rounded operations. The input is the typed tree
//! of the source, not the lowered one and not naga's module, so that errors of the lowering, of naga and of
//! drivers appear as differences.
//!
//! Each instruction is applied to a batch of pixels, which amortizes the cost of dispatch; values that are
//! uniform in a batch are computed once.
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
//! # Parts
//!
//! A tower, in which each part imports only those below it:
//!
//! | part | contents |
//! |---|---|
//! | `program`, `render`, `trace`, `profile`, `passes`, `parametric` | what callers use; `compile`: the pipeline |
//! | `exec` | number types, batches, the function of each kind of instruction, tiles of an image |
//! | `lower` | linear code with jumps and masks, registers |
//! | `opt` | passes on the function |
//! | `build` | the function of a typed tree: calls inlined, vectors scalarized, checks added |
//! | `ir` | the function; the sites of faults, and the events of traces |
//!
//! A *word* is a component of type `int`, `uint` or `bool`. A *row* holds a component of all pixels of a
//! batch, in *chunks* of sixteen; a *scalar* holds one that all pixels have in common.
//!
//! `toyproof-eval-native` makes machine code of programs, with the same bits: for large images, use its
//! `Program`.
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
//! - [`Wide`] has 160 bits, and takes thousands of times as long: it says how wrong f64 is.
//!
//! # Undefined behavior
//!
//! GLSL leaves some operations undefined: an index out of bounds, an integer division by zero, a shift by 32
//! or more, a conversion of a float that does not fit, `smoothstep` with equal edges, `pow` of a negative
//! base. [`UndefinedPolicy`] chooses what they give. The shader is rendered with different substitutes, and a
//! pixel depends on undefined behavior only if its color does: an unused out-of-bounds element does not
//! count. [`Observations`] counts such operations by source position, as well as reads of uninitialized
//! variables, which give zero as in WebGL, and iterations of loops.
//!
//! # Traces
//!
//! [`PixelDebugger`] runs single pixels and records what they compute ([`ExecutionTrace`]). A
//! [`ForcedPrefix`] imposes recorded values on a run in another number type, which finds the operation that
//! loses the digits.

#![expect(
    clippy::inline_always,
    clippy::needless_range_loop,
    reason = "per-pixel code must be inlined to vectorize, with loops over lane indices"
)]

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;

mod build;
mod compile;
mod exec;
mod ir;
mod lower;
mod opt;
mod parametric;
mod passes;
mod profile;
mod program;
mod render;
mod sound;
mod supersample;
#[cfg(test)]
mod tests;
mod trace;

pub use build::{MAX_VALUES, Refusal, Substitute, UndefinedPolicy};
pub use exec::evaluate::Number;
pub use exec::frame::Framebuffer;
pub use exec::limits::Failure;
pub use exec::number::{Arithmetic, RandomRounding, Seed};
pub use exec::observe::{MESA_CAP, Observations, Observed};
pub use exec::places::Places;
pub use exec::recorder::{ExecutionTrace, ForcedPrefix, TraceEvent, TraceFault, TraceValue};
pub use exec::settings::{Engine, Settings};
pub use exec::wide::Wide;
pub use ir::{Call, CallId, Event, EventId, EventKind, Fault, Site, Store, StoreId, TraceSchema};
pub use ir::{Origin, Part, PartId, PartKind};
pub use parametric::{ParametricProgram, Point, PointEvaluator};
pub use passes::{PassFailure, PassRenderer, bound};
pub use profile::Profile;
pub use program::Program;
pub use render::{Rendered, RenderedF32};
pub use sound::SOUND_COLUMNS;
pub use supersample::Supersampling;
pub use trace::PixelDebugger;

/// What a compiler to machine code is given, and implements.
#[doc(hidden)]
pub mod native {
    pub use crate::exec::batch::Active;
    pub use crate::exec::lanes::{LANES, Lanes};
    pub use crate::exec::native::{
        BatchTables, NativeBatch, NativeCompiler, NativeFrame, NativeInput, NativeProgram,
    };
    pub use crate::exec::number::FloatFormat;
    pub use crate::ir::{Kind, NONE, Operation, Predicate, SiteId, Value, ValueDef};
    pub use crate::lower::LoweredCode;
    pub use crate::lower::linearize::{Step, Target};
    pub use crate::lower::regalloc::Location;
    pub use crate::opt::rollback::{Map, RollbackMap};
}
