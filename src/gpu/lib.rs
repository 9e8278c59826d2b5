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
//! # Parts
//!
//! - `worker`: the parent's side: starts the worker, enforces deadlines, classifies failures.
//! - `serve`, `device`, `pipeline`, `draw`, `readback`: the worker's side.
//! - `protocol`: the messages between them.
//! - `play`, `texture`: the passes of a shader, whose textures stay on the device.
//! - [`quirks`]: each fault of a driver that is worked around, with its symptom and the condition for removal
//!   (`docs/evidence/drivers.md`), and the code of those workarounds that the worker applies.
//! - `sandbox`: what a worker process may do.
//! - [`browser`]: the shader in Chromium, with WebGPU or WebGL 2 on the software driver that Chromium ships.

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

pub use device::{
    Driver, INSTALL_HINT, is_automatic_driver_software, is_pinned_by_user, lavapipe_manifest, manifests,
    pinned,
};
pub use draw::LocalRenderer;
pub use protocol::{PassCode, ShaderArtifact};
pub use quirks::loop_cap::{LoopCap, SAFE_ITERATIONS};
pub use sandbox::{SANDBOX_VARIABLE, Sandbox};
use serde::{Deserialize, Serialize};
pub use serve::{MAX_MEMORY_BYTES, serve};
use toyproof_diagnostic::Diagnostics;
pub use toyproof_player::{DrawOutput, DriverFailure as Failure, Phase, Readback};
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

/// naga's errors about a shader that it rejects.
fn refused(diagnostics: Diagnostics) -> Failure {
    Failure::Refused(diagnostics.into())
}

/// naga's internal error.
fn naga_failed(error: TranslateError) -> Failure {
    Failure::Naga(error.0)
}
