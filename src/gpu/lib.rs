//! Runs shaders on a Vulkan driver in a worker process, so that a hang, a crash or exhausted memory costs one shader only.
//! The program that uses this crate starts itself as the worker.
//!
//! ```no_run
//! use std::time::Duration;
//!
//! use toyproof_gpu::{On, Worker, serve};
//!
//! let arguments: Vec<String> = std::env::args().skip(1).collect();
//! if arguments == ["worker"] {
//!     return serve(std::io::stdin().lock(), std::io::stdout().lock()).unwrap();
//! }
//! let program = std::env::current_exe().unwrap();
//! let mut worker = Worker::new(program, vec!["worker".into()], On::Auto, Duration::from_secs(10));
//! println!("{:?}", worker.probe());
//! ```
//!
//! naga and the driver run in a worker process: [`Worker`] is the parent's side, [`serve`] the child's.
//! A hang, a crash, a panic, a lost device or exhausted memory costs one shader; the worker is started
//! anew for the next.

pub mod browser;
mod device;
mod draw;
mod driver;
mod pipeline;
mod protocol;
mod serve;
mod worker;

use std::fmt;
use std::time::Duration;

pub use device::{Driver, LoopCap};
pub use draw::{Drawn, Painter, SAFE_ROUNDS};
pub use driver::{INSTALL_HINT, is_pinned_by_user, lavapipe_manifest, manifests, pinned};
pub use protocol::Written;
use serde::{Deserialize, Serialize};
pub use serve::{MEMORY_BYTES, serve};
use thiserror::Error;
use toyproof_diagnostic::Diagnostic;
pub use worker::Worker;

/// Which adapter runs the shader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum On {
    /// lavapipe where it is installed, else the first adapter.
    Auto,
    /// Mesa's lavapipe and nothing else.
    Lavapipe,
    /// The first adapter whose name holds these words, in any case.
    Named(String),
}

/// What the worker was doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Loading the driver.
    Starting,
    /// naga parses, validates and writes.
    Translating,
    /// The driver compiles.
    Compiling,
    /// The frame is painted and read back.
    Drawing,
    /// The frame is painted again to see whether the driver ended a loop by force.
    WatchingLoops,
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Starting => "the Vulkan driver was starting",
            Self::Translating => "naga was translating the shader",
            Self::Compiling => "the driver was compiling the shader",
            Self::Drawing => "the driver was painting the frame",
            Self::WatchingLoops => "the driver was painting the frame with its loops watched",
        })
    }
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
pub enum Failure {
    /// The shader does not compile.
    #[error("the shader does not compile")]
    Invalid(Vec<Diagnostic>),
    /// naga refuses what we made of a valid shader.
    #[error("naga cannot translate this shader")]
    Refused(Vec<Diagnostic>),
    /// What was written is not read again.
    #[error("what was written is refused by naga's own front end: {0}")]
    Reread(String),
    /// naga gave up on it.
    #[error("naga cannot translate this shader: {0}")]
    Naga(String),
    /// The deadline passed.
    #[error("stopped after {:.1} s, while {phase}", after.as_secs_f64())]
    Timeout {
        /// What was going on.
        phase: Phase,
        /// The deadline.
        after: Duration,
    },
    /// The memory limit was reached.
    #[error("out of memory while {phase} (limit {} GiB)", MEMORY_BYTES >> 30)]
    OutOfMemory {
        /// What was going on.
        phase: Phase,
    },
    /// The stack overflowed: recursion on something nested very deep.
    #[error("nested too deep: the stack overflowed while {phase}")]
    StackOverflow {
        /// What was going on.
        phase: Phase,
    },
    /// The worker died.
    #[error("the worker process {how} while {phase}")]
    Crash {
        /// What was going on.
        phase: Phase,
        /// Signal or exit code, and the last words.
        how: String,
    },
    /// The driver refused or lost the device.
    #[error("the Vulkan driver failed: {0}")]
    Device(String),
    /// There is no such driver.
    #[error("{0}")]
    NoDriver(String),
    /// The driver, or the worker process itself, did not start: no shader is to blame.
    #[error("{0}")]
    NotStarted(String),
    /// The worker process could not be started or spoken to.
    #[error("cannot run the worker process: {0}")]
    Worker(String),
}

impl Failure {
    /// Whether there is no driver to be used, whatever the shader: the evaluator may take its place.
    #[must_use]
    pub fn is_without_driver(&self) -> bool {
        matches!(self, Self::NoDriver(_) | Self::NotStarted(_))
    }

    /// Whether the time ran out while the driver compiled the shader: that says nothing of how long the shader runs.
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
