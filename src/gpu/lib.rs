//! Runs shaders on a Vulkan driver in a worker process, so that a hang, a crash or memory exhaustion affects
//! one shader only.
//!
//! The worker is the host program itself, started again with the arguments that it names: no second binary
//! has to be installed or found. So `main` must serve the worker before it does anything else, and write
//! nothing to standard output there, which carries the replies:
//!
//! ```no_run
//! use std::time::Duration;
//!
//! use toyproof_gpu::{AdapterSelector, Worker, serve};
//!
//! let arguments: Vec<String> = std::env::args().skip(1).collect();
//! if arguments == ["worker"] {
//!     return serve(std::io::stdin(), std::io::stdout()).unwrap();
//! }
//! let program = std::env::current_exe().unwrap();
//! let timeout = Duration::from_secs(10);
//! let mut worker = Worker::new(program, vec!["worker".into()], AdapterSelector::Auto, timeout);
//! println!("{:?}", worker.probe());
//! ```
//!
//! naga and the driver run in the worker process: [`Worker`] is the parent's side, [`serve`] the child's.
//! After a hang, a crash, a panic, a lost device or memory exhaustion, the worker is restarted for the next
//! shader. A library without a `main` of its own, such as a plug-in, needs a small program that serves.
//!
//! [`quirks`] lists the faults of drivers that are worked around.

pub mod browser;
mod device;
mod draw;
mod pipeline;
mod play;
mod protocol;
pub mod quirks;
mod readback;
mod sandbox;
mod serve;
mod texture;
mod worker;

use std::fmt;
use std::time::Duration;

pub use device::{
    Driver, INSTALL_HINT, is_automatic_driver_software, is_pinned_by_user, lavapipe_manifest, manifests,
    pinned,
};
pub use draw::{DrawOutput, LocalRenderer};
pub use protocol::{ChannelSampling, PlayedPasses, Readback, ShaderArtifact};
pub use quirks::loop_cap::{LoopCap, SAFE_ITERATIONS};
pub use sandbox::{SANDBOX_VARIABLE, Sandbox};
use serde::{Deserialize, Serialize};
pub use serve::{MAX_MEMORY_BYTES, serve};
use thiserror::Error;
use toyproof_diagnostic::{Diagnostic, Diagnostics};
use toyproof_translate::TranslateError;
pub use worker::Worker;

/// The adapter on which shaders run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum AdapterSelector {
    /// lavapipe if it is installed, otherwise the first adapter.
    Auto,
    /// Mesa's lavapipe only.
    Lavapipe,
    /// The first adapter whose name contains this substring, ignoring case.
    Named(String),
}

/// What the worker was doing when a job failed.
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

/// Why a shader could not be rendered.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
pub enum Failure {
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
    #[error("out of memory while {phase} (limit {} GiB)", MAX_MEMORY_BYTES >> 30)]
    OutOfMemory {
        /// Phase in which it happened.
        phase: Phase,
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

impl Failure {
    fn refused(diagnostics: Diagnostics) -> Self {
        Self::Refused(diagnostics.into())
    }

    fn naga(error: TranslateError) -> Self {
        Self::Naga(error.0)
    }

    /// Returns whether no driver is usable, whatever the shader. The evaluator may take its place.
    #[must_use]
    pub fn is_without_driver(&self) -> bool {
        matches!(self, Self::NoDriver(_) | Self::NotStarted(_))
    }

    /// Returns the diagnostics on the shader.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Invalid(diagnostics) | Self::Refused(diagnostics) => diagnostics,
            _ => &[],
        }
    }

    /// Returns whether the deadline expired.
    #[must_use]
    pub fn is_timeout(&self) -> bool {
        matches!(self, Self::Timeout { .. })
    }

    /// Returns whether the shader does not compile, as opposed to an error of the tools.
    #[must_use]
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
    #[must_use]
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
