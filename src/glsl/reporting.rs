//! Parts that the diagnostics of all stages share.

use toyproof_diagnostic::{Code, Diagnostic, Overdue, plural};

/// The error about a shader that takes too long to compile, in any stage.
pub fn overdue(overdue: Overdue) -> Diagnostic {
    Diagnostic::new(Code::TooSlow, overdue.to_string())
        .help("shorten the longest expressions, arrays and functions, or raise `--timeout` (for `trade`, `--budget`)")
}

/// Maximum number of reported errors of one file, and of warnings.
pub const MAX_REPORTED: usize = 50;

/// Adds a diagnostic unless the limit for its severity is reached.
pub(crate) fn push_limited(reported: &mut Vec<Diagnostic>, diagnostic: Diagnostic) {
    let alike = reported
        .iter()
        .filter(|other| other.severity == diagnostic.severity);
    if alike.count() < MAX_REPORTED {
        reported.push(diagnostic);
    }
}

/// Formats a number of arguments or elements: `1 was given`, `3 were given`.
pub(crate) fn given(count: usize) -> String {
    format!("{count} {} given", plural(count as u64, "was", "were"))
}
