//! `-x` of unsigned integers: `0u - x`, which wraps the same way.
//!
//! naga's validator refuses it.

use toyproof_glsl::tree::{BinaryOp, ExprKind, Scalar, UnaryOp};

use super::draft::Draft;
use super::zero;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| {
        let (ty, at) = (draft.tree[id].ty, draft.tree[id].at);
        if let ExprKind::Unary {
            op: UnaryOp::Minus,
            operand,
        } = draft.tree[id].kind
            && ty.scalar() == Some(Scalar::Uint)
        {
            let left = zero::value(draft, ty, at);
            draft.tree[id].kind = ExprKind::Binary {
                op: BinaryOp::Subtract,
                left,
                right: operand,
            };
        }
    });
}
