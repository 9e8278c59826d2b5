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
///
/// Arrays and structures share their parts with what they were made of, so that a copy, an element and a constructor
/// take no more time than they have parts themselves.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Its type.
    pub ty: Type,
    content: Content,
}

#[derive(Debug, Clone, PartialEq)]
enum Content {
    /// Of a scalar.
    One(Value),
    /// Of a vector or matrix, in column order.
    Components(Arc<[Value]>),
    /// Of a structure or array: the members or elements in order, and how many scalars they have together.
    Parts(Arc<[Constant]>, usize),
}

impl Constant {
    /// One scalar.
    #[must_use]
    pub fn scalar(value: Value) -> Self {
        Self {
            ty: value.ty(),
            content: Content::One(value),
        }
    }

    /// A scalar, vector or matrix with those components, in column order.
    #[must_use]
    pub fn of_components(ty: Type, components: Vec<Value>) -> Self {
        let content = match components[..] {
            [only] => Content::One(only),
            _ => Content::Components(components.into()),
        };
        Self { ty, content }
    }

    /// A structure or array with those members or elements.
    #[must_use]
    pub fn of_parts(ty: Type, parts: Vec<Self>) -> Self {
        let counts = parts.iter().map(Self::scalar_count);
        let count = counts.fold(0, usize::saturating_add);
        let content = Content::Parts(parts.into(), count);
        Self { ty, content }
    }

    /// The components of a scalar, vector or matrix, in column order; none of structures and arrays.
    #[must_use]
    pub fn components(&self) -> &[Value] {
        match &self.content {
            Content::One(value) => std::slice::from_ref(value),
            Content::Components(values) => values,
            Content::Parts(..) => &[],
        }
    }

    /// The members of a structure or the elements of an array; none of other values.
    #[must_use]
    pub fn parts(&self) -> &[Self] {
        match &self.content {
            Content::Parts(parts, _) => parts,
            Content::One(_) | Content::Components(_) => &[],
        }
    }

    /// How many scalars it has, at all depths.
    #[must_use]
    pub fn scalar_count(&self) -> usize {
        match &self.content {
            Content::One(_) => 1,
            Content::Components(values) => values.len(),
            Content::Parts(_, count) => *count,
        }
    }

    /// The value of an `int` or `uint`.
    #[must_use]
    pub fn integer(&self) -> Option<i64> {
        match self.content {
            Content::One(Value::Int(value)) => Some(i64::from(value)),
            Content::One(Value::Uint(value)) => Some(i64::from(value)),
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
