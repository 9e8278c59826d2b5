//! What was seen while a shader ran, as diagnostics with their lines.

use std::time::Duration;

use toyproof_diagnostic::{Diagnostic, Severity};
use toyproof_eval::{Fault, MESA_CAP, Observations, Observed};
use toyproof_glsl::tree::{ExprKind, Input, SamplerShape, VariableKind};
use toyproof_glsl::{Checked, Code};
use toyproof_image::Frame;
use toyproof_lint::Lints;

use crate::compare::{grouped, plural};

/// What was seen, but for what was foreseen: `warned` before the run. Pixels may be left out because of it.
pub(super) fn notes(noted: &Observations, leaves_out: bool, warned: &[Diagnostic]) -> Vec<Diagnostic> {
    let is_foreseen = |observed: &Observed| {
        let codes = [Code::Unwritten, Code::MaybeUnwritten].map(Code::as_str);
        let at = observed.site.at.span;
        let is_same = |warning: &Diagnostic| {
            let declared = warning.related.iter().any(|(span, _)| *span == at);
            declared && codes.contains(&&*warning.code)
        };
        warned.iter().any(is_same)
    };
    let mut notes = Vec::new();
    for observed in &noted.faults {
        if observed.site.fault == Fault::NeverWritten && !is_foreseen(observed) {
            notes.push(never_written(observed));
        } else if observed.site.fault.is_undefined() {
            notes.push(undefined(observed, leaves_out));
        }
    }
    let foreseen = warned
        .iter()
        .any(|warning| warning.code == Code::LongLoop.as_str());
    if noted.beyond_cap > 0 && !foreseen {
        let message = format!(
            "loops run more than {} rounds in {} {}, after which Mesa before 23 ends them by force",
            grouped(u64::from(MESA_CAP)),
            grouped(noted.beyond_cap),
            plural(noted.beyond_cap, "pixel", "pixels")
        );
        notes.push(Diagnostic::warning(Code::LongRun.as_str(), message));
    }
    notes
}

/// The channels that a shader names and a frame has no picture for, each where it is named first.
#[must_use]
pub fn unbound(checked: &Checked, lints: &Lints, frame: &Frame) -> Vec<Diagnostic> {
    let mut named = [None; 4];
    for (_, expr) in checked.tree.exprs.iter() {
        if let ExprKind::Variable(variable) = expr.kind
            && let VariableKind::Input(Input::Channel(channel)) = checked.tree[variable].kind
        {
            named[usize::from(channel)].get_or_insert(expr.at.span);
        }
    }
    let named = (0..)
        .zip(named)
        .filter_map(|(channel, span)| Some((channel, span?)));
    let told = named.filter_map(|(channel, span): (usize, _)| {
        let note = match checked.channels[channel] {
            SamplerShape::D2 if frame.channels[channel].is_some() => return None,
            SamplerShape::D2 => {
                format!("`--channel{channel} FILE` binds a picture, `--channel{channel} noise` noise")
            }
            _ => "cube maps, volumes and arrays cannot be bound yet".to_owned(),
        };
        let message = format!("`iChannel{channel}` is black: no picture is bound to it");
        let diagnostic = Diagnostic::warning(Code::UnboundChannel.as_str(), message);
        Some(diagnostic.at(span).note(note))
    });
    told.filter(|note| !lints.allows(note)).collect()
}

/// Why no GPU ran the shader.
pub(super) fn slow_compilation(after: Duration) -> Diagnostic {
    let message = format!(
        "the Vulkan driver takes longer than {} s to compile this shader: it was evaluated on the CPU, without the \
         toolchain check",
        after.as_secs_f64()
    );
    Diagnostic::new(Severity::Note, Code::SlowCompilation.as_str(), message).note(
        "a longer `--timeout` lets the driver finish; shorter functions and smaller arrays compile faster",
    )
}

fn undefined(observed: &Observed, leaves_out: bool) -> Diagnostic {
    let message = format!(
        "{} in {}: GLSL leaves open what comes of it",
        observed.site.fault.words(),
        pixels(observed)
    );
    let diagnostic =
        Diagnostic::warning(Code::UndefinedOperation.as_str(), message).at(observed.site.at.span);
    if leaves_out {
        diagnostic
    } else {
        diagnostic.note("no pixel's colour depends on it, so that none is left out of the comparison")
    }
}

fn never_written(observed: &Observed) -> Diagnostic {
    let message = format!(
        "read before anything is written to it in {}: WebGL takes zero, other drivers anything",
        pixels(observed)
    );
    Diagnostic::warning(Code::NeverWritten.as_str(), message)
        .at(observed.site.at.span)
        .note("give it a value where it is declared")
}

/// In how many pixels, and the first of them.
fn pixels(observed: &Observed) -> String {
    let [x, y] = observed.first;
    let count = observed.pixels;
    format!(
        "{} {}, first at ({x}, {y})",
        grouped(count),
        plural(count, "pixel", "pixels")
    )
}
