//! Integer arithmetic that wraps: in C++, and so in Metal, the overflow of an `int` is undefined, and hashes
//! rely on it. Arithmetic that looks like a hash is computed with `uint`, which wraps.

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Literal, Scalar, Type, UnaryOp, Value};

use crate::c_family::expression::{Part, Parts, level};
use crate::c_family::writer::{PrintResult, Writer};

/// Products with constants from here on are taken for those of a hash: coordinates and counters stay below
/// 2³¹ with smaller ones.
const LARGE: i64 = 4096;

/// A piece of an expression of unsigned integers.
enum Piece {
    Node(ExprId, u8),
    Token(String),
}

impl Writer<'_> {
    /// `int(uint(n) * 15731u)` for a sum, a difference or a product of `int`s that may overflow.
    pub(super) fn wrapped(&self, op: BinaryOp, left: ExprId, right: ExprId) -> PrintResult<Option<Parts>> {
        let ty = match [left, right].map(|side| self.cx.tree[side].ty) {
            [Type::Scalar(Scalar::Int), ty] | [ty, _] => ty,
        };
        let is_constant = [left, right].iter().all(|&side| self.cx.tree[side].constant);
        if ty.scalar() != Some(Scalar::Int) || is_constant || !self.may_overflow(op, left, right) {
            return Ok(None);
        }
        let mut parts = vec![Part::Token(format!("{}(", self.type_name(ty)?))];
        let mut pending = Vec::new();
        push_operation(op, left, right, level::SEQUENCE, &mut pending);
        while let Some(piece) = pending.pop() {
            let (id, at_least) = match piece {
                Piece::Token(text) => {
                    parts.push(Part::Token(text));
                    continue;
                }
                Piece::Node(id, at_least) => (id, at_least),
            };
            match &self.cx.tree[id].kind {
                &ExprKind::Binary { op, left, right } if is_arithmetic(op) => {
                    push_operation(op, left, right, at_least, &mut pending);
                }
                ExprKind::Literal(literal) if self.source.macro_name(self.cx.tree[id].at).is_none() => {
                    parts.push(Part::Token(unsigned(literal)));
                }
                _ => {
                    let ty = self.cx.tree[id]
                        .ty
                        .with_scalar(Scalar::Uint)
                        .unwrap_or(Type::UINT);
                    parts.extend(Self::call(self.type_name(ty)?, &[id]));
                }
            }
        }
        parts.push(Part::token(")"));
        Ok(Some((parts, level::POSTFIX)))
    }

    /// Whether arithmetic has a product and a large constant, or a product of bits.
    fn may_overflow(&self, op: BinaryOp, left: ExprId, right: ExprId) -> bool {
        if !is_arithmetic(op) {
            return false;
        }
        let tree = &self.cx.tree;
        let (mut has_product, mut is_large) = (op == BinaryOp::Multiply, false);
        let mut pending = vec![left, right];
        while let Some(id) = pending.pop() {
            match tree[id].kind {
                ExprKind::Binary { op, left, right } if is_arithmetic(op) => {
                    has_product |= op == BinaryOp::Multiply;
                    pending.extend([left, right]);
                }
                ExprKind::Unary {
                    op: UnaryOp::Minus | UnaryOp::Plus,
                    operand,
                } => pending.push(operand),
                ExprKind::Binary {
                    op: BinaryOp::BitXor | BinaryOp::ShiftLeft,
                    ..
                } => is_large = true,
                _ if tree[id].constant => {
                    let is_large_component = |value: &Value| match *value {
                        Value::Int(value) => i64::from(value).abs() >= LARGE,
                        _ => false,
                    };
                    is_large |= tree
                        .value(id)
                        .is_some_and(|value| value.components().iter().any(is_large_component));
                }
                _ => {}
            }
        }
        has_product && is_large
    }
}

fn is_arithmetic(op: BinaryOp) -> bool {
    matches!(op, BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Multiply)
}

/// Pushes the pieces of an operation, the first of which is popped first.
fn push_operation(op: BinaryOp, left: ExprId, right: ExprId, at_least: u8, pending: &mut Vec<Piece>) {
    let level = op.precedence() + level::BINARY;
    let token = |text: &str| Piece::Token(text.to_owned());
    if level < at_least {
        pending.push(token(")"));
    }
    pending.push(Piece::Node(right, level + 1));
    pending.push(Piece::Token(format!(" {} ", op.symbol())));
    pending.push(Piece::Node(left, level));
    if level < at_least {
        pending.push(token("("));
    }
}

/// An integer literal with the suffix of `uint`.
fn unsigned(literal: &Literal) -> String {
    match literal.value {
        Value::Int(value) => format!("{}u", value.cast_unsigned()),
        _ => literal.text.to_string(),
    }
}
