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

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_eval::{Engine, Number, Settings, Substitute};
    use toyproof_image::Frame;

    use super::*;

    /// The color of `int(float)`, and whether it is observed as out of range, with each engine. The shader
    /// multiplies the float's double by the fraction of a pixel's center, 0.5, so that nothing folds it.
    fn converted<N: Number>(double: &str, undefined: UndefinedPolicy) -> Vec<(f64, bool)> {
        let text =
            format!("void mainImage(out vec4 c, in vec2 p) {{ c = vec4(int(fract(p.x) * {double})); }}");
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        let checked = toyproof_glsl::check(&files, file, &Default::default()).unwrap();
        let program = Program::new(&checked).unwrap();
        let frame = Frame {
            size: [48, 27],
            ..Frame::default()
        };
        let engines = [Engine::Handlers, Engine::Native, Engine::Avx2].into_iter();
        let results = engines.map(|engine| {
            let settings = Settings::<N> {
                undefined,
                engine,
                ..Settings::default()
            };
            let rendered = program.render(&frame, &settings).unwrap();
            let color = rendered.framebuffer.get(7, 5)[0].to_f64();
            (color, !rendered.observations.faults.is_empty())
        });
        results.collect()
    }

    #[test]
    fn the_range_of_int_begins_with_the_smallest_int_in_both_precisions() {
        // Half of the third is the first f64 that is out of range, and rounds to the smallest int in f32.
        for (double, is_int32, is_int64) in [
            ("-4294967296.0", true, true),
            ("-4294967297.0", true, true),
            ("-4294967298.0", true, false),
            ("-4294967808.0", false, false),
            ("4294967040.0", true, true),
            ("4294967296.0", false, false),
        ] {
            let smallest = f64::from(i32::MIN);
            let observed = UndefinedPolicy::Observed;
            for (_, is_fault) in converted::<f32>(double, observed) {
                assert_eq!(is_fault, !is_int32, "{double} in f32");
            }
            for (_, is_fault) in converted::<f64>(double, observed) {
                assert_eq!(is_fault, !is_int64, "{double} in f64");
            }
            let substitute = UndefinedPolicy::Substitute(Substitute::Number);
            for (color, _) in converted::<f32>(double, substitute) {
                assert_eq!(color == 0.0, !is_int32, "{double} in f32 is {color}");
                assert!(!double.starts_with('-') || !is_int32 || color == smallest);
            }
            for (color, _) in converted::<f64>(double, substitute) {
                assert_eq!(color == 0.0, !is_int64, "{double} in f64 is {color}");
                assert!(!double.starts_with('-') || !is_int64 || color == smallest);
            }
        }
    }
}
