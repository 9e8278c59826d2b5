//! The toolchain check alone: the evaluator's image in f32 and that of a strict GPU run.

use std::time::{Duration, Instant};

use toyproof::eval::{Program, Settings};
use toyproof::glsl::Checked;
use toyproof::gpu::{DrawOutput, Worker};
use toyproof::image::Frame;
use toyproof::translate::{FloatMode, lower_strict};
use toyproof::verify::compare::{self, CheckSummary};

/// Renders a frame with the evaluator, within a time limit, and on a driver, and compares all bits.
///
/// # Errors
/// Why one of them renders no image.
pub fn compare_bits(
    worker: &mut Worker,
    checked: &Checked,
    frame: &Frame,
    timeout: Duration,
) -> Result<CheckSummary, String> {
    let program = Program::new(checked).map_err(|refusal| format!("evaluator: {refusal}"))?;
    let settings = Settings {
        deadline: Some(Instant::now() + timeout),
        ..Settings::default()
    };
    let evaluated = program
        .render_rows::<f32>(frame, frame.rows(), &settings)
        .map_err(|failure| format!("evaluator: {failure}"))?;
    let drawn = worker
        .draw_unwatched(lower_strict(checked), frame.clone(), FloatMode::Strict)
        .map(DrawOutput::image)
        .map_err(|failure| failure.to_string())?;
    let statuses = compare::toolchain(&evaluated.image, &drawn, &evaluated.undefined);
    Ok(CheckSummary::new(&evaluated.image, &drawn, &statuses))
}
