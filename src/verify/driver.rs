//! The driver that renders a shader in float32.

use std::time::Duration;

use toyproof_player::{DrawOutput, DriverFailure};
use toyproof_translate::{FloatMode, Lowered};

/// What renders the shader in float32, for the precision and toolchain checks.
pub type Driver = dyn toyproof_player::Driver<Code = (Lowered, FloatMode)>;

/// The GPU that rendered an image, and its times.
#[derive(Debug, Clone)]
pub struct GpuRun {
    /// Adapter and driver.
    pub device: String,
    /// Time for naga to parse, validate and write.
    pub translate: Duration,
    /// Time for the driver to compile.
    pub compile: Duration,
    /// Time to render and read back.
    pub draw: Duration,
}

impl From<DrawOutput> for GpuRun {
    fn from(drawn: DrawOutput) -> Self {
        Self {
            device: drawn.device,
            translate: drawn.translate,
            compile: drawn.compile,
            draw: drawn.draw,
        }
    }
}

/// Whether the evaluator may take the place of a worker that failed. How long the driver takes shows nothing
/// about the shader. Without a reference, other failures are what the check is about.
#[must_use]
pub fn is_replaceable(failure: &DriverFailure, has_reference: bool) -> bool {
    let is_decisive = failure.is_invalid() || failure.is_without_driver();
    !is_decisive && (failure.is_timeout() || has_reference)
}
