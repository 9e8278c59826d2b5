//! Shaders with several passes over frames: their playback, and how rounding errors grow.

pub mod bind;
mod buffers;
pub mod frames;
pub mod growth;
pub mod playback;
