//! `a[i++] += x`, `a[i = 1][i]`: each index is evaluated once, from left to right.
//!
//! naga evaluates the target of `+=` twice, once to read and once to write it, and evaluates an index before what it
//! indexes.

use std::collections::HashSet;

use super::super::tree::{Direction, ExprId, ExprKind, Tree, VariableKind};
use super::draft::Draft;
use super::lvalue::{self, Fix};
use super::walk;

pub(super) fn run(draft: &mut Draft) {
    let places = places(&draft.tree);
    draft.operands_first(|draft, id| match draft.tree[id].kind {
        ExprKind::Assign { op, target, .. } => fix(draft, id, target, op.is_some()),
        ExprKind::Step { target, .. } => fix(draft, id, target, false),
        ExprKind::Index { .. } if !places.contains(&id) => fix(draft, id, id, false),
        _ => {}
    });
}

/// Lets what is indexed and the indices of a path be evaluated before the operation that reads or writes it, where naga's order
/// can be told from theirs.
fn fix(draft: &mut Draft, operation: ExprId, path: ExprId, twice: bool) {
    let nodes = lvalue::path(&draft.tree, path);
    let Some(&root) = nodes.last() else {
        return;
    };
    let indices = nodes.iter().filter_map(|&node| match draft.tree[node].kind {
        ExprKind::Index { index, .. } => Some(index),
        _ => None,
    });
    let operands = indices.chain([root]);
    let acting = operands
        .clone()
        .filter(|&operand| walk::acts(&draft.tree, operand));
    let changing = operands.filter(|&operand| operand != root && !draft.tree[operand].constant);
    // A value that is made where it is indexed, of variables that an index may change.
    let root_is_made = !draft.tree[root].constant && !matches!(draft.tree[root].kind, ExprKind::Variable(_));
    if acting.count() == 0 || !twice && changing.count() + usize::from(root_is_made) < 2 {
        return;
    }
    let mut steps = Vec::new();
    if root_is_made {
        steps.push(lvalue::set_aside(draft, root, "base"));
    }
    lvalue::fix_indices(draft, path, Fix::Changing, &mut steps);
    let last = draft.build_at(operation).detach(operation);
    lvalue::replace(draft, operation, steps, Some(last));
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
                    let is_in = matches!(tree[parameter].kind, VariableKind::Parameter(Direction::In));
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
