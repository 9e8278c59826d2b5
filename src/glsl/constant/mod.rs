//! What constant expressions are worth (§4.3.3), as far as the rules ask: array sizes, indices, labels, and constants that they
//! are made of.
//!
//! Floats are computed in `f64`, integers in 32 wrapping bits. What the specification leaves undefined (division of an integer by zero, a shift
//! too far, a float too large for its integer) has no value, nor have the built-in functions on matrices and packed floats.

mod arithmetic;
mod builtin;

use std::sync::Arc;

use super::tree::{Constant, Constructor, ExprId, ExprKind, Scalar, Tree, Type, UnaryOp, Value};

/// The most scalars that a value may have; structures of structures could have 2⁶⁰.
const MAX_SCALARS: usize = 1 << 18;

impl Tree {
    /// The value of a constant expression; none if it is none, or its value cannot be told.
    #[must_use]
    pub fn value(&self, root: ExprId) -> Option<Constant> {
        if !self[root].constant {
            return None;
        }
        // Operands come before what uses them, so their values lie on top of this stack. A loop, for chains of any length.
        let mut values: Vec<Option<Constant>> = Vec::new();
        for expr in self.postorder(root) {
            let mut operands = 0;
            self[expr].kind.for_each_operand(|_| operands += 1);
            let operands = values.split_off(values.len() - operands);
            values.push(self.value_of(expr, operands));
        }
        values.pop().flatten()
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
        let scalars: Arc<[Value]> = match (&self[expr].kind, &operands[..]) {
            (ExprKind::Literal(literal), _) => [literal.value].into(),
            (ExprKind::Variable(variable), _) => self[*variable].value.as_ref()?.scalars.clone(),
            (ExprKind::Unary { op, .. }, [a]) => {
                a.scalars.iter().map(|&a| unary(*op, a)).collect::<Option<_>>()?
            }
            (ExprKind::Binary { op, .. }, [a, b]) => arithmetic::binary(*op, a, b)?.into(),
            (ExprKind::Conditional { .. }, [condition, yes, no]) => match condition.scalars[..] {
                [Value::Bool(true)] => yes.scalars.clone(),
                [Value::Bool(false)] => no.scalars.clone(),
                _ => return None,
            },
            (ExprKind::Construct { constructor, .. }, arguments) => {
                construct(*constructor, ty, arguments)?.into()
            }
            (ExprKind::BuiltIn { function, .. }, arguments) => {
                builtin::call(*function, ty, arguments)?.into()
            }
            (ExprKind::Swizzle { components, .. }, [vector]) => components
                .components()
                .iter()
                .map(|&component| vector.scalars.get(usize::from(component)).copied())
                .collect::<Option<_>>()?,
            (ExprKind::Member { member, .. }, [structure]) => {
                let Type::Struct(id) = structure.ty else {
                    return None;
                };
                let before = &self[id].members[..*member];
                let start = before
                    .iter()
                    .map(|member| self.scalar_count(member.ty))
                    .sum::<Option<usize>>()?;
                structure
                    .scalars
                    .get(start..start + self.scalar_count(ty)?)?
                    .into()
            }
            (ExprKind::Index { .. }, [base, index]) => {
                let size = self.scalar_count(ty)?;
                let start = usize::try_from(index.integer()?).ok()?.checked_mul(size)?;
                base.scalars.get(start..start + size)?.into()
            }
            _ => return None,
        };
        (scalars.len() <= MAX_SCALARS).then_some(Constant { ty, scalars })
    }

    /// How many scalars a type has; none for those without, and those with more than a constant may have.
    fn scalar_count(&self, ty: Type) -> Option<usize> {
        let count = match ty {
            Type::Scalar(_) | Type::Vector(..) | Type::Matrix { .. } => usize::from(ty.component_count()?),
            Type::Array(id) => self
                .scalar_count(self.array(id).element)?
                .checked_mul(self.array(id).size as usize)?,
            Type::Struct(id) => {
                let mut sum = 0;
                for member in &self[id].members {
                    sum += self.scalar_count(member.ty)?;
                    if sum > MAX_SCALARS {
                        return None;
                    }
                }
                sum
            }
            Type::Void | Type::Sampler(_) | Type::Error => return None,
        };
        (count <= MAX_SCALARS).then_some(count)
    }
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

/// §5.4.
fn construct(constructor: Constructor, ty: Type, arguments: &[Constant]) -> Option<Vec<Value>> {
    let all = || {
        arguments
            .iter()
            .flat_map(|argument| argument.scalars.iter().copied())
    };
    if matches!(constructor, Constructor::Struct | Constructor::Array) {
        let total: usize = arguments.iter().map(|argument| argument.scalars.len()).sum();
        return (total <= MAX_SCALARS).then(|| all().collect());
    }
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
            let [
                Constant {
                    ty: Type::Matrix { columns, rows },
                    scalars,
                },
            ] = arguments
            else {
                return None;
            };
            of_matrix(&|column, row| {
                if column < *columns && row < *rows {
                    scalars.get(usize::from(column * rows + row)).copied()
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
