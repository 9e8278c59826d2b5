//! Values of constant expressions.

use std::sync::Arc;

use super::Type;

/// The value of a scalar.
///
/// Floats are `f64`: a literal is its nearest `f64`, and constant expressions are evaluated in `f64`. What the specification asks
/// of such values (array sizes, indices, labels) is integers, and who evaluates the shader evaluates its constants anew from
/// the tree, in the number type it is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// Of a `bool`.
    Bool(bool),
    /// Of an `int`.
    Int(i32),
    /// Of a `uint`.
    Uint(u32),
    /// Of a `float`.
    Float(f64),
}

/// The value of an expression of any type.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Its type.
    pub ty: Type,
    /// Its scalars: components in column order, members in order, elements in order.
    pub scalars: Arc<[Value]>,
}

impl Constant {
    /// One scalar.
    #[must_use]
    pub fn scalar(value: Value) -> Self {
        Self {
            ty: value.ty(),
            scalars: Arc::new([value]),
        }
    }

    /// The value of an `int` or `uint`.
    #[must_use]
    pub fn integer(&self) -> Option<i64> {
        match (self.ty, &*self.scalars) {
            (Type::Scalar(_), [Value::Int(value)]) => Some(i64::from(*value)),
            (Type::Scalar(_), [Value::Uint(value)]) => Some(i64::from(*value)),
            _ => None,
        }
    }
}

impl Value {
    /// `bool`, `int`, `uint` or `float`.
    #[must_use]
    pub fn ty(self) -> Type {
        match self {
            Self::Bool(_) => Type::BOOL,
            Self::Int(_) => Type::INT,
            Self::Uint(_) => Type::UINT,
            Self::Float(_) => Type::FLOAT,
        }
    }
}
