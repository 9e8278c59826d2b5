//! The fix of a division of integers where a float is needed: `1 / 3` and `float(1 / 3)` are 0, so the fix
//! converts the operands, not the result.

use toyproof_diagnostic::{Edit, Fix};

use super::Checker;
use crate::tree::{BinaryOp, ExprId, ExprKind, Type, UnaryOp, VariableKind};

/// Maximum number of operators and operands of an expression that is rewritten.
const MAX_NODES: usize = 16;

impl Checker<'_> {
    /// The fix of a constant expression with a division of integers, which converts the operands, or only
    /// advice where a macro contains some of them; `None` for other expressions.
    pub(super) fn float_quotient(&self, expr: ExprId) -> Option<Result<Fix, String>> {
        if self.ty(expr) != Type::INT || !self.tree[expr].constant || !self.divides(expr) {
            return None;
        }
        let mut edits = Vec::new();
        let Some(text) = self.in_floats(expr, 0, &mut edits) else {
            return Some(Err(
                "convert the operands to `float`: a division of integers drops the fraction".to_owned(),
            ));
        };
        let mut edits = edits.into_iter();
        let first = edits.next()?;
        let fix = Fix::new(format!("write `{text}`"), first.span, first.replacement);
        Some(Ok(
            edits.fold(fix, |fix, edit| fix.and(edit.span, edit.replacement))
        ))
    }

    /// Whether a short arithmetic expression contains a division.
    fn divides(&self, expr: ExprId) -> bool {
        let mut pending = vec![expr];
        let mut divides = false;
        for _ in 0..MAX_NODES {
            let Some(expr) = pending.pop() else {
                return divides;
            };
            match self.tree[expr].kind {
                ExprKind::Binary { op, left, right } => {
                    divides |= op == BinaryOp::Divide;
                    pending.extend([left, right]);
                }
                ExprKind::Unary { operand, .. } => pending.push(operand),
                _ => {}
            }
        }
        false
    }

    /// The text of an integer expression with all its operands as floats, where an operator of this
    /// precedence surrounds it, and the edits that convert them. `None` if an operand is not a number or a
    /// constant that is written here.
    fn in_floats(&self, expr: ExprId, outer: u8, edits: &mut Vec<Edit>) -> Option<String> {
        let at = self.tree[expr].at;
        if at.is_expanded() {
            return None;
        }
        let mut convert = |replacement: String| {
            edits.push(Edit {
                span: at.span,
                replacement: replacement.clone(),
            });
            Some(replacement)
        };
        match &self.tree[expr].kind {
            ExprKind::Literal(literal) => {
                // A number that begins with 0 is octal.
                let is_decimal = literal.text.bytes().all(|byte| byte.is_ascii_digit())
                    && !(literal.text.len() > 1 && literal.text.starts_with('0'));
                is_decimal.then(|| convert(format!("{}.0", literal.text)))?
            }
            ExprKind::Variable(variable) if self.tree[*variable].kind == VariableKind::Const => {
                convert(format!("float({})", self.tree[*variable].name))
            }
            &ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => Some(format!("-{}", self.in_floats(operand, u8::MAX, edits)?)),
            &ExprKind::Binary { op, left, right }
                if op.precedence() >= BinaryOp::Add.precedence() && op != BinaryOp::Remainder =>
            {
                let own = op.precedence();
                let left = self.in_floats(left, own, edits)?;
                // Operators of equal precedence are left-associative.
                let right = self.in_floats(right, own + 1, edits)?;
                let text = format!("{left} {} {right}", op.symbol());
                Some(if own < outer { format!("({text})") } else { text })
            }
            _ => None,
        }
    }
}
