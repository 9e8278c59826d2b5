//! Operators and conversions that naga refuses or translates wrongly.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, BuiltIn, Condition, Constructor, ExprId, ExprKind, FunctionId, Place, Scalar,
    Statement, StatementKind, StepOp, Swizzle, Tree, Type, UnaryOp, Value, VariableId, walk,
};

use crate::lower::context::LoweringContext;
use crate::lower::generated::Helper;
use crate::lower::{initializer, lvalue};

/// Splits conversions of `bool` whose sizes differ: `vec3(b)`, `vec2(b3)`, `float(b2)`.
///
/// naga converts a single `bool` argument by a selection of the argument's size, so that `vec3(b)` becomes a
/// float.
pub(super) fn lower_boolean_conversions(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| {
        let ExprKind::Construct {
            constructor,
            ref arguments,
        } = cx.tree[id].kind
        else {
            return;
        };
        let &[only] = arguments.as_slice() else {
            return;
        };
        let (to, from) = (cx.tree[id].ty, cx.tree[only].ty);
        let (Some(scalar), Some(Scalar::Bool)) = (to.scalar(), from.scalar()) else {
            return;
        };
        if scalar == Scalar::Bool {
            return;
        }
        let is_constant = cx.tree[only].constant;
        let mut build = cx.build_at(id);
        let only = if let (Type::Vector(..) | Type::Matrix { .. }, Type::Scalar(_)) = (to, from) {
            build.construct(Constructor::Scalar, vec![only], Type::Scalar(scalar))
        } else {
            let left = to.component_count().unwrap_or(1);
            let components = Swizzle::new(&[0, 1, 2, 3][..usize::from(left.min(4))]);
            match components {
                Some(components) if from.component_count() != Some(left) => build.swizzle(only, components),
                _ => return,
            }
        };
        cx.tree[only].constant = is_constant;
        cx.tree[id].kind = ExprKind::Construct {
            constructor,
            arguments: vec![only],
        };
    });
}

/// Rewrites the matrix constructors `mat2(v4)` and `mat2(v3, v3)`, whose last argument has more components
/// than are left.
///
/// naga repeats a single vector as each column, and builds an extra column from surplus components
/// (gfx-rs/wgpu #4897).
pub(super) fn lower_matrix_constructors(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| {
        let ty = cx.tree[id].ty;
        let ExprKind::Construct {
            constructor: Constructor::Matrix,
            arguments,
        } = &cx.tree[id].kind
        else {
            return;
        };
        let arguments = arguments.clone();
        if let &[only] = arguments.as_slice() {
            let (vector, at) = (cx.tree[only].ty, cx.tree[id].at);
            let function = cx.helper(Helper::Matrix, (ty, vector), at);
            cx.tree[id].kind = ExprKind::Call { function, arguments };
        } else if let Some((&last, others)) = arguments.split_last() {
            let count = |ty: Type| ty.component_count().unwrap_or(0);
            let given: u8 = others.iter().map(|&argument| count(cx.tree[argument].ty)).sum();
            let left = count(ty).saturating_sub(given);
            if left < count(cx.tree[last].ty)
                && let Some(components) = Swizzle::new(&[0, 1, 2, 3][..usize::from(left.min(4))])
            {
                let trimmed = cx.build_at(last).swizzle(last, components);
                let mut arguments = arguments;
                arguments.pop();
                arguments.push(trimmed);
                cx.tree[id].kind = ExprKind::Construct {
                    constructor: Constructor::Matrix,
                    arguments,
                };
            }
        }
    });
}

/// Rewrites `a && f()` and `a || f()` as conditionals: `a ? f() : false`.
///
/// naga evaluates both sides, so the writes of a call on the right always happen (gfx-rs/wgpu #4394). It
/// lowers `?:` to an `if`.
pub(super) fn lower_short_circuit(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| {
        let ExprKind::Binary {
            op: op @ (BinaryOp::And | BinaryOp::Or),
            left,
            right,
        } = cx.tree[id].kind
        else {
            return;
        };
        if !walk::has_side_effects(&cx.tree, right) {
            return;
        }
        let constant = cx.build_at(id).literal(Value::Bool(op == BinaryOp::Or));
        let (yes, no) = if op == BinaryOp::And {
            (right, constant)
        } else {
            (constant, right)
        };
        cx.tree[id].kind = ExprKind::Conditional {
            condition: left,
            yes,
            no,
        };
    });
}

/// Rewrites `-x` of unsigned integers as `0u - x`, which wraps in the same way.
///
/// naga's validator refuses the negation.
pub(super) fn lower_negation(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| {
        let (ty, at) = (cx.tree[id].ty, cx.tree[id].at);
        if let ExprKind::Unary {
            op: UnaryOp::Minus,
            operand,
        } = cx.tree[id].kind
            && ty.scalar() == Some(Scalar::Uint)
        {
            let left = initializer::zero_value(cx, ty, at);
            cx.tree[id].kind = ExprKind::Binary {
                op: BinaryOp::Subtract,
                left,
                right: operand,
            };
        }
    });
}

/// Rewrites `!=` of floats as `!(a == b)`, which is true if either is NaN, as GLSL and WebGL 2 require.
///
/// naga writes SPIR-V's ordered comparison (`OpFOrdNotEqual`), which is false for NaN, so that `x != x` never
/// detects one.
pub(super) fn lower_inequality(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| match &cx.tree[id].kind {
        &ExprKind::Binary {
            op: BinaryOp::NotEqual,
            left,
            right,
        } if is_float(cx, left) => {
            let at = cx.tree[id].at;
            let operand = cx.build(at).binary(BinaryOp::Equal, left, right, Type::BOOL);
            cx.tree[id].kind = ExprKind::Unary {
                op: UnaryOp::Not,
                operand,
            };
        }
        ExprKind::BuiltIn {
            function: BuiltIn::NotEqual,
            arguments,
        } if arguments.iter().any(|&argument| is_float(cx, argument)) => {
            let (ty, at, arguments) = (cx.tree[id].ty, cx.tree[id].at, arguments.clone());
            let equal = ExprKind::BuiltIn {
                function: BuiltIn::Equal,
                arguments,
            };
            let equal = cx.build(at).push(equal, ty);
            cx.tree[id].kind = ExprKind::BuiltIn {
                function: BuiltIn::Not,
                arguments: vec![equal],
            };
        }
        _ => {}
    });
}

fn is_float(cx: &LoweringContext, id: ExprId) -> bool {
    cx.tree[id].ty.scalar() == Some(Scalar::Float)
}

/// Rewrites `a % b` of integers: it floors where `a` or `b` is negative, and accepts a vector and a scalar.
///
/// The specification leaves negative operands undefined; glslang, Mesa and `SwiftShader` floor, and hence
/// browsers do, but naga truncates. naga also refuses `v % s`, though it accepts such operands for every
/// other operator.
pub(super) fn lower_remainder(cx: &mut LoweringContext) {
    cx.each_expression(expand_remainder_assignment);
    cx.each_expression(|cx, id| {
        let ExprKind::Binary {
            op: BinaryOp::Remainder,
            left,
            right,
        } = cx.tree[id].kind
        else {
            return;
        };
        let ty = cx.tree[id].ty;
        let [left, right] = [left, right].map(|operand| widen(cx, operand, ty));
        let signed = ty.scalar() == Some(Scalar::Int);
        cx.tree[id].kind = if signed
            && ![left, right]
                .iter()
                .all(|&operand| is_nonnegative_constant(&cx.tree, operand))
        {
            let at = cx.tree[id].at;
            let function = cx.helper(Helper::Remainder, (ty, ty), at);
            ExprKind::Call {
                function,
                arguments: vec![left, right],
            }
        } else {
            ExprKind::Binary {
                op: BinaryOp::Remainder,
                left,
                right,
            }
        };
    });
}

/// Rewrites `a %= b` as `a = a % b`; the indices in `a` have no side effects at this point.
fn expand_remainder_assignment(cx: &mut LoweringContext, id: ExprId) {
    if let ExprKind::Assign {
        op: Some(op @ BinaryOp::Remainder),
        target,
        value,
    } = cx.tree[id].kind
    {
        let ty = cx.tree[target].ty;
        let mut build = cx.build_at(id);
        let left = build.copy(target);
        let value = build.binary(op, left, value, ty);
        cx.tree[id].kind = ExprKind::Assign {
            op: None,
            target,
            value,
        };
    }
}

fn is_nonnegative_constant(tree: &Tree, operand: ExprId) -> bool {
    let natural = |value: &Value| matches!(value, Value::Int(value) if *value >= 0);
    tree.value(operand)
        .is_some_and(|value| value.components().iter().all(natural))
}

fn widen(cx: &mut LoweringContext, operand: ExprId, ty: Type) -> ExprId {
    match (cx.tree[operand].ty, ty) {
        (Type::Scalar(_), Type::Vector(..)) => {
            cx.build_at(operand)
                .construct(Constructor::Splat, vec![operand], ty)
        }
        _ => operand,
    }
}

/// Rewrites `==` and `!=` of structures and arrays as calls of a function for each type, which compares
/// member by member.
///
/// naga refuses the operators.
pub(super) fn lower_equality(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| {
        if let ExprKind::Binary {
            op: op @ (BinaryOp::Equal | BinaryOp::NotEqual),
            left,
            right,
        } = cx.tree[id].kind
        {
            replace_comparison(cx, id, op, left, right);
        }
    });
}

fn is_composite(ty: Type) -> bool {
    matches!(ty, Type::Struct(_) | Type::Array(_))
}

/// Replaces a comparison of structures or arrays by a call.
fn replace_comparison(cx: &mut LoweringContext, id: ExprId, op: BinaryOp, left: ExprId, right: ExprId) {
    let (ty, at) = (cx.tree[left].ty, cx.tree[id].at);
    if !is_composite(ty) {
        return;
    }
    let function = cx.helper(Helper::Equal, (ty, ty), at);
    let call = ExprKind::Call {
        function,
        arguments: vec![left, right],
    };
    cx.tree[id].kind = if op == BinaryOp::Equal {
        call
    } else {
        let operand = cx.build(at).push(call, Type::BOOL);
        ExprKind::Unary {
            op: UnaryOp::Not,
            operand,
        }
    };
}

/// The body of the function that compares two values of a type.
pub(super) fn equality_body(cx: &mut LoweringContext, function: FunctionId, ty: Type, at: Place) -> Block {
    let &[a, b] = cx.tree[function].parameters.as_slice() else {
        return Block::new();
    };
    match ty {
        Type::Struct(id) => {
            let mut whole = None;
            for (member, ty) in cx.tree[id]
                .members
                .clone()
                .into_iter()
                .map(|member| member.ty)
                .enumerate()
            {
                let mut build = cx.build(at);
                let [left, right] = [a, b].map(|parameter| {
                    let structure = build.variable(parameter);
                    build.push(ExprKind::Member { structure, member }, ty)
                });
                let equal = build.binary(BinaryOp::Equal, left, right, Type::BOOL);
                replace_comparison(cx, equal, BinaryOp::Equal, left, right);
                whole = Some(match whole {
                    Some(before) => cx.build(at).binary(BinaryOp::And, before, equal, Type::BOOL),
                    None => equal,
                });
            }
            vec![Statement::new(StatementKind::Return(whole), at)]
        }
        Type::Array(id) => array_equality_body(cx, [a, b], cx.tree.array(id).size, at),
        _ => Block::new(),
    }
}

/// `for (int i = 0; i < size; i++) if (a[i] != b[i]) return false; return true;`
fn array_equality_body(cx: &mut LoweringContext, arrays: [VariableId; 2], size: u32, at: Place) -> Block {
    let counter = cx.local("i", Type::INT, at);
    let mut build = cx.build(at);
    let zero = build.literal(Value::Int(0));
    build.tree[counter].initializer = Some(zero);
    let i = build.variable(counter);
    let end = build.literal(Value::Int(size.cast_signed()));
    let within = build.binary(BinaryOp::Less, i, end, Type::BOOL);
    let target = build.variable(counter);
    let step = build.push(
        ExprKind::Step {
            op: StepOp::Increment,
            postfix: true,
            target,
        },
        Type::INT,
    );
    let [left, right] = arrays.map(|array| {
        let array = build.variable(array);
        let index = build.variable(counter);
        build.index(array, index)
    });
    let differs = build.binary(BinaryOp::NotEqual, left, right, Type::BOOL);
    let [no, yes] = [false, true].map(|value| Some(build.literal(Value::Bool(value))));
    replace_comparison(cx, differs, BinaryOp::NotEqual, left, right);
    let statement = |kind| Statement::new(kind, at);
    let arm = Arm {
        condition: differs,
        body: vec![statement(StatementKind::Return(no))],
    };
    vec![
        statement(StatementKind::For {
            init: vec![statement(StatementKind::Declare(counter))],
            condition: Some(Condition::Expression(within)),
            step: Some(step),
            body: vec![statement(StatementKind::If {
                arms: vec![arm],
                otherwise: None,
            })],
        }),
        statement(StatementKind::Return(yes)),
    ]
}

/// Maximum number of chained operators in one expression.
const MAX_CHAIN_OPERATORS: usize = 64;

/// Splits chains of thousands of operators, `a + b + c + …`: parts of a long chain are computed before the
/// rest.
///
/// naga recurses for each operator and overflows its stack.
pub(super) fn split_operator_chains(cx: &mut LoweringContext) {
    let mut inner = HashSet::new();
    for (_, expr) in cx.tree.exprs.iter() {
        inner.extend(first_operand(&expr.kind));
    }
    cx.each_expression_postorder(|cx, id| {
        if !inner.contains(&id) {
            split_chain(cx, id);
        }
    });
}

/// The operand that an expression evaluates first.
fn first_operand(kind: &ExprKind) -> Option<ExprId> {
    match *kind {
        ExprKind::Unary { operand: first, .. }
        | ExprKind::Binary { left: first, .. }
        | ExprKind::Conditional { condition: first, .. } => Some(first),
        _ => None,
    }
}

/// Moves parts of a chain into temporaries, from the innermost outwards.
fn split_chain(cx: &mut LoweringContext, root: ExprId) {
    let chain = operator_chain(&cx.tree, root);
    if chain.len() <= MAX_CHAIN_OPERATORS {
        return;
    }
    let ends = chain
        .iter()
        .rev()
        .copied()
        .skip(MAX_CHAIN_OPERATORS)
        .step_by(MAX_CHAIN_OPERATORS);
    let ends: Vec<ExprId> = ends.filter(|&end| end != root).collect();
    let steps = ends
        .into_iter()
        .map(|end| lvalue::move_to_temporary(cx, end, "part"))
        .collect();
    let rest = cx.build_at(root).detach(root);
    lvalue::replace_with_sequence(cx, root, steps, Some(rest));
}

fn operator_chain(tree: &Tree, root: ExprId) -> Vec<ExprId> {
    std::iter::successors(Some(root), |&id| first_operand(&tree[id].kind)).collect()
}
