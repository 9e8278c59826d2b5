//! The debugger for single pixels.

use toyproof_image::Frame;

use crate::exec::evaluate::Number;
use crate::exec::isel::FrameCode;
use crate::exec::limits::Failure;
use crate::exec::recorder::{ExecutionTrace, ForcedPrefix};
use crate::exec::settings::Settings;
use crate::ir::TraceSchema;
use crate::lower::LoweredCode;
use crate::program::Program;

/// A shader that is ready to trace the pixels of a frame.
#[derive(Debug)]
pub struct PixelDebugger<'a, N: Number> {
    lowered: &'a LoweredCode,
    code: FrameCode<N>,
    frame: &'a Frame,
    settings: Settings<'a, N>,
}

impl Program {
    /// Prepares to trace the pixels of a frame.
    ///
    /// # Errors
    /// If the shader is too large.
    pub fn pixel_debugger<'a, N: Number>(
        &'a self,
        frame: &'a Frame,
        settings: Settings<'a, N>,
    ) -> Result<PixelDebugger<'a, N>, Failure> {
        Ok(PixelDebugger::new(self.traced()?, frame, settings))
    }

    /// Prepares to trace the pixels of a frame with all steps: where statements and functions begin, which
    /// variables are written, and which operations are undefined.
    ///
    /// # Errors
    /// If the shader is too large.
    pub fn step_debugger<'a, N: Number>(
        &'a self,
        frame: &'a Frame,
        settings: Settings<'a, N>,
    ) -> Result<PixelDebugger<'a, N>, Failure> {
        Ok(PixelDebugger::new(self.stepping()?, frame, settings))
    }
}

impl<'a, N: Number> PixelDebugger<'a, N> {
    fn new(lowered: &'a LoweredCode, frame: &'a Frame, settings: Settings<'a, N>) -> Self {
        Self {
            lowered,
            code: N::select(lowered, frame),
            frame,
            settings,
        }
    }

    /// Returns all events that may occur.
    #[must_use]
    pub fn schema(&self) -> &'a TraceSchema {
        &self.lowered.schema
    }

    /// Traces the pixel at (x, y), y upwards from the bottom. With a prefix, its first values are forced to
    /// those of a different trace.
    ///
    /// # Errors
    /// If a limit is exceeded.
    ///
    /// # Panics
    /// If the pixel lies outside of the frame.
    pub fn trace(
        &self,
        pixel: [u32; 2],
        prefix: Option<ForcedPrefix<'_>>,
    ) -> Result<ExecutionTrace, Failure> {
        let (frame, settings) = (self.frame, &self.settings);
        assert!(pixel[0] < frame.size[0] && pixel[1] < frame.size[1], "{pixel:?}");
        N::trace(self.lowered, &self.code, frame, settings, pixel, prefix)
    }
}
