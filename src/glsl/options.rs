//! What a check is told about the shader's surroundings.

use toyproof_diagnostic::Deadline;

use super::tree::SamplerShape;

/// How to judge a shader.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Options {
    /// Takes desktop GLSL's liberties: global initialisers that are not constant (they run before `mainImage`, in order),
    /// implicit conversions from integers to floats, arrays of arrays, `?:` of arrays and structures, own functions named as built-in ones.
    pub lenient: bool,
    /// The shapes of the textures bound to `iChannel0` to `iChannel3`. Where none is known, it is told from use: `sampler2D`, or
    /// what the first lookup that does not fit a `sampler2D` asks for.
    pub channels: [Option<SamplerShape>; 4],
    /// When the check must be over. Lints have a quarter of the time for themselves; what takes longer is left out.
    pub deadline: Deadline,
}
