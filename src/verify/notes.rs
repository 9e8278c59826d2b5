//! Diagnostics about a run: what the evaluator observed, colors that are not finite, and the line in which a
//! shader loses precision.

use std::collections::BTreeMap;
use std::time::Instant;

use toyproof_diagnostic::{Diagnostic, Severity, Span, grouped, plural};
use toyproof_eval::{self as eval, EventKind, Fault, MESA_CAP, Observations, Observed, Program, TraceValue};
use toyproof_glsl::tree::{ExprKind, Input, SamplerShape, VariableKind};
use toyproof_glsl::{Checked, Code};
use toyproof_image::{Frame, Image};
use toyproof_lint::Lints;

use super::{Case, CheckResult, Failure};
use crate::bounds::MAX_TRACED_ITERATIONS;
use crate::compare::{CheckSummary, PixelStatus};
use crate::debug::{Explanation, digits, explain_within};
use crate::decide::is_toolchain_fault;

/// Reports what was observed, except what the lints report already. `excludes_pixels` is true if pixels with
/// undefined behavior are excluded.
pub(super) fn notes(observed: &Observations, excludes_pixels: bool, lints: &Lints) -> Vec<Diagnostic> {
    let mut notes = Vec::new();
    for observed in &observed.faults {
        if observed.site.fault == Fault::NeverWritten {
            notes.extend(never_written(observed, lints));
        } else if observed.site.fault.is_undefined() {
            notes.push(undefined(observed, excludes_pixels));
        }
    }
    let is_warned = lints
        .warnings
        .iter()
        .any(|warning| warning.code == Code::LongLoop.as_str());
    if observed.beyond_cap > 0 && !is_warned {
        let message = format!(
            "the loops of {} {} run more than {} iterations, the limit of Mesa before 23",
            grouped(observed.beyond_cap),
            plural(observed.beyond_cap, "pixel", "pixels"),
            grouped(u64::from(MESA_CAP))
        );
        notes.push(Diagnostic::warning(Code::LongRun.as_str(), message));
    }
    notes
}

/// Reports the channels that a shader reads but the frame has no image for, each at its first use.
#[must_use]
pub fn unbound(checked: &Checked, lints: &Lints, frame: &Frame) -> Vec<Diagnostic> {
    let unbound = unbound_channels(checked, frame).into_iter().map(|(channel, span)| {
        let note = match checked.channels[channel] {
            SamplerShape::D2 => {
                format!(
                    "bind an image with `--channel{channel} FILE`, or noise with `--channel{channel} noise`"
                )
            }
            _ => "cube maps, volumes and arrays cannot be bound".to_owned(),
        };
        let message = format!("`iChannel{channel}` is black: no image is bound to it");
        let diagnostic = Diagnostic::warning(Code::UnboundChannel.as_str(), message);
        diagnostic.at(span).note(note)
    });
    unbound.filter(|note| !lints.allows(note)).collect()
}

/// The channels that a shader reads but the frame has no image for, each with its first use.
#[must_use]
pub fn unbound_channels(checked: &Checked, frame: &Frame) -> Vec<(usize, Span)> {
    let mut first_uses = [None; 4];
    for (_, expr) in checked.tree.exprs.iter() {
        if let ExprKind::Variable(variable) = expr.kind
            && let VariableKind::Input(Input::Channel(channel)) = checked.tree[variable].kind
        {
            first_uses[usize::from(channel)].get_or_insert(expr.at.span);
        }
    }
    let first_uses = (0..)
        .zip(first_uses)
        .filter_map(|(channel, span)| Some((channel, span?)));
    let is_black =
        |channel: usize| checked.channels[channel] != SamplerShape::D2 || frame.channels[channel].is_none();
    first_uses.filter(|&(channel, _)| is_black(channel)).collect()
}

/// Reports why a worker rendered no image, where the evaluator takes its place.
#[must_use]
pub fn driver_failure(failure: &Failure) -> Diagnostic {
    #[cfg(feature = "gpu")]
    if let Failure::Gpu(toyproof_gpu::Failure::Timeout {
        phase: toyproof_gpu::Phase::Compiling,
        after,
    }) = failure
    {
        let message = format!(
            "the Vulkan driver takes longer than {} s to compile this shader; it was evaluated on the CPU instead, \
             without the toolchain check",
            after.as_secs_f64()
        );
        return Diagnostic::new(Severity::Note, Code::SlowCompilation.as_str(), message)
            .note("use a longer `--timeout`; shorter functions and smaller arrays compile faster");
    }
    // What naga rejects it states itself.
    let stated = failure
        .diagnostics()
        .first()
        .map(|one| format!(": {}", one.message));
    let message = format!(
        "there is no image of the driver: {failure}{}; the shader was evaluated on the CPU instead, without the \
         toolchain check",
        stated.unwrap_or_default()
    );
    Diagnostic::warning(Code::DriverFailure.as_str(), message).note(NOT_THE_SHADER)
}

/// Whose fault a failure or a difference of the toolchain is.
const NOT_THE_SHADER: &str = "naga, the driver or toyproof is at fault, not the shader";

/// Reports that the driver's image visibly differs from the evaluator's, if it does.
pub(super) fn toolchain_difference(toolchain: &CheckSummary) -> Option<Diagnostic> {
    let first = toolchain
        .first
        .as_ref()
        .filter(|_| is_toolchain_fault(toolchain))?;
    let message = format!(
        "{} of {} pixels of the driver's image differ from the same float32 arithmetic on the CPU, first at \
         ({}, {}); the evaluator's image was checked",
        grouped(toolchain.differing),
        grouped(toolchain.pixels),
        first.x,
        first.y
    );
    let diagnostic = Diagnostic::warning(Code::ToolchainDifference.as_str(), message);
    Some(diagnostic.note(NOT_THE_SHADER))
}

/// Reports that the shader could not be evaluated in double precision.
pub(super) fn only_single(failure: &eval::Failure) -> Diagnostic {
    let message = format!(
        "the shader cannot be evaluated in double precision: {failure}; it was compared in float32, without the \
         precision check"
    );
    let diagnostic = Diagnostic::warning(Code::OnlySingle.as_str(), message);
    match failure {
        eval::Failure::TooOften { at, .. } | eval::Failure::Timeout { at } => diagnostic.at(at.span),
        _ => diagnostic,
    }
}

fn undefined(observed: &Observed, excludes_pixels: bool) -> Diagnostic {
    let message = format!(
        "{} in {}; the result is undefined in GLSL",
        observed.site.fault.words(),
        pixels(observed)
    );
    let diagnostic =
        Diagnostic::warning(Code::UndefinedOperation.as_str(), message).at(observed.site.at.span);
    if excludes_pixels {
        diagnostic
    } else {
        diagnostic.note("no pixel's color depends on it, so no pixel is excluded from the comparison")
    }
}

/// Reports reads of a variable in pixels that did not write it: at the read that a lint suspects, otherwise
/// at the declaration; not at all if a lint has reported the variable.
fn never_written(observed: &Observed, lints: &Lints) -> Option<Diagnostic> {
    let declared = observed.site.at.span;
    let is_same = |warning: &&Diagnostic| warning.related.iter().any(|(span, _)| *span == declared);
    let mut warnings = lints.warnings.iter();
    if warnings.any(|warning| warning.code == Code::Unwritten.as_str() && is_same(&warning)) {
        return None;
    }
    let message = format!("in {}", pixels(observed));
    if let Some(suspected) = lints.maybe_uninitialized.iter().find(is_same) {
        return Some(suspected.clone().note(format!("observed {message}")));
    }
    let message = format!("read before it is written {message}; it is zero in WebGL and undefined elsewhere");
    let diagnostic = Diagnostic::warning(Code::NeverWritten.as_str(), message).at(declared);
    Some(diagnostic.note("initialize it in its declaration"))
}

/// Formats the number of pixels and the first of them.
fn pixels(observed: &Observed) -> String {
    let [x, y] = observed.first;
    let count = observed.pixels;
    format!(
        "{} {}, first at ({x}, {y})",
        grouped(count),
        plural(count, "pixel", "pixels")
    )
}

/// The largest number of differing pixels that are explained to find the cause.
const MAX_EXPLAINED_PIXELS: usize = 5;

/// Returns the place at which most of the explained pixels diverge between f32 and f64; none if the deadline is
/// exceeded.
pub(super) fn cause(
    program: &Program,
    case: &Case,
    deadline: Instant,
    check: &CheckResult,
) -> Option<Diagnostic> {
    let pixels = sample_pixels(check, case.frame.size, MAX_EXPLAINED_PIXELS);
    lost_digits(program, case.frame, &pixels, deadline)
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
            TraceValue::Float(value) if !value.is_finite() => Some(digits(*value, true)),
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
            Diagnostic::warning(Code::NotFinite.as_str(), message)
                .at(span)
                .note(hint([x, y])),
        )
    }
}

/// Returns at most `max_count` of the differing pixels, spread over the image; of the ill-conditioned ones if
/// none differs, and else of those in which the reference is ill-conditioned.
pub(super) fn sample_pixels(check: &CheckResult, size: [u32; 2], max_count: usize) -> Vec<[u32; 2]> {
    let width = size[0] as usize;
    let of = |status| {
        let statuses = check.statuses.iter().enumerate();
        statuses.filter(move |&(_, &own)| own == status).map(|(at, _)| at)
    };
    let statuses = [
        PixelStatus::Differs,
        PixelStatus::IllConditioned,
        PixelStatus::Tied,
    ];
    let status = statuses.into_iter().find(|&status| of(status).next().is_some());
    let Some(status) = status else {
        return Vec::new();
    };
    let mut left = of(status).enumerate();
    spread(of(status).count(), max_count)
        .filter_map(|chosen| left.find(|&(number, _)| number == chosen))
        .map(|(_, at)| [(at % width) as u32, (at / width) as u32])
        .collect()
}

/// At most `max_count` numbers below `all`, evenly spaced.
fn spread(all: usize, max_count: usize) -> impl Iterator<Item = usize> {
    let count = all.min(max_count);
    (0..count).map(move |at| (2 * at + 1) * all / (2 * count))
}

fn diagnostic(explanation: &Explanation<'_>, [x, y]: [u32; 2]) -> Option<(Span, Diagnostic)> {
    let step = &explanation.steps[explanation.cause?];
    let event = explanation.schema.event(step.event);
    let at = format!("at ({x}, {y})");
    let message = match step.worst() {
        Some((_, single, double)) if event.kind == EventKind::Branch => {
            let branch = |value| matches!(value, TraceValue::Word(word) if word != 0);
            format!(
                "float32 takes another branch here: {at} the condition is {}, but {} in double precision",
                branch(single),
                branch(double)
            )
        }
        Some((_, TraceValue::Float(single), TraceValue::Float(double)))
            if digits(single, true) != digits(double, false) =>
        {
            format!(
                "float32 loses precision here: {at} this is {}, but {} in double precision",
                digits(single, true),
                digits(double, false)
            )
        }
        _ => format!("float32 and double precision diverge here, {at}"),
    };
    let span = event.at.span;
    Some((
        span,
        Diagnostic::warning(Code::LostDigits.as_str(), message)
            .at(span)
            .note(hint([x, y])),
    ))
}

fn hint([x, y]: [u32; 2]) -> String {
    format!("`toyproof debug` with `--pixel {x},{y}` shows how this value is computed")
}
