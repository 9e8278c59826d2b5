//! The operation at which a result loses its digits.

use std::time::Duration;

use serde::Serialize;
use toyproof_eval::Failure;
use toyproof_glsl::Checked;
use toyproof_verify::debug::digit_loss;

use super::Case;
use super::evaluator::Evaluator;
use super::interface::Interface;
use crate::run::RunError;

/// An operation that loses digits, as bytes of the shader's text.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cause {
    /// The first byte of the expression.
    pub start: u32,
    /// The byte after it.
    pub end: u32,
    /// Its result in f32, and what it would be without the rounding errors that matter; `None` if it is not a
    /// float.
    pub values: Option<[f64; 2]>,
}

/// The operation at which an output loses its digits for a case; `None` if no single one does.
pub(super) fn cause(
    text: &str,
    checked: &Checked,
    interface: &Interface,
    output: usize,
    case: &Case,
    timeout: Option<Duration>,
) -> Result<Option<Cause>, RunError> {
    let outputs = &interface.outputs[output..=output];
    let evaluator = Evaluator::of_outputs(text, checked, interface, outputs, timeout)?;
    let frame = evaluator.frame(std::slice::from_ref(case));
    let shader = &evaluator.shader;
    match digit_loss(
        &shader.program,
        &frame,
        [0, 0],
        text.len() as u32,
        shader.deadline,
    ) {
        Ok(found) => Ok(found.map(|loss| Cause {
            start: loss.at.span.start,
            end: loss.at.span.end,
            values: loss.values,
        })),
        // The traced shader has more instructions, and is slower: the error is known without its cause.
        Err(Failure::Refused(_) | Failure::Timeout { .. } | Failure::TimeUp) => Ok(None),
        Err(failure) => Err(failure.into()),
    }
}
