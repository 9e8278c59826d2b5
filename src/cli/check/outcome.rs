//! The result of checking a shader: its record, and the messages that wait for its turn.

use toyproof_diagnostic::{self as diagnostic, Diagnostic, Files};
use toyproof_explain::Findings;
use toyproof_report::Record;
use toyproof_verify::Failure;

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

/// What is known of the check of a shader apart from its record.
#[derive(Default)]
pub(super) struct Log {
    /// The messages to print.
    pub(super) messages: Vec<Message>,
    /// The diagnostics of the frame in progress.
    pub(super) diagnostics: Vec<diagnostic::Json>,
    pub(super) device: Option<String>,
    /// Whether something failed that the verdict does not show.
    pub(super) failed: bool,
    /// Whether an image could not be written, so that `--resume` has to check the shader again.
    pub(super) lacks_image: bool,
    /// Whether the driver, which names no line, exceeded the time limit.
    pub(super) is_late_on_gpu: bool,
}

impl Log {
    pub(super) fn report_findings(&mut self, shader: &str, findings: &Findings) {
        if let Some(gpu_run) = &findings.results.gpu_run {
            self.messages.push(Message::Detail(format!(
                "{shader}: translated in {:.4} s, compiled in {:.3} s, rendered in {:.3} s on {}",
                gpu_run.translate.as_secs_f64(),
                gpu_run.compile.as_secs_f64(),
                gpu_run.draw.as_secs_f64(),
                gpu_run.device
            )));
            self.device = Some(gpu_run.device.clone());
        }
    }

    pub(super) fn report_failure(&mut self, failure: &Failure, files: &Files) {
        self.report(failure.diagnostics(), files);
        self.is_late_on_gpu = match failure {
            Failure::LoopTruncated(_) => true,
            Failure::Gpu(failure) => failure.is_timeout(),
            _ => false,
        };
    }

    pub(super) fn report(&mut self, diagnostics: Vec<Diagnostic>, files: &Files) {
        let json = diagnostics.iter().map(|one| diagnostic::json(one, files));
        self.diagnostics.extend(json);
        // Diagnostics that are the same in several frames are printed once.
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

    pub(super) fn fail(&mut self, message: String) {
        self.messages.push(Message::Error(message));
        self.failed = true;
    }
}
