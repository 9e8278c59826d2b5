//! Lvalues: paths from a variable to a part of it, and the order in which their indices are evaluated.
//!
//! The passes here rewrite accesses whose parts naga evaluates twice, in another order, or through pointers
//! that it cannot form: indices, swizzles, compound assignments and `out` arguments.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{
    Direction, ExprId, ExprKind, FunctionId, Swizzle, Tree, Type, Value, VariableId, VariableKind, walk,
};

use super::call_order::callees_first;
use crate::lower::context::LoweringContext;

/// The nodes of a path, from the part that it denotes down to the variable.
pub(super) fn path_nodes(tree: &Tree, lvalue: ExprId) -> Vec<ExprId> {
    tree.path(lvalue).collect()
}

/// The indices of a path that must be evaluated only once.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Hoist {
    /// The indices with side effects.
    Effectful,
    /// All indices that are not constant.
    NonConstant,
}

/// Moves indices into temporaries, so that the path denotes the same place each time that it is evaluated.
/// Appends the assignments to `steps`, in order of evaluation.
pub(super) fn hoist_indices(cx: &mut LoweringContext, lvalue: ExprId, hoist: Hoist, steps: &mut Vec<ExprId>) {
    for node in path_nodes(&cx.tree, lvalue).into_iter().rev() {
        let ExprKind::Index { index, .. } = cx.tree[node].kind else {
            continue;
        };
        let needed = match hoist {
            Hoist::Effectful => walk::has_side_effects(&cx.tree, index),
            Hoist::NonConstant => !cx.tree[index].constant,
        };
        if needed {
            steps.push(move_to_temporary(cx, index, "index"));
        }
    }
}

/// Replaces an expression by a temporary. Returns the assignment that must run before.
pub(super) fn move_to_temporary(cx: &mut LoweringContext, id: ExprId, name: &str) -> ExprId {
    let (ty, at) = (cx.tree[id].ty, cx.tree[id].at);
    let temporary = cx.temporary(name, ty, at);
    let mut build = cx.build(at);
    let value = build.detach(id);
    let step = build.set(temporary, value);
    cx.tree[id].kind = ExprKind::Variable(temporary);
    step
}

/// Replaces an expression by a sequence; `last` is its value, if that is used.
pub(super) fn replace_with_sequence(
    cx: &mut LoweringContext,
    id: ExprId,
    mut steps: Vec<ExprId>,
    last: Option<ExprId>,
) {
    steps.extend(last);
    let sequence = cx.build_at(id).sequence(steps);
    let node = cx.tree[sequence].clone();
    cx.tree[id] = node;
}

/// The kind of access to a path.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Access {
    Read,
    Write,
    /// Read, then written.
    ReadWrite,
}

/// Evaluates each index once, from left to right, of a variable: `a[i++] += x`, `a[i = 1][i]`, `(b ? u :
/// v)[i]`, `m[0].yx[i]`.
///
/// naga evaluates the target of `+=` twice, to read and to write it, and evaluates an index before its base.
/// Of `?:` below an index it forms pointers, which it then cannot store ("Local variable has a type that
/// can't be stored"); of a swizzle below an index it looks up a field of a pointer ("Can't lookup field on
/// this type").
pub(super) fn lower_indices(cx: &mut LoweringContext) {
    let written_places = written_places(&cx.tree);
    cx.each_expression_postorder(|cx, id| match cx.tree[id].kind {
        ExprKind::Assign { op: None, target, .. } | ExprKind::Step { target, .. } => {
            order_access(cx, id, target, Access::Write);
        }
        ExprKind::Assign { target, .. } => order_access(cx, id, target, Access::ReadWrite),
        ExprKind::Index { .. } if !written_places.contains(&id) => order_access(cx, id, id, Access::Read),
        _ => {}
    });
}

/// Evaluates the base and the indices of a path before the operation, where naga's order would be observable
/// or naga cannot index the base in place.
fn order_access(cx: &mut LoweringContext, operation: ExprId, path: ExprId, access: Access) {
    let nodes = path_nodes(&cx.tree, path);
    let Some(&root) = nodes.last() else {
        return;
    };
    let indices = nodes.iter().filter_map(|&node| match cx.tree[node].kind {
        ExprKind::Index { index, .. } => Some(index),
        _ => None,
    });
    let operands = indices.chain([root]);
    let acts = operands
        .clone()
        .any(|operand| walk::has_side_effects(&cx.tree, operand));
    let changing = operands.filter(|&operand| operand != root && !cx.tree[operand].constant);
    // The base is computed in place from variables that an index may change.
    let root_is_computed = !cx.tree[root].constant && !matches!(cx.tree[root].kind, ExprKind::Variable(_));
    let in_order =
        acts && (access == Access::ReadWrite || changing.count() + usize::from(root_is_computed) >= 2);
    let is_conditional = is_conditional(&cx.tree, root);
    let swizzle = (access == Access::Read)
        .then(|| indexed_swizzle(&cx.tree, &nodes))
        .flatten();
    if !in_order && !is_conditional && swizzle.is_none() {
        return;
    }
    let mut steps = Vec::new();
    if is_conditional || in_order && root_is_computed {
        steps.push(move_to_temporary(cx, root, "base"));
    }
    if in_order || acts && swizzle.is_some() {
        hoist_indices(cx, path, Hoist::NonConstant, &mut steps);
    }
    if let Some(swizzle) = swizzle {
        steps.push(move_to_temporary(cx, swizzle, "base"));
    }
    let last = cx.build_at(operation).detach(operation);
    replace_with_sequence(cx, operation, steps, Some(last));
}

/// Whether a value is a conditional; naga looks for pointers in its branches when it is indexed.
fn is_conditional(tree: &Tree, mut root: ExprId) -> bool {
    while let ExprKind::Sequence { second, .. } = tree[root].kind {
        root = second;
    }
    matches!(tree[root].kind, ExprKind::Conditional { .. })
}

/// The swizzle in a path that has a dynamic index, if any; constant indices are folded into swizzles before.
fn indexed_swizzle(tree: &Tree, nodes: &[ExprId]) -> Option<ExprId> {
    nodes.iter().find_map(|&node| match tree[node].kind {
        ExprKind::Index { base, .. } if matches!(tree[base].kind, ExprKind::Swizzle { .. }) => Some(base),
        _ => None,
    })
}

/// All places that are written, namely targets and `out` arguments; they stay paths to a variable.
fn written_places(tree: &Tree) -> HashSet<ExprId> {
    let mut written = HashSet::new();
    for id in tree.exprs.ids() {
        tree.each_write(id, |place, _| written.extend(tree.path(place)));
    }
    written
}

/// Simplifies swizzles of swizzles, and copies vectors whose swizzles are assigned to: `v.zyx.x = 1.`,
/// `m[0].xy = v`, `v.zyx[i]++`.
///
/// naga's pointers denote whole vectors and single components. It cannot look up fields of a pointer to a
/// matrix column ("Can't lookup field on this type") and loses the variable below two swizzles. A single
/// component becomes an index; several are written in a copy of the vector.
pub(super) fn lower_swizzles(cx: &mut LoweringContext) {
    cx.each_expression(fold_swizzles);
    cx.each_expression(index_column);
    let discarded = cx.discarded_values();
    cx.each_expression_postorder(|cx, id| write_through_copy(cx, id, &discarded));
}

/// `v.zyx.xy` is `v.zy`, and `v.zyx[0]` is `v.z`.
fn fold_swizzles(cx: &mut LoweringContext, id: ExprId) {
    loop {
        let (base, picked) = match cx.tree[id].kind {
            ExprKind::Swizzle { vector, components } => (vector, components),
            ExprKind::Index { base, index } => match constant_index(&cx.tree, index) {
                Some(component) => (base, component),
                None => return,
            },
            _ => return,
        };
        let ExprKind::Swizzle { vector, components } = cx.tree[base].kind else {
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
        cx.tree[id].kind = ExprKind::Swizzle { vector, components };
    }
}

/// The component that a constant index selects.
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
fn index_column(cx: &mut LoweringContext, id: ExprId) {
    let ExprKind::Swizzle { vector, components } = cx.tree[id].kind else {
        return;
    };
    if let (true, &[component]) = (is_column(&cx.tree, vector), components.components()) {
        let index = cx.build_at(id).literal(Value::Int(component.into()));
        cx.tree[id].kind = ExprKind::Index { base: vector, index };
    }
}

fn is_column(tree: &Tree, id: ExprId) -> bool {
    matches!(tree[id].kind, ExprKind::Index { base, .. } if matches!(tree[base].ty, Type::Matrix { .. }))
}

/// The vector that must be copied before a part of it is written.
fn vector_to_copy(tree: &Tree, target: ExprId) -> Option<ExprId> {
    path_nodes(tree, target)
        .into_iter()
        .find_map(|node| match tree[node].kind {
            ExprKind::Swizzle { vector, .. } if is_column(tree, vector) => Some(vector),
            ExprKind::Index { base, .. } if matches!(tree[base].kind, ExprKind::Swizzle { .. }) => Some(base),
            _ => None,
        })
}

/// Rewrites an assignment whose value is not used, if it writes part of a vector that must be copied.
fn rewrite_unused_assignment(cx: &mut LoweringContext, assignment: ExprId) {
    write_through_copy(cx, assignment, &HashSet::from([assignment]));
}

/// `m[i].xy = v` becomes `c = m[i], c.xy = v, m[i] = c`.
fn write_through_copy(cx: &mut LoweringContext, id: ExprId, discarded: &HashSet<ExprId>) {
    let (target, value) = match cx.tree[id].kind {
        ExprKind::Assign { target, value, .. } => (target, Some(value)),
        ExprKind::Step { target, .. } => (target, None),
        _ => return,
    };
    let Some(part) = vector_to_copy(&cx.tree, target) else {
        return;
    };
    let mut steps = Vec::new();
    let acting = value.filter(|&value| walk::has_side_effects(&cx.tree, value));
    if acting.is_some() || walk::has_side_effects(&cx.tree, target) {
        hoist_indices(cx, target, Hoist::NonConstant, &mut steps);
    }
    if let Some(value) = acting {
        steps.push(move_to_temporary(cx, value, "value"));
    }
    let (ty, at) = (cx.tree[part].ty, cx.tree[id].at);
    let copy = cx.temporary("vector", ty, at);
    let mut build = cx.build(at);
    let (place, read) = (build.detach(part), build.copy(part));
    steps.push(build.set(copy, read));
    build.tree[part].kind = ExprKind::Variable(copy);
    let operation = build.detach(id);
    let (operation, result) = if discarded.contains(&id) {
        (operation, None)
    } else {
        let ty = cx.tree[id].ty;
        let result = cx.temporary("result", ty, at);
        let mut build = cx.build(at);
        (build.set(result, operation), Some(build.variable(result)))
    };
    steps.push(operation);
    let mut build = cx.build(at);
    let value = build.variable(copy);
    let back = build.assign(place, value);
    steps.push(back);
    replace_with_sequence(cx, id, steps, result);
    // The copied part may itself require a copy.
    rewrite_unused_assignment(cx, back);
}

/// Evaluates the right side of a compound assignment first if it may change the target: `t += f(t *= 2.0)`
/// adds to the changed `t`, and `t[i] += i++` adds to the element that `i` selected before.
///
/// GLSL does not specify when the target is read: naga reads it first, WebGL 2's translators and glslang
/// last. All of them evaluate its indices first; since the right side moves before them here, they move as
/// well.
pub(super) fn lower_compound_assignments(cx: &mut LoweringContext) {
    cx.each_expression_postorder(|cx, id| {
        if let ExprKind::Assign {
            op: Some(_),
            target,
            value,
        } = cx.tree[id].kind
            && walk::may_change(&cx.tree, value, target)
        {
            let mut steps = Vec::new();
            hoist_indices(cx, target, Hoist::NonConstant, &mut steps);
            steps.push(move_to_temporary(cx, value, "value"));
            let operation = cx.build_at(id).detach(id);
            replace_with_sequence(cx, id, steps, Some(operation));
        }
    });
}

/// Passes copies for `out` and `inout` arguments that are components, swizzles, elements or members:
/// `m(p.x)`, `m(a[i])`, `m(s.a)`.
///
/// naga passes a pointer to a component, on which its SPIR-V writer panics. GLSL copies in and out (§6.1.1),
/// and so does this pass: indices are evaluated once, in the order of the arguments, and values are copied in
/// after all arguments are evaluated, as in glslang. Arguments that are parts of the same variable are also
/// copied, since WGSL forbids aliasing pointers. Variables and their parts passed to `in` parameters are read
/// last as well, those passed to `const in` parameters in order: `f(i, i++)`.
///
/// Where parameters are references, only arguments that cannot be bound to one are copied, and global
/// variables that the function itself names.
pub(super) fn lower_out_arguments(cx: &mut LoweringContext) {
    let discarded = cx.discarded_values();
    let globals = if cx.has_references {
        globals_of_functions(&cx.tree)
    } else {
        HashMap::new()
    };
    cx.each_expression_postorder(|cx, id| {
        if let ExprKind::Call { function, arguments } = &cx.tree[id].kind {
            let directions = cx.tree[*function]
                .parameters
                .iter()
                .map(|&parameter| walk::direction(&cx.tree, parameter));
            let arguments: Vec<_> = arguments.iter().copied().zip(directions).collect();
            copy_in_out(cx, id, &arguments, discarded.contains(&id), globals.get(function));
        }
    });
}

fn is_out(direction: Direction) -> bool {
    matches!(direction, Direction::Out | Direction::InOut)
}

/// The variables outside functions that each function names, or a function that it calls.
fn globals_of_functions(tree: &Tree) -> HashMap<FunctionId, HashSet<VariableId>> {
    let mut globals: HashMap<FunctionId, HashSet<VariableId>> = HashMap::new();
    for (function, callees) in callees_first(tree) {
        let body = tree[function].body.as_ref().map(|body| walk::roots(tree, body));
        let nodes = body.into_iter().flatten().flat_map(|root| tree.postorder(root));
        let own = nodes.filter_map(|id| match tree[id].kind {
            ExprKind::Variable(variable) if tree[variable].kind == VariableKind::Global => Some(variable),
            _ => None,
        });
        let of_callees = callees.iter().filter_map(|callee| globals.get(callee)).flatten();
        let named: HashSet<VariableId> = own.chain(of_callees.copied()).collect();
        globals.insert(function, named);
    }
    globals
}

/// Whether a reference can be bound to a place: a variable, a member, an element, or a column of a matrix.
fn binds_reference(tree: &Tree, place: ExprId) -> bool {
    tree.path(place).all(|node| match tree[node].kind {
        ExprKind::Variable(_) | ExprKind::Member { .. } => true,
        ExprKind::Index { base, .. } => matches!(tree[base].ty, Type::Array(_) | Type::Matrix { .. }),
        _ => false,
    })
}

/// Lets a call work on copies where naga cannot form pointers to the arguments, or nothing can be bound to
/// a reference. `globals` are the variables that the function itself names.
fn copy_in_out(
    cx: &mut LoweringContext,
    call: ExprId,
    arguments: &[(ExprId, Direction)],
    discarded: bool,
    globals: Option<&HashSet<VariableId>>,
) {
    let mut written = HashSet::new();
    let needs_copy: Vec<bool> = arguments
        .iter()
        .map(|&(argument, direction)| {
            let is_in_place = if cx.has_references {
                binds_reference(&cx.tree, argument)
            } else {
                matches!(cx.tree[argument].kind, ExprKind::Variable(_))
            };
            let root = cx.tree.root_variable(argument);
            let is_named = root.is_some_and(|root| globals.is_some_and(|names| names.contains(&root)));
            is_out(direction) && (!root.is_none_or(|root| written.insert(root)) || !is_in_place || is_named)
        })
        .collect();
    let read_last: Vec<bool> = arguments
        .iter()
        .map(|&(argument, direction)| direction == Direction::In && cx.tree.root_variable(argument).is_some())
        .collect();
    let changed = (0..arguments.len()).any(|at| {
        let mut later = arguments[at + 1..].iter();
        read_last[at] && later.any(|&(later, _)| walk::may_change(&cx.tree, later, arguments[at].0))
    });
    if !changed && !needs_copy.contains(&true) {
        return;
    }
    // Once one value is in a temporary, all must be: whatever stays in the call is evaluated last.
    let acting = arguments
        .iter()
        .any(|&(argument, _)| walk::has_side_effects(&cx.tree, argument));
    let (mut before, mut copied, mut after) = (Vec::new(), Vec::new(), Vec::new());
    for ((&(argument, direction), needs_copy), read_last) in arguments.iter().zip(needs_copy).zip(read_last) {
        if acting && read_last {
            hoist_indices(cx, argument, Hoist::NonConstant, &mut before);
        } else if needs_copy {
            hoist_indices(cx, argument, Hoist::NonConstant, &mut before);
            let at = cx.tree[argument].at;
            let ty = cx.tree[argument].ty;
            let copy = cx.temporary("argument", ty, at);
            let mut build = cx.build(at);
            if direction == Direction::InOut {
                let read = build.copy(argument);
                copied.push(build.set(copy, read));
            }
            let place = build.detach(argument);
            let value = build.variable(copy);
            let back = build.assign(place, value);
            rewrite_unused_assignment(cx, back);
            after.push(back);
            cx.tree[argument].kind = ExprKind::Variable(copy);
        } else if acting && !is_out(direction) && !cx.tree[argument].constant {
            before.push(move_to_temporary(cx, argument, "argument"));
        }
    }
    before.extend(copied);
    let at = cx.tree[call].at;
    let ty = cx.tree[call].ty;
    let mut steps = before;
    let operation = cx.build(at).detach(call);
    if discarded || ty == Type::Void {
        steps.push(operation);
        steps.extend(after);
        replace_with_sequence(cx, call, steps, None);
    } else {
        let result = cx.temporary("result", ty, at);
        let mut build = cx.build(at);
        steps.push(build.set(result, operation));
        let result = build.variable(result);
        steps.extend(after);
        replace_with_sequence(cx, call, steps, Some(result));
    }
}
