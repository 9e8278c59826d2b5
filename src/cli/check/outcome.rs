//! The result of checking a shader: its record, and the messages that wait for its turn.

use toyproof_diagnostic::{Diagnostic, Files};
use toyproof_report::Record;

use crate::cli::Terminal;

/// A message that waits for its shader's turn.
pub(super) enum Message {
    Diagnostics(Vec<Diagnostic>, Files),
    Warning(String),
    Error(String),
    Detail(String),
}

impl Message {
    pub(super) fn print(&self, terminal: &Terminal) {
        match self {
            Self::Diagnostics(diagnostics, files) => terminal.diagnostics(diagnostics, files),
            Self::Warning(message) => terminal.warn(message),
            Self::Error(message) => terminal.error(message),
            Self::Detail(message) => terminal.detail(message),
        }
    }
}

/// The result of checking a shader.
pub(super) struct Outcome {
    pub(super) record: Record,
    pub(super) log: Log,
}

/// The messages on a shader, and what else is known of its check apart from its record.
#[derive(Default)]
pub(super) struct Log {
    /// The messages to print.
    pub(super) messages: Vec<Message>,
    pub(super) device: Option<String>,
    /// Whether something failed that the verdict does not show.
    pub(super) failed: bool,
    /// Whether an image could not be written, so that `--resume` has to check the shader again.
    pub(super) lacks_image: bool,
}

impl Log {
    /// Adds diagnostics, except those that are known from another frame.
    pub(super) fn diagnostics(&mut self, diagnostics: Vec<Diagnostic>, files: &Files) {
        let is_new = |diagnostic: &Diagnostic| {
            !self.messages.iter().any(|message| match message {
                Message::Diagnostics(known, _) => known.contains(diagnostic),
                _ => false,
            })
        };
        let diagnostics: Vec<_> = diagnostics.into_iter().filter(is_new).collect();
        if !diagnostics.is_empty() {
            self.messages
                .push(Message::Diagnostics(diagnostics, files.clone()));
        }
    }

    pub(super) fn warn(&mut self, message: String) {
        self.messages.push(Message::Warning(message));
    }

    pub(super) fn detail(&mut self, message: String) {
        self.messages.push(Message::Detail(message));
    }

    pub(super) fn fail(&mut self, message: String) {
        self.messages.push(Message::Error(message));
        self.failed = true;
    }
}
