//! Constructors and conversions (§5.4).

use toyproof_glsl::tree::{Constructor, ExprId, Place, Scalar, Type};

use super::{Builder, Result, layout};
use crate::ir::function::{NONE, Value};
use crate::ir::operation::{Kind, Operation};
use crate::observe::{Fault, Predicate};

impl Builder<'_> {
    pub(super) fn construct(
        &mut self,
        constructor: Constructor,
        ty: Type,
        arguments: &[ExprId],
    ) -> Result<Vec<Value>> {
        let composite = matches!(constructor, Constructor::Struct | Constructor::Array);
        let mut values = Vec::new();
        for &argument in arguments {
            let components = self.expression(argument)?;
            if composite {
                values.extend(components);
                continue;
            }
            let (Some(from), Some(to)) = (self.ty(argument).scalar(), ty.scalar()) else {
                continue;
            };
            // What is left over of the last argument is not converted: it may be out of range.
            let wanted = match constructor {
                Constructor::Scalar | Constructor::Splat | Constructor::Diagonal => 1,
                Constructor::Resize => components.len(),
                _ => layout::size(self.tree, ty) - values.len(),
            };
            let at = self.at(argument);
            for value in components.into_iter().take(wanted) {
                let converted = self.convert(value, from, to, at);
                values.push(self.settle(converted));
            }
        }
        Ok(match (constructor, ty) {
            (Constructor::Splat, _) => vec![values[0]; layout::size(self.tree, ty)],
            (Constructor::Diagonal, Type::Matrix { columns, rows }) => {
                let zero = self.float(0.0);
                each(
                    columns,
                    rows,
                    |column, row| if column == row { values[0] } else { zero },
                )
            }
            (Constructor::Resize, Type::Matrix { columns, rows }) => {
                let Some(Type::Matrix {
                    columns: old_columns,
                    rows: old_rows,
                }) = arguments.first().map(|&argument| self.ty(argument))
                else {
                    return Ok(values);
                };
                let (zero, one) = (self.float(0.0), self.float(1.0));
                each(columns, rows, |column, row| {
                    if column < old_columns && row < old_rows {
                        values[usize::from(column * old_rows + row)]
                    } else if column == row {
                        one
                    } else {
                        zero
                    }
                })
            }
            _ => values,
        })
    }

    /// A scalar as another type of scalar (§5.4.1).
    fn convert(&mut self, value: Value, from: Scalar, to: Scalar, at: Place) -> Value {
        match (from, to) {
            (Scalar::Float, Scalar::Float)
            | (Scalar::Bool, Scalar::Bool)
            | (Scalar::Int | Scalar::Uint, Scalar::Int | Scalar::Uint) => value,
            (Scalar::Bool, Scalar::Float) => {
                let (one, zero) = (self.float(1.0), self.float(0.0));
                self.select(value, one, zero, Kind::Float)
            }
            (Scalar::Bool, Scalar::Int | Scalar::Uint) => {
                let one = self.word(1);
                self.binary(Operation::And, value, one)
            }
            (Scalar::Int, Scalar::Float) => self.unary(Operation::FromInt, value),
            (Scalar::Uint, Scalar::Float) => self.unary(Operation::FromUint, value),
            (Scalar::Float, Scalar::Int) => {
                self.check(Fault::IntegerOverflow, at, Predicate::NoInt, [value, NONE]);
                self.unary(Operation::ToInt, value)
            }
            (Scalar::Float, Scalar::Uint) => {
                self.check(Fault::IntegerOverflow, at, Predicate::NoUint, [value, NONE]);
                self.unary(Operation::ToUint, value)
            }
            (Scalar::Float, Scalar::Bool) => {
                let zero = self.float(0.0);
                self.binary(Operation::NotEqual, value, zero)
            }
            (Scalar::Int | Scalar::Uint, Scalar::Bool) => {
                let zero = self.word(0);
                let equal = self.binary(Operation::EqualWord, value, zero);
                self.unary(Operation::Not, equal)
            }
        }
    }
}

/// The components of a matrix, column by column.
fn each(columns: u8, rows: u8, component: impl Fn(u8, u8) -> Value) -> Vec<Value> {
    let component = &component;
    (0..columns)
        .flat_map(|column| (0..rows).map(move |row| component(column, row)))
        .collect()
}
