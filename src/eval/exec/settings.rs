//! The settings of a run.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use crate::build::UndefinedPolicy;
use crate::exec::number::Arithmetic;

/// The settings for rendering a frame.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'a, N: Arithmetic> {
    /// The treatment of operations that GLSL leaves undefined.
    pub undefined: UndefinedPolicy,
    /// The seed of [`RandomRounding`](crate::RandomRounding); nothing for other number types.
    pub noise: N::Noise,
    /// The maximum number of loop iterations of a pixel, all loops together.
    pub max_iterations: u32,
    /// The time at which to give up.
    pub deadline: Option<Instant>,
    /// A flag that other threads set to interrupt the run.
    pub interrupt: Option<&'a AtomicBool>,
    /// The pixels that are needed, bottom row first; others may stay black. None means all.
    pub wanted: Option<&'a [bool]>,
    /// What executes the program. The result is the same.
    #[doc(hidden)]
    pub engine: Engine,
}

/// What executes a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[doc(hidden)]
pub enum Engine {
    /// Machine code for many pixels, handlers for few.
    #[default]
    Fastest,
    /// Handlers of instructions.
    Handlers,
    /// Machine code, where there is any.
    Native,
    /// Machine code for AVX2, although the processor may have AVX-512.
    Avx2,
}

impl<N: Arithmetic> Settings<'_, N> {
    /// The default settings, but without records of undefined operations.
    #[must_use]
    pub fn plain() -> Self {
        Self {
            undefined: UndefinedPolicy::Plain,
            ..Self::default()
        }
    }
}

impl<N: Arithmetic> Default for Settings<'_, N> {
    /// Records undefined operations, has no time limit, and allows more iterations than any reasonable shader
    /// runs.
    fn default() -> Self {
        Self {
            undefined: UndefinedPolicy::Observed,
            noise: N::Noise::default(),
            max_iterations: 1 << 26,
            deadline: None,
            interrupt: None,
            wanted: None,
            engine: Engine::Fastest,
        }
    }
}
