//! Built-in functions that naga's GLSL front end lacks, or that some of its targets do: `modf`, `matrixCompMult`,
//! `outerProduct`, `inverse`.
//!
//! `modf` (gfx-rs/naga #2526) and `matrixCompMult` are unknown to it; naga has no WGSL for `outerProduct`, and no HLSL or
//! Metal for it and for `inverse`.

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
            BuiltIn::Modf => Helper::Modf,
            BuiltIn::MatrixCompMult => Helper::MatrixCompMult,
            BuiltIn::OuterProduct => Helper::OuterProduct,
            BuiltIn::Inverse => Helper::Inverse,
            _ => return,
        };
        let arguments = arguments.clone();
        let ty = |at: usize| {
            arguments
                .get(at)
                .map_or(Type::Void, |&argument| draft.tree[argument].ty)
        };
        let types = (ty(0), ty(1));
        let at = draft.tree[id].at;
        let function = draft.helper(helper, types, at);
        draft.tree[id].kind = ExprKind::Call { function, arguments };
    });
}
