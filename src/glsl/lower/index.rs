//! `a[i++] += x`, `a[i++][j++]`: each index is evaluated once, from left to right.
//!
//! naga evaluates the target of `+=` twice, once to read and once to write it, and evaluates an index before what it
//! indexes.

use super::super::tree::ExprKind;
use super::draft::Draft;
use super::lvalue::{self, Fix};
use super::walk;

pub(super) fn run(draft: &mut Draft) {
    draft.operands_first(|draft, id| {
        let (target, read_too) = match draft.tree[id].kind {
            ExprKind::Assign { op, target, .. } => (target, op.is_some()),
            ExprKind::Step { target, .. } => (target, false),
            _ => return,
        };
        let acting = lvalue::path(&draft.tree, target)
            .into_iter()
            .filter(|&node| match draft.tree[node].kind {
                ExprKind::Index { index, .. } => walk::acts(&draft.tree, index),
                _ => false,
            })
            .count();
        if acting > usize::from(!read_too) {
            let mut steps = Vec::new();
            lvalue::fix_indices(draft, target, Fix::Acting, &mut steps);
            let operation = draft.build_at(id).detach(id);
            lvalue::replace(draft, id, steps, Some(operation));
        }
    });
    draft.operands_first(|draft, id| {
        if let ExprKind::Index { base, index } = draft.tree[id].kind
            && walk::acts(&draft.tree, index)
            && walk::acts(&draft.tree, base)
        {
            let step = lvalue::set_aside(draft, base, "base");
            let whole = draft.build_at(id).detach(id);
            lvalue::replace(draft, id, vec![step], Some(whole));
        }
    });
}
