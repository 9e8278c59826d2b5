//! A shader of which some operations have 16 bits, on drivers that have such floats: its image and its time
//! beside those in 32 bits.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use toyproof_glsl::Checked;
use toyproof_gpu::{Failure, Worker};
use toyproof_image::{Frame, Image};
use toyproof_translate::{FloatMode, Lowered};
use toyproof_verify::compare::{PixelStatus, precision, visible_pixels};

use super::schedule::{self, Cost, RunKind, Runner, TimeStatistics};

/// A shader in 32 and in 16 bits on a device, with the driver's fast arithmetic.
#[derive(Debug)]
pub struct HalfRun {
    /// The number of pixels that look different in 16 and in 32 bits.
    pub changed_pixels: u64,
    /// The number of pixels that look different from the emulation in 16 bits, but not from the evaluator's
    /// image in 32 bits.
    pub unlike_emulation: u64,
    /// The times of a frame, in 32 and in 16 bits.
    pub seconds_per_frame: [TimeStatistics; 2],
}

/// A shader with its image by the evaluator.
#[derive(Debug, Clone, Copy)]
pub struct Evaluated<'a> {
    /// The shader.
    pub shader: &'a Checked,
    /// The evaluator's image in f32.
    pub image: &'a Image,
}

/// Renders the shader as it is, and one that rounds values by the functions named
/// [`ROUNDING_FUNCTION`](toyproof_translate::backend::spirv::ROUNDING_FUNCTION), which are then computed in
/// 16 bits; in turns, until a deadline. `None` if there was no time for both.
///
/// # Errors
/// Why there is no image: [`Failure::NoDriver`] if the device has no floats of 16 bits.
pub fn half_run(
    worker: &mut Worker,
    [single, half]: [Evaluated<'_>; 2],
    frame: &Frame,
    until: Instant,
    interrupt: &AtomicBool,
) -> Result<Option<HalfRun>, Failure> {
    let mut turns = Turns {
        worker,
        // A device without such floats fails at once.
        shaders: [
            FloatMode::Fast.lower(half.shader).narrowed(),
            FloatMode::Fast.lower(single.shader),
        ],
        frame,
        images: [None, None],
        start: Instant::now(),
        interrupt,
    };
    let budget = until.saturating_duration_since(turns.start).as_secs_f64();
    let cost = Cost { kind: 0, size: 1.0 };
    let seconds = schedule::measure(&mut turns, &[cost; 2], budget)?;
    let [Some(narrow), Some(wide)] = turns.images else {
        return Ok(None);
    };
    if seconds.iter().any(Vec::is_empty) {
        return Ok(None);
    }
    let differs = |status: &PixelStatus| *status == PixelStatus::Differs;
    let statuses = precision(single.image, &wide, &vec![false; wide.pixels().len()]);
    let is_unlike: Vec<bool> = statuses.iter().map(differs).collect();
    let statuses = precision(half.image, &narrow, &is_unlike);
    Ok(Some(HalfRun {
        changed_pixels: visible_pixels(&wide, &narrow),
        unlike_emulation: statuses.iter().filter(|status| differs(status)).count() as u64,
        seconds_per_frame: [1, 0].map(|at: usize| TimeStatistics::new(&seconds[at])),
    }))
}

/// Draws the shaders in turns.
struct Turns<'a> {
    worker: &'a mut Worker,
    shaders: [Lowered; 2],
    frame: &'a Frame,
    images: [Option<Image>; 2],
    start: Instant,
    interrupt: &'a AtomicBool,
}

impl Runner for Turns<'_> {
    type Error = Failure;

    fn run(&mut self, method: usize, _: RunKind) -> Result<Option<f64>, Failure> {
        if self.interrupt.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let (lowered, frame) = (self.shaders[method].clone(), self.frame.clone());
        let drawn = self.worker.draw_unwatched(lowered, frame, FloatMode::Fast)?;
        let took = drawn.draw.as_secs_f64();
        self.images[method] = Some(drawn.image());
        Ok(Some(took))
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}
