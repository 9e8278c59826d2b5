//! Candidates: edits of a shader, as changes of its tree and of its text.

use std::collections::BTreeMap;

use toyproof_diagnostic::{Edit, Fix, Span};
use toyproof_glsl::tree::ExprId;

use super::scan;
use super::shader::{Shader, Shape};
use super::term::{PRIMARY, Term, context, is_parenthesized};
use crate::engine::Numbers;
use crate::engine::tournament::{Entrant, Values};
use crate::known::KnownMistake;
use crate::known::documented::{Documented, documented};

/// An edit that may repair a shader.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) change: Change,
    /// The numbers that it tries.
    pub(super) values: Values,
    /// How unlikely the edit is, before its place is considered: larger edits, and edits of a kind that
    /// mistakes seldom have, cost more.
    pub(super) cost: u32,
    pub(super) kind: EditKind,
}

/// What an edit changes.
#[derive(Debug, Clone)]
pub(super) enum Change {
    /// Replaces the expression of a site.
    Expression { site: usize, term: Term },
    /// Deletes, copies and inserts statements; each by its index among the shader's.
    Statements(Vec<(usize, Action)>),
}

/// A change at a statement.
#[derive(Debug, Clone)]
pub(super) enum Action {
    Delete,
    /// Inserts a copy of another statement in front.
    CopyBefore(usize),
    /// Inserts a copy of another statement behind.
    CopyAfter(usize),
    /// Inserts an assignment in front.
    Before(Term),
    /// Inserts an assignment behind.
    After(Term),
}

macro_rules! kinds {
    ($($(#[doc = $fix:literal])+ $kind:ident $id:literal $description:literal,)*) => {
        /// The kind of an edit, which names the mistake.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(super) enum EditKind {
            $($kind,)*
        }

        /// What the guide says about the mistakes that edits name.
        pub(crate) const DOCUMENTED: &[Documented] = documented! {
            $($(#[doc = $fix])+ Edits $id: $description;)*
        };

        impl EditKind {
            /// All kinds.
            #[cfg(test)]
            pub(super) const ALL: &[Self] = &[$(Self::$kind),*];

            /// The mistake that an edit of this kind repairs.
            pub(super) fn mistake(self) -> KnownMistake {
                match self {
                    $(Self::$kind => KnownMistake::new($id, $description),)*
                }
            }
        }
    };
}

kinds! {
    /// Compare the number in that line with the scene or the formula that it comes from. The fix, where it is
    /// shown, has the right one.
    Number "wrong-number" "a number is wrong",
    /// Write the operator of the fix, and compare the formula with its derivation.
    Operator "wrong-operator" "an operator is wrong",
    /// Write the comparison of the fix, and check what happens on both sides of the limit.
    Comparison "wrong-comparison" "a comparison is wrong",
    /// Change the sign, and check which way the vector or the root must point.
    Sign "wrong-sign" "a sign is wrong",
    /// Use the variable of the fix; names that differ more are harder to confuse.
    Variable "wrong-variable" "a variable is used in place of another",
    /// Call the function of the fix.
    Function "wrong-function" "a function is called in place of another",
    /// Use the component of the fix, such as `.y` for `.x`.
    Component "wrong-component" "a component is used in place of another",
    /// Swap the operands: the order matters for `-`, `/` and products with matrices.
    Operands "swapped-operands" "two operands are swapped",
    /// Swap the arguments, and compare them with the parameters of the function.
    Arguments "swapped-arguments" "two arguments are swapped",
    /// Add the call of the fix, such as `normalize` or `max`.
    MissingCall "missing-call" "a function call is missing around an expression",
    /// Remove the call, and keep its argument.
    SuperfluousCall "superfluous-call" "a function call is superfluous",
    /// Multiply by the factor of the fix.
    MissingFactor "missing-factor" "a factor is missing",
    /// Remove the factor.
    SuperfluousFactor "superfluous-factor" "a factor is superfluous",
    /// Add the term of the fix.
    MissingTerm "missing-term" "a term of a sum is missing",
    /// Remove the term.
    SuperfluousTerm "superfluous-term" "a term of a sum is superfluous",
    /// Write the condition of the fix, and check in which pixels it must be true.
    Condition "wrong-condition" "a condition is wrong",
    /// Add the statement of the fix.
    MissingStatement "missing-statement" "a statement is missing",
    /// Remove the statement.
    SuperfluousStatement "superfluous-statement" "a statement is superfluous",
    /// Move the statement to the place of the fix: before or after others, or into another block.
    MisplacedStatement "misplaced-statement" "a statement is in the wrong place",
    /// Use the bounds of the fix, and count the iterations.
    Loop "wrong-loop" "the bounds of a loop are wrong",
    /// Write the expression of the fix, and compare it with the formula that it implements.
    Expression "wrong-expression" "an expression is wrong",
    /// Make both edits of the fix; each alone improves the image.
    Two "two-mistakes" "two things are wrong",
}

impl Candidate {
    /// The index of the statement that it changes first.
    pub(super) fn statement(&self, shader: &Shader) -> usize {
        match &self.change {
            Change::Expression { site, .. } => shader.sites[*site].statement,
            Change::Statements(actions) => actions.iter().map(|&(at, _)| at).min().unwrap_or(0),
        }
    }

    pub(super) fn entrant(&self) -> Entrant<'_> {
        Entrant {
            values: &self.values,
            cost: self.cost,
        }
    }

    /// The candidate with its numbers, at their cost.
    pub(super) fn with_numbers(&self, numbers: &Numbers, cost: u32) -> Self {
        let mut fitted = self.clone();
        fitted.cost = cost;
        match &mut fitted.change {
            Change::Expression { term, .. } => *term = term.with_fitted(numbers),
            Change::Statements(actions) => {
                for (_, action) in actions {
                    if let Action::Before(term) | Action::After(term) = action {
                        *term = term.with_fitted(numbers);
                    }
                }
            }
        }
        fitted.values = Values::Fixed;
        fitted
    }

    /// Several candidates, each with the numbers of one cost.
    pub(super) fn by_cost(self) -> Vec<Self> {
        let Values::Tried { values, fit } = &self.values else {
            return vec![self];
        };
        let with = |values: Vec<(f64, u32)>, fit, cost| Self {
            values: Values::Tried { values, fit },
            cost,
            ..self.clone()
        };
        let mut by_cost: BTreeMap<u32, Vec<(f64, u32)>> = BTreeMap::new();
        for &(value, cost) in values {
            by_cost.entry(cost).or_default().push((value, cost));
        }
        let mut all: Vec<Self> = by_cost
            .into_iter()
            .map(|(cost, values)| with(values, None, cost))
            .collect();
        all.extend(fit.map(|(cost, fit)| with(Vec::new(), Some((cost, fit)), cost)));
        all
    }

    /// The kind of mistake that it repairs; in the head of a loop, that of the loop.
    pub(super) fn kind(&self, shader: &Shader) -> EditKind {
        let is_head = shader.statements[self.statement(shader)].kind == Shape::Loop;
        if is_head && matches!(self.change, Change::Expression { .. }) {
            EditKind::Loop
        } else {
            self.kind
        }
    }

    /// The edits of the text; `None` if it has no text that could be edited.
    pub(super) fn fix(&self, shader: &Shader) -> Option<Fix> {
        match &self.change {
            Change::Expression { site, term } => replacement(shader, *site, term),
            Change::Statements(actions) => statement_edits(shader, actions),
        }
    }
}

/// The edit that replaces a site's text.
fn replacement(shader: &Shader, site: usize, term: &Term) -> Option<Fix> {
    let site = &shader.sites[site];
    let (tree, source) = (shader.tree, shader.source);
    let old = shader.text(site.span);
    let required = match site.user {
        _ if is_parenthesized(old) || site.exprs.len() > 1 => PRIMARY,
        Some(user) => context(tree, user, site.exprs[0]),
        None => 0,
    };
    let new = term.text(tree, source, required);
    if new == old || old.is_empty() {
        return None;
    }
    // A short text may occur several times on the line: show what encloses it.
    let (mut shown_old, mut shown_new) = (old.to_owned(), new.clone());
    let line = scan::line(source, site.span.start as usize);
    let mut user = site.user;
    while let Some(expr) = user
        && line.matches(shown_old.as_str()).count() > 1
    {
        let whole = tree[expr].at.span;
        if tree[expr].at.is_expanded() || whole.start > site.span.start || whole.end < site.span.end {
            break;
        }
        let text = shader.text(whole);
        let [from, to] = [site.span.start, site.span.end].map(|at| (at - whole.start) as usize);
        shown_new = format!("{}{new}{}", &text[..from], &text[to..]);
        text.clone_into(&mut shown_old);
        user = parent(shader, expr);
    }
    let message = format!(
        "replace `{}` with `{}`",
        one_line(&shown_old),
        one_line(&shown_new)
    );
    Some(Fix::new(message, site.span, new))
}

/// The expression that uses another, if its site is known.
fn parent(shader: &Shader, expr: ExprId) -> Option<ExprId> {
    let site = shader.sites.iter().find(|site| site.exprs[0] == expr)?;
    site.user
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The edits that delete, copy and insert statements.
fn statement_edits(shader: &Shader, actions: &[(usize, Action)]) -> Option<Fix> {
    let source = shader.source;
    let extent = |at: usize| -> Option<Span> {
        let statement = &shader.statements[at];
        if statement.is_expanded {
            return None;
        }
        let start = statement.span.start as usize;
        let end = scan::statement_end(source, start)?;
        Some(Span::new(statement.span.file, statement.span.start, end as u32))
    };
    let mut edits = Vec::new();
    let mut messages = Vec::new();
    let is_move = actions.len() > 1;
    for (at, action) in actions {
        let own = extent(*at)?;
        let is_braced = scan::follows_statement(source, own.start as usize);
        let place = |at| Span::new(own.file, at, at);
        match action {
            Action::Delete => {
                let replacement = if is_braced { "" } else { ";" };
                edits.push(Edit {
                    span: own,
                    replacement: replacement.to_owned(),
                });
                if !is_move {
                    messages.push(format!("delete `{}`", shortened(shader.text(own))));
                }
            }
            Action::CopyBefore(_) | Action::CopyAfter(_) if !is_braced => return None,
            Action::CopyBefore(other) | Action::CopyAfter(other) => {
                let copy = shader.text(extent(*other)?);
                let is_before = matches!(action, Action::CopyBefore(_));
                edits.push(Edit {
                    span: place(if is_before { own.start } else { own.end }),
                    replacement: if is_before {
                        format!("{copy} ")
                    } else {
                        format!(" {copy}")
                    },
                });
                let verb = if is_move { "move" } else { "repeat" };
                let side = if is_before { "before" } else { "after" };
                let copy = shortened(copy);
                messages.push(if at == other {
                    format!("{verb} `{copy}`")
                } else {
                    format!("{verb} `{copy}` {side} `{}`", shortened(shader.text(own)))
                });
            }
            Action::Before(term) | Action::After(term) => {
                let text = format!("{};", term.text(shader.tree, source, 0));
                let (before, after, side) = match action {
                    Action::Before(_) => (format!("{text} "), String::new(), "before"),
                    _ => (String::new(), format!(" {text}"), "after"),
                };
                // A body without braces gets them.
                let (before, after) = if is_braced {
                    (before, after)
                } else {
                    (format!("{{ {before}"), format!("{after} }}"))
                };
                for (at, replacement) in [(own.start, before), (own.end, after)] {
                    if !replacement.is_empty() {
                        let span = place(at);
                        edits.push(Edit { span, replacement });
                    }
                }
                messages.push(format!(
                    "insert `{text}` {side} `{}`",
                    shortened(shader.text(own))
                ));
            }
        }
    }
    edits.sort_by_key(|edit| edit.span.start);
    Some(Fix {
        message: messages.join(", and "),
        edits,
    })
}

/// The largest number of characters of a statement in a message.
const MAX_SHOWN: usize = 60;

pub(super) fn shortened(text: &str) -> String {
    let text = one_line(text);
    match text.char_indices().nth(MAX_SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
