//! What one pixel does in f32 and in f64, side by side, and where the two part.

mod cause;
mod digits;
mod parting;
mod step;

use std::time::Instant;

pub use digits::digits;
pub use parting::BOUND;
pub use step::{Step, ulps};
use toyproof_eval::{Failure, Number, Plot, Program, Settings, Told};
use toyproof_image::Frame;

/// Both stories of a pixel.
#[derive(Debug, Clone)]
pub struct Explanation<'a> {
    /// What may happen.
    pub plot: &'a Plot,
    /// What the pixel is painted in f32; none if it is discarded.
    pub single: Option<[f64; 3]>,
    /// The same in f64.
    pub double: Option<[f64; 3]>,
    /// What happened, in order; what happened in one of the two only stands where it would have stood in the other.
    pub steps: Vec<Step>,
    /// The first step where the two part by more than [`BOUND`].
    pub parting: Option<usize>,
    /// The step that a visible difference of the colours comes of.
    pub cause: Option<usize>,
    /// The step in which f32 first has a NaN, or, where the colour is infinite, an infinity.
    pub not_finite: Option<usize>,
    /// Whether the stories were too long, and their ends are missing.
    pub is_cut: bool,
}

/// Runs a pixel of a frame, y upwards from the bottom, in f32 and in f64.
///
/// # Errors
/// If the shader is too large, or runs too long.
pub fn explain<'a>(
    program: &'a Program,
    frame: &'a Frame,
    pixel: [u32; 2],
    deadline: Option<Instant>,
) -> Result<Explanation<'a>, Failure> {
    let singles = program.teller(frame, settings::<f32>(deadline))?;
    let doubles = program.teller(frame, settings::<f64>(deadline))?;
    let plot = doubles.plot();
    let single = singles.story(pixel, None)?;
    let double = doubles.story(pixel, None)?;
    let cause = cause::find(&doubles, pixel, &single, &double)?;
    let steps = step::merge(plot, &single, &double);
    let infinite = single
        .colour
        .is_some_and(|colour| colour.iter().any(|part| part.is_infinite()));
    let bad = |step: &Step, is_bad: fn(f64) -> bool| {
        let told = step.single.iter().flatten();
        told.into_iter()
            .any(|told| matches!(told, Told::Float(value) if is_bad(*value)))
    };
    let first = |is_bad| steps.iter().position(|step| bad(step, is_bad));
    Ok(Explanation {
        plot,
        single: single.colour,
        double: double.colour,
        parting: parting::find(plot, &steps, false),
        cause: cause.and_then(|moment| steps.iter().position(|step| step.moment == moment)),
        not_finite: first(f64::is_nan).or_else(|| first(f64::is_infinite).filter(|_| infinite)),
        is_cut: single.is_cut || double.is_cut,
        steps,
    })
}

fn settings<'a, N: Number>(deadline: Option<Instant>) -> Settings<'a, N> {
    Settings {
        deadline,
        ..Settings::default()
    }
}
