//! `a && f()`, `a || f()`: the right side is evaluated only where it is needed.
//!
//! naga evaluates both sides, so what a call on the right writes is written always
//! (gfx-rs/wgpu #4394). It lowers `?:` to an `if`, which is what these are: `a ? f() : false`.

use toyproof_glsl::tree::{BinaryOp, ExprKind, Value, walk};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| {
        let ExprKind::Binary {
            op: op @ (BinaryOp::And | BinaryOp::Or),
            left,
            right,
        } = draft.tree[id].kind
        else {
            return;
        };
        if !walk::acts(&draft.tree, right) {
            return;
        }
        let settled = draft.build_at(id).literal(Value::Bool(op == BinaryOp::Or));
        let (yes, no) = if op == BinaryOp::And {
            (right, settled)
        } else {
            (settled, right)
        };
        draft.tree[id].kind = ExprKind::Conditional {
            condition: left,
            yes,
            no,
        };
    });
}
