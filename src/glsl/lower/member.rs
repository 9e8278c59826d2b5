//! Members of structures that are arrays of anything narrower than 16 bytes, or matrices of two rows.
//!
//! naga lays every structure out as if it stood in a uniform block: such arrays get a stride of 16 there, which makes
//! them another type than the same array elsewhere, and matrices of two rows are refused (gfx-rs/wgpu #4375). So the
//! matrices become arrays of columns, and the arrays are copied element by element.

use std::collections::{HashMap, HashSet};

use super::super::tree::{
    Block, Constructor, ExprId, ExprKind, FunctionId, Place, Statement, StatementKind, StructId, Tree, Type,
    Value, VariableId,
};
use super::draft::Draft;
use super::helper::Helper;
use super::lvalue::{self, Fix};
use super::walk;

pub(super) fn run(draft: &mut Draft) {
    let matrices = split_matrices(draft);
    draft.each_expression(spell_out);
    let discarded = draft.discarded();
    let (elements, targets) = element_accesses(&draft.tree);
    draft.operands_first(|draft, id| match draft.tree[id].kind {
        ExprKind::Member { .. } if !elements.contains(&id) && !targets.contains(&id) => read(draft, id),
        ExprKind::Assign {
            op: None,
            target,
            value,
        } if narrow(&draft.tree, target).is_some() => {
            write(draft, id, target, value, discarded.contains(&id));
        }
        ExprKind::Construct {
            constructor: Constructor::Struct,
            ..
        } => make(draft, id, &matrices),
        _ => {}
    });
}

/// Whether a member of that type is of another type within its structure.
fn is_narrow(tree: &Tree, ty: Type) -> bool {
    match ty {
        Type::Array(id) => !matches!(
            tree.array(id).element,
            Type::Vector(_, 3 | 4) | Type::Matrix { rows: 3 | 4, .. }
        ),
        Type::Matrix { rows: 2, .. } => true,
        _ => false,
    }
}

/// Whether a structure cannot be made by its constructor.
pub(super) fn has_narrow(tree: &Tree, id: StructId) -> bool {
    tree[id].members.iter().any(|member| is_narrow(tree, member.ty))
}

/// How many elements the narrow member has that an expression names.
fn narrow(tree: &Tree, id: ExprId) -> Option<u32> {
    let ExprKind::Member { structure, member } = tree[id].kind else {
        return None;
    };
    let Type::Struct(structure) = tree[structure].ty else {
        return None;
    };
    match tree[structure].members[member].ty {
        ty @ Type::Array(array) if is_narrow(tree, ty) => Some(tree.array(array).size),
        _ => None,
    }
}

/// Lets matrices of two rows be arrays of columns; gives what they were.
fn split_matrices(draft: &mut Draft) -> HashMap<(StructId, usize), Type> {
    let mut matrices = HashMap::new();
    let structs: Vec<_> = draft.tree.structs.ids().collect();
    for id in structs {
        for member in 0..draft.tree[id].members.len() {
            let ty = draft.tree[id].members[member].ty;
            if let Type::Matrix { columns, rows: 2 } = ty {
                let column = Type::vector(super::super::tree::Scalar::Float, 2);
                draft.tree[id].members[member].ty = draft.tree.array_of(column, columns.into());
                matrices.insert((id, member), ty);
            }
        }
    }
    matrices
}

/// `s.m *= x` is `s.m = s.m * x`: what stands in indices is evaluated once already.
fn spell_out(draft: &mut Draft, id: ExprId) {
    if let ExprKind::Assign {
        op: Some(op),
        target,
        value,
    } = draft.tree[id].kind
        && narrow(&draft.tree, target).is_some()
    {
        let ty = draft.tree[target].ty;
        let mut build = draft.build_at(id);
        let left = build.copy(target);
        let value = build.binary(op, left, value, ty);
        draft.tree[id].kind = ExprKind::Assign {
            op: None,
            target,
            value,
        };
    }
}

/// The expressions that only an element is asked of, and those that are written whole.
fn element_accesses(tree: &Tree) -> (HashSet<ExprId>, HashSet<ExprId>) {
    let (mut elements, mut targets) = (HashSet::new(), HashSet::new());
    for (_, expr) in tree.exprs.iter() {
        match expr.kind {
            ExprKind::Index { base, .. } | ExprKind::Length { array: base } => {
                elements.insert(base);
            }
            ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => {
                targets.insert(target);
            }
            _ => {}
        }
    }
    (elements, targets)
}

/// `path[number]`
fn element(draft: &mut Draft, path: ExprId, number: u32, at: Place) -> ExprId {
    let mut build = draft.build(at);
    let base = build.copy(path);
    let index = build.literal(Value::Int(number.cast_signed()));
    build.index(base, index)
}

/// The whole of a narrow member is made of its elements.
fn read(draft: &mut Draft, id: ExprId) {
    let Some(size) = narrow(&draft.tree, id) else {
        return;
    };
    let (ty, at) = (draft.tree[id].ty, draft.tree[id].at);
    let mut steps = Vec::new();
    if let ExprKind::Member { structure, .. } = draft.tree[id].kind
        && walk::acts(&draft.tree, structure)
    {
        steps.push(lvalue::set_aside(draft, structure, "structure"));
    }
    let arguments = (0..size).map(|number| element(draft, id, number, at)).collect();
    let constructor = if matches!(ty, Type::Matrix { .. }) {
        Constructor::Matrix
    } else {
        Constructor::Array
    };
    let whole = draft.build(at).construct(constructor, arguments, ty);
    lvalue::replace(draft, id, steps, Some(whole));
}

/// A narrow member is written element by element.
fn write(draft: &mut Draft, id: ExprId, target: ExprId, value: ExprId, discarded: bool) {
    let Some(size) = narrow(&draft.tree, target) else {
        return;
    };
    let mut steps = Vec::new();
    lvalue::fix_indices(draft, target, Fix::Acting, &mut steps);
    if !matches!(draft.tree[value].kind, ExprKind::Variable(_)) {
        steps.push(lvalue::set_aside(draft, value, "value"));
    }
    steps.extend(copies(draft, target, value, size, draft.tree[id].at));
    let last = (!discarded).then(|| draft.build_at(id).copy(value));
    lvalue::replace(draft, id, steps, last);
}

/// `target[k] = value[k]` for each k.
fn copies(draft: &mut Draft, target: ExprId, value: ExprId, size: u32, at: Place) -> Vec<ExprId> {
    (0..size)
        .map(|number| {
            let [target, value] = [target, value].map(|path| element(draft, path, number, at));
            draft.build(at).assign(target, value)
        })
        .collect()
}

/// A function stands for the constructor.
fn make(draft: &mut Draft, id: ExprId, matrices: &HashMap<(StructId, usize), Type>) {
    let (ty, at) = (draft.tree[id].ty, draft.tree[id].at);
    let (Type::Struct(structure), ExprKind::Construct { arguments, .. }) = (ty, draft.tree[id].kind.clone())
    else {
        return;
    };
    if !has_narrow(&draft.tree, structure) {
        return;
    }
    let function = draft.helper(Helper::Make, (ty, Type::Void), at);
    // The matrices are passed as such.
    for (member, parameter) in draft.tree[function].parameters.clone().into_iter().enumerate() {
        if let Some(&matrix) = matrices.get(&(structure, member)) {
            draft.tree[parameter].ty = matrix;
        }
    }
    if draft.tree[function].body.is_none() {
        let body = body(draft, function, structure, at);
        draft.tree[function].body = Some(body);
    }
    draft.tree[id].kind = ExprKind::Call { function, arguments };
}

/// `S s; s.a = a; s.b[0] = b[0]; … return s;`
fn body(draft: &mut Draft, function: FunctionId, structure: StructId, at: Place) -> Block {
    let made = draft.local("made", Type::Struct(structure), at);
    let mut sets = Vec::new();
    let parameters: Vec<VariableId> = draft.tree[function].parameters.clone();
    for (member, parameter) in parameters.into_iter().enumerate() {
        let mut build = draft.build(at);
        let whole = build.variable(made);
        let value = build.variable(parameter);
        let ty = build.tree[parameter].ty;
        let target = build.push(
            ExprKind::Member {
                structure: whole,
                member,
            },
            ty,
        );
        match narrow(&draft.tree, target) {
            Some(size) => sets.extend(copies(draft, target, value, size, at)),
            None => sets.push(draft.build(at).assign(target, value)),
        }
    }
    let statement = |kind| Statement { kind, at };
    let result = draft.build(at).variable(made);
    std::iter::once(StatementKind::Declare(made))
        .chain(sets.into_iter().map(StatementKind::Expression))
        .chain([StatementKind::Return(Some(result))])
        .map(statement)
        .collect()
}
