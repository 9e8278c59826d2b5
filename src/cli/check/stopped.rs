//! Why a shader got no further.

use toyproof_diagnostic::{Diagnostic, Files, Severity};
use toyproof_eval as eval;
use toyproof_glsl::{self as glsl, Code};
use toyproof_gpu::Failure;
use toyproof_verify as verify;
use toyproof_verify::compare::Verdict;

use super::cut_short;
use crate::cli::run::place;
use crate::cli::shader::{Unusable, is_invalid};

/// Why a shader got no further.
pub(super) struct Stopped {
    pub(super) verdict: Verdict,
    pub(super) reason: String,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) files: Files,
}

impl Stopped {
    fn because(verdict: Verdict, reason: String) -> Self {
        Self {
            verdict,
            reason,
            diagnostics: Vec::new(),
            files: Files::default(),
        }
    }

    /// `verdict` is for what the text itself is guilty of.
    pub(super) fn unusable(unusable: Unusable, files: Files, verdict: Verdict) -> Self {
        match unusable {
            Unusable::Trouble(error) => Self::because(Verdict::Error, error),
            Unusable::Invalid(diagnostics) => Self::invalid(verdict, diagnostics, files),
        }
    }

    fn invalid(verdict: Verdict, diagnostics: Vec<Diagnostic>, files: Files) -> Self {
        let is_slow = |told: &Diagnostic| told.code == Code::TooSlow.as_str();
        let verdict = if diagnostics.iter().any(is_slow) {
            Verdict::Timeout
        } else {
            verdict
        };
        let error = diagnostics.iter().find(|told| told.severity == Severity::Error);
        let reason = error.map_or_else(
            || "it does not compile".to_owned(),
            |first| match first.span.map(|span| files.position(span)) {
                Some(at) => format!("{} (line {}, column {})", first.message, at.line, at.column),
                None => first.message.clone(),
            },
        );
        Self {
            verdict,
            reason,
            diagnostics,
            files,
        }
    }

    pub(super) fn failure(failure: verify::Failure, files: Files) -> Self {
        match failure {
            verify::Failure::Gpu(failure) => Self::gpu(failure, files),
            verify::Failure::CutShort(pixels) => Self::because(Verdict::Timeout, cut_short(pixels)),
            verify::Failure::Cpu(failure) => Self::cpu(&failure, &files),
            verify::Failure::Overdue(overdue) => {
                Self::invalid(Verdict::Timeout, vec![glsl::overdue(overdue)], files)
            }
        }
    }

    fn gpu(failure: Failure, files: Files) -> Self {
        let verdict = match &failure {
            failure if is_invalid(failure) => Verdict::Invalid,
            Failure::Timeout { .. } => Verdict::Timeout,
            _ => Verdict::Error,
        };
        match failure {
            Failure::Invalid(diagnostics) | Failure::Refused(diagnostics) => {
                Self::invalid(verdict, diagnostics, files)
            }
            failure => Self::because(verdict, failure.to_string()),
        }
    }

    fn cpu(failure: &eval::Failure, files: &Files) -> Self {
        use eval::Failure::{Interrupted, Refused, TimeUp, Timeout, TooOften};
        let verdict = match failure {
            Refused(_) | Interrupted => Verdict::Error,
            TooOften { .. } | Timeout { .. } | TimeUp => Verdict::Timeout,
        };
        let place = place(failure, files);
        Self::because(verdict, format!("{failure}{place}"))
    }
}
