//! Types (GLSL ES 3.00.6 §4.1).

use super::{Id, Place};

/// A type; `Copy`, and equal exactly if it is the same type: arrays and structures are named by id, and
/// [`Tree::array_of`](super::Tree::array_of) makes each array type once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Type {
    /// `void`: of functions that return nothing.
    Void,
    /// `bool`, `int`, `uint`, `float`.
    Scalar(Scalar),
    /// `vec3`, `ivec2`, …: 2, 3 or 4 components.
    Vector(Scalar, u8),
    /// `mat3`, `mat2x4`, …: 2, 3 or 4 columns of 2, 3 or 4 floats.
    Matrix {
        /// How many columns: the first number of `mat2x4`.
        columns: u8,
        /// How many rows: the second number of `mat2x4`.
        rows: u8,
    },
    /// `sampler2D`, `isamplerCube`, …
    Sampler(Sampler),
    /// A structure of the author.
    Struct(StructId),
    /// An array of known size.
    Array(ArrayId),
    /// Of an expression in which an error was found and told: it fits everywhere, so that one mistake is
    /// told once. Never in a tree that `check` returns.
    #[default]
    Error,
}

/// `bool`, `int`, `uint` or `float`: also what vectors are made of.
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

/// A sampler type: what a texture is made of and how it is looked up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// What a texel's components are: `float`, `int` or `uint`.
    pub texel: Scalar,
    /// The texture's shape.
    pub shape: SamplerShape,
    /// Whether it compares depths (`sampler2DShadow`).
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

/// Names an array type of a tree.
pub type ArrayId = Id<ArrayType>;

/// An array type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ArrayType {
    /// The type of an element; an array only under `lenient` (arrays of arrays are of ES 3.10).
    pub element: Type,
    /// How many; at least 1.
    pub size: u32,
}

/// Names a structure of a tree.
pub type StructId = Id<Struct>;

/// A structure type. Each declaration is a type of its own, whatever its name (§4.1.8).
#[derive(Debug, Clone)]
pub struct Struct {
    /// The author's name for it; empty for `struct { … } x;`.
    pub name: String,
    /// Its members, at least one.
    pub members: Vec<Member>,
    /// Where the name (or the word `struct`) stands.
    pub at: Place,
}

/// A member of a structure.
#[derive(Debug, Clone)]
pub struct Member {
    /// The author's name for it.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// Where its name stands.
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

    /// The vector of that many components; the scalar itself for one.
    #[must_use]
    pub fn vector(scalar: Scalar, size: u8) -> Self {
        match size {
            1 => Self::Scalar(scalar),
            _ => Self::Vector(scalar, size),
        }
    }

    /// What its components are: of scalars, vectors and matrices.
    #[must_use]
    pub fn scalar(self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) | Self::Vector(scalar, _) => Some(scalar),
            Self::Matrix { .. } => Some(Scalar::Float),
            _ => None,
        }
    }

    /// How many components a scalar, vector or matrix has.
    #[must_use]
    pub fn component_count(self) -> Option<u8> {
        match self {
            Self::Scalar(_) => Some(1),
            Self::Vector(_, size) => Some(size),
            Self::Matrix { columns, rows } => Some(columns * rows),
            _ => None,
        }
    }

    /// The same shape of another scalar: `ivec3` for `vec3` and `int`. Of scalars and vectors only.
    #[must_use]
    pub fn with_scalar(self, scalar: Scalar) -> Option<Self> {
        match self {
            Self::Scalar(_) => Some(Self::Scalar(scalar)),
            Self::Vector(_, size) => Some(Self::Vector(scalar, size)),
            _ => None,
        }
    }
}

impl Scalar {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Int => "int",
            Self::Uint => "uint",
            Self::Float => "float",
        }
    }

    /// What the names of its vectors begin with: `ivec3`.
    #[must_use]
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

    /// The word for it: `isampler2DArray`.
    #[must_use]
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

    /// The sampler of floats of that shape.
    #[must_use]
    pub const fn float(shape: SamplerShape) -> Self {
        Self {
            texel: Scalar::Float,
            shape,
            shadow: false,
        }
    }
}
