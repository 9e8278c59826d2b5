//! toyproof checks, renders and converts ShaderToy shaders, and says how far each picture can be trusted.

pub mod diagnostic;
pub mod glsl;
pub mod source;
