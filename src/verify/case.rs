//! What is verified, and how.

use std::time::Duration;

use rayon::ThreadPool;
use toyproof_glsl::Checked;
use toyproof_image::Frame;
use toyproof_lint::Lints;
use toyproof_translate::FloatMode;

use crate::expected::Expected;
use crate::project::growth::VisibleGrowth;

/// A shader to verify, and how.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The results of linting the shader.
    pub lints: &'a Lints,
    /// The reference, if there is one; its frame must be `frame`.
    pub expected: Option<&'a Expected>,
    /// The frame. The textures of its channels are in float32.
    pub frame: &'a Frame,
    /// What earlier frames contribute; none if the frame does not depend on them.
    pub from_start: Option<FromStart<'a>>,
    /// How far the driver may rearrange arithmetic. There is no toolchain check if it may do so at all.
    pub float: FloatMode,
    /// The time limit of an image.
    pub timeout: Duration,
    /// The thread pool of the evaluator and the tracer; rayon's global pool if none. There, a slow shader's
    /// rows could run before another shader's, whose time limit elapses meanwhile.
    pub pool: Option<&'a ThreadPool>,
}

impl<'a> Case<'a> {
    /// Creates the case of a shader in a frame without a reference: strict, within 10 s for an image, and in
    /// rayon's global pool.
    #[must_use]
    pub fn new(checked: &'a Checked, lints: &'a Lints, frame: &'a Frame) -> Self {
        Self {
            checked,
            lints,
            expected: None,
            frame,
            from_start: None,
            float: FloatMode::Strict,
            timeout: DEFAULT_TIMEOUT,
            pool: None,
        }
    }

    /// Compares the shader with a reference, whose frame must be the case's.
    #[must_use]
    pub fn with_expected(self, expected: &'a Expected) -> Self {
        Self {
            expected: Some(expected),
            ..self
        }
    }

    /// Sets the time limit of an image.
    #[must_use]
    pub fn with_timeout(self, timeout: Duration) -> Self {
        Self { timeout, ..self }
    }
}

/// The time limit of an image of a new [`Case`].
const DEFAULT_TIMEOUT: Duration = Duration::from_secs(10);

/// A frame that depends on earlier ones.
#[derive(Debug, Clone, Copy)]
pub struct FromStart<'a> {
    /// The frame with what earlier ones rendered in double precision.
    pub double: &'a Frame,
    /// The visible difference of that to float32, if there is one.
    pub growth: Option<VisibleGrowth>,
}
