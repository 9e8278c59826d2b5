//! Warnings about legal GLSL that does not do what its author meant, or not on every machine: one file for each lint.
//! [`lint`] takes what the front end has checked and knows nothing of what becomes of it.
//!
//! ```
//! use toyproof_diagnostic::{Deadline, File, Files};
//!
//! let mut files = Files::default();
//! let text = "void mainImage(out vec4 c, in vec2 p) { float shade; c = vec4(shade); }";
//! let file = files.add(File::new("shade.glsl", text));
//! let checked = toyproof_glsl::check(&files, file, &Default::default()).unwrap();
//! let lints = toyproof_lint::lint(&files, &checked, &Deadline::default());
//! assert_eq!(lints.warnings[0].code, "W0003");
//! ```
//!
//! A warning that is wrong teaches people to read none, so each analysis speaks where it is sure, and is silent where it
//! is not. Only what `mainImage` reaches is looked at. Time is linear in the size of the shader; blocks are walked by
//! recursion, as their nesting is bounded, and all else with loops.

mod allow;
mod direction;
mod equality;
mod iteration;
mod program;
mod quadratic;
mod randomness;
mod shape;
mod uniformity;
mod unused;
mod unwritten;

use std::collections::HashSet;

use toyproof_diagnostic::{Deadline, Diagnostic, Files, Overdue, Severity, Span};
use toyproof_glsl::tree::Place;
use toyproof_glsl::{Checked, Code, MAX_TOLD};

use self::allow::Allows;
use self::program::Program;

/// The lints' findings about a shader that keeps every rule.
#[derive(Debug, Clone, Default)]
pub struct Lints {
    /// Warnings of the front end and of the lints that the author does not allow, in the order of the text; or a note
    /// that the lints were out of time.
    pub warnings: Vec<Diagnostic>,
    /// Discriminants of ray-sphere formulas that lose digits, but for those that the author allows. Whether the loss
    /// is visible depends on the scene.
    pub discriminants: Vec<Span>,
    /// Warnings about a run that the author allows, and where.
    pub allowed: Vec<(Code, Span)>,
}

impl Lints {
    /// Whether the author allows this finding of a run. A finding without a line is allowed anywhere.
    #[must_use]
    pub fn allows(&self, finding: &Diagnostic) -> bool {
        let holds = |over: &Span| {
            finding
                .span
                .is_none_or(|at| at.file == over.file && (over.start..over.end).contains(&at.start))
        };
        let mut allowed = self.allowed.iter();
        allowed.any(|(code, over)| code.as_str() == finding.code && holds(over))
    }
}

/// Searches a shader for suspicious code, until the deadline at the latest. The front end's warnings that the author
/// allows are left out, too.
#[must_use]
pub fn lint(files: &Files, checked: &Checked, deadline: &Deadline) -> Lints {
    let tree = &checked.tree;
    let program = Program::new(tree, checked.main_image, deadline);
    let mut found = Found::default();
    let quadratics = quadratic::quadratics(&program);
    direction::run(&program, &quadratics, &mut found);
    equality::run(&program, &mut found);
    iteration::run(&program, &mut found);
    randomness::run(&program, &mut found);
    uniformity::run(&program, &mut found);
    unused::run(&program, &mut found);
    unwritten::run(&program, files, &mut found);
    for quadratic in &quadratics {
        found.tell(Code::NearTangent, tree[quadratic.expr].at, "", |diagnostic| {
            diagnostic
        });
    }
    let in_time = deadline.check();
    let mut all = checked.warnings.clone();
    if in_time.is_ok() {
        // Of lints that were out of time, what they found is no more than chance.
        all.append(&mut found.all);
    }
    let mut of_remarks = Vec::new();
    let allows = Allows::read(files, &checked.remarks, tree, &mut of_remarks);
    let mut left = allows.sift(all);
    left.append(&mut of_remarks);
    if let Err(overdue) = in_time {
        left.retain(|diagnostic| diagnostic.code != Code::UnusedAllow.as_str());
        left.push(lint_timeout(overdue));
    }
    left.sort_by_key(|diagnostic| diagnostic.span.map(|span| span.start));
    let (seeds, mut warnings): (Vec<_>, Vec<_>) = left
        .into_iter()
        .partition(|diagnostic| diagnostic.code == Code::NearTangent.as_str());
    warnings.truncate(MAX_TOLD);
    Lints {
        warnings,
        discriminants: seeds.into_iter().filter_map(|seed| seed.span).collect(),
        allowed: allows.of_runs(),
    }
}

fn lint_timeout(overdue: Overdue) -> Diagnostic {
    let message = format!(
        "the lints take longer than {} s for this shader: it was not searched for suspicious code",
        overdue.limit.as_secs_f64()
    );
    Diagnostic::new(Severity::Note, Code::LintTimeout.as_str(), message)
        .note("shorter functions take less time; `--timeout` gives more")
}

/// What the analyses found so far.
#[derive(Default)]
struct Found {
    all: Vec<Diagnostic>,
    /// A macro used a hundred times is told once.
    spelled: HashSet<(Code, Place)>,
}

impl Found {
    /// Adds a warning, unless the same characters were warned of before.
    fn tell(
        &mut self,
        code: Code,
        at: Place,
        message: impl Into<String>,
        finish: impl FnOnce(Diagnostic) -> Diagnostic,
    ) {
        if self.spelled.insert((code, Place::plain(at.spelled))) {
            self.all.push(finish(code.at(at, message)));
        }
    }
}

/// A number as people write it, with at most six digits that count.
fn number(value: f64) -> String {
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
