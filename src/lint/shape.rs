//! Whether two expressions are written alike: the same operators on the same variables.

use std::fmt::Write;

use toyproof_glsl::tree::{ExprId, ExprKind, Tree, VariableId};

/// The most nodes that are compared.
const MAX_NODES: usize = 100;

/// What an expression looks like; none of what does more than give a value, and of the very large.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Shape {
    text: String,
    /// Whose values it depends on.
    pub(super) variables: Vec<VariableId>,
}

impl Shape {
    pub(super) fn of_variable(variable: VariableId) -> Self {
        Self {
            text: format!("{variable:?};"),
            variables: vec![variable],
        }
    }

    pub(super) fn of(tree: &Tree, root: ExprId) -> Option<Self> {
        let mut shape = Self {
            text: String::new(),
            variables: Vec::new(),
        };
        let mut pending = vec![root];
        for _ in 0..MAX_NODES {
            let Some(expr) = pending.pop() else {
                return Some(shape);
            };
            // Every operator has as many operands as its name says, so that names in prefix order tell trees apart.
            let text = &mut shape.text;
            let written = match &tree[expr].kind {
                ExprKind::Literal(literal) => write!(text, "{:?};", literal.value),
                ExprKind::Variable(variable) => {
                    shape.variables.push(*variable);
                    write!(text, "{variable:?};")
                }
                ExprKind::Unary { op, .. } => write!(text, "{op:?};"),
                ExprKind::Binary { op, .. } => write!(text, "{op:?};"),
                ExprKind::Conditional { .. } => write!(text, "?:;"),
                ExprKind::BuiltIn { function, arguments } if function.out_parameter().is_none() => {
                    write!(text, "{function:?}{};", arguments.len())
                }
                ExprKind::Construct { arguments, .. } => {
                    write!(text, "{:?}{};", tree[expr].ty, arguments.len())
                }
                ExprKind::Swizzle { components, .. } => write!(text, ".{};", components.name()),
                ExprKind::Member { member, .. } => write!(text, ".{member};"),
                ExprKind::Index { .. } => write!(text, "[];"),
                ExprKind::Length { .. } => write!(text, "length;"),
                _ => return None,
            };
            written.ok()?;
            let first = pending.len();
            tree[expr].kind.for_each_operand(|operand| pending.push(operand));
            pending[first..].reverse();
        }
        None
    }
}
