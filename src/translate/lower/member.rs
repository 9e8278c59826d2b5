//! Narrow members of structures: arrays with elements narrower than 16 bytes or of booleans, two-row
//! matrices, and arrays of such.
//!
//! naga lays out every structure as if it were in a uniform block. There such arrays get a stride of 16
//! bytes, which makes their type differ from that of the same array elsewhere, and two-row matrices are
//! refused (gfx-rs/wgpu #4375). So these matrices become arrays of columns (an array of matrices becomes an
//! array of structures with one such member), and narrow arrays are copied element by element.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{
    BinaryOp, Block, Constructor, ExprId, ExprKind, FunctionId, Member, Place, Scalar, Statement,
    StatementKind, StepOp, Struct, StructId, Tree, Type, Value, VariableId, walk,
};

use crate::lower::context::LoweringContext;
use crate::lower::generated::Helper;
use crate::lower::lvalue::{self, Hoist};

pub(super) fn run(cx: &mut LoweringContext) {
    let matrices = split_matrices(cx);
    cx.each_expression(access_columns);
    let discarded = cx.discarded_values();
    cx.each_expression(|cx, id| expand_compound(cx, id, discarded.contains(&id)));
    let (elements, targets) = element_accesses(&cx.tree);
    cx.each_expression_postorder(|cx, id| match cx.tree[id].kind {
        ExprKind::Member { .. } | ExprKind::Index { .. }
            if !elements.contains(&id) && !targets.contains(&id) =>
        {
            read(cx, id);
        }
        ExprKind::Assign {
            op: None,
            target,
            value,
        } if narrow(&cx.tree, target).is_some() => {
            write(cx, id, target, value, discarded.contains(&id));
        }
        ExprKind::Construct {
            constructor: Constructor::Struct,
            ..
        } => replace_constructor(cx, id, &matrices),
        _ => {}
    });
}

/// Whether a member of this type has a different type within its structure.
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

/// Whether a structure has narrow members and cannot be built by its constructor.
pub(super) fn has_narrow(tree: &Tree, id: StructId) -> bool {
    tree[id].members.iter().any(|member| is_narrow(tree, member.ty))
}

/// The type that a member, or an element of one, has within its structure.
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

/// The number of elements of the narrow array that an expression denotes: a member, or an element of one.
fn narrow(tree: &Tree, id: ExprId) -> Option<u32> {
    match type_within(tree, id)? {
        ty @ Type::Array(array) if is_narrow(tree, ty) => Some(tree.array(array).size),
        _ => None,
    }
}

/// Turns two-row matrices into arrays of columns, and arrays of such matrices into arrays of structures that
/// hold them. Returns the original types.
fn split_matrices(cx: &mut LoweringContext) -> HashMap<(StructId, usize), Type> {
    let mut matrices = HashMap::new();
    let mut holders = HashMap::new();
    let structs: Vec<_> = cx.tree.structs.ids().collect();
    for id in structs {
        let at = cx.tree[id].at;
        for member in 0..cx.tree[id].members.len() {
            let ty = cx.tree[id].members[member].ty;
            let split = match ty {
                Type::Matrix { columns, rows: 2 } => Some(columns_of(cx, columns)),
                _ => holder_array(cx, &mut holders, ty, at),
            };
            if let Some(split) = split {
                cx.tree[id].members[member].ty = split;
                matrices.insert((id, member), ty);
            }
        }
    }
    matrices
}

/// The array type that holds the columns of a two-row matrix.
fn columns_of(cx: &mut LoweringContext, columns: u8) -> Type {
    cx.tree.array_of(Type::vector(Scalar::Float, 2), columns.into())
}

/// The array of structures that replaces an array of two-row matrices, one structure type for each number of
/// columns; `None` for other types.
fn holder_array(
    cx: &mut LoweringContext,
    holders: &mut HashMap<u8, StructId>,
    ty: Type,
    at: Place,
) -> Option<Type> {
    let Type::Array(array) = ty else {
        return None;
    };
    let array = cx.tree.array(array);
    let element = match array.element {
        Type::Matrix { columns, rows: 2 } => {
            let id = *holders.entry(columns).or_insert_with(|| {
                let member = Member {
                    name: "columns".to_owned(),
                    ty: columns_of(cx, columns),
                    at,
                };
                cx.tree.structs.push(Struct {
                    name: format!("toyproof_mat{columns}x2"),
                    members: vec![member],
                    at,
                })
            });
            Type::Struct(id)
        }
        inner => holder_array(cx, holders, inner, at)?,
    };
    Some(cx.tree.array_of(element, array.size))
}

/// Rewrites `s.m[i]` as `s.m[i].columns` if it is a matrix that became a structure.
fn access_columns(cx: &mut LoweringContext, id: ExprId) {
    if matches!(cx.tree[id].kind, ExprKind::Index { .. })
        && matches!(cx.tree[id].ty, Type::Matrix { .. })
        && let Some(holder @ Type::Struct(_)) = type_within(&cx.tree, id)
    {
        let structure = cx.build_at(id).detach(id);
        cx.tree[structure].ty = holder;
        cx.tree[id].kind = ExprKind::Member { structure, member: 0 };
    }
}

/// Rewrites `s.m *= x` as `s.m = s.m * x`, and `s.m++` likewise; the indices have no side effects at this
/// point.
fn expand_compound(cx: &mut LoweringContext, id: ExprId, discarded: bool) {
    let (op, target, value) = match cx.tree[id].kind {
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
    if narrow(&cx.tree, target).is_none() {
        return;
    }
    let ty = cx.tree[target].ty;
    let keeps_old = !discarded && matches!(cx.tree[id].kind, ExprKind::Step { postfix: true, .. });
    let mut build = cx.build_at(id);
    let left = build.copy(target);
    let old = keeps_old.then(|| lvalue::move_to_temporary(cx, left, "old"));
    let mut build = cx.build_at(id);
    let value = value.unwrap_or_else(|| build.zero_or_one(Scalar::Float, true));
    let value = build.binary(op, left, value, ty);
    let assign = ExprKind::Assign {
        op: None,
        target,
        value,
    };
    match old {
        Some(old) => {
            let (set, last) = (build.push(assign, ty), build.copy(left));
            lvalue::replace_with_sequence(cx, id, vec![old, set], Some(last));
        }
        None => cx.tree[id].kind = assign,
    }
}

/// The expressions that are only indexed or measured, and those that are assigned as a whole.
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
fn element(cx: &mut LoweringContext, path: ExprId, number: u32, at: Place) -> ExprId {
    let mut build = cx.build(at);
    let base = build.copy(path);
    let index = build.literal(Value::Int(number.cast_signed()));
    let element = build.index(base, index);
    access_columns(cx, element);
    element
}

/// Builds the value of a narrow array from its elements.
fn read(cx: &mut LoweringContext, id: ExprId) {
    if narrow(&cx.tree, id).is_none() {
        return;
    }
    let mut steps = Vec::new();
    // The path is repeated for each element.
    let path = lvalue::path_nodes(&cx.tree, id);
    if let Some(&root) = path.last()
        && walk::has_side_effects(&cx.tree, root)
    {
        steps.push(lvalue::move_to_temporary(cx, root, "structure"));
    }
    lvalue::hoist_indices(cx, id, Hoist::Effectful, &mut steps);
    let whole = read_elements(cx, id);
    lvalue::replace_with_sequence(cx, id, steps, Some(whole));
}

/// The value of an array or an element, built from its elements if it is narrow.
fn read_elements(cx: &mut LoweringContext, path: ExprId) -> ExprId {
    let Some(size) = narrow(&cx.tree, path) else {
        return path;
    };
    let (ty, at) = (cx.tree[path].ty, cx.tree[path].at);
    let arguments = (0..size)
        .map(|number| {
            let element = element(cx, path, number, at);
            read_elements(cx, element)
        })
        .collect();
    let constructor = if matches!(ty, Type::Matrix { .. }) {
        Constructor::Matrix
    } else {
        Constructor::Array
    };
    cx.build(at).construct(constructor, arguments, ty)
}

/// Writes a narrow array element by element.
fn write(cx: &mut LoweringContext, id: ExprId, target: ExprId, value: ExprId, discarded: bool) {
    let mut steps = Vec::new();
    let hoist = if walk::has_side_effects(&cx.tree, value) {
        Hoist::NonConstant
    } else {
        Hoist::Effectful
    };
    lvalue::hoist_indices(cx, target, hoist, &mut steps);
    if !matches!(cx.tree[value].kind, ExprKind::Variable(_)) {
        steps.push(lvalue::move_to_temporary(cx, value, "value"));
    }
    copy_elements(cx, target, value, cx.tree[id].at, &mut steps);
    let last = (!discarded).then(|| cx.build_at(id).copy(value));
    lvalue::replace_with_sequence(cx, id, steps, last);
}

/// `target[k] = value[k]` for each k, recursively for narrow elements.
fn copy_elements(cx: &mut LoweringContext, target: ExprId, value: ExprId, at: Place, out: &mut Vec<ExprId>) {
    let Some(size) = narrow(&cx.tree, target) else {
        out.push(cx.build(at).assign(target, value));
        return;
    };
    for number in 0..size {
        let [target, value] = [target, value].map(|path| element(cx, path, number, at));
        copy_elements(cx, target, value, at, out);
    }
}

/// Replaces a constructor by a call of a function.
fn replace_constructor(cx: &mut LoweringContext, id: ExprId, matrices: &HashMap<(StructId, usize), Type>) {
    let (ty, at) = (cx.tree[id].ty, cx.tree[id].at);
    let (Type::Struct(structure), ExprKind::Construct { arguments, .. }) = (ty, cx.tree[id].kind.clone())
    else {
        return;
    };
    if !has_narrow(&cx.tree, structure) {
        return;
    }
    let function = cx.helper(Helper::Make, (ty, Type::Void), at);
    // The parameters keep the matrix types.
    for (member, parameter) in cx.tree[function].parameters.clone().into_iter().enumerate() {
        if let Some(&matrix) = matrices.get(&(structure, member)) {
            cx.tree[parameter].ty = matrix;
        }
    }
    if cx.tree[function].body.is_none() {
        let body = constructor_body(cx, function, structure, at);
        cx.tree[function].body = Some(body);
    }
    cx.tree[id].kind = ExprKind::Call { function, arguments };
}

/// `S s; s.a = a; s.b[0] = b[0]; … return s;`
fn constructor_body(cx: &mut LoweringContext, function: FunctionId, structure: StructId, at: Place) -> Block {
    let made = cx.local("made", Type::Struct(structure), at);
    let mut sets = Vec::new();
    let parameters: Vec<VariableId> = cx.tree[function].parameters.clone();
    for (member, parameter) in parameters.into_iter().enumerate() {
        let mut build = cx.build(at);
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
        copy_elements(cx, target, value, at, &mut sets);
    }
    let statement = |kind| Statement::new(kind, at);
    let result = cx.build(at).variable(made);
    std::iter::once(StatementKind::Declare(made))
        .chain(sets.into_iter().map(StatementKind::Expression))
        .chain([StatementKind::Return(Some(result))])
        .map(statement)
        .collect()
}
