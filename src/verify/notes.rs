//! Diagnostics about a run: what the evaluator observed, what is not bound, and what the driver rendered.

use toyproof_diagnostic::Code;
use toyproof_diagnostic::{Diagnostic, Span, grouped, plural};
use toyproof_eval::{self as eval, Fault, MESA_CAP, Observations, Observed};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprKind, SamplerShape, VariableKind};
use toyproof_image::{Frame, Shape};
use toyproof_lint::Lints;
use toyproof_player::{DriverFailure, Phase};

use crate::compare::CheckSummary;
use crate::failure::Failure;
use crate::limits::is_toolchain_fault;

/// Reports the observations, except those that the lints have reported. `excludes_pixels` is true if pixels
/// with undefined behavior are excluded.
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
        .any(|warning| warning.code == Code::LongLoop);
    if observed.beyond_cap > 0 && !is_warned {
        let message = format!(
            "the loops of {} {} run more than {} iterations, the limit of Mesa before 23",
            grouped(observed.beyond_cap),
            plural(observed.beyond_cap, "pixel", "pixels"),
            grouped(u64::from(MESA_CAP))
        );
        notes.push(Diagnostic::new(Code::LongRun, message));
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
            SamplerShape::Cube | SamplerShape::D3 => {
                "cube maps and volumes are bound by the `project.toml` of a project".to_owned()
            }
            SamplerShape::D2Array => "arrays of textures cannot be bound".to_owned(),
        };
        let message = format!("`iChannel{channel}` is black: no image is bound to it");
        let diagnostic = Diagnostic::new(Code::UnboundChannel, message);
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
            && let VariableKind::Channel(channel) = checked.tree[variable].kind
        {
            first_uses[usize::from(channel)].get_or_insert(expr.at.span);
        }
    }
    let first_uses = (0..)
        .zip(first_uses)
        .filter_map(|(channel, span)| Some((channel, span?)));
    let is_black = |channel: usize| {
        let shape = match checked.channels[channel] {
            SamplerShape::D2 => Shape::Flat,
            SamplerShape::D3 => Shape::Volume,
            SamplerShape::Cube => Shape::Cube,
            SamplerShape::D2Array => return true,
        };
        let texture = frame.channels[channel].as_ref();
        texture.is_none_or(|texture| texture.shape() != shape)
    };
    first_uses.filter(|&(channel, _)| is_black(channel)).collect()
}

/// Reports why a worker rendered no image, where the evaluator takes its place.
#[must_use]
pub fn driver_failure(failure: &Failure) -> Diagnostic {
    if let Failure::Gpu(DriverFailure::Timeout {
        phase: Phase::Compiling,
        after,
    }) = failure
    {
        let message = format!(
            "the Vulkan driver takes longer than {} s to compile this shader; it was evaluated on the CPU instead, \
             without the toolchain check",
            after.as_secs_f64()
        );
        return Diagnostic::new(Code::SlowCompilation, message)
            .note("use a longer `--timeout`; shorter functions and smaller arrays compile faster");
    }
    // naga's message states what it rejects.
    let stated = failure
        .diagnostics()
        .first()
        .map(|one| format!(": {}", one.message));
    let message = format!(
        "there is no image of the driver: {failure}{}; the shader was evaluated on the CPU instead, without the \
         toolchain check",
        stated.unwrap_or_default()
    );
    Diagnostic::new(Code::DriverFailure, message).note(NOT_THE_SHADER)
}

/// The note on a failure or a difference of the toolchain.
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
    let diagnostic = Diagnostic::new(Code::ToolchainDifference, message);
    Some(diagnostic.note(NOT_THE_SHADER))
}

/// Reports that the shader could not be evaluated in double precision.
pub(super) fn only_single(failure: &eval::Failure) -> Diagnostic {
    let message = format!(
        "the shader cannot be evaluated in double precision: {failure}; it was compared in float32, without the \
         precision check"
    );
    let diagnostic = Diagnostic::new(Code::OnlySingle, message);
    match failure {
        eval::Failure::TooOften { at, .. } | eval::Failure::Timeout { at } => diagnostic.at(at.span),
        _ => diagnostic,
    }
}

fn undefined(observed: &Observed, excludes_pixels: bool) -> Diagnostic {
    let message = format!(
        "{} in {}; the result is undefined in GLSL",
        observed.site.fault.description(),
        pixels(observed)
    );
    let diagnostic = Diagnostic::new(Code::UndefinedOperation, message).at(observed.site.at.span);
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
    if warnings.any(|warning| warning.code == Code::Unwritten && is_same(&warning)) {
        return None;
    }
    let message = format!("in {}", pixels(observed));
    if let Some(suspected) = lints.maybe_uninitialized.iter().find(is_same) {
        return Some(suspected.clone().note(format!("observed {message}")));
    }
    let message = format!("read before it is written {message}; it is zero in WebGL and undefined elsewhere");
    let diagnostic = Diagnostic::new(Code::NeverWritten, message).at(declared);
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
