//! Values as lists of components, and places: the components of a variable that an lvalue denotes.

use toyproof::glsl::tree::{Scalar, Tree, Type, VariableId};

use super::real::Real;

/// A scalar: a component of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Component<N> {
    /// A `bool`.
    Bool(bool),
    /// An `int`.
    Int(i32),
    /// A `uint`.
    Uint(u32),
    /// A `float`.
    Float(N),
}

/// A value of any type: its components in order of columns, members and elements; none for `void`.
pub(super) type Value<N> = Vec<Component<N>>;

impl<N: Real> Component<N> {
    /// The zero of a scalar type.
    pub(super) fn zero(scalar: Scalar) -> Self {
        match scalar {
            Scalar::Bool => Self::Bool(false),
            Scalar::Int => Self::Int(0),
            Scalar::Uint => Self::Uint(0),
            Scalar::Float => Self::float(0.0),
        }
    }

    pub(super) fn float(value: f64) -> Self {
        Self::Float(N::from_f64(value))
    }

    /// The number of a `float`.
    pub(super) fn real(self) -> N {
        match self {
            Self::Float(value) => value,
            other => panic!("{other:?} is not a float"),
        }
    }

    /// The value of a `bool`.
    pub(super) fn truth(self) -> bool {
        match self {
            Self::Bool(value) => value,
            other => panic!("{other:?} is not a bool"),
        }
    }

    /// The bits of an `int` or a `uint`.
    pub(super) fn bits(self) -> u32 {
        match self {
            Self::Int(value) => value.cast_unsigned(),
            Self::Uint(value) => value,
            other => panic!("{other:?} is not an integer"),
        }
    }

    /// An integer of the same type.
    pub(super) fn with_bits(self, bits: u32) -> Self {
        match self {
            Self::Int(_) => Self::Int(bits.cast_signed()),
            _ => Self::Uint(bits),
        }
    }

    /// Whether it is another value than zero or `false`.
    pub(super) fn is_not_zero(self) -> bool {
        match self {
            Self::Bool(value) => value,
            Self::Int(_) | Self::Uint(_) => self.bits() != 0,
            Self::Float(value) => value != N::from_f64(0.0),
        }
    }

    /// Whether it is equal to another of the same type, as `==` compares them.
    pub(super) fn equals(self, other: Self) -> bool {
        match (self, other) {
            (Self::Float(a), Self::Float(b)) => a == b,
            _ => self == other,
        }
    }
}

/// The numbers of a value of floats.
pub(super) fn reals<N: Real>(value: &[Component<N>]) -> Vec<N> {
    value.iter().map(|component| component.real()).collect()
}

/// A value of floats.
pub(super) fn floats<N: Real>(numbers: impl IntoIterator<Item = N>) -> Value<N> {
    numbers.into_iter().map(Component::Float).collect()
}

/// The zero of a type.
pub(super) fn zero<N: Real>(tree: &Tree, ty: Type) -> Value<N> {
    tree.scalars(ty).into_iter().map(Component::zero).collect()
}

/// The number of components of a type.
pub(super) fn size(tree: &Tree, ty: Type) -> usize {
    tree.scalars(ty).len()
}

/// The type of the elements that an index selects from, and their number.
pub(super) fn elements(tree: &Tree, ty: Type) -> (Type, usize) {
    match ty {
        Type::Array(id) => (tree.array(id).element, tree.array(id).size as usize),
        Type::Matrix { columns, rows } => (Type::vector(Scalar::Float, rows), columns.into()),
        Type::Vector(scalar, size) => (Type::Scalar(scalar), size.into()),
        other => panic!("{other:?} has no elements"),
    }
}

/// The position of the first component of a member among those of its structure.
pub(super) fn member_start(tree: &Tree, structure: Type, member: usize) -> usize {
    let Type::Struct(id) = structure else {
        panic!("{structure:?} is not a structure");
    };
    tree[id].members[..member]
        .iter()
        .map(|member| size(tree, member.ty))
        .sum()
}

/// The part of a variable that an lvalue denotes.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) variable: VariableId,
    /// The positions of its components among those of the variable.
    pub(super) components: Vec<usize>,
}
