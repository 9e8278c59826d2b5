//! What generated functions compute: the keys by which each is generated once.

use toyproof_glsl::tree::{BuiltIn, VariableId};

/// The operation of a helper function; each is instantiated for its argument types.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Helper {
    /// Returns its argument, hidden from constant evaluation.
    Runtime,
    /// Floored `%`.
    Remainder,
    /// `normalize` of a float.
    Normalize,
    /// `faceforward` of floats.
    Faceforward,
    /// `refract` of floats.
    Refract,
    /// `reflect` of floats.
    Reflect,
    /// A 2×2 matrix of a `vec4`.
    Matrix,
    /// `matrixCompMult`.
    MatrixCompMult,
    /// `outerProduct`.
    OuterProduct,
    /// `inverse`.
    Inverse,
    /// `isnan`.
    IsNan,
    /// `isinf`.
    IsInf,
    /// `modf`.
    Modf,
    /// `==` of structures and arrays.
    Equal,
    /// A structure or an array of zeros.
    Zero,
    /// A structure of its members; [`super::member`] gives it a body.
    Make,
}

/// An operation to expand, instantiated for the types of its arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Expansion {
    /// A built-in function.
    Function(BuiltIn),
    /// `*` of matrices and vectors.
    Product,
    /// The conversion of a `uint` to the nearest float.
    UintToFloat,
    /// A filtered lookup of a channel, whose texture is this variable.
    Lookup {
        texture: VariableId,
        channel: u8,
        level: Level,
    },
    /// The level of the mipmaps for derivatives in texels.
    LevelOfDetail,
    /// This number of coordinates, which `textureProj` divides by the last component.
    Projection(u8),
    /// The face of a cube map that a direction points to, and the place on it.
    CubePlace,
    /// The derivative of that place, from a direction and its derivative.
    CubeGradient,
}

/// What determines the level of the mipmaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Level {
    /// The derivatives of the coordinates.
    Implicit,
    /// These derivatives, and an argument that is added to the level.
    Biased,
    /// An argument.
    Given,
    /// The derivatives in two arguments.
    Gradient,
    /// None: a single texel of a level is fetched.
    Fetched,
    /// None: the size of a level is returned.
    Size,
}
