//! From a checked shader to the languages that GPUs take: by way of GLSL 450 that naga reads rightly, to SPIR-V, WGSL,
//! MSL, HLSL and GLSL; or straight from the tree to WGSL that the author would recognize.
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

/// How far the driver may rearrange arithmetic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum FloatMode {
    /// As written: operations carry `NoContraction`, derivatives are those of a pixel's own row and column, and `sin` and the like are
    /// spelled out.
    #[default]
    Strict,
    /// As the driver likes.
    Fast,
}

impl FloatMode {
    /// What naga is fed of a shader: in strict mode with all spelled out that drivers differ in.
    #[must_use]
    pub fn lower(self, checked: &Checked) -> Lowered {
        match self {
            Self::Strict => lower_strict(checked),
            Self::Fast => lower(checked),
        }
    }

    /// The same within a deadline.
    ///
    /// # Errors
    /// If it passes.
    pub fn lower_within(self, checked: &Checked, deadline: &Deadline) -> Result<Lowered, Overdue> {
        let passes = match self {
            Self::Strict => Passes::strict(),
            Self::Fast => Passes::all(),
        };
        lower_within(checked, passes, deadline)
    }
}
