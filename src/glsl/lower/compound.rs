//! `t += f(t *= 2.0)`: what the right side makes of the target is what is added to, and `t[i] += i++` adds to the element that `i` named
//! before.
//!
//! GLSL leaves open when the target is read; naga reads it first, WebGL2's translators and glslang read it last. Its indices all of them
//! evaluate first, but here the right side moves before them, too.

use std::collections::HashSet;

use super::super::tree::{ExprId, ExprKind, Tree, VariableId, VariableKind};
use super::draft::Draft;
use super::lvalue::{self, Fix};
use super::walk;

pub(super) fn run(draft: &mut Draft) {
    draft.operands_first(|draft, id| {
        if let ExprKind::Assign {
            op: Some(_),
            target,
            value,
        } = draft.tree[id].kind
            && may_change(&draft.tree, value, target)
        {
            let mut steps = Vec::new();
            lvalue::fix_indices(draft, target, Fix::Changing, &mut steps);
            steps.push(lvalue::set_aside(draft, value, "value"));
            let operation = draft.build_at(id).detach(id);
            lvalue::replace(draft, id, steps, Some(operation));
        }
    });
}

/// Whether evaluating `value` may change the variable that `target` is part of, or what its indices are made of: it stands in it where
/// something acts, or a function that is called may know it.
fn may_change(tree: &Tree, value: ExprId, target: ExprId) -> bool {
    if !walk::acts(tree, value) {
        return false;
    }
    let read: HashSet<VariableId> = walk::variables(tree, target).collect();
    let has_global = read
        .iter()
        .any(|&variable| tree[variable].kind == VariableKind::Global);
    walk::any(tree, value, |kind| match kind {
        ExprKind::Variable(other) => read.contains(other),
        ExprKind::Call { .. } => has_global,
        _ => false,
    })
}
