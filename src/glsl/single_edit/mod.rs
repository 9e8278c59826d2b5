//! A single edit after which an invalid shader compiles: one inserted, removed or replaced token.
//!
//! Candidates are collected from the errors: fixes that they carry, edits of tokens near them, braces that
//! the indentation contradicts. Each has a cost, which grows with the size of the change and its distance
//! from the first error. In the order of their costs, [`check`](crate::check) verifies them on the edited
//! text.

mod braces;
mod candidates;
mod names;
mod punctuation;
mod types;

use std::time::Duration;

use toyproof_diagnostic::{Code, Deadline, Diagnostic, Diagnostics, File, FileId, Files, Fix, Severity};

use self::candidates::{Candidates, edited};
use crate::source::Source;
use crate::{Options, check, preprocess};

/// Maximum number of candidates that are verified.
const MAX_CHECKS: usize = 300;

/// Maximum number of bytes that all verifications check: 300 checks of a shader of 10 kB.
const MAX_CHECKED_BYTES: usize = 3_000_000;

/// Maximum number of tokens that all verifications check, after macros are expanded.
const MAX_CHECKED_TOKENS: usize = 1_000_000;

/// Maximum length of a text in bytes. ShaderToy's own limit is 65,535 characters.
const MAX_TEXT_BYTES: usize = 200_000;

/// The search takes at most one part in this many of the time limit.
const TIME_SHARE: u32 = 8;

/// Maximum duration of the search. The limits on work end it much earlier, except for constructs that take
/// unusually long to check.
const MAX_DURATION: Duration = Duration::from_secs(2);

/// Finds the most plausible single edit after which [`check`](crate::check) accepts the file, given the
/// errors of a check with the same options. Returns `None` if none was found within the limits on work and
/// time.
///
/// A renamed identifier counts as one edit at all its occurrences, and so do all fixes of one kind of error.
///
/// ```
/// use toyproof_diagnostic::{File, Files};
/// use toyproof_glsl::{Options, check, single_edit};
///
/// let mut files = Files::default();
/// let text = "void mainImage(out vec4 c, in vec2 p) {\n    float t = dot(p, p)\n    c = vec4(t);\n}\n";
/// let file = files.add(File::new("a.glsl", text));
/// let options = Options::default();
/// let errors = check(&files, file, &options).unwrap_err();
/// let fix = single_edit(&files, file, &errors, &options).unwrap();
/// assert_eq!(fix.message, "insert `;` after `dot(p, p)`");
/// ```
pub fn single_edit(files: &Files, file: FileId, errors: &Diagnostics, options: &Options) -> Option<Fix> {
    let text = files.get(file).text();
    let is_overdue = errors.iter().any(|error| error.code == Code::TooSlow);
    if text.len() > MAX_TEXT_BYTES || is_overdue {
        return None;
    }
    let source = Source::new(files, file);
    let mut candidates = Candidates::new(&source, errors);
    candidates.add_carried_fixes(errors);
    names::collect(&mut candidates, errors);
    punctuation::collect(&mut candidates);
    braces::collect(&mut candidates);
    types::collect(&mut candidates, errors);
    let limit = options
        .deadline
        .left()
        .map_or(MAX_DURATION, |left| left / TIME_SHARE);
    let options = Options {
        deadline: Deadline::after(limit.min(MAX_DURATION)),
        ..options.clone()
    };
    let (_, preprocessed) = preprocess(files, file, &options);
    let tokens = preprocessed.tokens.len();
    let checks = MAX_CHECKS
        .min(MAX_CHECKED_BYTES / text.len().max(1))
        .min(MAX_CHECKED_TOKENS / tokens.max(1));
    for fix in candidates.by_cost().take(checks) {
        if options.deadline.check().is_err() {
            return None;
        }
        let mut files = Files::default();
        let file = files.add(File::new("", edited(text, &fix.edits)));
        if check(&files, file, &options).is_ok() {
            return Some(fix);
        }
    }
    None
}

/// The errors of a check, with the [`single_edit`] after which the file compiles as the fix of the first
/// error. It replaces the fixes of that error, which are not sufficient. Nothing changes if the errors carry
/// that edit.
pub fn with_single_edit(
    files: &Files,
    file: FileId,
    errors: Diagnostics,
    options: &Options,
) -> Vec<Diagnostic> {
    let found = single_edit(files, file, &errors, options);
    let mut diagnostics = Vec::from(errors);
    let Some(fix) = found else {
        return diagnostics;
    };
    let carried = || {
        diagnostics
            .iter()
            .flat_map(|one| &one.fixes)
            .flat_map(|fix| &fix.edits)
    };
    if fix.edits.iter().all(|edit| carried().any(|other| other == edit)) {
        return diagnostics;
    }
    let is_error = |one: &&mut Diagnostic| one.severity == Severity::Error;
    if let Some(first) = diagnostics.iter_mut().find(is_error) {
        first.fixes = vec![fix];
    }
    diagnostics
}

#[cfg(test)]
mod tests;
