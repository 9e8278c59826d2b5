//! The tests of a function, as they are written.

use toyproof_diagnostic::Span;
use toyproof_toml::Literal;

use super::assertion::Assertion;
use super::source::Snippet;

/// The largest difference of a component of floats, unless a test states another: expected results are
/// written with a few digits.
pub const DEFAULT_TOLERANCE: f64 = 1e-4;

/// The largest number of tests in the comments of one shader, and of listed calls of one function.
pub const MAX_TESTS: usize = 256;

/// The tests of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionTest {
    /// The function's name.
    pub name: String,
    /// The points for a function that passes all tests, ≥ 0.
    pub points: f64,
    /// The precision of the evaluation; `None` for that of the command.
    pub precision: Option<Precision>,
    /// What is evaluated before each call, such as `makeScene()`.
    pub after: Option<Snippet>,
    /// The calls of the function.
    pub cases: FunctionCases,
}

/// The number types in which a function is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Float32.
    Single,
    /// Double precision.
    Double,
    /// One after the other.
    Both,
}

/// The calls of a test.
#[derive(Debug, Clone, PartialEq)]
pub enum FunctionCases {
    /// Calls and assertions, at least one of both.
    Written {
        /// Calls with given arguments.
        listed: Vec<ListedCall>,
        /// Comparisons of expressions.
        assertions: Vec<Assertion>,
    },
    /// The rays and spheres of [`toyproof_stress`] of typical size, for a function that
    /// intersects a ray with a sphere, whatever its signature.
    Stress,
}

/// A call of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedCall {
    /// Where it is written.
    pub at: Option<Span>,
    /// The values of the parameters that are not `out`. Lists represent vectors, matrices, arrays and
    /// structures.
    pub arguments: Vec<Literal>,
    /// The expected result, if it is compared.
    pub result: Option<Literal>,
    /// The expected values of the `out` and `inout` parameters, if they are compared.
    pub outputs: Option<Vec<Literal>>,
    /// The largest difference of a component from the expected value, relative to values above 1; by
    /// default [`DEFAULT_TOLERANCE`] for floats, and 0 for integers.
    pub tolerance: Option<f64>,
}
