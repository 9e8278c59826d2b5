//! Swizzles of swizzles, and swizzles of matrix columns that are assigned to: `v.zyx.x = 1.`, `m[0].xy = v`, `v.zyx[i]++`.
//!
//! naga's pointers name whole vectors and single components; it knows no fields of a matrix column's pointer ("Can't
//! lookup field on this type") and loses the variable below two swizzles. One component is an index, several are
//! worked on in a copy of the vector.

use std::collections::HashSet;

use toyproof_glsl::tree::{ExprId, ExprKind, Swizzle, Tree, Type, Value, walk};

use super::draft::Draft;
use super::lvalue::{self, Fix};

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(join);
    draft.each_expression(index_column);
    let discarded = draft.discarded();
    draft.operands_first(|draft, id| work_on_copy(draft, id, &discarded));
}

/// `v.zyx.xy` is `v.zy`, and `v.zyx[0]` is `v.z`.
fn join(draft: &mut Draft, id: ExprId) {
    loop {
        let (base, picked) = match draft.tree[id].kind {
            ExprKind::Swizzle { vector, components } => (vector, components),
            ExprKind::Index { base, index } => match constant_index(&draft.tree, index) {
                Some(component) => (base, component),
                None => return,
            },
            _ => return,
        };
        let ExprKind::Swizzle { vector, components } = draft.tree[base].kind else {
            return;
        };
        let chosen: Option<Vec<u8>> = picked
            .components()
            .iter()
            .map(|&c| components.components().get(usize::from(c)).copied())
            .collect();
        let Some(components) = chosen.and_then(|chosen| Swizzle::new(&chosen)) else {
            return;
        };
        draft.tree[id].kind = ExprKind::Swizzle { vector, components };
    }
}

/// An index as the component that it names.
fn constant_index(tree: &Tree, index: ExprId) -> Option<Swizzle> {
    let ExprKind::Literal(literal) = &tree[index].kind else {
        return None;
    };
    match literal.value {
        Value::Int(value) => Swizzle::new(&[u8::try_from(value).ok()?]),
        Value::Uint(value) => Swizzle::new(&[u8::try_from(value).ok()?]),
        _ => None,
    }
}

/// `m[i].y` is `m[i][1]`.
fn index_column(draft: &mut Draft, id: ExprId) {
    let ExprKind::Swizzle { vector, components } = draft.tree[id].kind else {
        return;
    };
    if let (true, &[component]) = (is_column(&draft.tree, vector), components.components()) {
        let index = draft.build_at(id).literal(Value::Int(component.into()));
        draft.tree[id].kind = ExprKind::Index { base: vector, index };
    }
}

fn is_column(tree: &Tree, id: ExprId) -> bool {
    matches!(tree[id].kind, ExprKind::Index { base, .. } if matches!(tree[base].ty, Type::Matrix { .. }))
}

/// The vector that must be copied before that part of it is written.
fn awkward(tree: &Tree, target: ExprId) -> Option<ExprId> {
    lvalue::path(tree, target)
        .into_iter()
        .find_map(|node| match tree[node].kind {
            ExprKind::Swizzle { vector, .. } if is_column(tree, vector) => Some(vector),
            ExprKind::Index { base, .. } if matches!(tree[base].kind, ExprKind::Swizzle { .. }) => Some(base),
            _ => None,
        })
}

/// An assignment of no value of its own, mended if it writes part of a vector that must be copied.
pub(super) fn mend(draft: &mut Draft, assignment: ExprId) {
    work_on_copy(draft, assignment, &HashSet::from([assignment]));
}

/// `m[i].xy = v` becomes `c = m[i], c.xy = v, m[i] = c`.
fn work_on_copy(draft: &mut Draft, id: ExprId, discarded: &HashSet<ExprId>) {
    let (target, value) = match draft.tree[id].kind {
        ExprKind::Assign { target, value, .. } => (target, Some(value)),
        ExprKind::Step { target, .. } => (target, None),
        _ => return,
    };
    let Some(part) = awkward(&draft.tree, target) else {
        return;
    };
    let mut steps = Vec::new();
    let acting = value.filter(|&value| walk::acts(&draft.tree, value));
    if acting.is_some() || walk::acts(&draft.tree, target) {
        lvalue::fix_indices(draft, target, Fix::Changing, &mut steps);
    }
    if let Some(value) = acting {
        steps.push(lvalue::set_aside(draft, value, "value"));
    }
    let (ty, at) = (draft.tree[part].ty, draft.tree[id].at);
    let copy = draft.temporary("vector", ty, at);
    let mut build = draft.build(at);
    let (home, read) = (build.detach(part), build.copy(part));
    steps.push(build.set(copy, read));
    build.tree[part].kind = ExprKind::Variable(copy);
    let operation = build.detach(id);
    let (operation, result) = if discarded.contains(&id) {
        (operation, None)
    } else {
        let ty = draft.tree[id].ty;
        let result = draft.temporary("result", ty, at);
        let mut build = draft.build(at);
        (build.set(result, operation), Some(build.variable(result)))
    };
    steps.push(operation);
    let mut build = draft.build(at);
    let value = build.variable(copy);
    let back = build.assign(home, value);
    steps.push(back);
    lvalue::replace(draft, id, steps, result);
    // The copy may itself be of a part that needs one.
    mend(draft, back);
}
