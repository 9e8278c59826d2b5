//! The first step where f32 and f64 part.

use toyproof_eval::{Plot, Told, What};

use super::{Step, step};

/// Values part when they differ by more than this, relative to the largest component of the two: ten of the 24 bits of an f32
/// are left.
pub const BOUND: f64 = 1e-3;

/// Finds it. `flushed` says whether to name also what differs because f32 flushes tiny numbers to zero, which hardly ever matters.
pub(super) fn find(plot: &Plot, steps: &[Step], flushed: bool) -> Option<usize> {
    steps.iter().position(|step| is_apart(plot, step, flushed))
}

fn is_apart(plot: &Plot, step: &Step, flushed: bool) -> bool {
    if step.single.is_none() || step.double.is_none() {
        return true;
    }
    // What is counted or packed follows from floats; the decision that comes of it tells.
    let decides = plot.event(step.event).what == What::Branch;
    let (mut scale, mut most) = (0.0f64, 0.0f64);
    for pair in step.pairs() {
        match pair {
            (Told::Word(single), Told::Word(double)) if decides && single != double => return true,
            (Told::Float(single), Told::Float(double)) => {
                most = most.max(step::distance(single, double));
                scale = scale.max(single.abs()).max(double.abs());
            }
            _ => {}
        }
    }
    most == f64::INFINITY || most > BOUND * scale && (flushed || scale > f64::from(f32::MIN_POSITIVE))
}
