//! Limits of a run, and the reasons why it fails.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use thiserror::Error;
use toyproof_glsl::tree::Place;

use crate::build::Refusal;
use crate::exec::batch::{Cancellation, Stop};
use crate::exec::number::Arithmetic;
use crate::exec::settings::Settings;
use crate::lower::LoweredCode;

/// The reason why rendering failed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Failure {
    /// The shader cannot be compiled.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A pixel exceeded the limit of loop iterations.
    #[error("a pixel exceeded the limit of {limit} loop iterations")]
    TooOften {
        /// The limit.
        limit: u32,
        /// The loop that ran last.
        at: Place,
    },
    /// The deadline passed inside a loop.
    #[error("time limit exceeded inside a loop")]
    Timeout {
        /// The loop.
        at: Place,
    },
    /// The deadline passed between two parts of the image.
    #[error("time limit exceeded")]
    TimeUp,
    /// [`Settings::interrupt`] was set.
    #[error("interrupted")]
    Interrupted,
}

/// The limits of a run.
pub(crate) struct Limits<'a> {
    deadline: Option<Instant>,
    interrupt: Option<&'a AtomicBool>,
    /// Set by the first part that fails, so that the others end.
    pub(crate) failed: AtomicBool,
}

impl<'a> Limits<'a> {
    pub(crate) fn new<N: Arithmetic>(settings: &Settings<'a, N>) -> Self {
        Self {
            deadline: settings.deadline,
            interrupt: settings.interrupt,
            failed: AtomicBool::new(false),
        }
    }

    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    fn is_late(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }
}

impl Cancellation for Limits<'_> {
    fn is_cancelled(&self) -> bool {
        self.failed.load(Ordering::Relaxed) || self.is_interrupted() || self.is_late()
    }
}

/// The reason why a band was not rendered.
#[derive(Debug, Clone, Copy)]
pub(crate) enum BandError {
    Cancelled,
    LoopStopped(Stop),
}

impl BandError {
    /// Converts to the error that callers see.
    pub(crate) fn failure(self, compiled: &LoweredCode, limits: &Limits<'_>, limit: u32) -> Failure {
        match self {
            Self::LoopStopped(stop) if stop.over_limit => Failure::TooOften {
                limit,
                at: compiled.loop_at(stop.id),
            },
            _ if limits.is_interrupted() => Failure::Interrupted,
            Self::LoopStopped(stop) => Failure::Timeout {
                at: compiled.loop_at(stop.id),
            },
            Self::Cancelled => Failure::TimeUp,
        }
    }
}
