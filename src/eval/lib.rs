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
//! let mut files = Files::default();
//! let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0, 1); }";
//! let file = files.add(File::new("gradient.glsl", text));
//! let checked = toyproof_glsl::check(&files, file, &Default::default()).unwrap();
//! let frame = Frame { size: [4, 2], ..Frame::default() };
//! let rendered = Program::new(&checked).unwrap().render(&frame, &Settings::<f64>::default()).unwrap();
//! assert_eq!(rendered.framebuffer.image().get(3, 1), [0.875, 0.75, 0.0, 1.0]);
//! ```

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
mod number;
mod observe;
mod ops;
mod opt;
mod program;
mod render;
#[cfg(test)]
mod tests;
mod tile;
mod trace;

pub use build::Refusal;
pub use frame::Framebuffer;
pub use number::{Number, RandomRounding, Seed};
pub use observe::{Fault, MESA_CAP, Observations, Observed, Site};
pub use program::Program;
pub use render::{Failure, Places, Rendered, RenderedF32, Settings, Substitute, UndefinedPolicy};
pub use trace::{
    Call, CallId, Event, EventId, ExecutionTrace, ForcedPrefix, PixelDebugger, TraceEvent, TraceSchema,
    TraceValue, What,
};
