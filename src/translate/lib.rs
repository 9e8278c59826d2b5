//! Translates checked shaders to GPU languages.
//!
//! There are two paths: GLSL 450, in the subset that naga parses correctly, which naga writes as SPIR-V,
//! WGSL, MSL, HLSL or GLSL; and WGSL printed straight from the syntax tree, which the author would recognize.
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_translate::backend::{Target, emit};
//! use toyproof_translate::{lower, naga_ir};
//!
//! let mut files = Files::default();
//! let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0, 1); }";
//! let file = files.add(File::new("gradient.glsl", text));
//! let checked = toyproof_glsl::check(&files, file, &Default::default()).unwrap();
//! let module = naga_ir::ValidModule::parse(&lower(&checked)).unwrap();
//! let spirv = emit(&module, Target::Spirv).unwrap();
//! assert_eq!(spirv[..4], 0x0723_0203_u32.to_le_bytes());
//! ```

pub mod backend;
pub mod lower;
pub mod naga_ir;
mod print;
pub mod wgsl;

pub use lower::{lower, lower_strict, lower_within};
pub use print::Lowered;
use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Deadline, Overdue};
use toyproof_glsl::Checked;

use crate::lower::Passes;

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
    #[must_use]
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
            Self::Fast => Passes::all(),
        };
        lower_within(checked, passes, deadline)
    }
}
