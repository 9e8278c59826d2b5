//! What constant expressions are worth (§4.3.3), as far as the rules ask: array sizes, indices, labels, and constants that they
//! are made of.
//!
//! Floats are computed in `f64`, integers in 32 wrapping bits. What the specification leaves undefined (division of an integer by zero, a shift
//! too far, a float too large for its integer) has no value, nor have the built-in functions on matrices and packed floats.

mod arithmetic;
mod builtin;

use super::tree::{Constant, Constructor, ExprId, ExprKind, Scalar, Tree, Type, UnaryOp, Value};

/// The most scalars that a value may have; structures of structures could have 2⁶⁰.
const MAX_SCALARS: usize = 1 << 18;

impl Tree {
    /// The value of a constant expression; none if it is none, or its value cannot be told. Takes constant time for expressions
    /// that [`Self::keep_value`] was called for.
    #[must_use]
    pub fn value(&self, root: ExprId) -> Option<Constant> {
        if !self[root].constant {
            return None;
        }
        if let Some(known) = self.kept_value(root) {
            return known;
        }
        // Operands come before what uses them, so their values lie on top of this stack. A loop, for chains of any length.
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
            } else if let Some(known) = self.kept_value(expr) {
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

    /// Computes the value of an expression once and for all, from those of its operands. Called for operands before what uses
    /// them, as expressions are made, this keeps the time for all values proportional to the size of the tree. Whoever rewrites
    /// the expression later must leave it its value, or unset [`Expr::constant`](super::tree::Expr::constant).
    pub fn keep_value(&mut self, expr: ExprId) {
        let is_literal = matches!(self[expr].kind, ExprKind::Literal(_));
        if self[expr].constant && !is_literal {
            let value = self.value(expr);
            self.values.insert(expr, value);
        }
    }

    /// Forgets all values that were kept: expressions were rewritten that others are made of.
    pub fn forget_values(&mut self) {
        self.values.clear();
    }

    /// What is known of a value without computing it: none of those that were not kept.
    #[expect(
        clippy::option_option,
        reason = "a value that is not known, and one that there is not"
    )]
    fn kept_value(&self, expr: ExprId) -> Option<Option<Constant>> {
        match &self[expr].kind {
            ExprKind::Literal(literal) => Some(Some(Constant::scalar(literal.value))),
            _ => self.values.get(&expr).cloned(),
        }
    }

    fn value_of(&self, expr: ExprId, operands: Vec<Option<Constant>>) -> Option<Constant> {
        let ty = self[expr].ty;
        if let ExprKind::Length { array } = self[expr].kind {
            // Known from the type, whatever the array holds.
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
            (ExprKind::Binary { op, .. }, [a, b]) => arithmetic::binary(*op, a, b)?,
            (ExprKind::Construct { constructor, .. }, arguments) => construct(*constructor, ty, arguments)?,
            (ExprKind::BuiltIn { function, .. }, arguments) => builtin::call(*function, ty, arguments)?,
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

/// An element of an array, a column of a matrix, or a component of a vector, of that type.
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

/// The components of a scalar, vector or matrix (§5.4).
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

/// A scalar as another type of scalar (§5.4.1).
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
