//! Choices in branches of choices: `a ? x : b ? y : z` as `p = a, r = p ? x : r, q = !p, …`.

use std::collections::HashSet;

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Place, Scalar, Tree, Type, UnaryOp, VariableId};

use super::super::draft::Draft;
use super::super::lvalue;

/// How deep choices nest in branches of choices and stay as they are.
const KEPT: usize = 16;

pub(super) fn run(draft: &mut Draft) {
    let mut nested = HashSet::new();
    for (_, expr) in draft.tree.exprs.iter() {
        if let ExprKind::Conditional { yes, no, .. } = expr.kind {
            nested.extend([yes, no]);
        }
    }
    draft.each_expression(|draft, id| {
        if !nested.contains(&id)
            && draft.tree[id].ty != Type::Void
            && !draft.tree[id].constant
            && nests_deeper(&draft.tree, id)
        {
            flatten(draft, id);
        }
    });
}

/// Whether a choice has choices in its branches that nest deeper than may be.
fn nests_deeper(tree: &Tree, root: ExprId) -> bool {
    let mut pending = vec![(root, 0)];
    while let Some((id, depth)) = pending.pop() {
        if let ExprKind::Conditional { yes, no, .. } = tree[id].kind {
            if depth == KEPT {
                return true;
            }
            pending.extend([(yes, depth + 1), (no, depth + 1)]);
        }
    }
    false
}

/// Lets a sequence stand for a choice: first to last, what the choice would evaluate.
fn flatten(draft: &mut Draft, root: ExprId) {
    let (ty, at) = (draft.tree[root].ty, draft.tree[root].at);
    let chosen = draft.temporary("chosen", ty, at);
    let first = super::super::zero::value(draft, ty, at);
    let mut steps = vec![draft.build(at).set(chosen, first)];
    // With the flag that tells whether it is evaluated; the first of all is.
    let whole = draft.build(at).detach(root);
    let mut pending = vec![(whole, None)];
    while let Some((id, flag)) = pending.pop() {
        let ExprKind::Conditional { condition, yes, no } = draft.tree[id].kind else {
            let old = draft.build(at).variable(chosen);
            let value = choose(draft, flag, id, old, at);
            steps.push(draft.build(at).set(chosen, value));
            continue;
        };
        let (here, other) = (
            draft.temporary("here", Type::BOOL, at),
            draft.temporary("other", Type::BOOL, at),
        );
        let no_way = draft.build(at).small(Scalar::Bool, false);
        let tested = choose(draft, flag, condition, no_way, at);
        let mut build = draft.build(at);
        steps.push(build.set(here, tested));
        let here_read = build.variable(here);
        let not_here = build.unary(UnaryOp::Not, here_read);
        let otherwise = match flag {
            Some(flag) => {
                let flag = build.variable(flag);
                build.binary(BinaryOp::And, flag, not_here, Type::BOOL)
            }
            None => not_here,
        };
        steps.push(build.set(other, otherwise));
        // Only one of them is evaluated: the order is that of the text.
        pending.extend([(no, Some(other)), (yes, Some(here))]);
    }
    let last = draft.build(at).variable(chosen);
    lvalue::replace(draft, root, steps, Some(last));
}

/// `flag ? value : other`, or the value alone.
fn choose(draft: &mut Draft, flag: Option<VariableId>, value: ExprId, other: ExprId, at: Place) -> ExprId {
    let Some(flag) = flag else {
        return value;
    };
    let ty = draft.tree[value].ty;
    let mut build = draft.build(at);
    let condition = build.variable(flag);
    build.push(
        ExprKind::Conditional {
            condition,
            yes: value,
            no: other,
        },
        ty,
    )
}
