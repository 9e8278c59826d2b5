//! Runs the typed GLSL tree on the CPU: any shader, without a driver, in f32 bit for bit as the strict GPU run, or in f64.
//!
//! ```text
//! tree ─► compile ─► forward ─► prune ─► uniform ─► fuse ─────► flatten ─► allocate ─► prepare ──────► paint
//!         (calls     (loads are (what     (what is   (products   (jumps,    (registers) (instructions:
//!         inlined,   values)    nobody    the same   with their  masks)                 a function
//!         components)           reads)    for all)   sums)                              pointer each)
//! ```
//!
//! Each instruction is applied to a batch of pixels, so that finding out what to do costs little beside doing it; what does
//! not vary within a batch is done once for all of them. It is the tree as the author wrote it that runs, not the lowered one and not
//! naga's module: what lowering, naga and driver make of a shader can be told from what it says.

#![expect(
    clippy::inline_always,
    clippy::needless_range_loop,
    reason = "what runs for each pixel must become one run of vector instructions, over lanes by number"
)]

mod allocate;
mod batch;
mod compile;
mod flatten;
mod flow;
mod forward;
mod fuse;
mod group;
mod handler;
mod input;
mod number;
mod observe;
mod operation;
mod paint;
mod painting;
mod prepare;
mod program;
mod prune;
mod story;
mod teller;
#[cfg(test)]
mod tests;
mod texture;
mod tile;
mod uniform;

pub use compile::Refusal;
pub use number::{Jittered, Number, Seed};
pub use observe::{Fault, MESA_CAP, Observations, Observed, Site};
pub use paint::{Failure, Other, Painted, Pictured, Places, Settings, Variant};
pub use painting::Painting;
pub use program::Program;
pub use story::{Call, CallId, Event, EventId, Happened, Lead, Plot, Story, Told, What};
pub use teller::Teller;
