//! Conditionals whose sides have side effects become branches, for languages that evaluate both sides of `?:`,
//! as HLSL does before 2021. Such languages select no structures, arrays or matrices either.

use toyproof_glsl::tree::{ExprId, ExprKind, Type, walk};

use crate::lower::context::LoweringContext;

/// Rewrites `c ? f() : g()` as `(c ? (t = f()) : (t = g()), t)`, whose first part
/// [`Pass::Sequences`](super::Pass::Sequences) turns into an `if`.
pub(crate) fn branch_for_effects(cx: &mut LoweringContext) {
    cx.each_expression_postorder(|cx, id| {
        let ExprKind::Conditional { condition, yes, no } = cx.tree[id].kind else {
            return;
        };
        let has_effect = |side: ExprId| walk::has_side_effects(&cx.tree, side);
        let is_value = matches!(cx.tree[id].ty, Type::Scalar(_) | Type::Vector(..));
        if cx.tree[id].ty == Type::Void || is_value && !has_effect(yes) && !has_effect(no) {
            return;
        }
        let (ty, at) = (cx.tree[id].ty, cx.tree[id].at);
        let value = cx.temporary("value", ty, at);
        let mut build = cx.build(at);
        let yes = build.set(value, yes);
        let no = build.set(value, no);
        let branches = build.push(ExprKind::Conditional { condition, yes, no }, ty);
        let result = build.variable(value);
        cx.tree[id].kind = ExprKind::Sequence {
            first: branches,
            second: result,
        };
    });
}
