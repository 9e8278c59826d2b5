//! Reduces a GLSL shader to the smallest one that still shows a fault, such as a compiler's error, a driver's
//! crash or a different image. What the fault is, a [`Tester`] decides; [`fault`] has those of toyproof's own
//! checks and of any command.
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_reduce::{Limits, Progress, reduce};
//!
//! let text = "float twice(float x) { return 2. * x; } // doubles\n\
//!             void mainImage(out vec4 c, in vec2 p) {\n\
//!                 float a = twice(p.x);\n\
//!                 if (a > 1.) { a = a + dFdx(a); }\n\
//!                 c = vec4(a);\n\
//!             }\n";
//! let language = toyproof_glsl::Options::default();
//! let takes_derivative = |text: &str| {
//!     let mut files = Files::default();
//!     let file = files.add(File::new("candidate", text));
//!     let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default());
//!     checked.is_ok_and(|checked| checked.takes_derivatives())
//! };
//! let mut go_on = |_: &Progress| ControlFlow::Continue(());
//! let reduced = reduce(text, &language, &Limits::default(), &|| takes_derivative, &mut go_on).unwrap();
//! assert_eq!(reduced.text, "void mainImage(out vec4 c, in vec2 p) {\n    dFdx(0.);\n}\n");
//! ```
//!
//! # How it works
//!
//! Candidates are texts: the tree shows what may go, and a rewrite edits the text, which is then tested
//! like any other. So a fault in how a candidate is made loses the candidate, and cannot give a wrong result.
//! A text that does not compile is reduced by its brackets and tokens.
//!
//! Kinds of rewrites follow each other from the largest to the smallest; of each, all are tried together,
//! then halves of them, until each is tried alone (delta debugging, Zeller and Hildebrandt 2002). All of this
//! is repeated until nothing succeeds.
//!
//! # Parts
//!
//! - `rewrites`: what is tried, by kind: declarations, functions, statements, variables, expressions, tokens.
//! - `outline`: declarations and statements of a text by its brackets; `rewrite`: edits that apply together.
//! - `search`: tries candidates on several threads; `size`: which of two texts is smaller.
//! - `parts`: several texts that show a fault together, such as the passes of a project.
//! - [`fault`]: the faults of naga, drivers, toyproof and commands, and how they are found and compared.
//! - [`report`]: the text of an issue for the project whose fault it is; `khronos`: what glslang and
//!   spirv-val say about its shader.

pub mod fault;
mod khronos;
mod outline;
mod parts;
pub mod report;
mod rewrite;
mod rewrites;
mod search;
mod size;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use thiserror::Error;
use toyproof_diagnostic::Deadline;
use toyproof_glsl as glsl;

pub use self::parts::{OnPartsProgress, Part, PartsReduction, PartsTester, Texts, reduce_parts};
pub use self::size::Size;

/// Decides whether a text shows the fault. Each thread has its own.
pub trait Tester {
    /// Whether a text shows the fault; the same for the same text.
    fn shows_fault(&mut self, text: &str) -> bool;
}

impl<F: FnMut(&str) -> bool> Tester for F {
    fn shows_fault(&mut self, text: &str) -> bool {
        self(text)
    }
}

/// How long a reduction may take, and on how many threads.
#[derive(Debug, Clone)]
pub struct Limits<'a> {
    /// The number of threads that test candidates, at least 1.
    pub threads: usize,
    /// When the reduction ends with what it has.
    pub deadline: Deadline,
    /// Set to end the reduction with what it has.
    pub stop: Option<&'a AtomicBool>,
}

impl Default for Limits<'_> {
    /// One thread, without a limit.
    fn default() -> Self {
        Self {
            threads: 1,
            deadline: Deadline::default(),
            stop: None,
        }
    }
}

impl Limits<'_> {
    fn are_over(&self) -> bool {
        self.deadline.is_over() || self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

/// The state of a reduction.
#[derive(Debug, Clone, Copy)]
pub struct Progress<'a> {
    /// The smallest text so far.
    pub text: &'a str,
    /// Its size.
    pub size: Size,
    /// The number of candidates that were tested.
    pub tries: u64,
    /// Whether the text has just become smaller.
    pub is_smaller: bool,
}

/// The result of a reduction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reduction {
    /// The smallest text.
    pub text: String,
    /// The number of candidates that were tested, without those that threads tried in advance.
    pub tries: u64,
    /// Whether no rewrite succeeds any more; otherwise a limit or the caller has ended the reduction.
    pub is_complete: bool,
}

/// The text does not show the fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the shader does not show the fault")]
pub struct NoFault;

/// Reduces a text that shows a fault. `language` is how the text is checked; `make_tester` is called once on
/// each thread. `on_progress` gets every smaller text, and may end the reduction.
///
/// # Errors
/// If the text does not show the fault.
pub fn reduce<T: Tester>(
    text: &str,
    language: &glsl::Options,
    limits: &Limits,
    make_tester: &(impl Fn() -> T + Sync),
    on_progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Reduction, NoFault> {
    if !make_tester().shows_fault(text) {
        return Err(NoFault);
    }
    Ok(search::run(text, language, limits, make_tester, on_progress))
}

#[cfg(test)]
mod tests;
