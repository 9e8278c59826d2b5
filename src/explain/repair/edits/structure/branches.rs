//! Jumps, `else`, and declarations that hide a variable.

use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{Direction, ExprKind, Type, VariableId, VariableKind};

use super::super::super::edit::{EditKind, shortened};
use super::super::super::scan;
use super::super::super::shader::Shape;
use super::super::writer;
use super::{MAX_VALUES, Writer, deletion, insertion, replacement};

/// The costs: a jump or `else`, a jump on a condition, another branch, an assignment in place of a declaration,
/// a `break` in a `switch`, a dropped value, and another qualifier.
const JUMP: u32 = 17;
const EXIT: u32 = 23;
const BRANCH: u32 = 22;
const HIDDEN: u32 = 12;
const BREAK: u32 = 14;
const DROPPED: u32 = 10;
const INOUT: u32 = 14;

/// The largest number of statements after which an inserted `else` ends.
const MAX_ENDS: usize = 4;

impl Writer<'_> {
    /// Leaves the function or the loop at the end of an `if`, and makes what follows it its `else`.
    pub(super) fn jumps(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let Shape::If { is_single: true } = shader.statements[at].kind else {
            return;
        };
        let (Some(extent), Some(function)) = (self.outline.extents[at], self.function(at)) else {
            return;
        };
        let mut words = Vec::new();
        if tree[function].return_type == Type::Void {
            words.push("return;");
        }
        if self
            .outline
            .enclosing(at)
            .any(|outer| shader.statements[outer].kind == Shape::Loop)
        {
            words.extend(["break;", "continue;"]);
        }
        let text = shader.text(extent);
        let head = shortened(shader.text(shader.statements[at].span));
        for word in words {
            let edits = if text.ends_with('}') {
                vec![insertion(extent, extent.end - 1, format!("{word} "))]
            } else {
                let Some(body) = scan::body(shader.source, extent.start as usize) else {
                    continue;
                };
                vec![
                    insertion(extent, body as u32, "{ ".to_owned()),
                    insertion(extent, extent.end, format!(" {word} }}")),
                ]
            };
            let message = format!("insert `{word}` at the end of `{head}`");
            self.add(at, EditKind::MissingStatement, JUMP, message, edits);
        }
        let after: Vec<usize> = self
            .siblings(at)
            .into_iter()
            .filter(|&other| other > at)
            .collect();
        let Some(&next) = after.first() else { return };
        let Some(start) = self.outline.extents[next] else {
            return;
        };
        let shown = shortened(self.text(next));
        let message = format!("insert `else` before `{shown}`");
        let single = vec![insertion(start, start.start, "else ".to_owned())];
        self.add(at, EditKind::Condition, JUMP, message.clone(), single);
        // Up to a statement that is no declaration, or to the last.
        let is_declaration = |at: usize| matches!(shader.statements[at].kind, Shape::Declaration(_));
        let ends = after.iter().skip(1).filter(|&&end| !is_declaration(end));
        let ends: Vec<usize> = ends.take(MAX_ENDS).chain(after.last()).copied().collect();
        for end in ends {
            let Some(end) = self.outline.extents[end] else {
                continue;
            };
            let edits = vec![
                insertion(start, start.start, "else { ".to_owned()),
                insertion(end, end.end, " }".to_owned()),
            ];
            let message = format!("{message} and what follows");
            self.add(at, EditKind::Condition, JUMP, message, edits);
        }
    }

    /// Leaves the cases of a `switch` that continue in the next.
    pub(super) fn cases(&mut self, at: usize) {
        let shader = self.shader;
        let (Shape::Other, Some(extent)) = (&shader.statements[at].kind, self.outline.extents[at]) else {
            return;
        };
        let text = shader.text(extent);
        let labels = ["case ", "default:"].map(|label| text.match_indices(label));
        for (start, label) in labels.into_iter().flatten() {
            let place = extent.start + start as u32;
            let message = format!("insert `break;` before `{}`", label.trim_end());
            let edits = vec![insertion(extent, place, "break; ".to_owned())];
            self.add(at, EditKind::MissingStatement, BREAK, message, edits);
        }
    }

    /// Uses a value that is computed and dropped: assigns it, or returns it.
    pub(super) fn dropped(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let (&Shape::Expression(expr), Some(extent), Some(function)) = (
            &shader.statements[at].kind,
            self.outline.extents[at],
            self.function(at),
        ) else {
            return;
        };
        let ty = tree[expr].ty;
        let is_assignment = matches!(tree[expr].kind, ExprKind::Assign { .. } | ExprKind::Step { .. });
        if is_assignment || matches!(ty, Type::Void | Type::Error) {
            return;
        }
        let mut starts: Vec<String> = self.values(at, ty).map(|name| format!("{name} = ")).collect();
        if tree[function].return_type == ty {
            starts.push("return ".to_owned());
        }
        let shown = shortened(self.text(at));
        for start in starts {
            let message = format!("insert `{}` before `{shown}`", start.trim_end());
            let edits = vec![insertion(extent, extent.start, start)];
            self.add(at, EditKind::MissingStatement, DROPPED, message, edits);
        }
    }

    /// Returns the parameters that a function assigns to its caller.
    pub(super) fn parameters(&mut self) {
        let (shader, tree) = (self.shader, self.shader.tree);
        for at in 0..shader.statements.len() {
            let Shape::Expression(expr) = shader.statements[at].kind else {
                continue;
            };
            let ExprKind::Assign { target, .. } = tree[expr].kind else {
                continue;
            };
            let parameter = tree.root_variable(target).map(|id| &tree[id]);
            let Some(parameter) = parameter.filter(|own| own.kind == VariableKind::Parameter(Direction::In))
            else {
                continue;
            };
            let Some(name) = parameter.at.filter(|at| !at.is_expanded()) else {
                continue;
            };
            // Its type follows a parenthesis or a comma.
            let before = &shader.source[..name.span.start as usize];
            let Some(start) = before.rfind(['(', ',']) else {
                continue;
            };
            let declared = before[start + 1..].trim_start();
            let place = before.len() - declared.len();
            let (qualifier, end) = match declared.strip_prefix("in ") {
                Some(_) => ("inout", place + 2),
                None => ("inout ", place),
            };
            let span = Span::new(name.span.file, place as u32, end as u32);
            let message = format!("make the parameter `{}` `inout`", parameter.name);
            self.add(
                at,
                EditKind::MissingStatement,
                INOUT,
                message,
                vec![replacement(span, qualifier)],
            );
        }
    }

    /// Leaves a loop, or a function, on a condition of the reference, behind a statement and in front of the
    /// first of its block.
    pub(super) fn exits(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let (Some(extent), Some(function)) = (self.outline.extents[at], self.function(at)) else {
            return;
        };
        let is_in_loop = self
            .outline
            .enclosing(at)
            .any(|outer| shader.statements[outer].kind == Shape::Loop);
        let exit = if is_in_loop {
            "break;"
        } else if tree[function].return_type == Type::Void {
            "return;"
        } else {
            return;
        };
        if !self.is_simple(at) {
            return;
        }
        let is_first = self.siblings(at).first() == Some(&at);
        let conditions = writer::Writer::new(shader, self.constants).conditions(at);
        let head = shortened(self.text(at));
        for condition in conditions {
            let text = format!("if ({condition}) {exit}");
            let message = format!("insert `{text}` after `{head}`");
            let edits = vec![insertion(extent, extent.end, format!(" {text}"))];
            self.add(at, EditKind::MissingStatement, EXIT, message, edits);
            if is_first {
                let message = format!("insert `{text}` before `{head}`");
                let edits = vec![insertion(extent, extent.start, format!("{text} "))];
                self.add(at, EditKind::MissingStatement, EXIT, message, edits);
            }
        }
    }

    /// An `else` that assigns another value to a variable that the branch assigns.
    pub(super) fn alternatives(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let (Shape::If { is_single: true }, Some(extent)) =
            (&shader.statements[at].kind, self.outline.extents[at])
        else {
            return;
        };
        let mut texts: Vec<String> = Vec::new();
        for inner in self.outline.children(at) {
            let Shape::Expression(expr) = shader.statements[inner].kind else {
                continue;
            };
            let ExprKind::Assign { target, .. } = tree[expr].kind else {
                continue;
            };
            if tree[target].at.is_expanded() {
                continue;
            }
            let name = shader.text(tree[target].at.span);
            let values = self.values(at, tree[target].ty).filter(|value| *value != name);
            texts.extend(values.take(MAX_VALUES).map(|value| format!("{name} = {value};")));
        }
        texts.dedup();
        let head = shortened(shader.text(shader.statements[at].span));
        for text in texts {
            let message = format!("insert `else {{ {text} }}` after `{head}`");
            let edits = vec![insertion(extent, extent.end, format!(" else {{ {text} }}"))];
            self.add(at, EditKind::MissingStatement, BRANCH, message, edits);
        }
    }

    /// Assigns to a variable instead of declaring another one that hides it.
    pub(super) fn hidden(&mut self, at: usize) {
        let (shader, tree) = (self.shader, self.shader.tree);
        let (&Shape::Declaration(variable), Some(extent)) =
            (&shader.statements[at].kind, self.outline.extents[at])
        else {
            return;
        };
        let own = &tree[variable];
        let is_hidden = |other: &&VariableId| {
            let other = &tree[**other];
            let is_variable = matches!(
                other.kind,
                VariableKind::Local | VariableKind::Parameter(_) | VariableKind::Global
            );
            is_variable && other.name == own.name && other.ty == own.ty
        };
        let Some(name) = own
            .at
            .filter(|_| shader.statements[at].scope.iter().any(|id| is_hidden(&id)))
        else {
            return;
        };
        let ty = Span::new(extent.file, extent.start, name.span.start);
        if own.initializer.is_some() && ty.start < ty.end && name.span.end <= extent.end {
            let message = format!(
                "replace `{0} {1} =` with `{1} =`",
                shader.text(ty).trim(),
                own.name
            );
            self.add(at, EditKind::Variable, HIDDEN, message, vec![deletion(ty)]);
        }
    }
}
