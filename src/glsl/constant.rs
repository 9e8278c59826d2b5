//! Evaluation of constant expressions (§4.3.3), as far as the rules require it: array sizes, indices, labels,
//! and the constants used in them.
//!
//! Floats are computed in double precision, integers in 32 wrapping bits. Operations that the specification
//! leaves undefined (integer division by zero, too large a shift, a float out of an integer's range) have no
//! value. The built-in functions on matrices and packed floats have no value either.

use crate::tree::{BinaryOp, Constant, Constructor, ExprId, ExprKind, Scalar, Tree, Type, UnaryOp, Value};

/// Maximum number of scalars of a value; nested structures could have 2⁶⁰.
const MAX_SCALARS: usize = 1 << 18;

impl Tree {
    /// The value of a constant expression; `None` if it is not constant or has no known value. Takes constant
    /// time for expressions cached by [`Self::cache_value`].
    pub fn value(&self, root: ExprId) -> Option<Constant> {
        if !self[root].constant {
            return None;
        }
        if let Some(known) = self.cached_value(root) {
            return known;
        }
        // Operands are evaluated before their users, so their values are on top of this stack. A loop handles
        // chains of any length.
        let mut values: Vec<Option<Constant>> = Vec::new();
        let mut pending = vec![(root, false)];
        while let Some((expr, operands_done)) = pending.pop() {
            if operands_done {
                let mut operands = 0;
                self[expr].kind.for_each_operand(|_| operands += 1);
                let operands = values.split_off(values.len() - operands);
                values.push(self.value_of(expr, operands));
            } else if !self[expr].constant {
                values.push(None);
            } else if let Some(known) = self.cached_value(expr) {
                values.push(known);
            } else {
                pending.push((expr, true));
                let first = pending.len();
                self[expr]
                    .kind
                    .for_each_operand(|operand| pending.push((operand, false)));
                pending[first..].reverse();
            }
        }
        values.pop().flatten()
    }

    /// Computes the value of an expression from those of its operands, and caches it. Called for each new
    /// expression, operands first, this keeps the total time proportional to the size of the tree. A later
    /// rewrite must preserve the value, or clear [`Expr::constant`](super::tree::Expr::constant).
    pub fn cache_value(&mut self, expr: ExprId) {
        let is_literal = matches!(self[expr].kind, ExprKind::Literal(_));
        if self[expr].constant && !is_literal {
            let value = self.value(expr);
            self.values.insert(expr, value);
        }
    }

    /// Clears the cached value of an expression, after a rewrite that may change it.
    pub fn clear_cached_value(&mut self, expr: ExprId) {
        self.values.remove(&expr);
    }

    /// Clears the cache, after a rewrite that may change values.
    pub fn clear_cached_values(&mut self) {
        self.values.clear();
    }

    /// The cached value; `None` if it was not cached.
    #[expect(
        clippy::option_option,
        reason = "the outer option: whether it is cached; the inner: whether it has a value"
    )]
    fn cached_value(&self, expr: ExprId) -> Option<Option<Constant>> {
        match &self[expr].kind {
            ExprKind::Literal(literal) => Some(Some(Constant::scalar(literal.value))),
            _ => self.values.get(&expr).cloned(),
        }
    }

    /// Computes the value of a constant expression from those of its operands, in the order in which
    /// [`ExprKind::for_each_operand`] visits them.
    pub fn value_of(&self, expr: ExprId, operands: Vec<Option<Constant>>) -> Option<Constant> {
        let ty = self[expr].ty;
        if let ExprKind::Length { array } = self[expr].kind {
            // The type determines the length.
            let Type::Array(id) = self[array].ty else {
                return None;
            };
            return Some(Constant::scalar(Value::Int(self.array(id).size.cast_signed())));
        }
        let operands: Vec<Constant> = operands.into_iter().collect::<Option<_>>()?;
        let components: Vec<Value> = match (&self[expr].kind, &operands[..]) {
            (ExprKind::Variable(variable), _) => return self[*variable].value.clone(),
            (ExprKind::Conditional { .. }, [condition, yes, no]) => match condition.components() {
                [Value::Bool(true)] => return Some(yes.clone()),
                [Value::Bool(false)] => return Some(no.clone()),
                _ => return None,
            },
            (ExprKind::Member { member, .. }, [structure]) => return structure.parts().get(*member).cloned(),
            (ExprKind::Index { .. }, [base, index]) => {
                return element(base, ty, usize::try_from(index.integer()?).ok()?);
            }
            (
                ExprKind::Construct {
                    constructor: Constructor::Struct | Constructor::Array,
                    ..
                },
                _,
            ) => {
                let whole = Constant::of_parts(ty, operands);
                return (whole.scalar_count() <= MAX_SCALARS).then_some(whole);
            }
            (ExprKind::Literal(literal), _) => vec![literal.value],
            (ExprKind::Unary { op, .. }, [a]) => {
                let results = a.components().iter().map(|&a| unary(*op, a));
                results.collect::<Option<_>>()?
            }
            (ExprKind::Binary { op, .. }, [a, b]) => binary(*op, a, b)?,
            (ExprKind::Construct { constructor, .. }, arguments) => construct(*constructor, ty, arguments)?,
            (ExprKind::BuiltIn { function, .. }, arguments) => function.of_constants(ty, arguments)?,
            (ExprKind::Swizzle { components, .. }, [vector]) => components
                .components()
                .iter()
                .map(|&component| vector.components().get(usize::from(component)).copied())
                .collect::<Option<_>>()?,
            _ => return None,
        };
        Some(Constant::of_components(ty, components))
    }
}

/// Indexes an array, a matrix (a column) or a vector (a component); `ty` is the element's type.
fn element(base: &Constant, ty: Type, index: usize) -> Option<Constant> {
    if let Type::Array(_) = base.ty {
        return base.parts().get(index).cloned();
    }
    let size = usize::from(ty.component_count()?);
    let start = index.checked_mul(size)?;
    let components = base.components().get(start..start.checked_add(size)?)?;
    Some(Constant::of_components(ty, components.to_vec()))
}

fn unary(op: UnaryOp, a: Value) -> Option<Value> {
    Some(match (op, a) {
        (UnaryOp::Plus, a) => a,
        (UnaryOp::Minus, Value::Int(a)) => Value::Int(a.wrapping_neg()),
        (UnaryOp::Minus, Value::Uint(a)) => Value::Uint(a.wrapping_neg()),
        (UnaryOp::Minus, Value::Float(a)) => Value::Float(-a),
        (UnaryOp::Not, Value::Bool(a)) => Value::Bool(!a),
        (UnaryOp::BitNot, Value::Int(a)) => Value::Int(!a),
        (UnaryOp::BitNot, Value::Uint(a)) => Value::Uint(!a),
        _ => return None,
    })
}

/// Evaluates a constructor of a scalar, vector or matrix (§5.4).
fn construct(constructor: Constructor, ty: Type, arguments: &[Constant]) -> Option<Vec<Value>> {
    let all = || {
        arguments
            .iter()
            .flat_map(|argument| argument.components().iter().copied())
    };
    let scalar = ty.scalar()?;
    let count = usize::from(ty.component_count()?);
    let of_matrix = |pick: &dyn Fn(u8, u8) -> Option<Value>| {
        let Type::Matrix { columns, rows } = ty else {
            return None;
        };
        (0..columns)
            .flat_map(|column| (0..rows).map(move |row| pick(column, row)))
            .collect::<Option<Vec<_>>>()
    };
    let identity = |column, row| Value::Float(f64::from(u8::from(column == row)));
    match constructor {
        Constructor::Splat => {
            let value = convert(all().next()?, scalar)?;
            Some(vec![value; count])
        }
        Constructor::Diagonal => {
            let value = convert(all().next()?, scalar)?;
            of_matrix(&|column, row| Some(if column == row { value } else { Value::Float(0.0) }))
        }
        Constructor::Resize => {
            let [matrix] = arguments else {
                return None;
            };
            let Type::Matrix { columns, rows } = matrix.ty else {
                return None;
            };
            of_matrix(&|column, row| {
                if column < columns && row < rows {
                    matrix.components().get(usize::from(column * rows + row)).copied()
                } else {
                    Some(identity(column, row))
                }
            })
        }
        _ => all().take(count).map(|value| convert(value, scalar)).collect(),
    }
}

/// Converts a scalar (§5.4.1).
fn convert(value: Value, to: Scalar) -> Option<Value> {
    let float = match value {
        Value::Bool(value) => f64::from(u8::from(value)),
        Value::Int(value) => f64::from(value),
        Value::Uint(value) => f64::from(value),
        Value::Float(value) => value,
    };
    Some(match (to, value) {
        (Scalar::Bool, _) => Value::Bool(float != 0.0),
        (Scalar::Float, _) => Value::Float(float),
        (Scalar::Int, Value::Uint(bits)) => Value::Int(bits.cast_signed()),
        (Scalar::Uint, Value::Int(bits)) => Value::Uint(bits.cast_unsigned()),
        (Scalar::Int, _) if float.trunc() >= -2_147_483_648.0 && float < 2_147_483_648.0 => {
            Value::Int(float as i32)
        }
        (Scalar::Uint, _) if float > -1.0 && float < 4_294_967_296.0 => Value::Uint(float as u32),
        _ => return None,
    })
}

// Binary operators on constants (§5.9).

/// Maximum number of scalars that are compared: constants share their parts, so a short text may compare
/// large ones often.
const MAX_COMPARED: usize = 1 << 12;

fn binary(op: BinaryOp, a: &Constant, b: &Constant) -> Option<Vec<Value>> {
    match op {
        BinaryOp::Equal | BinaryOp::NotEqual => {
            let is_comparable = a.scalar_count() <= MAX_COMPARED && b.scalar_count() <= MAX_COMPARED;
            let is_equal = is_comparable.then(|| a == b)?;
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
    // A scalar is combined with every component of the other side.
    let pick = |side: &Constant, at: usize| {
        side.components()
            .get(if side.components().len() == 1 { 0 } else { at })
            .copied()
    };
    (0..count)
        .map(|at| scalars(op, pick(a, at)?, pick(b, at)?))
        .collect()
}

/// Multiplies rows by columns; a vector is a row on the left and a column on the right.
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
        (Less, ..) => Value::Bool(ordering(a, b)? == Some(std::cmp::Ordering::Less)),
        (Greater, ..) => Value::Bool(ordering(a, b)? == Some(std::cmp::Ordering::Greater)),
        (LessEqual, ..) => Value::Bool(ordering(a, b)?.is_some_and(std::cmp::Ordering::is_le)),
        (GreaterEqual, ..) => Value::Bool(ordering(a, b)?.is_some_and(std::cmp::Ordering::is_ge)),
        _ => return None,
    })
}

/// Compares two values; `None` if their types are not ordered; the inner option is `None` if one is NaN.
#[expect(
    clippy::option_option,
    reason = "the outer option: whether the types are ordered; the inner: whether neither is NaN"
)]
pub(crate) fn ordering(a: Value, b: Value) -> Option<Option<std::cmp::Ordering>> {
    Some(match (a, b) {
        (Value::Int(a), Value::Int(b)) => Some(a.cmp(&b)),
        (Value::Uint(a), Value::Uint(b)) => Some(a.cmp(&b)),
        (Value::Float(a), Value::Float(b)) => a.partial_cmp(&b),
        _ => return None,
    })
}

/// Shifts an integer; undefined from 32 on (§5.9).
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
