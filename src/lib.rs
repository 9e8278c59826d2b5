//! toyproof checks, renders and converts ShaderToy shaders, and says how far each picture can be trusted.

pub mod browser;
pub mod chart;
pub mod cli;
pub mod compare;
pub mod contain;
pub mod deadline;
pub mod diagnostic;
pub mod elementary;
pub mod emit;
pub mod eval;
pub mod explain;
pub mod export;
pub mod frame;
pub mod glsl;
pub mod gpu;
pub mod image;
pub mod mistake;
pub mod module;
pub mod output;
pub mod report;
pub mod scene;
pub mod source;
pub mod stress;
pub mod trace;
pub mod trade;
pub mod verify;
