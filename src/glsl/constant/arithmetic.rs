//! Binary operators on constants (§5.9).

use crate::tree::{BinaryOp, Constant, Type, Value};

/// The most scalars that are compared: constants share their parts, so that a short text may compare large ones often.
const MAX_COMPARED: usize = 1 << 12;

pub(super) fn binary(op: BinaryOp, a: &Constant, b: &Constant) -> Option<Vec<Value>> {
    match op {
        BinaryOp::Equal | BinaryOp::NotEqual => {
            let is_equal = a.scalar_count() <= MAX_COMPARED && b.scalar_count() <= MAX_COMPARED;
            let is_equal = is_equal.then(|| a == b)?;
            return Some(vec![Value::Bool(is_equal == (op == BinaryOp::Equal))]);
        }
        _ => {}
    }
    let vector_or_matrix = |ty| matches!(ty, Type::Matrix { .. } | Type::Vector(..));
    let algebraic = matches!(a.ty, Type::Matrix { .. }) && vector_or_matrix(b.ty)
        || vector_or_matrix(a.ty) && matches!(b.ty, Type::Matrix { .. });
    if op == BinaryOp::Multiply && algebraic {
        return product(a, b);
    }
    let count = a.components().len().max(b.components().len());
    // A scalar meets every component of the other side.
    let pick = |side: &Constant, at: usize| {
        side.components()
            .get(if side.components().len() == 1 { 0 } else { at })
            .copied()
    };
    (0..count)
        .map(|at| scalars(op, pick(a, at)?, pick(b, at)?))
        .collect()
}

/// Rows times columns; a vector is a row on the left and a column on the right.
fn product(a: &Constant, b: &Constant) -> Option<Vec<Value>> {
    let shape = |ty, row_vector| match ty {
        Type::Matrix { columns, rows } => Some((usize::from(columns), usize::from(rows))),
        Type::Vector(_, size) if row_vector => Some((usize::from(size), 1)),
        Type::Vector(_, size) => Some((1, usize::from(size))),
        _ => None,
    };
    let (inner, rows) = shape(a.ty, true)?;
    let (columns, _) = shape(b.ty, false)?;
    let float = |side: &Constant, at: usize| match side.components().get(at) {
        Some(Value::Float(value)) => Some(*value),
        _ => None,
    };
    let mut result = Vec::with_capacity(columns * rows);
    for column in 0..columns {
        for row in 0..rows {
            let mut sum = 0.0;
            for k in 0..inner {
                sum += float(a, k * rows + row)? * float(b, column * inner + k)?;
            }
            result.push(Value::Float(sum));
        }
    }
    Some(result)
}

fn scalars(op: BinaryOp, a: Value, b: Value) -> Option<Value> {
    use BinaryOp::{
        Add, And, BitAnd, BitOr, BitXor, Divide, Greater, GreaterEqual, Less, LessEqual, Multiply, Or,
        Remainder, ShiftLeft, ShiftRight, Subtract, Xor,
    };
    if matches!(op, ShiftLeft | ShiftRight) {
        return shift(op, a, b);
    }
    Some(match (op, a, b) {
        (Add, Value::Int(a), Value::Int(b)) => Value::Int(a.wrapping_add(b)),
        (Subtract, Value::Int(a), Value::Int(b)) => Value::Int(a.wrapping_sub(b)),
        (Multiply, Value::Int(a), Value::Int(b)) => Value::Int(a.wrapping_mul(b)),
        (Divide, Value::Int(a), Value::Int(b)) if b != 0 => Value::Int(a.wrapping_div(b)),
        (Remainder, Value::Int(a), Value::Int(b)) if b != 0 => Value::Int(a.wrapping_rem(b)),
        (BitAnd, Value::Int(a), Value::Int(b)) => Value::Int(a & b),
        (BitXor, Value::Int(a), Value::Int(b)) => Value::Int(a ^ b),
        (BitOr, Value::Int(a), Value::Int(b)) => Value::Int(a | b),
        (Add, Value::Uint(a), Value::Uint(b)) => Value::Uint(a.wrapping_add(b)),
        (Subtract, Value::Uint(a), Value::Uint(b)) => Value::Uint(a.wrapping_sub(b)),
        (Multiply, Value::Uint(a), Value::Uint(b)) => Value::Uint(a.wrapping_mul(b)),
        (Divide, Value::Uint(a), Value::Uint(b)) => Value::Uint(a.checked_div(b)?),
        (Remainder, Value::Uint(a), Value::Uint(b)) => Value::Uint(a.checked_rem(b)?),
        (BitAnd, Value::Uint(a), Value::Uint(b)) => Value::Uint(a & b),
        (BitXor, Value::Uint(a), Value::Uint(b)) => Value::Uint(a ^ b),
        (BitOr, Value::Uint(a), Value::Uint(b)) => Value::Uint(a | b),
        (Add, Value::Float(a), Value::Float(b)) => Value::Float(a + b),
        (Subtract, Value::Float(a), Value::Float(b)) => Value::Float(a - b),
        (Multiply, Value::Float(a), Value::Float(b)) => Value::Float(a * b),
        (Divide, Value::Float(a), Value::Float(b)) => Value::Float(a / b),
        (And, Value::Bool(a), Value::Bool(b)) => Value::Bool(a && b),
        (Or, Value::Bool(a), Value::Bool(b)) => Value::Bool(a || b),
        (Xor, Value::Bool(a), Value::Bool(b)) => Value::Bool(a != b),
        (Less, ..) => Value::Bool(order(a, b)? == Some(std::cmp::Ordering::Less)),
        (Greater, ..) => Value::Bool(order(a, b)? == Some(std::cmp::Ordering::Greater)),
        (LessEqual, ..) => Value::Bool(order(a, b)?.is_some_and(std::cmp::Ordering::is_le)),
        (GreaterEqual, ..) => Value::Bool(order(a, b)?.is_some_and(std::cmp::Ordering::is_ge)),
        _ => return None,
    })
}

/// None if the two have no order; inside, none if one is NaN.
#[expect(
    clippy::option_option,
    reason = "a comparison that is wrong, and one that is false"
)]
pub(super) fn order(a: Value, b: Value) -> Option<Option<std::cmp::Ordering>> {
    Some(match (a, b) {
        (Value::Int(a), Value::Int(b)) => Some(a.cmp(&b)),
        (Value::Uint(a), Value::Uint(b)) => Some(a.cmp(&b)),
        (Value::Float(a), Value::Float(b)) => a.partial_cmp(&b),
        _ => return None,
    })
}

/// Undefined from 32 on (§5.9).
fn shift(op: BinaryOp, a: Value, b: Value) -> Option<Value> {
    let by = match b {
        Value::Int(by) => u32::try_from(by).ok()?,
        Value::Uint(by) => by,
        _ => return None,
    };
    Some(match (op, a) {
        (BinaryOp::ShiftLeft, Value::Int(a)) => Value::Int(a.checked_shl(by)?),
        (BinaryOp::ShiftLeft, Value::Uint(a)) => Value::Uint(a.checked_shl(by)?),
        (_, Value::Int(a)) => Value::Int(a.checked_shr(by)?),
        (_, Value::Uint(a)) => Value::Uint(a.checked_shr(by)?),
        _ => return None,
    })
}
