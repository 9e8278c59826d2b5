//! Types (GLSL ES 3.00.6 §4.1), and values of constant expressions.

use std::sync::Arc;

use super::{Id, Place};

/// A type. It is `Copy`; two are equal if and only if they are the same type: arrays and structures are
/// identified by id, and [`Tree::array_of`](super::Tree::array_of) creates each array type once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Type {
    /// `void`, the return type of functions without a result.
    Void,
    /// `bool`, `int`, `uint`, `float`.
    Scalar(Scalar),
    /// `vec3`, `ivec2`, …: 2, 3 or 4 components.
    Vector(Scalar, u8),
    /// `mat3`, `mat2x4`, …: 2, 3 or 4 columns of 2, 3 or 4 floats.
    Matrix {
        /// The number of columns: the first number of `mat2x4`.
        columns: u8,
        /// The number of rows: the second number of `mat2x4`.
        rows: u8,
    },
    /// `sampler2D`, `isamplerCube`, …
    Sampler(Sampler),
    /// A user-defined structure.
    Struct(StructId),
    /// An array of known size.
    Array(ArrayId),
    /// The type of an expression whose error has been reported. It fits everywhere, so that each error is
    /// reported once. Never in a tree that `check` returns.
    #[default]
    Error,
}

/// A scalar type, also the component type of vectors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// `bool`.
    Bool,
    /// `int`: 32 bits, two's complement, wrapping.
    Int,
    /// `uint`: 32 bits, wrapping.
    Uint,
    /// `float`.
    Float,
}

/// A sampler type: texel type, shape, and whether it compares depths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// The type of a texel's components: `float`, `int` or `uint`.
    pub texel: Scalar,
    /// The texture's shape.
    pub shape: SamplerShape,
    /// Whether the sampler compares depths (`sampler2DShadow`).
    pub shadow: bool,
}

/// The shape of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SamplerShape {
    /// `sampler2D`.
    D2,
    /// `sampler3D`.
    D3,
    /// `samplerCube`.
    Cube,
    /// `sampler2DArray`.
    D2Array,
}

/// The id of an array type.
pub type ArrayId = Id<ArrayType>;

/// An array type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ArrayType {
    /// The element type; an array only under `lenient` (GLSL ES 3.10 has arrays of arrays).
    pub element: Type,
    /// The number of elements, at least 1.
    pub size: u32,
}

/// The id of a structure.
pub type StructId = Id<Struct>;

/// A structure type. Each declaration is a distinct type, whatever its name (§4.1.8).
#[derive(Debug, Clone)]
pub struct Struct {
    /// The name; empty for `struct { … } x;`.
    pub name: String,
    /// The members, at least one.
    pub members: Vec<Member>,
    /// The place of the structure's name, or of the keyword `struct`.
    pub at: Place,
}

/// A member of a structure.
#[derive(Debug, Clone)]
pub struct Member {
    /// The name.
    pub name: String,
    /// The type.
    pub ty: Type,
    /// The place of the member's name.
    pub at: Place,
}

impl Type {
    /// `bool`.
    pub const BOOL: Self = Self::Scalar(Scalar::Bool);
    /// `int`.
    pub const INT: Self = Self::Scalar(Scalar::Int);
    /// `uint`.
    pub const UINT: Self = Self::Scalar(Scalar::Uint);
    /// `float`.
    pub const FLOAT: Self = Self::Scalar(Scalar::Float);

    /// The vector type with `size` components; the scalar itself for one.
    pub fn vector(scalar: Scalar, size: u8) -> Self {
        match size {
            1 => Self::Scalar(scalar),
            _ => Self::Vector(scalar, size),
        }
    }

    /// The component type of a scalar, vector or matrix.
    pub fn scalar(self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) | Self::Vector(scalar, _) => Some(scalar),
            Self::Matrix { .. } => Some(Scalar::Float),
            _ => None,
        }
    }

    /// The number of components of a scalar, vector or matrix.
    pub fn component_count(self) -> Option<u8> {
        match self {
            Self::Scalar(_) => Some(1),
            Self::Vector(_, size) => Some(size),
            Self::Matrix { columns, rows } => Some(columns * rows),
            _ => None,
        }
    }

    /// The type of the same shape with a different component type: `ivec3` for `vec3` and `int`. For scalars
    /// and vectors only.
    pub fn with_scalar(self, scalar: Scalar) -> Option<Self> {
        match self {
            Self::Scalar(_) => Some(Self::Scalar(scalar)),
            Self::Vector(_, size) => Some(Self::Vector(scalar, size)),
            _ => None,
        }
    }
}

impl Scalar {
    /// The name in GLSL.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Int => "int",
            Self::Uint => "uint",
            Self::Float => "float",
        }
    }

    /// The prefix of the names of vector types with such components: `i` in `ivec3`.
    pub fn vector_prefix(self) -> &'static str {
        match self {
            Self::Bool => "b",
            Self::Int => "i",
            Self::Uint => "u",
            Self::Float => "",
        }
    }
}

impl Sampler {
    /// `sampler2D`.
    pub const D2: Self = Self::float(SamplerShape::D2);

    /// The name in GLSL: `isampler2DArray`.
    pub fn name(self) -> String {
        let shape = match self.shape {
            SamplerShape::D2 => "2D",
            SamplerShape::D3 => "3D",
            SamplerShape::Cube => "Cube",
            SamplerShape::D2Array => "2DArray",
        };
        let shadow = if self.shadow { "Shadow" } else { "" };
        format!("{}sampler{shape}{shadow}", self.texel.vector_prefix())
    }

    /// The float sampler of a shape.
    pub const fn float(shape: SamplerShape) -> Self {
        Self {
            texel: Scalar::Float,
            shape,
            shadow: false,
        }
    }
}

// Values of constant expressions.

/// The value of a scalar.
///
/// Floats are `f64`: a literal is the nearest `f64`, and constant expressions are evaluated in `f64`. The
/// specification requires only integers of such values (array sizes, indices, labels); consumers that
/// evaluate the shader recompute its constants from the tree in their own number type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A `bool`.
    Bool(bool),
    /// An `int`.
    Int(i32),
    /// A `uint`.
    Uint(u32),
    /// A `float`.
    Float(f64),
}

/// The value of an expression of any type.
///
/// Arrays and structures share their parts with the values they were made from, so that a copy, an element
/// access and a constructor take time proportional to their direct parts only.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// The type.
    pub ty: Type,
    content: Content,
}

#[derive(Debug, Clone, PartialEq)]
enum Content {
    /// A scalar.
    One(Value),
    /// A vector or matrix, in column order.
    Components(Arc<[Value]>),
    /// A structure or array: the members or elements in order, and their total number of scalars.
    Parts(Arc<[Constant]>, usize),
}

impl Constant {
    /// Makes a scalar.
    pub fn scalar(value: Value) -> Self {
        Self {
            ty: value.ty(),
            content: Content::One(value),
        }
    }

    /// Makes a scalar, vector or matrix from its components, in column order.
    pub fn of_components(ty: Type, components: Vec<Value>) -> Self {
        let content = match components[..] {
            [only] => Content::One(only),
            _ => Content::Components(components.into()),
        };
        Self { ty, content }
    }

    /// Makes a structure or array from its members or elements.
    pub fn of_parts(ty: Type, parts: Vec<Self>) -> Self {
        let counts = parts.iter().map(Self::scalar_count);
        let count = counts.fold(0, usize::saturating_add);
        let content = Content::Parts(parts.into(), count);
        Self { ty, content }
    }

    /// The components of a scalar, vector or matrix, in column order; empty for structures and arrays.
    pub fn components(&self) -> &[Value] {
        match &self.content {
            Content::One(value) => std::slice::from_ref(value),
            Content::Components(values) => values,
            Content::Parts(..) => &[],
        }
    }

    /// The members of a structure or the elements of an array; empty for other values.
    pub fn parts(&self) -> &[Self] {
        match &self.content {
            Content::Parts(parts, _) => parts,
            Content::One(_) | Content::Components(_) => &[],
        }
    }

    /// The total number of scalars at all depths.
    pub fn scalar_count(&self) -> usize {
        match &self.content {
            Content::One(_) => 1,
            Content::Components(values) => values.len(),
            Content::Parts(_, count) => *count,
        }
    }

    /// The value of an `int` or `uint`; `None` for other types.
    pub fn integer(&self) -> Option<i64> {
        match self.content {
            Content::One(Value::Int(value)) => Some(i64::from(value)),
            Content::One(Value::Uint(value)) => Some(i64::from(value)),
            _ => None,
        }
    }
}

impl Value {
    /// The scalar type of the value.
    pub fn ty(self) -> Type {
        match self {
            Self::Bool(_) => Type::BOOL,
            Self::Int(_) => Type::INT,
            Self::Uint(_) => Type::UINT,
            Self::Float(_) => Type::FLOAT,
        }
    }
}
