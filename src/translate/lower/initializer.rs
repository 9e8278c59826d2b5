//! Initial values: global initializers, zero initialization and missing return values.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    BinaryOp, Block, BuiltIn, Constructor, Direction, ExprId, ExprKind, FunctionId, Item, Place, Scalar,
    Statement, StatementKind, Tree, Type, VariableId, VariableKind, walk,
};

use super::member;
use crate::lower::context::LoweringContext;
use crate::lower::generated::Helper;

/// Moves initializers that naga cannot evaluate to a function that runs before `mainImage`, in source order,
/// and constant arrays out of functions.
///
/// naga evaluates the initializer of a constant or refuses it, and silently drops that of a variable. It
/// copies a constant array with a dynamic index to a local variable at each use, which makes lavapipe ten
/// times slower.
pub(super) fn lower_globals(cx: &mut LoweringContext) {
    let variables: Vec<_> = cx.tree.global_variables().collect();
    let globals = variables.iter().copied().collect();
    for variable in variables {
        let Some(value) = cx.tree[variable].initializer else {
            continue;
        };
        // The value of a uniform is a literal.
        if cx.tree[variable].kind == VariableKind::Uniform {
            continue;
        }
        let evaluated = naga_evaluates(&cx.tree, &globals, value);
        if !evaluated || matches!(cx.tree[variable].ty, Type::Array(_)) {
            cx.tree[variable].kind = VariableKind::Global;
        }
        if !evaluated {
            cx.tree[variable].initializer = None;
            let set = cx.build_at(value).set(variable, value);
            cx.startup.push(set);
        }
    }
    // This follows the loop above, which decides which globals stay constant: a variable has no value yet
    // when arrays are initialized.
    hoist_constant_arrays(cx, &globals);
    add_startup_function(cx);
}

/// Moves arrays that have constant initializers and are never written out of functions.
fn hoist_constant_arrays(cx: &mut LoweringContext, globals: &HashSet<VariableId>) {
    let written = written_variables(&cx.tree);
    let mut hoisted = Vec::new();
    cx.each_statement(|cx, statement, out| {
        if let StatementKind::Declare(variable) = statement.kind
            && let Some(value) = cx.tree[variable].initializer
            && matches!(cx.tree[variable].ty, Type::Array(_))
            && !written.contains(&variable)
            && naga_evaluates(&cx.tree, globals, value)
        {
            hoisted.push(variable);
        } else {
            out.push(statement);
        }
    });
    for variable in hoisted {
        cx.tree[variable].kind = VariableKind::Global;
        cx.moved.insert(variable);
        cx.tree.items.push(Item::Variable(variable));
    }
}

/// The variables that any expression writes, in whole or in part.
fn written_variables(tree: &Tree) -> HashSet<VariableId> {
    let mut written = HashSet::new();
    for id in tree.exprs.ids() {
        tree.each_write(id, |target, _| written.extend(tree.root_variable(target)));
    }
    written
}

/// Whether naga can evaluate an expression at global scope.
fn naga_evaluates(tree: &Tree, globals: &HashSet<VariableId>, root: ExprId) -> bool {
    let is_small = |id: ExprId| matches!(tree[id].ty, Type::Scalar(_) | Type::Vector(..));
    tree.postorder(root).into_iter().all(|id| match &tree[id].kind {
        ExprKind::Literal(_) => true,
        ExprKind::Variable(variable) => {
            globals.contains(variable) && tree[*variable].kind == VariableKind::Const
        }
        ExprKind::Unary { .. } => is_small(id),
        &ExprKind::Binary { op, left, right } => {
            let scalars =
                matches!(tree[left].ty, Type::Scalar(_)) && matches!(tree[right].ty, Type::Scalar(_));
            let arithmetic = matches!(
                op,
                BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Multiply | BinaryOp::Divide
            );
            is_small(left)
                && is_small(right)
                && (scalars || arithmetic)
                && !matches!(op, BinaryOp::ShiftLeft | BinaryOp::Xor)
        }
        ExprKind::Construct {
            constructor,
            arguments,
        } => match constructor {
            Constructor::Struct | Constructor::Array => true,
            Constructor::Resize => false,
            _ => arguments.iter().all(|&argument| is_small(argument)),
        },
        &ExprKind::Swizzle { vector, .. } => is_small(vector),
        ExprKind::BuiltIn { function, arguments } => {
            naga_evaluates_function(*function)
                && arguments
                    .iter()
                    .all(|&argument| is_small(argument) && tree[argument].ty.scalar() == Some(Scalar::Float))
        }
        _ => false,
    })
}

/// The built-in functions that naga can evaluate.
fn naga_evaluates_function(function: BuiltIn) -> bool {
    use BuiltIn as B;
    matches!(
        function,
        B::Radians
            | B::Degrees
            | B::Sin
            | B::Cos
            | B::Tan
            | B::Asin
            | B::Acos
            | B::Atan
            | B::Sinh
            | B::Cosh
            | B::Tanh
            | B::Asinh
            | B::Acosh
            | B::Atanh
            | B::Pow
            | B::Exp
            | B::Log
            | B::Exp2
            | B::Log2
            | B::Sqrt
            | B::InverseSqrt
            | B::Abs
            | B::Sign
            | B::Floor
            | B::Trunc
            | B::Ceil
            | B::Fract
            | B::Min
            | B::Max
            | B::Clamp
            | B::Dot
            | B::Cross
            | B::Length
            | B::Distance
            | B::Normalize
            | B::Step
    )
}

/// Collects the assignments that run before `mainImage` in a function.
fn add_startup_function(cx: &mut LoweringContext) {
    let assignments = std::mem::take(&mut cx.startup);
    let Some(&first) = assignments.first() else {
        return;
    };
    let at = cx.tree[first].at;
    let function = cx.function("toyproof_start".to_owned(), &[], Type::Void, at);
    let body = assignments
        .into_iter()
        .map(|set| Statement::new(StatementKind::Expression(set), cx.tree[set].at));
    let body = body.collect();
    cx.tree[function].body = Some(body);
    cx.startup_function = Some(function);
}

/// Zeroes uninitialized variables: locals at each declaration, `out` parameters at each call, as WebGL does.
///
/// naga zeroes locals once for each call of their function, so those inside loops keep their values from the
/// last iteration; `out` parameters keep the caller's values.
pub(super) fn zero_uninitialized(cx: &mut LoweringContext) {
    cx.each_body(|cx, function, mut body| {
        zero_declarations(cx, &body, false);
        let zeroes = zero_out_parameters(cx, function, &body);
        body.splice(0..0, zeroes);
        body
    });
}

fn zero_declarations(cx: &mut LoweringContext, block: &Block, in_loop: bool) {
    for statement in block {
        match statement.kind {
            StatementKind::Declare(variable) if in_loop && cx.tree[variable].initializer.is_none() => {
                let ty = cx.tree[variable].ty;
                let zero = zero_value(cx, ty, statement.at);
                cx.tree[variable].initializer = Some(zero);
            }
            _ => {}
        }
        let loops = matches!(
            statement.kind,
            StatementKind::For { .. } | StatementKind::While { .. } | StatementKind::DoWhile { .. }
        );
        for body in walk::child_blocks(statement) {
            zero_declarations(cx, body, in_loop || loops);
        }
    }
}

/// `p = vec3(0.0);` for each `out` parameter that the function may read or return before writing all of it.
fn zero_out_parameters(cx: &mut LoweringContext, function: FunctionId, body: &Block) -> Vec<Statement> {
    let at = cx.tree[function].at;
    let parameters = cx.tree[function].parameters.clone();
    let open: Vec<VariableId> = parameters
        .into_iter()
        .filter(|&id| cx.tree[id].kind == VariableKind::Parameter(Direction::Out))
        .filter(|&id| !matches!(cx.tree[id].ty, Type::Sampler(_)) && !is_written_first(cx, id, body))
        .collect();
    open.into_iter()
        .map(|parameter| {
            let ty = cx.tree[parameter].ty;
            let zero = zero_value(cx, ty, at);
            Statement::new(StatementKind::Expression(cx.build(at).set(parameter, zero)), at)
        })
        .collect()
}

/// Whether the first statements write the variable and nothing reads it before.
pub(crate) fn is_written_first(cx: &LoweringContext, variable: VariableId, body: &[Statement]) -> bool {
    for statement in body {
        let written = match statement.kind {
            StatementKind::Expression(expr) => match cx.tree[expr].kind {
                ExprKind::Assign {
                    op: None,
                    target,
                    value,
                } if matches!(cx.tree[target].kind, ExprKind::Variable(v) if v == variable) => Some(value),
                _ => None,
            },
            StatementKind::Declare(_) => None,
            _ => return false,
        };
        let read = written.map_or_else(|| walk::own_expressions(&cx.tree, statement), |value| vec![value]);
        if read
            .into_iter()
            .any(|root| walk::mentions(&cx.tree, root, variable))
        {
            return false;
        }
        if written.is_some() {
            return true;
        }
    }
    false
}

/// Returns zero at the end of functions that may end without a `return` (§6.1 leaves the value undefined).
///
/// naga only checks the last statement and returns nothing there, which its validator refuses.
pub(super) fn add_missing_returns(cx: &mut LoweringContext) {
    cx.each_body(|cx, function, mut body| {
        let (ty, at) = (cx.tree[function].return_type, cx.tree[function].at);
        if ty != Type::Void && !always_returns(&body) {
            let value = zero_value(cx, ty, at);
            body.push(Statement::new(StatementKind::Return(Some(value)), at));
        }
        body
    });
}

/// Whether naga also recognizes that every path through a block returns.
fn always_returns(block: &Block) -> bool {
    block.last().is_some_and(|last| match &last.kind {
        StatementKind::Return(_) | StatementKind::Discard => true,
        StatementKind::Block(body) => always_returns(body),
        StatementKind::If {
            arms,
            otherwise: Some(otherwise),
        } => always_returns(otherwise) && arms.iter().all(|arm| always_returns(&arm.body)),
        _ => false,
    })
}

/// Maximum number of scalars and vectors in an inline zero; larger values come from a helper function for
/// readability.
const MAX_INLINE_PARTS: u64 = 16;

/// Builds an expression whose every component is zero, as WebGL initializes variables.
pub(super) fn zero_value(cx: &mut LoweringContext, ty: Type, at: Place) -> ExprId {
    match ty {
        Type::Struct(_) | Type::Array(_) if part_count(cx, ty) > MAX_INLINE_PARTS => {
            call_zero_function(cx, ty, at)
        }
        Type::Struct(id) if member::has_narrow(&cx.tree, id) => call_zero_function(cx, ty, at),
        Type::Struct(id) => {
            let members: Vec<_> = cx.tree[id].members.iter().map(|member| member.ty).collect();
            let arguments = members.into_iter().map(|ty| zero_value(cx, ty, at)).collect();
            cx.build(at).construct(Constructor::Struct, arguments, ty)
        }
        Type::Array(id) => {
            let array = cx.tree.array(id);
            let arguments = (0..array.size)
                .map(|_| zero_value(cx, array.element, at))
                .collect();
            cx.build(at).construct(Constructor::Array, arguments, ty)
        }
        _ => {
            let mut build = cx.build(at);
            let zero = build.zero_or_one(ty.scalar().unwrap_or(Scalar::Float), false);
            match ty {
                Type::Vector(..) => build.construct(Constructor::Splat, vec![zero], ty),
                Type::Matrix { .. } => build.construct(Constructor::Diagonal, vec![zero], ty),
                _ => zero,
            }
        }
    }
}

fn call_zero_function(cx: &mut LoweringContext, ty: Type, at: Place) -> ExprId {
    let function = cx.helper(Helper::Zero, (ty, Type::Void), at);
    cx.build(at).call(function, Vec::new())
}

/// The number of scalars and vectors in a value.
fn part_count(cx: &LoweringContext, ty: Type) -> u64 {
    match ty {
        Type::Struct(id) => cx.tree[id]
            .members
            .iter()
            .map(|member| part_count(cx, member.ty))
            .sum(),
        Type::Array(id) => {
            let array = cx.tree.array(id);
            u64::from(array.size) * part_count(cx, array.element)
        }
        _ => 1,
    }
}

/// The body of a function that returns zero: a variable that is never written.
pub(super) fn zero_body(cx: &mut LoweringContext, ty: Type, at: Place) -> Vec<Statement> {
    let zero = cx.local("zero", ty, at);
    let value = cx.build(at).variable(zero);
    vec![
        Statement::new(StatementKind::Declare(zero), at),
        Statement::new(StatementKind::Return(Some(value)), at),
    ]
}
