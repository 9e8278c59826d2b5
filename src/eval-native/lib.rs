//! Machine code for [`toyproof_eval`], with the bits of its instruction handlers. [`Program`] takes the place
//! of the evaluator's, and renders images of many pixels 1.2 to 3.4 times as fast.
//!
//! There is machine code for x86-64 processors with AVX2 or AVX-512 (`x86_64`). On others, where a system
//! refuses executable memory, and for traces and random rounding, the handlers run.
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_eval::Settings;
//! use toyproof_eval_native::Program;
//! use toyproof_image::Frame;
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0, 1); }";
//!     let file = files.add(File::new("gradient.glsl", text));
//!     let checked = toyproof_glsl::check(&files, file, &Default::default())?;
//!     let frame = Frame { size: [640, 360], ..Frame::default() };
//!     let rendered = Program::new(&checked)?.render(&frame, &Settings::<f32>::default())?;
//!     assert_eq!(rendered.framebuffer.get(320, 0)[0], 320.5 / 640.0);
//!     Ok(())
//! }
//! ```

use std::ops::Deref;
use std::time::Duration;

use toyproof_eval::native::NativeCompiler;
use toyproof_eval::{Refusal, UndefinedPolicy};
use toyproof_glsl::Checked;

#[cfg(target_arch = "x86_64")]
mod x86_64;

/// The compiler for this kind of processor.
#[cfg(target_arch = "x86_64")]
const COMPILER: Option<&'static dyn NativeCompiler> = Some(&x86_64::Compiler);
#[cfg(not(target_arch = "x86_64"))]
const COMPILER: Option<&'static dyn NativeCompiler> = None;

/// A [`toyproof_eval::Program`] with machine code.
///
/// The evaluator does not depend on a compiler to machine code; the type of the program chooses one. A
/// parameter would be repeated at each of the fifty calls that compile a shader, and a registration at run
/// time could come too late.
#[derive(Debug)]
pub struct Program(toyproof_eval::Program);

impl Program {
    /// Compiles a shader.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined.
    pub fn new(checked: &Checked) -> Result<Self, Refusal> {
        Self::prepared_within(checked, UndefinedPolicy::Observed, None)
    }

    /// Compiles a shader with a time limit.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined, or takes longer.
    pub fn within(checked: &Checked, limit: Duration) -> Result<Self, Refusal> {
        Self::prepared_within(checked, UndefinedPolicy::Observed, Some(limit))
    }

    /// Compiles one variant of a shader; the others are compiled on first use.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined.
    pub fn prepared(checked: &Checked, variant: UndefinedPolicy) -> Result<Self, Refusal> {
        Self::prepared_within(checked, variant, None)
    }

    /// Compiles one variant of a shader, with an optional time limit; the others are compiled on first use.
    ///
    /// # Errors
    /// If it is too large once its calls are inlined, or takes longer.
    pub fn prepared_within(
        checked: &Checked,
        variant: UndefinedPolicy,
        limit: Option<Duration>,
    ) -> Result<Self, Refusal> {
        toyproof_eval::Program::compile(checked, variant, limit, COMPILER).map(Self)
    }
}

impl Deref for Program {
    type Target = toyproof_eval::Program;

    fn deref(&self) -> &toyproof_eval::Program {
        &self.0
    }
}
