//! Writes valid modules in the languages that hosts accept.

mod hlsl;
pub mod roundtrip;
pub mod spirv;

use std::fmt;
use std::path::Path;

use naga::back::{glsl, msl, wgsl};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::{Expression, SampleLevel, ShaderStage};
use serde::{Deserialize, Serialize};

use crate::TranslateError;
use crate::naga_ir::{Fetches, ValidModule, functions};

/// A language that a shader can be converted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Target {
    /// WebGPU Shading Language.
    Wgsl,
    /// SPIR-V 1.0 for Vulkan, as little-endian words.
    Spirv,
    /// Metal Shading Language 2.0.
    Msl,
    /// HLSL, shader model 5.1.
    Hlsl,
    /// GLSL ES 3.00 for WebGL 2.
    Glsl,
}

impl Target {
    /// Every target.
    pub const ALL: [Self; 5] = [Self::Wgsl, Self::Spirv, Self::Msl, Self::Hlsl, Self::Glsl];

    /// The value of `--to`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Spirv => "spv",
            Self::Msl => "metal",
            Self::Hlsl => "hlsl",
            Self::Glsl => "glsl",
        }
    }

    /// The extension of files in this language, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Glsl => "frag",
            other => other.name(),
        }
    }

    /// The target whose file extension `path` has.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "glsl" => Some(Self::Glsl),
            "msl" => Some(Self::Msl),
            "spirv" => Some(Self::Spirv),
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

/// Writes the shader in a language, as the bytes of a file.
///
/// # Errors
/// naga's message, if it cannot write the module in that language.
pub fn emit(module: &ValidModule, target: Target) -> Result<Vec<u8>, TranslateError> {
    match target {
        Target::Wgsl => write_wgsl(module).map(String::into_bytes),
        Target::Spirv => Ok(spirv::bytes(&spirv::words(module)?)),
        Target::Msl => write_msl(module).map(String::into_bytes),
        Target::Hlsl => hlsl::write(module).map(String::into_bytes),
        Target::Glsl => write_glsl(module).map(String::into_bytes),
    }
}

/// The name of the entry point that naga's GLSL front end generates.
const ENTRY_POINT: &str = "main";

/// Clamps out-of-range indices everywhere: without a policy drivers differ, and some crash.
const BOUNDS: BoundsCheckPolicies = {
    use BoundsCheckPolicy::Restrict;
    BoundsCheckPolicies {
        index: Restrict,
        buffer: Restrict,
        image_load: Restrict,
        binding_array: Restrict,
    }
};

/// [`BOUNDS`], and the requirement of the module's language on texels beyond a texture.
fn bounds(module: &ValidModule) -> BoundsCheckPolicies {
    BoundsCheckPolicies {
        image_load: match module.fetches() {
            // On Mesa's software driver, naga's own check is wrong where the level varies between pixels.
            Fetches::Checked => BoundsCheckPolicy::Unchecked,
            Fetches::Zeros => BoundsCheckPolicy::ReadZeroSkipWrite,
            Fetches::Edge => BoundsCheckPolicy::Restrict,
        },
        ..BOUNDS
    }
}

/// The bindings that a module uses, with their classes in register-based languages.
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

/// WGSL refuses derivatives and implicit levels of detail in non-uniform control flow; GLSL allows them with
/// undefined values. This directive keeps GLSL's semantics.
const DERIVATIVES: &str = "diagnostic(off, derivative_uniformity);\n";

fn write_wgsl(module: &ValidModule) -> Result<String, TranslateError> {
    let text = wgsl::write_string(module.module(), module.info(), wgsl::WriterFlags::empty())
        .map_err(TranslateError::new)?;
    Ok(if uses_derivatives(module) {
        DERIVATIVES.to_owned() + &text
    } else {
        text
    })
}

fn uses_derivatives(module: &ValidModule) -> bool {
    functions(module.module())
        .flat_map(|function| function.expressions.iter())
        .any(|(_, expression)| {
            matches!(
                expression,
                Expression::Derivative { .. }
                    | Expression::ImageSample {
                        level: SampleLevel::Auto | SampleLevel::Bias(_),
                        ..
                    }
            )
        })
}

/// Writes Metal Shading Language: binding K becomes `buffer(K)`, `texture(K)` or `sampler(K)`.
fn write_msl(module: &ValidModule) -> Result<String, TranslateError> {
    let mut resources = msl::EntryPointResources::default();
    for (binding, class) in bindings(module) {
        let slot = u8::try_from(binding.binding).map_err(TranslateError::new)?;
        let mut target = msl::BindTarget::default();
        match class {
            Class::Block => target.buffer = Some(slot),
            Class::Texture => target.texture = Some(slot),
            Class::Sampler => target.sampler = Some(msl::BindSamplerTarget::Resource(slot)),
        }
        resources.resources.insert(binding, target);
    }
    let options = msl::Options {
        lang_version: (2, 0),
        per_entry_point_map: [(ENTRY_POINT.to_owned(), resources)].into(),
        fake_missing_bindings: false,
        bounds_check_policies: bounds(module),
        force_loop_bounding: false,
        ..msl::Options::default()
    };
    msl::write_string(
        module.module(),
        module.info(),
        &options,
        &msl::PipelineOptions::default(),
    )
    .map(|(text, _)| text)
    .map_err(TranslateError::new)
}

/// Writes GLSL ES 3.00 for WebGL 2 hosts; naga combines textures with their samplers.
fn write_glsl(module: &ValidModule) -> Result<String, TranslateError> {
    let options = glsl::Options {
        version: glsl::Version::new_gles(300),
        writer_flags: glsl::WriterFlags::empty(),
        ..glsl::Options::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: ShaderStage::Fragment,
        entry_point: ENTRY_POINT.to_owned(),
        multiview: None,
    };
    // Browsers check fetches themselves. GLSL ES 3.00 has no function for the number of levels, which a check
    // would need.
    let bounds = BoundsCheckPolicies {
        image_load: BoundsCheckPolicy::Unchecked,
        ..BOUNDS
    };
    let mut text = String::new();
    glsl::Writer::new(
        &mut text,
        module.module(),
        module.info(),
        &options,
        &pipeline,
        bounds,
    )
    .and_then(|mut writer| writer.write())
    .map_err(TranslateError::new)?;
    Ok(text)
}
