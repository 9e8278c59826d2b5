//! Chains of thousands of operators: `a + b + c + …`. Part of a long chain is computed before the rest.
//!
//! naga recurses for each operator and ends the process where its stack ends.

use std::collections::HashSet;

use toyproof_glsl::tree::{ExprId, ExprKind, Tree};

use super::draft::Draft;
use super::lvalue;

/// How many operators of a chain naga is given at once.
const LONGEST: usize = 64;

pub(super) fn run(draft: &mut Draft) {
    let mut inner = HashSet::new();
    for (_, expr) in draft.tree.exprs.iter() {
        inner.extend(first(&expr.kind));
    }
    draft.operands_first(|draft, id| {
        if !inner.contains(&id) {
            cut(draft, id);
        }
    });
}

/// The operand that is evaluated before everything else in an expression.
fn first(kind: &ExprKind) -> Option<ExprId> {
    match *kind {
        ExprKind::Unary { operand: first, .. }
        | ExprKind::Binary { left: first, .. }
        | ExprKind::Conditional { condition: first, .. } => Some(first),
        _ => None,
    }
}

/// Sets parts of a chain aside, from the innermost outwards.
fn cut(draft: &mut Draft, root: ExprId) {
    let chain = chain(&draft.tree, root);
    if chain.len() <= LONGEST {
        return;
    }
    let ends = chain.iter().rev().copied().skip(LONGEST).step_by(LONGEST);
    let ends: Vec<ExprId> = ends.filter(|&end| end != root).collect();
    let steps = ends
        .into_iter()
        .map(|end| lvalue::set_aside(draft, end, "part"))
        .collect();
    let rest = draft.build_at(root).detach(root);
    lvalue::replace(draft, root, steps, Some(rest));
}

fn chain(tree: &Tree, root: ExprId) -> Vec<ExprId> {
    std::iter::successors(Some(root), |&id| first(&tree[id].kind)).collect()
}
