//! What was seen while a shader ran, as diagnostics with their lines.

use super::cpu::Cpu;
use crate::compare::{grouped, plural};
use crate::diagnostic::Diagnostic;
use crate::eval::{Fault, MESA_CAP, Observed};
use crate::glsl::Code;

/// A shader does what GLSL leaves undefined.
pub(super) const UNDEFINED: &str = "W0600";
/// Its loops run longer than older drivers allow.
pub(super) const LONG_LOOPS: &str = "W0601";

/// It reads what it has not written.
const NEVER_WRITTEN: &str = "W0604";

/// What was seen, but for what was foreseen: `warned` before the run.
pub(super) fn notes(cpu: &Cpu, warned: &[Diagnostic]) -> Vec<Diagnostic> {
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
    for observed in &cpu.faults {
        if observed.site.fault == Fault::NeverWritten && !is_foreseen(observed) {
            notes.push(never_written(observed));
        } else if observed.site.fault.is_undefined() {
            notes.push(undefined(observed, cpu));
        }
    }
    let foreseen = warned
        .iter()
        .any(|warning| warning.code == Code::LongLoop.as_str());
    if cpu.beyond_cap > 0 && !foreseen {
        let message = format!(
            "loops run more than {} rounds in {} {}, after which Mesa before 23 ends them by force",
            grouped(u64::from(MESA_CAP)),
            grouped(cpu.beyond_cap),
            plural(cpu.beyond_cap, "pixel", "pixels")
        );
        notes.push(Diagnostic::warning(LONG_LOOPS, message));
    }
    notes
}

fn undefined(observed: &Observed, cpu: &Cpu) -> Diagnostic {
    let message = format!(
        "{} in {}: GLSL leaves open what comes of it",
        observed.site.fault.words(),
        pixels(observed)
    );
    let diagnostic = Diagnostic::warning(UNDEFINED, message).at(observed.site.at.span);
    if cpu.undefined.contains(&true) {
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
    Diagnostic::warning(NEVER_WRITTEN, message)
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
