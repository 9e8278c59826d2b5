//! Constant expressions that naga or tint cannot evaluate: infinities and NaNs (`1./0.`, `log(0.)`),
//! overflowing shifts (`1 << 31`), shifts by 32 bits or more, undefined integer quotients, `clamp` with
//! crossed bounds, `smoothstep` with equal edges, `pow` of a base that is not positive, packed halves; and
//! denormal operands and results, which naga does not flush to zero.
//!
//! naga evaluates every expression of literals and refuses these results; so do WGSL compilers. An operand
//! passed through a helper function that returns it unchanged is evaluated at run time instead. naga also
//! treats `(a, 31)` and `(i = 31)`, which are not constant expressions (§4.3.3), as 31. This pass does not
//! track the values that follow from them, so it makes all of them opaque.

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constant, Constructor, ExprId, ExprKind, Scalar, Tree, Type, Value,
};

use super::float32::{Float32Values, floats};
use crate::lower::context::LoweringContext;
use crate::lower::generated::Helper;

pub(super) fn run(cx: &mut LoweringContext) {
    let mut values = Float32Values::default();
    cx.each_expression_postorder(|cx, id| {
        cx.tree.cache_value(id);
        for value in forwarded_constants(&cx.tree, id) {
            make_opaque(cx, value);
        }
        let rewrite = rewrite(&cx.tree, &mut values, id);
        match rewrite {
            Some(Rewrite::Fold(value)) => {
                let node = constant_expression(cx, &value, id);
                cx.tree[id] = cx.tree[node].clone();
                // Enclosing expressions check this flag: naga continues to evaluate from here.
                cx.tree[id].constant = true;
            }
            Some(Rewrite::MakeOpaque(operand)) => make_opaque(cx, operand),
            Some(Rewrite::Bits(bits)) => {
                let mut build = cx.build_at(id);
                let bits = build.literal(Value::Uint(bits));
                let arguments = vec![bits];
                build.tree[id].kind = ExprKind::BuiltIn {
                    function: BuiltIn::UintBitsToFloat,
                    arguments,
                };
            }
            Some(Rewrite::Infinity) => {
                // The literal itself overflows: it becomes 1.0 divided by an opaque zero.
                let mut build = cx.build_at(id);
                let left = build.literal(Value::Float(1.0));
                let right = build.literal(Value::Float(0.0));
                build.tree[id].kind = ExprKind::Binary {
                    op: BinaryOp::Divide,
                    left,
                    right,
                };
                make_opaque(cx, right);
            }
            None => {}
        }
    });
}

/// The constants that an operation receives through sequences and assignments.
fn forwarded_constants(tree: &Tree, id: ExprId) -> Vec<ExprId> {
    let mut found = Vec::new();
    if matches!(
        tree[id].kind,
        ExprKind::Sequence { .. } | ExprKind::Assign { .. } | ExprKind::Call { .. }
    ) {
        return found;
    }
    tree[id].kind.for_each_operand(|operand| {
        let mut value = operand;
        while let ExprKind::Sequence { second: next, .. }
        | ExprKind::Assign {
            op: None,
            value: next,
            ..
        } = tree[value].kind
        {
            value = next;
        }
        if value != operand && tree[value].constant {
            found.push(value);
        }
    });
    found
}

enum Rewrite {
    /// Replace the expression by its value: integers are exact.
    Fold(Constant),
    /// Hide that operand's value until run time.
    MakeOpaque(ExprId),
    /// A literal beyond the range of 32-bit floats.
    Infinity,
    /// The largest float, given as bits: naga rounds its decimal form up.
    Bits(u32),
}

fn rewrite(tree: &Tree, values: &mut Float32Values, id: ExprId) -> Option<Rewrite> {
    match &tree[id].kind {
        ExprKind::Literal(literal) => match literal.value {
            Value::Float(value) if (value as f32).to_bits() == f32::MAX.to_bits() => {
                Some(Rewrite::Bits(f32::MAX.to_bits()))
            }
            value => is_not_finite(value).then_some(Rewrite::Infinity),
        },
        &ExprKind::Binary { op, left, right } => match op {
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight if shift_exceeds_width(tree, right) => {
                Some(Rewrite::MakeOpaque(right))
            }
            BinaryOp::ShiftLeft if tree[id].constant => {
                Some(tree.value(id).map_or(Rewrite::MakeOpaque(left), Rewrite::Fold))
            }
            BinaryOp::Divide | BinaryOp::Remainder if has_no_quotient(tree, left, right) => {
                Some(Rewrite::MakeOpaque(right))
            }
            BinaryOp::Divide => leaves_range(tree, values, id).then_some(Rewrite::MakeOpaque(right)),
            _ => leaves_range(tree, values, id).then_some(Rewrite::MakeOpaque(left)),
        },
        ExprKind::Assign {
            op: Some(BinaryOp::ShiftLeft | BinaryOp::ShiftRight),
            value,
            ..
        } if shift_exceeds_width(tree, *value) => Some(Rewrite::MakeOpaque(*value)),
        ExprKind::BuiltIn { function, arguments } => {
            let &first = arguments.first()?;
            let crossed = match (function, arguments.as_slice()) {
                (BuiltIn::Clamp, &[_, low, high]) => {
                    any_bounds(tree, low, high, |low, high| low > high).then_some(low)
                }
                (BuiltIn::Smoothstep, &[low, high, _]) => {
                    any_bounds(tree, low, high, |low, high| !((high - low) as f32).is_normal()).then_some(low)
                }
                // naga refuses a negative base, and 0 to the power 0.
                (BuiltIn::Pow, &[base, _]) => any_scalar(
                    tree,
                    base,
                    |value| matches!(value, Value::Float(base) if base <= 0.0),
                )
                .then_some(base),
                // The length may overflow although the quotients do not.
                (BuiltIn::Normalize, &[vector]) if tree[vector].constant => values
                    .value(tree, vector)
                    .and_then(|value| floats(&value))
                    .is_some_and(|vector| !toyproof_math::length(&vector).is_finite())
                    .then_some(vector),
                // Half floats may be infinite or NaN, and others may be too large for them.
                (BuiltIn::PackHalf2x16 | BuiltIn::UnpackHalf2x16, &[argument]) => {
                    tree[argument].constant.then_some(argument)
                }
                _ => None,
            };
            crossed
                .or_else(|| leaves_range(tree, values, id).then_some(first))
                .map(Rewrite::MakeOpaque)
        }
        _ => None,
    }
}

/// Whether the value overflows, or an operand or the value is denormal: processors treat it as zero, naga
/// does not.
fn leaves_range(tree: &Tree, values: &mut Float32Values, id: ExprId) -> bool {
    if overflows(tree, values, id) {
        return true;
    }
    let mut parts = vec![id];
    tree[id].kind.for_each_operand(|operand| parts.push(operand));
    let is_denormal = |value: &Value| matches!(value, Value::Float(value) if (*value as f32).is_subnormal());
    tree[id].constant
        && parts.into_iter().any(|part| {
            let value = values.value(tree, part);
            value.is_some_and(|value| value.components().iter().any(is_denormal))
        })
}

/// Whether the value is not a finite 32-bit float while those of all operands are.
fn overflows(tree: &Tree, values: &mut Float32Values, id: ExprId) -> bool {
    let mut is_infinite = |id: ExprId| {
        tree[id].constant
            && tree[id].ty.scalar() == Some(Scalar::Float)
            && values
                .value(tree, id)
                .is_some_and(|value| value.components().iter().copied().any(is_not_finite))
    };
    let mut operands = Vec::new();
    tree[id].kind.for_each_operand(|operand| operands.push(operand));
    is_infinite(id) && !operands.into_iter().any(is_infinite)
}

fn is_not_finite(value: Value) -> bool {
    matches!(value, Value::Float(value) if !(value as f32).is_finite())
}

/// Whether a quotient is undefined: division by zero, or of the least integer by -1.
fn has_no_quotient(tree: &Tree, dividend: ExprId, divisor: ExprId) -> bool {
    any_scalar(tree, divisor, |value| {
        matches!(value, Value::Int(0) | Value::Uint(0))
    }) || any_scalar(tree, dividend, |value| matches!(value, Value::Int(i32::MIN)))
        && any_scalar(tree, divisor, |value| matches!(value, Value::Int(-1)))
}

/// Whether a constant number of bits is 32 or more, or unknown: a converted float beyond all integers.
fn shift_exceeds_width(tree: &Tree, amount: ExprId) -> bool {
    let is_unknown = tree[amount].constant && tree.value(amount).is_none();
    is_unknown
        || any_scalar(tree, amount, |value| {
            !matches!(value, Value::Int(0..32) | Value::Uint(0..32))
        })
}

/// Whether an expression is constant and any of its components satisfies a predicate.
fn any_scalar(tree: &Tree, id: ExprId, predicate: impl Fn(Value) -> bool) -> bool {
    tree[id].constant
        && tree
            .value(id)
            .is_some_and(|value| value.components().iter().copied().any(predicate))
}

fn any_bounds(tree: &Tree, low: ExprId, high: ExprId, crossed: impl Fn(f64, f64) -> bool) -> bool {
    let values = |id: ExprId| tree[id].constant.then(|| tree.value(id)).flatten();
    let number = |value: &Value| match *value {
        Value::Float(value) => value,
        Value::Int(value) => value.into(),
        Value::Uint(value) => value.into(),
        Value::Bool(value) => f64::from(u8::from(value)),
    };
    match (values(low), values(high)) {
        (Some(low), Some(high)) => low
            .components()
            .iter()
            .zip(high.components().iter())
            .any(|(low, high)| crossed(number(low), number(high))),
        _ => false,
    }
}

/// Hides the value of an operand until run time.
fn make_opaque(cx: &mut LoweringContext, operand: ExprId) {
    let (ty, at) = (cx.tree[operand].ty, cx.tree[operand].at);
    let function = cx.helper(Helper::Runtime, (ty, Type::Void), at);
    let value = cx.build(at).detach(operand);
    cx.tree[operand].kind = ExprKind::Call {
        function,
        arguments: vec![value],
    };
    cx.tree[operand].constant = false;
}

/// Builds the expression of a constant value at the place of another expression.
pub(super) fn constant_expression(cx: &mut LoweringContext, value: &Constant, place: ExprId) -> ExprId {
    let ty = value.ty;
    let mut build = cx.build_at(place);
    let scalars: Vec<ExprId> = value
        .components()
        .iter()
        .map(|&scalar| build.literal(scalar))
        .collect();
    match (ty, scalars.as_slice()) {
        (Type::Scalar(_), &[only]) => only,
        (Type::Matrix { .. }, _) => build.construct(Constructor::Matrix, scalars, ty),
        _ => build.construct(Constructor::Vector, scalars, ty),
    }
}
