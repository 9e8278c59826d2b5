//! Translates checked shaders to GPU languages.
//!
//! There are two paths. The first lowers the tree to GLSL 450, in the subset that naga parses correctly; naga
//! writes it as SPIR-V, WGSL, MSL, HLSL or GLSL. The second ([`wgsl`]) prints WGSL straight from the tree,
//! with the author's names, loops and comments.
//!
//! ```text
//! tree ─► lower ─► print (GLSL 450) ─► naga_ir ─► backend (SPIR-V, WGSL, MSL, HLSL, GLSL)
//!   └───► wgsl, c_family
//! ```
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_translate::backend::{Target, emit};
//! use toyproof_translate::{lower, naga_ir};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0, 1); }";
//!     let file = files.add(File::new("gradient.glsl", text));
//!     let checked = toyproof_glsl::check(&files, file, &Default::default())?;
//!     let module = naga_ir::ValidModule::parse(&lower(&checked))?;
//!     let spirv = emit(&module, Target::Spirv)?;
//!     assert_eq!(spirv[..4], 0x0723_0203_u32.to_le_bytes());
//!     Ok(())
//! }
//! ```
//!
//! Programs that use wgpu or naga call [`glsl_to_module`], which does the first three steps.
//!
//! # Lowering
//!
//! Each pass of [`lower()`] rewrites one construct that naga or a driver gets wrong, and a test shows that it
//! still does without the pass, so that the pass can be removed some day. [`Lowered`] leads from naga's
//! messages back to the author's lines. naga's validator stays the gate: backends take only a
//! [`naga_ir::ValidModule`], and text that naga refuses is our error, never the shader's.
//!
//! # Strict and fast
//!
//! GLSL lets drivers rearrange sums, fuse products and choose the last bits of `sin`. With
//! [`FloatMode::Strict`], arithmetic is evaluated as written: such functions are expanded to exact operations
//! ([`lower_strict`]), and float operations carry `NoContraction` ([`backend::spirv::strict`]). All drivers
//! then give the bits that `toyproof_eval` computes in `f32`. With [`FloatMode::Fast`] the driver is free.
//!
//! # Interface of a translated shader
//!
//! The entry point is `main`, with the color at location 0. Group 0 has the uniform block of ShaderToy's
//! inputs at binding 0, in std140 layout (at the offsets of [`Input`](toyproof_glsl::tree::Input)), the
//! texture of channel K at binding 1 + 2K and its sampler at 2 + 2K. A shader declares only what it uses.
//!
//! # Crashes
//!
//! naga may panic, and drivers may crash or hang. `toyproof_gpu` runs both in a worker process.
//!
//! # Parts
//!
//! - [`lower`](mod@lower): one pass for each construct that naga or a driver gets wrong.
//! - `print`: the GLSL 450 that naga reads, with a map back to the author's spans ([`Lowered`]).
//! - `module`: [`glsl_to_module`], for programs that use naga.
//! - [`wgsl`]: the tree as WGSL that its author recognizes, for several kinds of host.
//! - [`c_family`]: the tree as HLSL that its author recognizes, for several hosts.
//! - [`naga_ir`]: naga's parsers and its validator.
//! - [`backend`]: SPIR-V, either strict or as naga writes it, also with floats of 16 bits; WGSL, MSL, HLSL and
//!   GLSL.
//! - `inexact`: the list of functions whose last bits are implementation-defined.

#![cfg_attr(
    not(feature = "backend"),
    expect(dead_code, reason = "only backends use some of the shared code")
)]

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;

mod author;
#[cfg(feature = "backend")]
pub mod backend;
pub mod c_family;
mod inexact;
pub mod lower;
mod module;
pub mod naga_ir;
mod print;
mod template;
mod unprintable;
pub mod wgsl;

pub use lower::{lower, lower_strict, lower_within};
pub use module::{GlslError, ModuleOptions, checked_to_module, glsl_to_module};
pub use naga;
pub use print::Lowered;
use serde::{Deserialize, Serialize};
use thiserror::Error;
use toyproof_diagnostic::{Deadline, Overdue};
use toyproof_glsl::Checked;
pub use unprintable::{Unprintable, WriteFailure};

use crate::lower::{Pass, Passes};

/// The version of naga that is linked.
pub const NAGA_VERSION: &str = "30.0.1";

/// Why a module cannot be read, changed or written: mostly naga's message.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct TranslateError(pub String);

impl TranslateError {
    fn new(message: impl std::fmt::Display) -> Self {
        Self(message.to_string())
    }
}

impl From<&str> for TranslateError {
    fn from(message: &str) -> Self {
        Self(message.to_owned())
    }
}

/// The freedom that a driver has to rearrange arithmetic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FloatMode {
    /// Evaluates arithmetic as written: operations carry `NoContraction`, derivatives use a pixel's own row
    /// and column, and functions such as `sin` are expanded.
    #[default]
    Strict,
    /// Leaves arithmetic to the driver.
    Fast,
}

impl FloatMode {
    /// Lowers a shader for naga; strict mode also expands every operation whose result depends on the driver.
    pub fn lower(self, checked: &Checked) -> Lowered {
        match self {
            Self::Strict => lower_strict(checked),
            Self::Fast => lower(checked),
        }
    }

    /// Lowers a shader like [`Self::lower`], within a deadline.
    ///
    /// # Errors
    /// If the deadline passes.
    pub fn lower_within(self, checked: &Checked, deadline: &Deadline) -> Result<Lowered, Overdue> {
        let passes = match self {
            Self::Strict => Passes::strict(),
            Self::Fast => Passes::required(),
        };
        lower_within(checked, passes, deadline)
    }

    /// Lowers a shader for a host that filters textures itself: unlike [`Self::lower_within`], strict mode
    /// leaves their lookups as they are.
    ///
    /// # Errors
    /// If the deadline passes.
    pub fn lower_for_host(self, checked: &Checked, deadline: &Deadline) -> Result<Lowered, Overdue> {
        lower_within(checked, self.passes_for_host(), deadline)
    }

    /// The passes for a host that filters textures itself.
    fn passes_for_host(self) -> Passes {
        match self {
            Self::Strict => Passes::strict().without(Pass::Lookups),
            Self::Fast => Passes::required(),
        }
    }
}
