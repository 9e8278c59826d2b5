//! Finds the line in which a shader loses precision, and the one in which a color stops being finite.

use std::collections::BTreeMap;
use std::time::Instant;

use toyproof_diagnostic::Code;
use toyproof_diagnostic::{Diagnostic, Span, grouped, plural};
use toyproof_eval::{EventKind, TraceValue};
use toyproof_eval_native::Program;
use toyproof_image::{Frame, Image};

use crate::bounds::MAX_TRACED_ITERATIONS;
use crate::compare::{CheckResult, spread};
use crate::debug::{Explanation, digits, explain_within};
use crate::expected::NumberType;

/// The largest number of differing pixels that are explained to find the cause.
const MAX_EXPLAINED_PIXELS: usize = 5;

/// Returns the place at which most of the explained pixels diverge between f32 and f64; none if the deadline
/// is exceeded.
#[must_use]
pub fn cause(program: &Program, frame: &Frame, deadline: Instant, check: &CheckResult) -> Option<Diagnostic> {
    let pixels = check.sample_pixels(frame.size, MAX_EXPLAINED_PIXELS);
    lost_digits(program, frame, &pixels, deadline)
}

/// Returns the place at which most of a few of these pixels, spread over them, diverge between f32 and f64;
/// none if the deadline is exceeded.
pub(super) fn lost_digits(
    program: &Program,
    frame: &Frame,
    pixels: &[[u32; 2]],
    deadline: Instant,
) -> Option<Diagnostic> {
    let mut causes = BTreeMap::<u32, (u64, Diagnostic)>::new();
    for pixel in spread(pixels.len(), MAX_EXPLAINED_PIXELS).map(|at| pixels[at]) {
        let explained = explain_within(program, frame, pixel, MAX_TRACED_ITERATIONS, Some(deadline));
        let diagnostic = explained
            .ok()
            .and_then(|explanation| diagnostic(&explanation, pixel));
        if let Some((span, diagnostic)) = diagnostic {
            causes.entry(span.start).or_insert((0, diagnostic)).0 += 1;
        }
    }
    let most = causes.into_values().max_by_key(|&(votes, _)| votes);
    most.map(|(_, diagnostic)| diagnostic)
}

/// Pixels with NaN or infinite colors.
#[derive(Debug, Default)]
pub(super) struct NotFinite {
    /// The number of pixels.
    count: u64,
    /// The first of these pixels.
    first: Option<[u32; 2]>,
}

impl NotFinite {
    /// Counts the pixels of a band that begins at `row`.
    pub(super) fn record(&mut self, band: &Image, row: u32) {
        let is_bad = |pixel: &[f32; 4]| pixel[..3].iter().any(|part| !part.is_finite());
        let bad = band.pixels().iter().enumerate();
        let mut bad = bad.filter(|(_, pixel)| is_bad(pixel)).map(|(at, _)| at as u32);
        if let Some(at) = bad.next() {
            let width = band.size()[0];
            self.first.get_or_insert([at % width, row + at / width]);
            self.count += 1 + bad.count() as u64;
        }
    }

    /// Reports the origin of the first such color; none if all are finite, or if it was not found.
    pub(super) fn diagnostic(
        &self,
        program: &Program,
        frame: &Frame,
        deadline: Instant,
    ) -> Option<Diagnostic> {
        let [x, y] = self.first?;
        let count = self.count;
        let explained = explain_within(program, frame, [x, y], MAX_TRACED_ITERATIONS, Some(deadline)).ok()?;
        let step = explained.not_finite.map(|at| &explained.steps[at])?;
        let value = step.single.iter().flatten().find_map(|value| match value {
            TraceValue::Float(value) if !value.is_finite() => Some(digits(*value, NumberType::Single)),
            _ => None,
        });
        let message = format!(
            "this makes the color of {} {} NaN or infinite, first at ({x}, {y}), where it is {}",
            grouped(count),
            plural(count, "pixel", "pixels"),
            value.unwrap_or_else(|| "not finite".to_owned()),
        );
        let span = explained.schema.event(step.event).at.span;
        Some(
            Diagnostic::new(Code::NotFinite, message)
                .at(span)
                .note(hint([x, y])),
        )
    }
}

fn diagnostic(explanation: &Explanation<'_>, [x, y]: [u32; 2]) -> Option<(Span, Diagnostic)> {
    let step = &explanation.steps[explanation.cause?];
    let event = explanation.schema.event(step.event);
    let at = format!("at ({x}, {y})");
    let worst = step.worst().map(|worst| (worst.single, worst.double));
    let message = match worst {
        Some((single, double)) if event.kind == EventKind::Branch => {
            let branch = |value| matches!(value, TraceValue::Word(word) if word != 0);
            format!(
                "float32 takes another branch here: {at} the condition is {}, but {} in double precision",
                branch(single),
                branch(double)
            )
        }
        Some((TraceValue::Float(single), TraceValue::Float(double)))
            if digits(single, NumberType::Single) != digits(double, NumberType::Double) =>
        {
            format!(
                "float32 loses precision here: {at} this is {}, but {} in double precision",
                digits(single, NumberType::Single),
                digits(double, NumberType::Double)
            )
        }
        _ => format!("float32 and double precision diverge here, {at}"),
    };
    let span = event.at.span;
    Some((
        span,
        Diagnostic::new(Code::LostDigits, message)
            .at(span)
            .note(hint([x, y])),
    ))
}

fn hint([x, y]: [u32; 2]) -> String {
    format!("`toyproof debug` with `--pixel {x},{y}` shows how this value is computed")
}
