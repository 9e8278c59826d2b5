//! `a % b` of integers: floors where `a` or `b` is negative, and takes a vector with a scalar.
//!
//! The specification leaves negative operands undefined; glslang, Mesa and `SwiftShader` floor, as a browser's picture then
//! does, and naga truncates. naga also refuses `v % s`, which it makes for every other operator.

use toyproof_glsl::tree::{BinaryOp, Constructor, ExprId, ExprKind, Scalar, Tree, Type, Value};

use super::draft::Draft;
use super::helper::Helper;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(spell_out);
    draft.each_expression(|draft, id| {
        let ExprKind::Binary {
            op: BinaryOp::Remainder,
            left,
            right,
        } = draft.tree[id].kind
        else {
            return;
        };
        let ty = draft.tree[id].ty;
        let [left, right] = [left, right].map(|operand| widen(draft, operand, ty));
        let signed = ty.scalar() == Some(Scalar::Int);
        draft.tree[id].kind = if signed
            && ![left, right]
                .iter()
                .all(|&operand| is_natural(&draft.tree, operand))
        {
            let at = draft.tree[id].at;
            let function = draft.helper(Helper::Remainder, (ty, ty), at);
            ExprKind::Call {
                function,
                arguments: vec![left, right],
            }
        } else {
            ExprKind::Binary {
                op: BinaryOp::Remainder,
                left,
                right,
            }
        };
    });
}

/// `a %= b` is `a = a % b`: what stands in the indices of `a` is evaluated once already.
fn spell_out(draft: &mut Draft, id: ExprId) {
    if let ExprKind::Assign {
        op: Some(op @ BinaryOp::Remainder),
        target,
        value,
    } = draft.tree[id].kind
    {
        let ty = draft.tree[target].ty;
        let mut build = draft.build_at(id);
        let left = build.copy(target);
        let value = build.binary(op, left, value, ty);
        draft.tree[id].kind = ExprKind::Assign {
            op: None,
            target,
            value,
        };
    }
}

/// Whether an operand is a constant that is not negative.
fn is_natural(tree: &Tree, operand: ExprId) -> bool {
    let natural = |value: &Value| matches!(value, Value::Int(value) if *value >= 0);
    tree.value(operand)
        .is_some_and(|value| value.components().iter().all(natural))
}

fn widen(draft: &mut Draft, operand: ExprId, ty: Type) -> ExprId {
    match (draft.tree[operand].ty, ty) {
        (Type::Scalar(_), Type::Vector(..)) => {
            draft
                .build_at(operand)
                .construct(Constructor::Splat, vec![operand], ty)
        }
        _ => operand,
    }
}
