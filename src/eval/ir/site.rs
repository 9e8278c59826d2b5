//! Sites: the source locations at which an operation may be at fault.

use toyproof_glsl::tree::Place;

/// Identifies a site: a fault at a source location.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SiteId(pub u32);

/// A fault of an operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    /// An index out of bounds: the last element is used.
    IndexOutOfBounds,
    /// An integer divided by zero: the result is the dividend, as naga guards it.
    DivisionByZero,
    /// The remainder by zero: the result is zero.
    RemainderByZero,
    /// Zero divided by zero where constant propagation sees both: each driver folds it to a value of its
    /// choice.
    ZeroByZero,
    /// A shift by 32 or more, or by a negative count: the lowest five bits of the count are used.
    ShiftTooFar,
    /// A float out of range of `int` or `uint`: the nearest representable value is used.
    IntegerOverflow,
    /// `smoothstep` between equal edges.
    EqualEdges,
    /// `smoothstep` with edge0 > edge1: all implementations compute the formula.
    ReversedEdges,
    /// `pow` of a negative base, or of zero to zero or less.
    PowDomain,
    /// `min`, `max` or `clamp` of NaN.
    NotANumber,
    /// `clamp` with its minimum above its maximum.
    ReversedClamp,
    /// `sqrt` of a negative number, `inversesqrt` of zero or less.
    RootDomain,
    /// `log` or `log2` of zero or less.
    LogDomain,
    /// `asin` or `acos` outside [−1, 1], `acosh` below 1, `atanh` outside (−1, 1).
    ArcDomain,
    /// `atan(0, 0)`.
    ArcOfNothing,
    /// The size of a mip level that the texture does not have.
    NoLevel,
    /// A texture lookup at coordinates that are infinite, NaN, or too large to identify a texel.
    NoPlace,
    /// A derivative in non-uniform control flow: not all pixels of the quad are active.
    NonUniformDerivative,
    /// A read of an uninitialized variable: zero, as in WebGL.
    NeverWritten,
}

impl Fault {
    /// Whether implementations differ in the result, so that the pixel is excluded from comparisons.
    ///
    /// Roots, logarithms and inverse functions outside of their domain are NaN everywhere, reversed edges
    /// follow the formula, and uninitialized variables are zero in WebGL.
    #[must_use]
    pub fn is_undefined(self) -> bool {
        !matches!(
            self,
            Self::ReversedEdges
                | Self::RootDomain
                | Self::LogDomain
                | Self::ArcDomain
                | Self::ArcOfNothing
                | Self::NeverWritten
        )
    }

    /// Returns the description for messages, such as `an index out of bounds`.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::IndexOutOfBounds => "an index out of bounds",
            Self::DivisionByZero => "an integer division by zero",
            Self::RemainderByZero => "the remainder of an integer division by zero",
            Self::ZeroByZero => "a division of two constant zeros",
            Self::ShiftTooFar => "a shift by 32 bits or more, or by a negative number",
            Self::IntegerOverflow => "a conversion of a float that is out of range of the integer type",
            Self::EqualEdges => "`smoothstep` with equal edges",
            Self::ReversedEdges => "`smoothstep` with reversed edges",
            Self::PowDomain => "`pow` of a negative base, or of base 0 and an exponent ≤ 0",
            Self::NotANumber => "`min`, `max` or `clamp` of NaN",
            Self::ReversedClamp => "`clamp` with a minimum above the maximum",
            Self::RootDomain => "`sqrt` of a negative number, or `inversesqrt` of a number ≤ 0",
            Self::LogDomain => "the logarithm of a number ≤ 0",
            Self::ArcDomain => "an inverse function outside its domain",
            Self::ArcOfNothing => "`atan(0, 0)`",
            Self::NoLevel => "`textureSize` of a mip level that does not exist",
            Self::NoPlace => "a texture lookup at infinite, NaN or very large coordinates",
            Self::NonUniformDerivative => "a derivative in non-uniform control flow",
            Self::NeverWritten => "a read of an uninitialized variable",
        }
    }
}

/// A fault that may occur at a source location.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Site {
    /// The fault.
    pub fault: Fault,
    /// The source location.
    pub at: Place,
}

/// The condition for a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Predicate {
    /// The word is at least this; negative indices are large words.
    AtLeast(u32),
    /// The word is zero.
    Zero,
    /// The float is out of range of `int`.
    NotInt,
    /// The float is out of range of `uint`.
    NotUint,
    /// At least one of the two is NaN.
    Unordered,
    /// The floats are equal.
    Equal,
    /// The first is greater than the second.
    Greater,
    /// The float is less than zero.
    Negative,
    /// The float is zero or less.
    NotPositive,
    /// The magnitude is greater than 1.
    BeyondOne,
    /// The magnitude is 1 or greater.
    AtLeastOne,
    /// The float is less than 1.
    BelowOne,
    /// Both are zero.
    BothZero,
    /// Both are zero; checked only where both operands are frame constants.
    ConstantZeros,
    /// `pow` is undefined.
    PowUndefined,
    /// The pixel is active and a pixel of its quad is not.
    PartialQuad,
}
