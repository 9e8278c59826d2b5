//! Why a graphics driver rendered no image.

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use thiserror::Error;
use toyproof_diagnostic::Diagnostic;

/// What the driver's process was doing when a job failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Loading the driver.
    Starting,
    /// naga parses, validates and emits the shader.
    Translating,
    /// The driver compiles the shader.
    Compiling,
    /// The frame is rendered and read back.
    Drawing,
    /// The frame is rendered again to check whether the driver terminated a loop.
    WatchingLoops,
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Starting => "the Vulkan driver was starting",
            Self::Translating => "naga was translating the shader",
            Self::Compiling => "the driver was compiling the shader",
            Self::Drawing => "the driver was rendering the frame",
            Self::WatchingLoops => "the driver was rendering the frame with instrumented loops",
        })
    }
}

/// Why a driver rendered no image of a shader.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
pub enum DriverFailure {
    /// The shader does not compile.
    #[error("the shader does not compile")]
    Invalid(Vec<Diagnostic>),
    /// naga rejects our lowering of a valid shader.
    #[error("naga cannot translate this shader")]
    Refused(Vec<Diagnostic>),
    /// naga's own front end rejects the output.
    #[error("naga's front end rejects the translated shader: {0}")]
    Reread(String),
    /// naga failed internally.
    #[error("naga cannot translate this shader: {0}")]
    Naga(String),
    /// The deadline expired.
    #[error("time limit of {:.1} s exceeded while {phase}", after.as_secs_f64())]
    Timeout {
        /// Phase in which it expired.
        phase: Phase,
        /// The deadline.
        after: Duration,
    },
    /// The memory limit was reached.
    #[error("out of memory while {phase} (limit {} GiB)", limit_bytes >> 30)]
    OutOfMemory {
        /// Phase in which it happened.
        phase: Phase,
        /// The limit.
        limit_bytes: u64,
    },
    /// The stack overflowed: recursion on deeply nested code.
    #[error("nested too deeply: stack overflow while {phase}")]
    StackOverflow {
        /// Phase in which it happened.
        phase: Phase,
    },
    /// The worker process terminated.
    #[error("the worker process {how} while {phase}")]
    Crash {
        /// Phase in which it happened.
        phase: Phase,
        /// Signal or exit code, and the last line of standard error.
        how: String,
    },
    /// The driver failed or lost the device.
    #[error("the Vulkan driver failed: {0}")]
    Device(String),
    /// There is no driver that matches the selector.
    #[error("{0}")]
    NoDriver(String),
    /// The driver or the worker process did not start, independently of any shader.
    #[error("{0}")]
    NotStarted(String),
    /// The worker process could not be started, or communication with it failed.
    #[error("cannot run the worker process: {0}")]
    Worker(String),
}

impl DriverFailure {
    /// Returns whether no driver is usable, whatever the shader. The evaluator may take its place.
    pub fn is_without_driver(&self) -> bool {
        matches!(self, Self::NoDriver(_) | Self::NotStarted(_))
    }

    /// Returns the diagnostics on the shader.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Invalid(diagnostics) | Self::Refused(diagnostics) => diagnostics,
            _ => &[],
        }
    }

    /// Returns whether the deadline expired.
    pub fn is_timeout(&self) -> bool {
        matches!(self, Self::Timeout { .. })
    }

    /// Returns whether the shader does not compile, as opposed to an error of the tools.
    pub fn is_invalid(&self) -> bool {
        matches!(
            self,
            Self::Invalid(_)
                | Self::StackOverflow {
                    phase: Phase::Translating | Phase::Compiling
                }
        )
    }

    /// Returns whether the deadline expired while the driver compiled the shader, which does not imply that
    /// the shader runs long.
    pub fn is_slow_compilation(&self) -> bool {
        matches!(
            self,
            Self::Timeout {
                phase: Phase::Compiling,
                ..
            }
        )
    }
}
