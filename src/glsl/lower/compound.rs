//! `t += f(t *= 2.0)`: what the right side makes of the target is what is added to.
//!
//! GLSL leaves open when the target is read; naga reads it first, WebGL2's translators and glslang read it last.

use super::super::tree::{ExprId, ExprKind, Tree, VariableKind};
use super::draft::Draft;
use super::{lvalue, walk};

pub(super) fn run(draft: &mut Draft) {
    draft.operands_first(|draft, id| {
        if let ExprKind::Assign {
            op: Some(_),
            target,
            value,
        } = draft.tree[id].kind
            && may_change(&draft.tree, value, target)
        {
            let step = lvalue::set_aside(draft, value, "value");
            let operation = draft.build_at(id).detach(id);
            lvalue::replace(draft, id, vec![step], Some(operation));
        }
    });
}

/// Whether evaluating `value` may change the variable that `target` is part of: it stands in it where something acts, or
/// a function that is called may know it.
fn may_change(tree: &Tree, value: ExprId, target: ExprId) -> bool {
    let Some(&root) = lvalue::path(tree, target).last() else {
        return false;
    };
    let ExprKind::Variable(variable) = tree[root].kind else {
        return false;
    };
    let is_global = tree[variable].kind == VariableKind::Global;
    walk::acts(tree, value)
        && walk::any(tree, value, |kind| match kind {
            ExprKind::Variable(other) => *other == variable,
            ExprKind::Call { .. } => is_global,
            _ => false,
        })
}
