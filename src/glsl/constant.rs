//! Evaluation of constant expressions (§4.3.3), as far as the rules require it: array sizes, indices, labels,
//! and the constants used in them.
//!
//! Floats are computed in double precision, integers in 32 wrapping bits. Operations that the specification
//! leaves undefined (integer division by zero, too large a shift, a float out of an integer's range) have no
//! value. The built-in functions on matrices and packed floats have no value either.

use toyproof_math::{Matrix, determinant, inverse, outer_product};

use crate::tree::{
    BinaryOp, BuiltIn, Constant, Constructor, ExprId, ExprKind, Scalar, Tree, Type, UnaryOp, Value,
};

/// Maximum number of scalars of a value; nested structures could have 2⁶⁰.
const MAX_SCALARS: usize = 1 << 18;

impl Tree {
    /// The value of a constant expression; `None` if it is not constant or has no known value. Takes constant
    /// time for expressions cached by [`Self::cache_value`].
    #[must_use]
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
        reason = "a value that is not known, and one that there is not"
    )]
    fn cached_value(&self, expr: ExprId) -> Option<Option<Constant>> {
        match &self[expr].kind {
            ExprKind::Literal(literal) => Some(Some(Constant::scalar(literal.value))),
            _ => self.values.get(&expr).cloned(),
        }
    }

    /// Computes the value of a constant expression from those of its operands, in the order in which
    /// [`ExprKind::for_each_operand`] visits them.
    #[must_use]
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
            (ExprKind::BuiltIn { function, .. }, arguments) => call(*function, ty, arguments)?,
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
        (Less, ..) => Value::Bool(compare(a, b)? == Some(std::cmp::Ordering::Less)),
        (Greater, ..) => Value::Bool(compare(a, b)? == Some(std::cmp::Ordering::Greater)),
        (LessEqual, ..) => Value::Bool(compare(a, b)?.is_some_and(std::cmp::Ordering::is_le)),
        (GreaterEqual, ..) => Value::Bool(compare(a, b)?.is_some_and(std::cmp::Ordering::is_ge)),
        _ => return None,
    })
}

/// Compares two values; `None` if their types are not ordered; the inner option is `None` if one is NaN.
#[expect(
    clippy::option_option,
    reason = "a comparison that is wrong, and one that is false"
)]
fn compare(a: Value, b: Value) -> Option<Option<std::cmp::Ordering>> {
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

// Built-in functions of constants (§8).

/// Evaluates a call; `None` if it is undefined or not supported.
fn call(function: BuiltIn, ty: Type, arguments: &[Constant]) -> Option<Vec<Value>> {
    if let Some(value) = geometric(function, arguments).or_else(|| matrix_function(function, arguments)) {
        return Some(value);
    }
    if let Some(value) = booleans(function, arguments) {
        return Some(vec![Value::Bool(value)]);
    }
    // All other functions are componentwise; a scalar is combined with every component.
    let count = usize::from(ty.component_count()?);
    (0..count)
        .map(|at| {
            let pick = |argument: &Constant| {
                let at = if argument.components().len() == 1 { 0 } else { at };
                argument.components().get(at).copied()
            };
            component(function, &arguments.iter().map(pick).collect::<Option<Vec<_>>>()?)
        })
        .collect()
}

fn component(function: BuiltIn, arguments: &[Value]) -> Option<Value> {
    match *arguments {
        [Value::Float(x)] => float_function(function, x),
        [Value::Float(x), Value::Float(y)] => binary_float_function(function, x, y),
        [Value::Float(x), Value::Float(y), Value::Float(z)] => Some(Value::Float(match function {
            BuiltIn::Clamp => glsl_min(glsl_max(x, y), z),
            BuiltIn::Mix => x * (1.0 - z) + y * z,
            BuiltIn::Smoothstep if x < y => {
                let t = ((z - x) / (y - x)).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            }
            _ => return None,
        })),
        [no, yes, Value::Bool(which)] if function == BuiltIn::Mix => Some(if which { yes } else { no }),
        _ => other_function(function, arguments),
    }
}

fn float_function(function: BuiltIn, x: f64) -> Option<Value> {
    Some(Value::Float(match function {
        BuiltIn::Radians => x.to_radians(),
        BuiltIn::Degrees => x.to_degrees(),
        BuiltIn::Sin => libm::sin(x),
        BuiltIn::Cos => libm::cos(x),
        BuiltIn::Tan => libm::tan(x),
        BuiltIn::Asin => libm::asin(x),
        BuiltIn::Acos => libm::acos(x),
        BuiltIn::Atan => libm::atan(x),
        BuiltIn::Sinh => libm::sinh(x),
        BuiltIn::Cosh => libm::cosh(x),
        BuiltIn::Tanh => libm::tanh(x),
        BuiltIn::Asinh => libm::asinh(x),
        BuiltIn::Acosh => libm::acosh(x),
        BuiltIn::Atanh => libm::atanh(x),
        BuiltIn::Exp => libm::exp(x),
        BuiltIn::Log => libm::log(x),
        BuiltIn::Exp2 => libm::exp2(x),
        BuiltIn::Log2 => libm::log2(x),
        BuiltIn::Sqrt => x.sqrt(),
        BuiltIn::InverseSqrt => 1.0 / x.sqrt(),
        BuiltIn::Abs => x.abs(),
        BuiltIn::Sign if x == 0.0 => 0.0,
        BuiltIn::Sign => x.signum(),
        BuiltIn::Floor => x.floor(),
        BuiltIn::Trunc => x.trunc(),
        BuiltIn::Round => x.round(),
        BuiltIn::RoundEven => x.round_ties_even(),
        BuiltIn::Ceil => x.ceil(),
        BuiltIn::Fract => x - x.floor(),
        // Derivatives of constants are zero (§8.9).
        BuiltIn::DFdx | BuiltIn::DFdy | BuiltIn::Fwidth => 0.0,
        BuiltIn::IsNan => return Some(Value::Bool(x.is_nan())),
        BuiltIn::IsInf => return Some(Value::Bool(x.is_infinite())),
        BuiltIn::FloatBitsToInt => return Some(Value::Int((x as f32).to_bits().cast_signed())),
        BuiltIn::FloatBitsToUint => return Some(Value::Uint((x as f32).to_bits())),
        _ => return None,
    }))
}

fn binary_float_function(function: BuiltIn, x: f64, y: f64) -> Option<Value> {
    Some(Value::Float(match function {
        BuiltIn::Atan => libm::atan2(x, y),
        BuiltIn::Pow if x >= 0.0 => libm::pow(x, y),
        BuiltIn::Mod => x - y * (x / y).floor(),
        BuiltIn::Min => glsl_min(x, y),
        BuiltIn::Max => glsl_max(x, y),
        BuiltIn::Step => f64::from(u8::from(y >= x)),
        _ => return relational(function, Value::Float(x), Value::Float(y)),
    }))
}

fn other_function(function: BuiltIn, arguments: &[Value]) -> Option<Value> {
    Some(match (function, arguments) {
        (BuiltIn::Abs, [Value::Int(x)]) => Value::Int(x.wrapping_abs()),
        (BuiltIn::Sign, [Value::Int(x)]) => Value::Int(x.signum()),
        (BuiltIn::IntBitsToFloat, [Value::Int(x)]) => {
            Value::Float(f64::from(f32::from_bits(x.cast_unsigned())))
        }
        (BuiltIn::UintBitsToFloat, [Value::Uint(x)]) => Value::Float(f64::from(f32::from_bits(*x))),
        (BuiltIn::Not, [Value::Bool(x)]) => Value::Bool(!x),
        (BuiltIn::Min, [Value::Int(x), Value::Int(y)]) => Value::Int(*x.min(y)),
        (BuiltIn::Min, [Value::Uint(x), Value::Uint(y)]) => Value::Uint(*x.min(y)),
        (BuiltIn::Max, [Value::Int(x), Value::Int(y)]) => Value::Int(*x.max(y)),
        (BuiltIn::Max, [Value::Uint(x), Value::Uint(y)]) => Value::Uint(*x.max(y)),
        (BuiltIn::Clamp, [Value::Int(x), Value::Int(y), Value::Int(z)]) => Value::Int(*x.max(y).min(z)),
        (BuiltIn::Clamp, [Value::Uint(x), Value::Uint(y), Value::Uint(z)]) => Value::Uint(*x.max(y).min(z)),
        (_, &[a, b]) => return relational(function, a, b),
        _ => return None,
    })
}

/// Evaluates a vector relational function (§8.7).
fn relational(function: BuiltIn, a: Value, b: Value) -> Option<Value> {
    use std::cmp::Ordering;
    Some(Value::Bool(match function {
        BuiltIn::Equal => a == b,
        BuiltIn::NotEqual => a != b,
        BuiltIn::LessThan => compare(a, b)? == Some(Ordering::Less),
        BuiltIn::GreaterThan => compare(a, b)? == Some(Ordering::Greater),
        BuiltIn::LessThanEqual => compare(a, b)?.is_some_and(Ordering::is_le),
        BuiltIn::GreaterThanEqual => compare(a, b)?.is_some_and(Ordering::is_ge),
        _ => return None,
    }))
}

fn booleans(function: BuiltIn, arguments: &[Constant]) -> Option<bool> {
    let mut all = arguments.first()?.components().iter();
    match function {
        BuiltIn::Any => Some(all.any(|&value| value == Value::Bool(true))),
        BuiltIn::All => Some(all.all(|&value| value == Value::Bool(true))),
        _ => None,
    }
}

/// The components of each argument, if all are floats.
fn floats(arguments: &[Constant]) -> Option<Vec<Vec<f64>>> {
    let float = |value: &Value| match value {
        Value::Float(value) => Some(*value),
        _ => None,
    };
    arguments
        .iter()
        .map(|argument| argument.components().iter().map(float).collect())
        .collect()
}

/// Evaluates a matrix function (§8.6).
fn matrix_function(function: BuiltIn, arguments: &[Constant]) -> Option<Vec<Value>> {
    let (columns, rows) = match arguments.first()?.ty {
        Type::Matrix { columns, rows } => (usize::from(columns), usize::from(rows)),
        // The arguments of `outerProduct`.
        _ => (1, 1),
    };
    let result = match (function, &floats(arguments)?[..]) {
        (BuiltIn::MatrixCompMult, [a, b]) => a.iter().zip(b).map(|(a, b)| a * b).collect(),
        (BuiltIn::OuterProduct, [column, row]) => outer_product(column, row).components(),
        (BuiltIn::Transpose, [m]) => (0..rows)
            .flat_map(|row| (0..columns).map(move |column| m[column * rows + row]))
            .collect(),
        (BuiltIn::Determinant, [m]) => vec![determinant(&Matrix::new(m, rows))],
        (BuiltIn::Inverse, [m]) => inverse(&Matrix::new(m, rows)).components(),
        _ => return None,
    };
    Some(result.into_iter().map(Value::Float).collect())
}

/// Evaluates a geometric function (§8.5).
fn geometric(function: BuiltIn, arguments: &[Constant]) -> Option<Vec<Value>> {
    let vectors = floats(arguments)?;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let along = |a: &[f64], s: f64, b: &[f64]| a.iter().zip(b).map(|(a, b)| a + s * b).collect::<Vec<_>>();
    let result = match (function, &vectors[..]) {
        (BuiltIn::Length, [a]) => vec![dot(a, a).sqrt()],
        (BuiltIn::Distance, [a, b]) => {
            let between = along(a, -1.0, b);
            vec![dot(&between, &between).sqrt()]
        }
        (BuiltIn::Dot, [a, b]) => vec![dot(a, b)],
        (BuiltIn::Cross, [a, b]) => match (&a[..], &b[..]) {
            ([a, b, c], [x, y, z]) => vec![b * z - y * c, c * x - z * a, a * y - x * b],
            _ => return None,
        },
        (BuiltIn::Normalize, [a]) => {
            let length = dot(a, a).sqrt();
            a.iter().map(|a| a / length).collect()
        }
        (BuiltIn::Faceforward, [n, i, reference]) if dot(reference, i) < 0.0 => n.clone(),
        (BuiltIn::Faceforward, [n, ..]) => n.iter().map(|n| -n).collect(),
        (BuiltIn::Reflect, [i, n]) => along(i, -2.0 * dot(n, i), n),
        (BuiltIn::Refract, [i, n, eta]) => {
            let (eta, cosine) = (*eta.first()?, dot(n, i));
            let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
            if k < 0.0 {
                vec![0.0; i.len()]
            } else {
                let scaled: Vec<_> = i.iter().map(|i| eta * i).collect();
                along(&scaled, -(eta * cosine + k.sqrt()), n)
            }
        }
        _ => return None,
    };
    Some(result.into_iter().map(Value::Float).collect())
}

/// GLSL's `min` (§8.3): y if it is less than x, otherwise x, also if one is NaN.
fn glsl_min(x: f64, y: f64) -> f64 {
    if y < x { y } else { x }
}

fn glsl_max(x: f64, y: f64) -> f64 {
    if x < y { y } else { x }
}
