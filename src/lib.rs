//! Checks, renders and converts ShaderToy shaders, and states how far each image can be trusted.
//!
//! Each stage is a crate of its own; this one composes them into the command line.

pub mod cli;
pub mod report;

pub use toyproof_diagnostic as diagnostic;
pub use toyproof_eval as eval;
pub use toyproof_glsl as glsl;
pub use toyproof_gpu as gpu;
pub use toyproof_image as image;
pub use toyproof_lab as lab;
pub use toyproof_lint as lint;
pub use toyproof_math as math;
pub use toyproof_scene as scene;
pub use toyproof_tracer as tracer;
pub use toyproof_translate as translate;
pub use toyproof_verify as verify;
