//! Evaluates a checked shader on the CPU, without a driver: in float32 with the bits of the strict GPU run, in double
//! precision, or in double precision with randomly rounded operations.
//!
//! ```text
//! tree ─► build ─► ir ─► opt (gvn, dce, divergence, fuse) ─► lower (linearize, regalloc, isel) ─► ops ─► render
//! ```
//!
//! Each instruction is applied to a batch of pixels, so that decoding it costs little beside its work; values that are
//! equal in all pixels of a batch are computed once. The tree as the author wrote it is evaluated, not the lowered one
//! and not naga's module, so that errors of lowering, naga and drivers show as differences.
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
//! let painted = Program::new(&checked).unwrap().paint(&frame, &Settings::<f64>::default()).unwrap();
//! assert_eq!(painted.painting.image().get(3, 1), [0.875, 0.75, 0.0, 1.0]);
//! ```

#![expect(
    clippy::inline_always,
    clippy::needless_range_loop,
    reason = "what runs for each pixel must become one run of vector instructions, over lanes by number"
)]

mod batch;
mod build;
mod framebuffer;
mod input;
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
mod texture;
mod tile;
mod trace;

pub use build::Refusal;
pub use framebuffer::Painting;
pub use number::{Jittered, Number, Seed};
pub use observe::{Fault, MESA_CAP, Observations, Observed, Site};
pub use program::Program;
pub use render::{Failure, Other, Painted, Pictured, Places, Settings, Variant};
pub use trace::{Call, CallId, Event, EventId, Happened, Lead, Plot, Story, Teller, Told, What};
