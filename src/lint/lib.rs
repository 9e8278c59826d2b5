//! Warnings about legal GLSL that does not do what its author meant, or differs between machines: one file
//! per lint. [`lint`] takes the front end's result, and does not depend on later stages.
//!
//! ```
//! use toyproof_diagnostic::{Code, Deadline, File, Files};
//!
//! let mut files = Files::default();
//! let text = "void mainImage(out vec4 c, in vec2 p) { float shade; c = vec4(shade); }";
//! let file = files.add(File::new("shade.glsl", text));
//! let checked = toyproof_glsl::check(&files, file, &Default::default()).unwrap();
//! let lints = toyproof_lint::lint(&files, &checked, &Deadline::default());
//! assert_eq!(lints.warnings[0].code, Code::Unwritten);
//! ```
//!
//! False warnings teach users to ignore all warnings, so each analysis reports only what it is sure of. Only
//! code reachable from `mainImage` is analyzed, except for functions that are never called. Time is linear in
//! the size of the shader; blocks, whose nesting is bounded, are walked recursively, everything else
//! iteratively.
//!
//! # Parts
//!
//! - `program`: facts that all lints share: reachable functions, definitions of variables.
//! - `shape`: structural equality of expressions.
//! - `uninit`, `unset`, `unused`, `uncalled`: variables, inputs, values and functions.
//! - `equality`, `edges`, `fraction`, `randomness`: results that rounding decides, or that are undefined.
//! - `direction`: directions of rays that are not normalized.
//! - `iteration`, `uniformity`: loops, and derivatives in non-uniform control flow.
//! - `allow`: comments that suppress warnings.

mod allow;
mod appendix_a;
mod direction;
mod edges;
mod equality;
mod fraction;
mod iteration;
mod program;
mod randomness;
mod shape;
mod uncalled;
mod uniformity;
mod uninit;
mod unset;
mod unused;

use std::collections::HashSet;

use allow::Allows;
use program::Program;
use toyproof_diagnostic::{Code, Deadline, Diagnostic, Files, Overdue, Span};
use toyproof_glsl::tree::Place;
use toyproof_glsl::{Checked, MAX_REPORTED};

/// The lints' findings about a valid shader.
#[derive(Debug, Clone, Default)]
pub struct Lints {
    /// Warnings of the front end and the lints that the author does not allow, sorted by position; or a note
    /// that the lints exceeded their time limit.
    pub warnings: Vec<Diagnostic>,
    /// Warnings (W0004) about variables that are read and written on some paths only, each for a run in which
    /// such a read is observed. They name the declaration in [`Diagnostic::related`].
    pub maybe_uninitialized: Vec<Diagnostic>,
    /// Codes of run-time warnings that the author allows, with their scopes.
    pub allowed: Vec<(Code, Span)>,
}

impl Lints {
    /// Whether the author allows this run-time finding. A finding without a position is covered by any scope.
    pub fn allows(&self, finding: &Diagnostic) -> bool {
        let holds = |scope: &Span| {
            finding
                .span
                .is_none_or(|at| at.file == scope.file && (scope.start..scope.end).contains(&at.start))
        };
        let mut allowed = self.allowed.iter();
        allowed.any(|(code, scope)| *code == finding.code && holds(scope))
    }
}

/// The number of variables that the functions of a shader read, on some path at least, without a value.
pub fn uninitialized_reads(checked: &Checked, deadline: &Deadline) -> usize {
    let program = Program::new(&checked.tree, checked.main_image, deadline);
    let mut findings = Findings::default();
    uninit::run(&program, &mut findings);
    findings.all.len() + findings.maybe_uninitialized.len()
}

/// Searches a shader for suspicious code until the deadline. Also removes front-end warnings that the author
/// allows.
pub fn lint(files: &Files, checked: &Checked, deadline: &Deadline) -> Lints {
    let tree = &checked.tree;
    let program = Program::new(tree, checked.main_image, deadline);
    let mut findings = Findings::default();
    appendix_a::run(&program, checked, &mut findings);
    direction::run(&program, &mut findings);
    edges::run(&program, files, &mut findings);
    equality::run(&program, &mut findings);
    fraction::run(&program, &mut findings);
    iteration::run(&program, &mut findings);
    randomness::run(&program, &mut findings);
    uncalled::run(&program, files, checked, &mut findings);
    uniformity::run(&program, &mut findings);
    unused::run(&program, &mut findings);
    uninit::run(&program, &mut findings);
    unset::run(&program, checked.dialect, &mut findings);
    let within_deadline = deadline.check();
    let mut all = checked.warnings.clone();
    if within_deadline.is_ok() {
        // The findings of lints that exceeded the time limit are arbitrary, and are dropped.
        all.append(&mut findings.all);
    } else {
        findings.maybe_uninitialized.clear();
    }
    let mut allow_warnings = Vec::new();
    let allows = Allows::read(files, &checked.control_comments, tree, &mut allow_warnings);
    let mut warnings = allows.filter(all);
    warnings.append(&mut allow_warnings);
    if let Err(overdue) = within_deadline {
        warnings.retain(|diagnostic| diagnostic.code != Code::UnusedAllow);
        warnings.push(lint_timeout(overdue));
    }
    warnings.sort_by_key(|diagnostic| diagnostic.span.map(|span| span.start));
    warnings.truncate(MAX_REPORTED);
    let named = |found: Vec<Diagnostic>| {
        let found = found.into_iter();
        found.map(|one| checked.expansions.named(one, files)).collect()
    };
    Lints {
        warnings: named(warnings),
        maybe_uninitialized: named(findings.maybe_uninitialized),
        allowed: allows.runtime_allows(),
    }
}

fn lint_timeout(overdue: Overdue) -> Diagnostic {
    let message = format!(
        "lints exceeded their time limit of {} s and were skipped",
        overdue.limit.as_secs_f64()
    );
    Diagnostic::new(Code::LintTimeout, message).help("raise `--timeout`, or shorten the functions")
}

/// The findings so far.
#[derive(Default)]
struct Findings {
    all: Vec<Diagnostic>,
    /// Findings that hold only if a run of the shader observes them.
    maybe_uninitialized: Vec<Diagnostic>,
    /// Codes and source text already reported: a macro used many times is reported once.
    reported: HashSet<(Code, Place)>,
}

impl Findings {
    /// Adds a warning, unless one with this code was added for the same source text.
    fn add(
        &mut self,
        code: Code,
        at: Place,
        message: impl Into<String>,
        finish: impl FnOnce(Diagnostic) -> Diagnostic,
    ) {
        if self.reported.insert((code, Place::plain(at.spelling))) {
            self.all.push(finish(code.at(at, message)));
        }
    }
}

/// Formats a number with at most six significant digits.
fn format_number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e6).contains(&size) {
        let digits = if value == 0.0 {
            0
        } else {
            (5 - size.log10().floor() as i32).max(0) as usize
        };
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            return text.trim_end_matches('0').trim_end_matches('.').to_owned();
        }
        return text;
    }
    let text = format!("{value:.2e}");
    match text.split_once('e') {
        Some((digits, exponent)) => format!(
            "{}e{exponent}",
            digits.trim_end_matches('0').trim_end_matches('.')
        ),
        None => text,
    }
}

#[cfg(test)]
mod tests;
