//! `!=` of floats: `!(a == b)`, which is true where either is NaN, as GLSL and WebGL2 have it.
//!
//! naga writes SPIR-V's ordered comparison (`OpFOrdNotEqual`), which is false there, so that `x != x` never finds a NaN.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, Scalar, Type, UnaryOp};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| match &draft.tree[id].kind {
        &ExprKind::Binary {
            op: BinaryOp::NotEqual,
            left,
            right,
        } if is_float(draft, left) => {
            let at = draft.tree[id].at;
            let operand = draft.build(at).binary(BinaryOp::Equal, left, right, Type::BOOL);
            draft.tree[id].kind = ExprKind::Unary {
                op: UnaryOp::Not,
                operand,
            };
        }
        ExprKind::BuiltIn {
            function: BuiltIn::NotEqual,
            arguments,
        } if arguments.iter().any(|&argument| is_float(draft, argument)) => {
            let (ty, at, arguments) = (draft.tree[id].ty, draft.tree[id].at, arguments.clone());
            let equal = ExprKind::BuiltIn {
                function: BuiltIn::Equal,
                arguments,
            };
            let equal = draft.build(at).push(equal, ty);
            draft.tree[id].kind = ExprKind::BuiltIn {
                function: BuiltIn::Not,
                arguments: vec![equal],
            };
        }
        _ => {}
    });
}

fn is_float(draft: &Draft, id: ExprId) -> bool {
    draft.tree[id].ty.scalar() == Some(Scalar::Float)
}
