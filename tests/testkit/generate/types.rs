//! The types of generated programs.

/// The type of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Scalar {
    Int,
    Float,
    Uint,
    Bool,
}

pub(crate) const SCALARS: [Scalar; 4] = [Scalar::Int, Scalar::Float, Scalar::Uint, Scalar::Bool];

/// A type that is not an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Base {
    Scalar(Scalar),
    /// With 2 to 4 components.
    Vector(Scalar, u8),
    /// Columns, rows.
    Matrix(u8, u8),
    /// The index of one of the program's structures.
    Struct(u8),
}

/// A type, an array if it has a length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Type {
    pub(crate) base: Base,
    pub(crate) length: Option<u8>,
}

/// A structure's fields.
#[derive(Debug)]
pub(crate) struct Struct {
    pub(crate) fields: Vec<(&'static str, Type)>,
}

pub(crate) const INT: Type = Type::of(Base::Scalar(Scalar::Int));
pub(crate) const UINT: Type = Type::of(Base::Scalar(Scalar::Uint));
pub(crate) const FLOAT: Type = Type::of(Base::Scalar(Scalar::Float));
pub(crate) const BOOL: Type = Type::of(Base::Scalar(Scalar::Bool));

impl Base {
    /// Its GLSL name.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Scalar(Scalar::Float) => "float".into(),
            Self::Scalar(Scalar::Int) => "int".into(),
            Self::Scalar(Scalar::Uint) => "uint".into(),
            Self::Scalar(Scalar::Bool) => "bool".into(),
            Self::Vector(scalar, size) => {
                let letter = match scalar {
                    Scalar::Float => "",
                    Scalar::Int => "i",
                    Scalar::Uint => "u",
                    Scalar::Bool => "b",
                };
                format!("{letter}vec{size}")
            }
            Self::Matrix(columns, rows) if columns == rows => format!("mat{columns}"),
            Self::Matrix(columns, rows) => format!("mat{columns}x{rows}"),
            Self::Struct(number) => format!("S{number}"),
        }
    }

    /// The type of its components; none for a structure.
    pub(crate) fn scalar(self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) | Self::Vector(scalar, _) => Some(scalar),
            Self::Matrix(..) => Some(Scalar::Float),
            Self::Struct(_) => None,
        }
    }

    /// The scalar, or the vector of that size.
    pub(crate) fn sized(scalar: Scalar, size: u8) -> Self {
        if size == 1 {
            Self::Scalar(scalar)
        } else {
            Self::Vector(scalar, size)
        }
    }

    /// The number of components of a scalar or vector.
    pub(crate) fn size(self) -> u8 {
        match self {
            Self::Vector(_, size) => size,
            _ => 1,
        }
    }
}

impl Type {
    pub(crate) const fn of(base: Base) -> Self {
        Self { base, length: None }
    }

    /// Its GLSL name, as a constructor or in a declaration.
    pub(crate) fn name(self) -> String {
        match self.length {
            Some(length) => format!("{}[{length}]", self.base.name()),
            None => self.base.name(),
        }
    }

    /// Its elements' type.
    pub(crate) fn element(self) -> Self {
        Self::of(self.base)
    }

    /// Returns whether it is an operand of operators other than `=`, `==` and `!=`.
    pub(crate) fn is_basic(self) -> bool {
        self.length.is_none() && !matches!(self.base, Base::Struct(_))
    }

    /// Returns whether it is a float, or a vector or matrix of floats.
    pub(crate) fn is_float(self) -> bool {
        self.length.is_none() && self.base.scalar() == Some(Scalar::Float)
    }
}
