//! What operations give whose result GLSL leaves undefined.

/// The treatment of operations that GLSL leaves undefined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UndefinedPolicy {
    /// Compute what strict GPU runs compute, and record each occurrence.
    Observed,
    /// Compute what strict GPU runs compute, without records.
    Plain,
    /// Substitute a different result: a pixel that is the same under all substitutes does not depend on
    /// undefined operations.
    Substitute(Substitute),
}

/// The result substituted for an undefined operation.
///
/// All are needed to find the dependencies: a number may be hidden by a multiplication with zero, and NaN by
/// comparisons, which are all false.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Substitute {
    /// A number.
    Number,
    /// NaN.
    NotANumber,
    /// What other implementations return for `pow`, which is the power of the absolute value, and zero for
    /// all other operations.
    OtherImplementation,
}

impl Substitute {
    /// All substitutes.
    pub const ALL: [Self; 3] = [Self::Number, Self::NotANumber, Self::OtherImplementation];
}
