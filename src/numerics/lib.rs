//! Changes of shaders for their numbers: forms of expressions that lose fewer digits, and variables that need
//! fewer bits.
//!
//! # Parts
//!
//! - [`mod@rewrite`]: a catalogue of identities, tried on the values that a shader computes.
//! - [`mod@mixed`]: which variables may be `mediump`, by emulated 16 bits.
//! - [`Precision`]: how far an image in f32 is from that in f64.

mod error;
pub mod mixed;
pub mod rewrite;

pub use error::Precision;
