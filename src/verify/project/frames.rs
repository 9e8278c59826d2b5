//! The frames of a shader with several passes.

use std::time::Duration;

use rayon::ThreadPool;
use toyproof_eval::{Number, Settings};
use toyproof_eval_native::Program;
use toyproof_player::Clock;

use super::playback::{CpuPlayback, PassShader};
use crate::bounds::EVALUATOR_TIME_FACTOR;

/// The frames of a shader up to the one that is checked.
#[derive(Debug, Clone, Copy)]
pub struct Frames<'a> {
    /// The shader.
    pub shader: &'a PassShader<'a>,
    /// The programs of the shader's passes.
    pub programs: &'a [Program],
    /// The inputs of each frame.
    pub clock: &'a Clock,
    /// The last frame.
    pub last: i32,
    /// The time limit of a frame in float32.
    pub timeout: Duration,
    /// The thread pool; rayon's global pool if none.
    pub pool: Option<&'a ThreadPool>,
}

impl<'a> Frames<'a> {
    /// Playback from the first frame on.
    #[must_use]
    pub fn start<N: Number>(&self, noise: N::Noise, timeout: Duration) -> CpuPlayback<'a, N> {
        let settings = Settings {
            noise,
            ..Settings::plain()
        };
        CpuPlayback::new(self.shader, self.programs, None, timeout, settings)
    }

    /// The time limit of a frame in double precision, which is slower: that is not the shader's fault.
    #[must_use]
    pub fn long_timeout(&self) -> Duration {
        self.timeout * EVALUATOR_TIME_FACTOR
    }
}
