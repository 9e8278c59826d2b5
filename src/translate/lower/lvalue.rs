//! Lvalues as paths from a variable to a part of it, and working on a part in a copy.

use toyproof_glsl::tree::{ExprId, ExprKind, Tree, walk};

use super::draft::Draft;

/// The nodes of a path from the part that it names down to its variable.
pub(super) fn path(tree: &Tree, lvalue: ExprId) -> Vec<ExprId> {
    std::iter::successors(Some(lvalue), |&node| match tree[node].kind {
        ExprKind::Swizzle { vector: base, .. }
        | ExprKind::Member { structure: base, .. }
        | ExprKind::Index { base, .. } => Some(base),
        _ => None,
    })
    .collect()
}

/// Which indices of a path must not be evaluated again.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Fix {
    /// Those that do something when they are evaluated.
    Acting,
    /// All whose value may be another later.
    Changing,
}

/// Puts indices into temporaries, so that the path may be evaluated twice and names the same place each time. The
/// assignments to the temporaries go to `steps`, in the order of evaluation.
pub(super) fn fix_indices(draft: &mut Draft, lvalue: ExprId, fix: Fix, steps: &mut Vec<ExprId>) {
    for node in path(&draft.tree, lvalue).into_iter().rev() {
        let ExprKind::Index { index, .. } = draft.tree[node].kind else {
            continue;
        };
        let needed = match fix {
            Fix::Acting => walk::acts(&draft.tree, index),
            Fix::Changing => !draft.tree[index].constant,
        };
        if needed {
            steps.push(set_aside(draft, index, "index"));
        }
    }
}

/// Lets a temporary stand for an expression, and gives the assignment that must run before.
pub(super) fn set_aside(draft: &mut Draft, id: ExprId, name: &str) -> ExprId {
    let (ty, at) = (draft.tree[id].ty, draft.tree[id].at);
    let temporary = draft.temporary(name, ty, at);
    let mut build = draft.build(at);
    let value = build.detach(id);
    let step = build.set(temporary, value);
    draft.tree[id].kind = ExprKind::Variable(temporary);
    step
}

/// Lets a sequence stand where an expression stood. `last` is its value, if that is asked for.
pub(super) fn replace(draft: &mut Draft, id: ExprId, mut steps: Vec<ExprId>, last: Option<ExprId>) {
    steps.extend(last);
    let sequence = draft.build_at(id).sequence(steps);
    let node = draft.tree[sequence].clone();
    draft.tree[id] = node;
}
