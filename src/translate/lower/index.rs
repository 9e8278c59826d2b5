//! `a[i++] += x`, `a[i = 1][i]`, `(b ? u : v)[i]`, `m[0].yx[i]`: each index is evaluated once, from left to
//! right, of a variable.
//!
//! naga evaluates the target of `+=` twice, once to read and once to write it, and evaluates an index before
//! what it indexes. Of `?:` below an index it wants pointers, which it then cannot store ("Local variable has
//! a type that can't be stored"), and of a swizzle below one a field of a pointer ("Can't lookup field on
//! this type").

use std::collections::HashSet;

use toyproof_glsl::tree::{Direction, ExprId, ExprKind, Tree, VariableKind, walk};

use super::draft::Draft;
use super::lvalue::{self, Fix};

/// What is done with a path.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Access {
    Read,
    Written,
    /// Read and then written.
    Updated,
}

pub(super) fn run(draft: &mut Draft) {
    let places = places(&draft.tree);
    draft.operands_first(|draft, id| match draft.tree[id].kind {
        ExprKind::Assign { op: None, target, .. } | ExprKind::Step { target, .. } => {
            fix(draft, id, target, Access::Written);
        }
        ExprKind::Assign { target, .. } => fix(draft, id, target, Access::Updated),
        ExprKind::Index { .. } if !places.contains(&id) => fix(draft, id, id, Access::Read),
        _ => {}
    });
}

/// Lets what is indexed and the indices of a path be evaluated before the operation that reads or writes it, where naga's order
/// can be told from theirs, or naga cannot index it where it stands.
fn fix(draft: &mut Draft, operation: ExprId, path: ExprId, access: Access) {
    let nodes = lvalue::path(&draft.tree, path);
    let Some(&root) = nodes.last() else {
        return;
    };
    let indices = nodes.iter().filter_map(|&node| match draft.tree[node].kind {
        ExprKind::Index { index, .. } => Some(index),
        _ => None,
    });
    let operands = indices.chain([root]);
    let acts = operands.clone().any(|operand| walk::acts(&draft.tree, operand));
    let changing = operands.filter(|&operand| operand != root && !draft.tree[operand].constant);
    // A value that is made where it is indexed, of variables that an index may change.
    let root_is_made = !draft.tree[root].constant && !matches!(draft.tree[root].kind, ExprKind::Variable(_));
    let in_order = acts && (access == Access::Updated || changing.count() + usize::from(root_is_made) >= 2);
    let is_chosen = is_chosen(&draft.tree, root);
    let swizzle = (access == Access::Read)
        .then(|| indexed_swizzle(&draft.tree, &nodes))
        .flatten();
    if !in_order && !is_chosen && swizzle.is_none() {
        return;
    }
    let mut steps = Vec::new();
    if is_chosen || in_order && root_is_made {
        steps.push(lvalue::set_aside(draft, root, "base"));
    }
    if in_order || acts && swizzle.is_some() {
        lvalue::fix_indices(draft, path, Fix::Changing, &mut steps);
    }
    if let Some(swizzle) = swizzle {
        steps.push(lvalue::set_aside(draft, swizzle, "base"));
    }
    let last = draft.build_at(operation).detach(operation);
    lvalue::replace(draft, operation, steps, Some(last));
}

/// Whether a value is one of two, which naga looks for pointers to where it is indexed.
fn is_chosen(tree: &Tree, mut root: ExprId) -> bool {
    while let ExprKind::Sequence { second, .. } = tree[root].kind {
        root = second;
    }
    matches!(tree[root].kind, ExprKind::Conditional { .. })
}

/// The swizzle of a path that is indexed by more than a number, if there is one: numbers were joined with it
/// before.
fn indexed_swizzle(tree: &Tree, nodes: &[ExprId]) -> Option<ExprId> {
    nodes.iter().find_map(|&node| match tree[node].kind {
        ExprKind::Index { base, .. } if matches!(tree[base].kind, ExprKind::Swizzle { .. }) => Some(base),
        _ => None,
    })
}

/// All that is written: targets and `out` arguments, which stay paths to a variable.
fn places(tree: &Tree) -> HashSet<ExprId> {
    let mut written = Vec::new();
    for (_, expr) in tree.exprs.iter() {
        match &expr.kind {
            ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => written.push(*target),
            ExprKind::Call { function, arguments } => {
                let outs = arguments.iter().zip(&tree[*function].parameters);
                written.extend(outs.filter_map(|(&argument, &parameter)| {
                    let is_in = matches!(
                        tree[parameter].kind,
                        VariableKind::Parameter(Direction::In | Direction::ConstIn)
                    );
                    (!is_in).then_some(argument)
                }));
            }
            ExprKind::BuiltIn { function, arguments } => {
                written.extend(function.out_parameter().and_then(|at| arguments.get(at).copied()));
            }
            _ => {}
        }
    }
    let paths = written.into_iter().flat_map(|place| lvalue::path(tree, place));
    paths.collect()
}
