//! The exit status of a command, and the error that ends it.

use std::fmt::Display;

use toyproof_diagnostic::{Diagnostic, Files, short};

/// The exit status of a command; the codes have the meanings that they have in grep, diff and cmp.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// Exit code 0.
    Success,
    /// Exit code 1: a shader is at fault, or images differ.
    ShaderFault,
    /// Exit code 2: any other error.
    Error,
}

/// The error that ends a command, or the part of it that concerns one input. Functions return it, and the
/// command line prints it in one place, with [`Terminal::fail`](super::Terminal::fail).
#[derive(Debug)]
pub(super) struct CliError {
    /// Diagnostics on a file that the user named, with its text. They are printed first.
    pub(super) diagnostics: Option<(Vec<Diagnostic>, Files)>,
    /// A sentence; a line `help: …` at its end is the advice.
    pub(super) message: Option<String>,
    /// A way out.
    pub(super) help: Option<String>,
    pub(super) exit: Exit,
}

impl CliError {
    pub(super) fn new(message: impl Display) -> Self {
        Self {
            message: Some(message.to_string()),
            ..Self::silent()
        }
    }

    /// An error that prints nothing: writing to standard output failed, which has been reported, or the
    /// user interrupted the command.
    pub(super) fn silent() -> Self {
        Self {
            diagnostics: None,
            message: None,
            help: None,
            exit: Exit::Error,
        }
    }

    /// Diagnostics on files that the user named.
    pub(super) fn diagnostics(diagnostics: impl Into<Vec<Diagnostic>>, files: &Files) -> Self {
        Self {
            diagnostics: Some((diagnostics.into(), files.clone())),
            ..Self::silent()
        }
    }

    pub(super) fn with_message(self, message: impl Display) -> Self {
        Self {
            message: Some(message.to_string()),
            ..self
        }
    }

    pub(super) fn with_help(self, help: impl Display) -> Self {
        Self {
            help: Some(help.to_string()),
            ..self
        }
    }

    /// The first diagnostic, and the message, in one line.
    pub(super) fn in_one_line(&self) -> String {
        let diagnostic = self.diagnostics.as_ref();
        let diagnostic = diagnostic.and_then(|(all, files)| Some(short(all.first()?, files)));
        let message = self.message.as_deref().and_then(|message| message.lines().next());
        let parts = diagnostic.iter().map(String::as_str).chain(message);
        parts.collect::<Vec<_>>().join("; ")
    }

    /// Sets the exit status, which is [`Exit::Error`] by default.
    pub(super) fn with_exit(self, exit: Exit) -> Self {
        Self { exit, ..self }
    }
}

impl<E: Display> From<E> for CliError {
    fn from(error: E) -> Self {
        Self::new(error)
    }
}
