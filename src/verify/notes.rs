//! What was seen while a shader ran, as diagnostics with their lines.

use super::cpu::Cpu;
use crate::compare::grouped;
use crate::diagnostic::Diagnostic;
use crate::eval::{MESA_CAP, Observed};
use crate::glsl::Code;

/// A shader does what GLSL leaves undefined.
pub(super) const UNDEFINED: &str = "W0600";
/// Its loops run longer than older drivers allow.
pub(super) const LONG_LOOPS: &str = "W0601";

/// What was seen, but for what was foreseen: `warned` before the run.
pub(super) fn notes(cpu: &Cpu, warned: &[Diagnostic]) -> Vec<Diagnostic> {
    let undefined = |observed: &&Observed| observed.site.fault.is_undefined();
    let mut notes: Vec<_> = cpu.faults.iter().filter(undefined).map(fault).collect();
    let foreseen = warned
        .iter()
        .any(|warning| warning.code == Code::LongLoop.as_str());
    if cpu.beyond_cap > 0 && !foreseen {
        let message = format!(
            "loops run more than {} rounds in {} pixels, after which Mesa before 23 ends them by force",
            grouped(u64::from(MESA_CAP)),
            grouped(cpu.beyond_cap)
        );
        notes.push(Diagnostic::warning(LONG_LOOPS, message));
    }
    notes
}

fn fault(observed: &Observed) -> Diagnostic {
    let [x, y] = observed.first;
    let message = format!(
        "{} in {} {}, first at ({x}, {y}): GLSL leaves open what comes of it",
        observed.site.fault.words(),
        grouped(observed.pixels),
        if observed.pixels == 1 { "pixel" } else { "pixels" },
    );
    Diagnostic::warning(UNDEFINED, message).at(observed.site.at.span)
}
