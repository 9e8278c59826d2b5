//! Members of structures that are arrays of anything narrower than 16 bytes or of truths, or matrices of two
//! rows, or arrays of such.
//!
//! naga lays every structure out as if it stood in a uniform block: such arrays get a stride of 16 there,
//! which makes them another type than the same array elsewhere, and matrices of two rows are refused
//! (gfx-rs/wgpu #4375). So the matrices become arrays of columns, in an array each as the one member of a
//! structure, and the arrays are copied element by element.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{
    BinaryOp, Block, Constructor, ExprId, ExprKind, FunctionId, Member, Place, Scalar, Statement,
    StatementKind, StepOp, Struct, StructId, Tree, Type, Value, VariableId, walk,
};

use super::draft::Draft;
use super::helper::Helper;
use super::lvalue::{self, Fix};

pub(super) fn run(draft: &mut Draft) {
    let matrices = split_matrices(draft);
    draft.each_expression(name_columns);
    let discarded = draft.discarded();
    draft.each_expression(|draft, id| spell_out(draft, id, discarded.contains(&id)));
    let (elements, targets) = element_accesses(&draft.tree);
    draft.operands_first(|draft, id| match draft.tree[id].kind {
        ExprKind::Member { .. } | ExprKind::Index { .. }
            if !elements.contains(&id) && !targets.contains(&id) =>
        {
            read(draft, id);
        }
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
            Type::Vector(Scalar::Float | Scalar::Int | Scalar::Uint, 3 | 4)
                | Type::Matrix { rows: 3 | 4, .. }
        ),
        Type::Matrix { rows: 2, .. } => true,
        _ => false,
    }
}

/// Whether a structure cannot be made by its constructor.
pub(super) fn has_narrow(tree: &Tree, id: StructId) -> bool {
    tree[id].members.iter().any(|member| is_narrow(tree, member.ty))
}

/// The type of a member, or of an element of one, as it lies in its structure.
fn type_within(tree: &Tree, id: ExprId) -> Option<Type> {
    match tree[id].kind {
        ExprKind::Member { structure, member } => match tree[structure].ty {
            Type::Struct(structure) => Some(tree[structure].members[member].ty),
            _ => None,
        },
        ExprKind::Index { base, .. } => match type_within(tree, base)? {
            Type::Array(array) => Some(tree.array(array).element),
            _ => None,
        },
        _ => None,
    }
}

/// How many elements the narrow array has that an expression names: a member, or an element of one.
fn narrow(tree: &Tree, id: ExprId) -> Option<u32> {
    match type_within(tree, id)? {
        ty @ Type::Array(array) if is_narrow(tree, ty) => Some(tree.array(array).size),
        _ => None,
    }
}

/// Lets matrices of two rows be arrays of columns, and arrays of them arrays of structures that hold those;
/// gives what they were.
fn split_matrices(draft: &mut Draft) -> HashMap<(StructId, usize), Type> {
    let mut matrices = HashMap::new();
    let mut holders = HashMap::new();
    let structs: Vec<_> = draft.tree.structs.ids().collect();
    for id in structs {
        let at = draft.tree[id].at;
        for member in 0..draft.tree[id].members.len() {
            let ty = draft.tree[id].members[member].ty;
            let split = match ty {
                Type::Matrix { columns, rows: 2 } => Some(columns_of(draft, columns)),
                _ => held(draft, &mut holders, ty, at),
            };
            if let Some(split) = split {
                draft.tree[id].members[member].ty = split;
                matrices.insert((id, member), ty);
            }
        }
    }
    matrices
}

/// The columns of a matrix of two rows as an array.
fn columns_of(draft: &mut Draft, columns: u8) -> Type {
    draft
        .tree
        .array_of(Type::vector(Scalar::Float, 2), columns.into())
}

/// An array of structures in place of one of matrices of two rows, one structure for each number of columns;
/// none for other types.
fn held(draft: &mut Draft, holders: &mut HashMap<u8, StructId>, ty: Type, at: Place) -> Option<Type> {
    let Type::Array(array) = ty else {
        return None;
    };
    let array = draft.tree.array(array);
    let element = match array.element {
        Type::Matrix { columns, rows: 2 } => {
            let id = *holders.entry(columns).or_insert_with(|| {
                let member = Member {
                    name: "columns".to_owned(),
                    ty: columns_of(draft, columns),
                    at,
                };
                draft.tree.structs.push(Struct {
                    name: format!("toyproof_mat{columns}x2"),
                    members: vec![member],
                    at,
                })
            });
            Type::Struct(id)
        }
        inner => held(draft, holders, inner, at)?,
    };
    Some(draft.tree.array_of(element, array.size))
}

/// `s.m[i]` is `s.m[i].columns` if it is a matrix that became a structure.
fn name_columns(draft: &mut Draft, id: ExprId) {
    if matches!(draft.tree[id].kind, ExprKind::Index { .. })
        && matches!(draft.tree[id].ty, Type::Matrix { .. })
        && let Some(holder @ Type::Struct(_)) = type_within(&draft.tree, id)
    {
        let structure = draft.build_at(id).detach(id);
        draft.tree[structure].ty = holder;
        draft.tree[id].kind = ExprKind::Member { structure, member: 0 };
    }
}

/// `s.m *= x` is `s.m = s.m * x`, and so is `s.m++`: what stands in indices is evaluated once already.
fn spell_out(draft: &mut Draft, id: ExprId, discarded: bool) {
    let (op, target, value) = match draft.tree[id].kind {
        ExprKind::Assign {
            op: Some(op),
            target,
            value,
        } => (op, target, Some(value)),
        ExprKind::Step { op, target, .. } => {
            let op = match op {
                StepOp::Increment => BinaryOp::Add,
                StepOp::Decrement => BinaryOp::Subtract,
            };
            (op, target, None)
        }
        _ => return,
    };
    if narrow(&draft.tree, target).is_none() {
        return;
    }
    let ty = draft.tree[target].ty;
    let keeps_old = !discarded && matches!(draft.tree[id].kind, ExprKind::Step { postfix: true, .. });
    let mut build = draft.build_at(id);
    let left = build.copy(target);
    let old = keeps_old.then(|| lvalue::set_aside(draft, left, "old"));
    let mut build = draft.build_at(id);
    let value = value.unwrap_or_else(|| build.small(Scalar::Float, true));
    let value = build.binary(op, left, value, ty);
    let assign = ExprKind::Assign {
        op: None,
        target,
        value,
    };
    match old {
        Some(old) => {
            let (set, last) = (build.push(assign, ty), build.copy(left));
            lvalue::replace(draft, id, vec![old, set], Some(last));
        }
        None => draft.tree[id].kind = assign,
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
    let element = build.index(base, index);
    name_columns(draft, element);
    element
}

/// The whole of a narrow array is made of its elements.
fn read(draft: &mut Draft, id: ExprId) {
    if narrow(&draft.tree, id).is_none() {
        return;
    }
    let mut steps = Vec::new();
    // It stands there once for each element.
    let path = lvalue::path(&draft.tree, id);
    if let Some(&root) = path.last()
        && walk::acts(&draft.tree, root)
    {
        steps.push(lvalue::set_aside(draft, root, "structure"));
    }
    lvalue::fix_indices(draft, id, Fix::Acting, &mut steps);
    let whole = whole(draft, id);
    lvalue::replace(draft, id, steps, Some(whole));
}

/// The value of an array or an element, made of its elements if it is narrow.
fn whole(draft: &mut Draft, path: ExprId) -> ExprId {
    let Some(size) = narrow(&draft.tree, path) else {
        return path;
    };
    let (ty, at) = (draft.tree[path].ty, draft.tree[path].at);
    let arguments = (0..size)
        .map(|number| {
            let element = element(draft, path, number, at);
            whole(draft, element)
        })
        .collect();
    let constructor = if matches!(ty, Type::Matrix { .. }) {
        Constructor::Matrix
    } else {
        Constructor::Array
    };
    draft.build(at).construct(constructor, arguments, ty)
}

/// A narrow array is written element by element.
fn write(draft: &mut Draft, id: ExprId, target: ExprId, value: ExprId, discarded: bool) {
    let mut steps = Vec::new();
    let fix = if walk::acts(&draft.tree, value) {
        Fix::Changing
    } else {
        Fix::Acting
    };
    lvalue::fix_indices(draft, target, fix, &mut steps);
    if !matches!(draft.tree[value].kind, ExprKind::Variable(_)) {
        steps.push(lvalue::set_aside(draft, value, "value"));
    }
    copies(draft, target, value, draft.tree[id].at, &mut steps);
    let last = (!discarded).then(|| draft.build_at(id).copy(value));
    lvalue::replace(draft, id, steps, last);
}

/// `target[k] = value[k]` for each k, and so on for narrow elements.
fn copies(draft: &mut Draft, target: ExprId, value: ExprId, at: Place, out: &mut Vec<ExprId>) {
    let Some(size) = narrow(&draft.tree, target) else {
        out.push(draft.build(at).assign(target, value));
        return;
    };
    for number in 0..size {
        let [target, value] = [target, value].map(|path| element(draft, path, number, at));
        copies(draft, target, value, at, out);
    }
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
        copies(draft, target, value, at, &mut sets);
    }
    let statement = |kind| Statement { kind, at };
    let result = draft.build(at).variable(made);
    std::iter::once(StatementKind::Declare(made))
        .chain(sets.into_iter().map(StatementKind::Expression))
        .chain([StatementKind::Return(Some(result))])
        .map(statement)
        .collect()
}
