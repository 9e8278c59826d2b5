//! From a valid module to the languages that hosts take.

mod glsl;
mod hlsl;
mod msl;
pub mod reread;
pub mod spirv;
mod wgsl;

use std::fmt;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::naga_ir::ValidModule;

/// A language that a shader can be converted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Target {
    /// WebGPU Shading Language.
    Wgsl,
    /// SPIR-V 1.0 for Vulkan, little-endian words.
    Spirv,
    /// Metal Shading Language 2.0.
    Msl,
    /// HLSL, shader model 5.1.
    Hlsl,
    /// GLSL ES 3.00, as WebGL2 takes it.
    Glsl,
}

impl Target {
    /// Every target.
    pub const ALL: [Self; 5] = [Self::Wgsl, Self::Spirv, Self::Msl, Self::Hlsl, Self::Glsl];

    /// The name that `--to` takes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Spirv => "spv",
            Self::Msl => "metal",
            Self::Hlsl => "hlsl",
            Self::Glsl => "glsl",
        }
    }

    /// The ending of files in this language, without the dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Glsl => "frag",
            other => other.name(),
        }
    }

    /// The target whose files end as `path` does.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "glsl" => Some(Self::Glsl),
            "msl" => Some(Self::Msl),
            _ => Self::ALL
                .into_iter()
                .find(|target| target.extension() == extension),
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The shader in that language, as the bytes of a file.
///
/// # Errors
/// naga's words, where it cannot write the module in that language.
pub fn emit(module: &ValidModule, target: Target) -> Result<Vec<u8>, String> {
    match target {
        Target::Wgsl => wgsl::write(module).map(String::into_bytes),
        Target::Spirv => Ok(spirv::bytes(&spirv::words(module)?)),
        Target::Msl => msl::write(module).map(String::into_bytes),
        Target::Hlsl => hlsl::write(module).map(String::into_bytes),
        Target::Glsl => glsl::write(module).map(String::into_bytes),
    }
}

/// The entry point's name in what naga's GLSL front end makes.
const ENTRY_POINT: &str = "main";

/// Out-of-range indices are clamped everywhere: without a policy the drivers differ, and some crash.
const BOUNDS: naga::proc::BoundsCheckPolicies = {
    use naga::proc::BoundsCheckPolicy::Restrict;
    naga::proc::BoundsCheckPolicies {
        index: Restrict,
        buffer: Restrict,
        image_load: Restrict,
        binding_array: Restrict,
    }
};

/// The bindings that a module uses, with the class that register-based languages sort them by.
fn bindings(module: &ValidModule) -> impl Iterator<Item = (naga::ResourceBinding, Class)> {
    let naga = module.module();
    naga.global_variables.iter().filter_map(|(_, global)| {
        let class = match naga.types[global.ty].inner {
            naga::TypeInner::Image { .. } => Class::Texture,
            naga::TypeInner::Sampler { .. } => Class::Sampler,
            _ => Class::Block,
        };
        Some((global.binding?, class))
    })
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    Block,
    Texture,
    Sampler,
}
