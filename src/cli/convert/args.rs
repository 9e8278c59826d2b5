//! What `toyproof convert` is told.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use toyproof_translate::backend::Target;
use toyproof_translate::wgsl::Style;

use super::super::inputs::{DriverArgs, LanguageArgs};

const HOSTS: &str = "\
Examples:
  toyproof convert glsl/02-sphere.glsl -o sphere.wgsl --verify
  toyproof convert glsl -o converted --to spv

What a host feeds the result: entry point `main`, colour at location 0. Group 0, binding 0 is a block of 208 bytes \
(std140): iResolution at byte 0, iTime 12, iTimeDelta 16, iFrame 20, iFrameRate 24, iChannelTime[4] 32 and \
iChannelResolution[4] 96 (16 bytes each), iMouse 160, iDate 176, iSampleRate 192. The texture of channel K is \
binding 1+2K, its sampler 2+2K; only those that the shader uses are declared.

Exit code: 0 if every shader was written (and proved, with --verify), 1 if one is at fault, 2 if there was other \
trouble, as where a conversion is not proved.";

/// Translate shaders to WGSL, SPIR-V, Metal, HLSL or GLSL ES
#[derive(Debug, clap::Args)]
#[command(after_help = HOSTS)]
pub(in crate::cli) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required = true)]
    pub(super) shaders: Vec<PathBuf>,
    /// A file (.wgsl .spv .metal .hlsl .frag), a folder for several, or - for standard output
    #[arg(short, long, value_name = "FILE|DIR")]
    pub(super) output: PathBuf,
    /// The language; needed with a folder and with -
    #[arg(long, value_enum)]
    pub(super) to: Option<To>,
    /// Run what was converted and compare it with the shader, pixel by pixel; write it only if they are equal to the bit
    #[arg(long)]
    pub(super) verify: bool,
    /// Have Chromium paint it too: WGSL with WebGPU, or GLSL with WebGL 2, beside the shader itself with WebGL 2, on its software
    /// driver; as shown, no colour may differ by more than 1/255
    #[arg(long, requires = "verify")]
    pub(super) browser: bool,
    /// The kind of host that WGSL is for: entry point, bindings, direction of y
    #[arg(long, value_enum, default_value_t = StyleName::Plain)]
    pub(super) style: StyleName,
    /// Write also what could not be proved; its header says so
    #[arg(long, requires = "verify")]
    pub(super) force: bool,
    /// Convert so many shaders at a time [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256), allow_negative_numbers = true)]
    pub(super) jobs: Option<u16>,
    #[command(flatten)]
    pub(super) language: LanguageArgs,
    #[command(flatten)]
    pub(super) driver: DriverArgs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum To {
    Wgsl,
    Spv,
    Metal,
    Hlsl,
    Glsl,
    /// The GLSL that naga is fed
    Lowered,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum StyleName {
    /// A fragment shader with the bindings below; row 0 of its target is the bottom
    Plain,
    /// `shader_main` for the Python package of that name
    WgpuShadertoy,
    /// A compute shader for compute.toys
    ComputeToys,
    /// A Material2d of Bevy
    Bevy,
}

impl From<StyleName> for Style {
    fn from(name: StyleName) -> Self {
        match name {
            StyleName::Plain => Self::Plain,
            StyleName::WgpuShadertoy => Self::WgpuShadertoy,
            StyleName::ComputeToys => Self::ComputeToys,
            StyleName::Bevy => Self::Bevy,
        }
    }
}

impl To {
    pub(super) fn target(self) -> Option<Target> {
        match self {
            Self::Wgsl => Some(Target::Wgsl),
            Self::Spv => Some(Target::Spirv),
            Self::Metal => Some(Target::Msl),
            Self::Hlsl => Some(Target::Hlsl),
            Self::Glsl => Some(Target::Glsl),
            Self::Lowered => None,
        }
    }

    pub(super) fn extension(self) -> &'static str {
        self.target().map_or("lowered.glsl", Target::extension)
    }

    /// What `--to` calls it.
    pub(super) fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Whether it may go to a file whose name ends as another's does: what naga is fed is GLSL.
    pub(super) fn may_end_as(self, other: Self) -> bool {
        self == other || (self, other) == (Self::Lowered, Self::Glsl)
    }

    pub(super) fn of(path: &Path) -> Option<Self> {
        let target = Target::of(path)?;
        Self::value_variants()
            .iter()
            .copied()
            .find(|to| to.target() == Some(target))
    }
}
