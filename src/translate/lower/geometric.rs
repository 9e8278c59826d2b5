//! Geometric functions of floats: `dot(1., 2.)`, `normalize(x)`, `reflect(x, n)`. Those of `length` and `distance` naga takes.
//!
//! naga declares them and then cannot tell their type.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprKind, Type};

use super::draft::Draft;
use super::helper::Helper;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| {
        let ExprKind::BuiltIn {
            function,
            ref arguments,
        } = draft.tree[id].kind
        else {
            return;
        };
        let (Some(&first), at) = (arguments.first(), draft.tree[id].at) else {
            return;
        };
        if draft.tree[first].ty != Type::FLOAT {
            return;
        }
        let arguments = arguments.clone();
        let float = (Type::FLOAT, Type::Void);
        let second = arguments.get(1).copied().unwrap_or(first);
        draft.tree[id].kind = match function {
            BuiltIn::Dot => ExprKind::Binary {
                op: BinaryOp::Multiply,
                left: first,
                right: second,
            },
            BuiltIn::Normalize => ExprKind::Call {
                function: draft.helper(Helper::Normalize, float, at),
                arguments,
            },
            BuiltIn::Faceforward => ExprKind::Call {
                function: draft.helper(Helper::Faceforward, float, at),
                arguments,
            },
            BuiltIn::Refract => ExprKind::Call {
                function: draft.helper(Helper::Refract, float, at),
                arguments,
            },
            BuiltIn::Reflect => ExprKind::Call {
                function: draft.helper(Helper::Reflect, float, at),
                arguments,
            },
            _ => return,
        };
    });
}
