//! How the textures of channels are sampled. `ShaderToy` sets it for each input; the shader cannot see it.

use serde::{Deserialize, Serialize};

/// How a lookup by normalized coordinates reads a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Sampling {
    /// The filter.
    pub filter: Filter,
    /// The values outside of the texture.
    pub wrap: Wrap,
}

impl Default for Sampling {
    /// Linear and repeated, without mipmaps.
    fn default() -> Self {
        Self {
            filter: Filter::Linear,
            wrap: Wrap::Repeat,
        }
    }
}

/// A texture filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Four texels, or eight in a volume.
    Linear,
    /// Linear, also between mipmaps.
    Mipmap,
}

/// How a texture continues beyond its edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Wrap {
    /// The texels of the edge continue.
    Clamp,
    /// The texture is repeated.
    Repeat,
}
