//! Faults that a shader may show, how they are found, and when two are the same.
//!
//! A candidate must show the same fault, not just any: reducers slip from one fault to a simpler one
//! otherwise. So a fault has what distinguishes it: naga's message up to names and numbers, how the driver
//! died, whether differing pixels are numbers, which pixels are wrong.

mod command;
mod compiled;
mod message;
mod observe;

use std::fmt;

use thiserror::Error;
use toyproof_diagnostic::{Code, Diagnostic, Severity};
use toyproof_image::Rgb8Image;
use toyproof_player::Target;
use toyproof_translate::backend;
use toyproof_verify::Verdict;
use toyproof_verify::compare::Pixel;

pub use self::command::{CommandError, CommandInput, CommandLine, Ending};
pub use self::compiled::ProjectParts;
pub use self::message::pattern;
pub use self::observe::{Session, Subject, Tools, WorkerFactory};
use crate::Tester;
use crate::parts::PartsTester;
use crate::report::language;

/// A fault of a shader, or of a tool that processes it.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The shader does not compile, or has a warning.
    Diagnostic {
        /// The code of the error or warning.
        code: Code,
        /// The [`pattern`] of its message.
        message: String,
        /// The codes of all errors of the original: a candidate has no others.
        errors: Vec<Code>,
    },
    /// naga refuses the lowered shader, or panics.
    Naga {
        /// The language that naga was to write.
        target: backend::Target,
        /// The [`pattern`] of its message.
        message: String,
    },
    /// The driver crashes, hangs or fails.
    Driver {
        /// The [`pattern`] of how it did.
        message: String,
    },
    /// The driver's image differs from the evaluator's in pixels that depend on no undefined operation.
    Toolchain {
        /// The first pass that differs.
        pass: Target,
        /// Whether both colors are numbers in a differing pixel; otherwise one is infinite or NaN.
        is_finite: bool,
    },
    /// The verdict on the shader.
    Verdict {
        /// The verdict.
        verdict: Verdict,
        /// The image of a wrong shader, which stays as it is: almost any shader is wrong in some way.
        image: Option<Rgb8Image>,
    },
    /// A command ends in a certain way.
    Command {
        /// The command.
        command: CommandLine,
        /// How it ends.
        ending: Ending,
    },
}

impl Fault {
    /// What to search for to find it again.
    pub fn wanted(&self) -> Wanted {
        match self {
            Self::Diagnostic { code, .. } => Wanted::Diagnostic(*code),
            Self::Naga { .. } => Wanted::Naga,
            Self::Driver { .. } => Wanted::Driver,
            Self::Toolchain { .. } => Wanted::Toolchain,
            Self::Verdict { verdict, .. } => Wanted::Verdict(Some(*verdict)),
            Self::Command { command, .. } => Wanted::Command(command.clone()),
        }
    }
}

/// The faults that are searched for.
#[derive(Debug, Clone, PartialEq)]
pub enum Wanted {
    /// The first that the shader shows, in the order of [`Fault`]; warnings last.
    Any,
    /// An error or a warning with this code.
    Diagnostic(Code),
    /// [`Fault::Naga`].
    Naga,
    /// [`Fault::Driver`].
    Driver,
    /// [`Fault::Toolchain`].
    Toolchain,
    /// [`Fault::Verdict`], any but those without a fault, or this one.
    Verdict(Option<Verdict>),
    /// [`Fault::Command`].
    Command(CommandLine),
}

/// Why no fault was found.
#[derive(Debug, Error)]
pub enum NotFound {
    /// The shader does not show it.
    #[error("{0}")]
    Absent(String),
    /// The shader cannot be tested for it.
    #[error("{0}")]
    Untested(String),
    /// The command cannot be run.
    #[error(transparent)]
    Command(#[from] CommandError),
}

/// A fault with what can be said about it, for people.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The fault.
    pub fault: Fault,
    /// The message of the tool, if it has one.
    pub message: Option<String>,
    /// A pixel that differs.
    pub pixel: Option<Pixel>,
    /// The number of pixels that differ, and of all.
    pub differing: Option<[u64; 2]>,
    /// The driver, if one rendered an image.
    pub device: Option<String>,
}

impl Finding {
    fn new(fault: Fault) -> Self {
        Self {
            fault,
            message: None,
            pixel: None,
            differing: None,
            device: None,
        }
    }

    /// The finding of an error or warning, among errors with some codes.
    fn of_diagnostic(diagnostic: &Diagnostic, errors: Vec<Code>) -> Self {
        let fault = Fault::Diagnostic {
            code: diagnostic.code,
            message: pattern(&diagnostic.message),
            errors,
        };
        Self::new(fault).with_message(&diagnostic.message)
    }

    fn with_message(self, message: impl Into<String>) -> Self {
        Self {
            message: Some(message.into()),
            ..self
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let message = self.message.as_deref().unwrap_or_default();
        match &self.fault {
            Fault::Diagnostic { code, .. } if code.severity() == Severity::Error => {
                write!(f, "error {code}: {message}")
            }
            Fault::Diagnostic { code, .. } => write!(f, "warning {code}: {message}"),
            Fault::Naga { target, .. } => write!(f, "naga does not write {}: {message}", language(*target)),
            Fault::Driver { .. } => write!(f, "the driver fails: {message}"),
            Fault::Toolchain { pass, .. } => match self.differing {
                Some([differing, pixels]) => {
                    let of_pass = match pass {
                        Target::Image => String::new(),
                        Target::Buffer(_) => format!(" of {pass}"),
                    };
                    write!(
                        f,
                        "{differing} of {pixels} pixels{of_pass} differ between the driver and the evaluator"
                    )
                }
                None => f.write_str("the driver and the evaluator differ"),
            },
            Fault::Verdict { verdict, .. } => write!(f, "the verdict `{verdict}`"),
            Fault::Command { command, ending } => write!(f, "`{command}` {ending}"),
        }
    }
}

/// Finds a fault of texts: one text of a shader, or those of the parts of a project. Of several frames, which
/// differ in their size, the first one counts in which the shader shows it; the subject then has this size.
///
/// # Errors
/// If the texts do not show the fault, or cannot be tested for it.
pub fn find(
    subject: &mut Subject,
    sizes: &[[u32; 2]],
    wanted: &Wanted,
    texts: &[Option<String>],
) -> Result<Finding, NotFound> {
    let mut last = None;
    for &size in sizes {
        subject.frame.size = size;
        match Session::new(subject).find(wanted, texts) {
            Err(error @ NotFound::Absent(_)) => last = Some(error),
            result => return result,
        }
    }
    if *wanted == Wanted::Any
        && let Some(found) = Session::new(subject).first_warning(texts)
    {
        return Ok(found);
    }
    Err(last.unwrap_or_else(|| NotFound::Untested("there is no frame to render".to_owned())))
}

/// Tests candidates for a fault.
pub struct FaultTester<'a> {
    session: Session<'a>,
    fault: &'a Fault,
    /// Whether a command gets candidates that compile only, since the original does.
    must_compile: bool,
    /// The largest number of reads without a value, which is that of the original, if the fault is a value: one
    /// that is open is not a fault. `None` if values do not matter.
    max_uninitialized: Option<usize>,
}

impl<'a> FaultTester<'a> {
    /// A tester for a fault of texts.
    pub fn new(subject: &'a Subject, fault: &'a Fault, original: &[Option<String>]) -> Self {
        let session = Session::new(subject);
        let must_compile = matches!(fault, Fault::Command { .. }) && session.compiles(original);
        let max_uninitialized = match fault {
            Fault::Toolchain { .. } => session.uninitialized_reads(original),
            _ => None,
        };
        Self {
            session,
            fault,
            must_compile,
            max_uninitialized,
        }
    }
}

impl PartsTester for FaultTester<'_> {
    fn show_fault(&mut self, texts: &[Option<String>]) -> bool {
        if self.must_compile && !self.session.compiles(texts) {
            return false;
        }
        let reads = || self.session.uninitialized_reads(texts);
        if self
            .max_uninitialized
            .is_some_and(|max| reads().is_none_or(|reads| reads > max))
        {
            return false;
        }
        self.session.shows(self.fault, texts)
    }
}

impl Tester for FaultTester<'_> {
    fn shows_fault(&mut self, text: &str) -> bool {
        self.show_fault(&[Some(text.to_owned())])
    }
}
