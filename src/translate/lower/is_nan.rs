//! `isnan` and `isinf`, by their bits.
//!
//! naga takes them and has no WGSL for them: WGSL lets compilers assume that neither is ever met.

use toyproof_glsl::tree::{BuiltIn, ExprKind, Type};

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
        let helper = match function {
            BuiltIn::IsNan => Helper::IsNan,
            BuiltIn::IsInf => Helper::IsInf,
            _ => return,
        };
        let arguments = arguments.clone();
        let ty = arguments
            .first()
            .map_or(Type::FLOAT, |&argument| draft.tree[argument].ty);
        let at = draft.tree[id].at;
        let function = draft.helper(helper, (ty, Type::Void), at);
        draft.tree[id].kind = ExprKind::Call { function, arguments };
    });
}
