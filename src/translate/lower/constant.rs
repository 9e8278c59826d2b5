//! Constant expressions that naga cannot evaluate: infinities and NaNs (`1./0.`, `log(0.)`), shifts that overflow (`1 << 31`),
//! shifts by more bits than there are, integer quotients that there are not, `clamp` with crossed bounds, `smoothstep` with equal ones.
//!
//! naga evaluates every expression of literals and refuses these results; so do WGSL compilers. An operand that goes
//! through a function of our own, which gives it back as it is, is evaluated when the shader runs. `(a, 31)` and `(i = 31)`, which are no
//! constant expressions (§4.3.3), naga takes for 31: what follows from such values is unknown here, so that all of them go that way.

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constant, Constructor, ExprId, ExprKind, Scalar, Tree, Type, Value,
};

use super::draft::Draft;
use super::helper::Helper;

pub(super) fn run(draft: &mut Draft) {
    draft.operands_first(|draft, id| {
        draft.tree.keep_value(id);
        for value in passed_on(&draft.tree, id) {
            postpone(draft, value);
        }
        let remedy = remedy(&draft.tree, id);
        match remedy {
            Some(Remedy::Spell(value)) => {
                let node = spell(draft, &value, id);
                draft.tree[id] = draft.tree[node].clone();
                // What stands around it asks: naga evaluates on from here.
                draft.tree[id].constant = true;
            }
            Some(Remedy::Postpone(operand)) => postpone(draft, operand),
            Some(Remedy::Bits(bits)) => {
                let mut build = draft.build_at(id);
                let bits = build.literal(Value::Uint(bits));
                let arguments = vec![bits];
                build.tree[id].kind = ExprKind::BuiltIn {
                    function: BuiltIn::UintBitsToFloat,
                    arguments,
                };
            }
            Some(Remedy::Infinity) => {
                // The literal is infinite itself: 1.0 over a zero that nobody knows.
                let mut build = draft.build_at(id);
                let left = build.literal(Value::Float(1.0));
                let right = build.literal(Value::Float(0.0));
                build.tree[id].kind = ExprKind::Binary {
                    op: BinaryOp::Divide,
                    left,
                    right,
                };
                postpone(draft, right);
            }
            None => {}
        }
    });
}

/// The constants that an operation computes with by way of sequences and assignments.
fn passed_on(tree: &Tree, id: ExprId) -> Vec<ExprId> {
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

enum Remedy {
    /// Integers are exact: the value stands for the expression.
    Spell(Constant),
    /// That operand is known when the shader runs.
    Postpone(ExprId),
    /// A literal that is too large for a float.
    Infinity,
    /// The largest float, which naga writes as a decimal that is larger still.
    Bits(u32),
}

fn remedy(tree: &Tree, id: ExprId) -> Option<Remedy> {
    match &tree[id].kind {
        ExprKind::Literal(literal) => match literal.value {
            Value::Float(value) if (value as f32).to_bits() == f32::MAX.to_bits() => {
                Some(Remedy::Bits(f32::MAX.to_bits()))
            }
            value => is_beyond(value).then_some(Remedy::Infinity),
        },
        &ExprKind::Binary { op, left, right } => match op {
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight if shifts_too_far(tree, right) => {
                Some(Remedy::Postpone(right))
            }
            BinaryOp::ShiftLeft if tree[id].constant => tree.value(id).map(Remedy::Spell),
            BinaryOp::Divide | BinaryOp::Remainder if has_no_quotient(tree, left, right) => {
                Some(Remedy::Postpone(right))
            }
            BinaryOp::Divide => overflows(tree, id).then_some(Remedy::Postpone(right)),
            _ => overflows(tree, id).then_some(Remedy::Postpone(left)),
        },
        ExprKind::Assign {
            op: Some(BinaryOp::ShiftLeft | BinaryOp::ShiftRight),
            value,
            ..
        } if shifts_too_far(tree, *value) => Some(Remedy::Postpone(*value)),
        ExprKind::BuiltIn { function, arguments } => {
            let &first = arguments.first()?;
            let crossed = match (function, arguments.as_slice()) {
                (BuiltIn::Clamp, &[_, low, high]) => {
                    crosses(tree, low, high, |low, high| low > high).then_some(low)
                }
                (BuiltIn::Smoothstep, &[low, high, _]) => {
                    crosses(tree, low, high, |low, high| low.total_cmp(&high).is_eq()).then_some(low)
                }
                _ => None,
            };
            crossed
                .or_else(|| overflows(tree, id).then_some(first))
                .map(Remedy::Postpone)
        }
        _ => None,
    }
}

/// Whether naga meets a value here that is no finite 32-bit float, and did not below.
fn overflows(tree: &Tree, id: ExprId) -> bool {
    let beyond = |id: ExprId| {
        tree[id].constant
            && tree
                .value(id)
                .is_some_and(|value| value.components().iter().copied().any(is_beyond))
    };
    let mut below = false;
    tree[id].kind.for_each_operand(|operand| {
        below |= tree[operand].ty.scalar() == Some(Scalar::Float) && beyond(operand);
    });
    tree[id].ty.scalar() == Some(Scalar::Float) && beyond(id) && !below
}

fn is_beyond(value: Value) -> bool {
    matches!(value, Value::Float(value) if !(value as f32).is_finite())
}

/// Integer division by zero, or of the least integer by -1.
fn has_no_quotient(tree: &Tree, dividend: ExprId, divisor: ExprId) -> bool {
    any_scalar(tree, divisor, |value| {
        matches!(value, Value::Int(0) | Value::Uint(0))
    }) || any_scalar(tree, dividend, |value| matches!(value, Value::Int(i32::MIN)))
        && any_scalar(tree, divisor, |value| matches!(value, Value::Int(-1)))
}

fn shifts_too_far(tree: &Tree, amount: ExprId) -> bool {
    any_scalar(tree, amount, |value| {
        !matches!(value, Value::Int(0..32) | Value::Uint(0..32))
    })
}

/// Whether an expression is constant and such a scalar is in it.
fn any_scalar(tree: &Tree, id: ExprId, is_such: impl Fn(Value) -> bool) -> bool {
    tree[id].constant
        && tree
            .value(id)
            .is_some_and(|value| value.components().iter().copied().any(is_such))
}

fn crosses(tree: &Tree, low: ExprId, high: ExprId, crossed: impl Fn(f64, f64) -> bool) -> bool {
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

/// Hides the value of an operand until the shader runs.
fn postpone(draft: &mut Draft, operand: ExprId) {
    let (ty, at) = (draft.tree[operand].ty, draft.tree[operand].at);
    let function = draft.helper(Helper::Runtime, (ty, Type::Void), at);
    let value = draft.build(at).detach(operand);
    draft.tree[operand].kind = ExprKind::Call {
        function,
        arguments: vec![value],
    };
    draft.tree[operand].constant = false;
}

/// A value as an expression, where another stands.
pub(super) fn spell(draft: &mut Draft, value: &Constant, place: ExprId) -> ExprId {
    let ty = value.ty;
    let mut build = draft.build_at(place);
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
