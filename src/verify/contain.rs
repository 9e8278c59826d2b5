//! Contains panics: a fault in one part of the work loses that part, not the results that exist already.

use std::any::Any;
use std::fmt;
use std::panic::{self, AssertUnwindSafe};

use thiserror::Error;

/// A part of the work whose failure must cost nothing but itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A whole command: the program ends, with a special exit code.
    Command,
    /// All work on one shader of a batch.
    Shader,
    /// The search for the mistake that explains a wrong image.
    Mistake,
    /// The search for the edit that repairs a wrong shader.
    Repair,
    /// The search for the line where an unstable shader loses digits.
    Cause,
    /// Notes on values that are not finite.
    Notes,
    /// One image of a shader.
    Image,
    /// The lines that a terminal shows of a shader.
    Summary,
    /// One report of a batch.
    Report,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 9] = [
        Self::Command,
        Self::Shader,
        Self::Mistake,
        Self::Repair,
        Self::Cause,
        Self::Notes,
        Self::Image,
        Self::Summary,
        Self::Report,
    ];
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Command => "running the command",
            Self::Shader => "checking the shader",
            Self::Mistake => "searching for a likely mistake",
            Self::Repair => "searching for a repair",
            Self::Cause => "searching for the line that loses precision",
            Self::Notes => "collecting notes",
            Self::Image => "encoding an image",
            Self::Summary => "formatting the result",
            Self::Report => "writing a report",
        })
    }
}

/// A panic that was contained.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("internal error while {part}: {message}; this is a bug in toyproof; please report it with the input")]
pub struct Panic {
    /// The part in which the panic occurred.
    pub part: Part,
    /// The panic's own message.
    pub message: String,
}

/// Runs a part of the work. After a panic, values that `work` has changed must not be used, unless the
/// invariants of these hold after each of its steps.
///
/// # Errors
/// The panic, if there was one; its location has gone to the panic hook.
pub fn contain<T>(part: Part, work: impl FnOnce() -> T) -> Result<T, Panic> {
    let work = || {
        inject(part);
        work()
    };
    panic::catch_unwind(AssertUnwindSafe(work)).map_err(|payload| Panic {
        part,
        message: message(payload.as_ref()).to_owned(),
    })
}

/// The message of a panic, from its payload.
#[must_use]
pub fn message(payload: &dyn Any) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("panic without a message")
}

/// The environment variable by which tests make a [`Part`] panic, named as in the source.
pub const INJECTION: &str = "TOYPROOF_PANIC_IN";

fn inject(part: Part) {
    let is_injected = || std::env::var_os(INJECTION).is_some_and(|name| *name == *format!("{part:?}"));
    assert!(!is_injected(), "injected by {INJECTION}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_with_its_message_also_from_other_threads() {
        assert_eq!(contain(Part::Image, || 1), Ok(1));
        let message = |work: fn()| contain(Part::Image, work).unwrap_err().message;
        assert_eq!(message(|| panic!("plain")), "plain");
        assert_eq!(message(|| panic!("of {}", 3)), "of 3");
        let threads = || {
            use rayon::prelude::*;
            (0..100).into_par_iter().for_each(|n| assert!(n < 50, "in rayon"));
        };
        assert_eq!(message(threads), "in rayon");
    }
}
