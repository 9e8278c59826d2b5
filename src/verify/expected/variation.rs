//! A reference shader with other numbers.

use toyproof_diagnostic::Span;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{BinaryOp, Expr, ExprId, ExprKind, Type, Value, VariableKind};

/// A reference with other numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variation {
    pub(super) edits: Vec<Edit>,
    pub(super) subject: Subject,
}

/// What a variation changes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Subject {
    /// Ray epsilons.
    Epsilons,
    /// Marches, with those of their limits that change, by the places where loops compare with them.
    March(Vec<Span>),
}

/// A change of one expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Edit {
    /// Another number in place of a literal.
    Number(ExprId, Value),
    /// A multiple of an expression.
    Scale(ExprId, f64),
}

impl Variation {
    /// The shader with this variation.
    pub(super) fn apply(&self, checked: &Checked) -> Checked {
        let mut checked = checked.clone();
        let tree = &mut checked.tree;
        for edit in &self.edits {
            match *edit {
                Edit::Number(id, value) => tree[id].kind = ExprKind::Literal(value.into()),
                Edit::Scale(id, factor) => {
                    let whole = tree[id].clone();
                    let right = tree.exprs.push(Expr {
                        kind: ExprKind::Literal(Value::Float(factor).into()),
                        ty: Type::FLOAT,
                        constant: true,
                        at: whole.at,
                    });
                    let left = tree.exprs.push(whole);
                    tree[id].kind = ExprKind::Binary {
                        op: BinaryOp::Multiply,
                        left,
                        right,
                    };
                }
            }
        }
        tree.clear_cached_values();
        // A constant precedes those that depend on it.
        for id in tree.variables.ids() {
            if tree[id].kind == VariableKind::Const
                && let Some(value) = tree[id]
                    .initializer
                    .and_then(|initializer| tree.value(initializer))
            {
                tree[id].value = Some(value);
            }
        }
        checked
    }
}
