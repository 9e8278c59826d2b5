//! What a profiled program counts: the operations as they are written, before any optimization.

use toyproof_glsl::tree::{ExprId, FunctionId, Place};

use super::operation::Operation;
use super::schema::{Call, CallId};

/// Where an operation comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Origin {
    /// The call that contains it; none in `mainImage` and at global scope.
    pub call: Option<CallId>,
    /// The source location: of an operator that of its right operand, whose line it is on in a long
    /// expression.
    pub at: Place,
    /// The expression; none of what a statement does itself.
    pub expr: Option<ExprId>,
}

/// A part of a program whose executions are counted. A function that is inlined twice has its parts twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The kind of the part.
    pub kind: PartKind,
    /// The source location: of a branch or a loop that of its condition, else its own.
    pub at: Place,
    /// The enclosing part, of those that are not statements.
    pub parent: Option<PartId>,
}

/// Identifies a part of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PartId(pub u32);

/// The kind of a [`Part`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PartKind {
    /// The body of a function.
    Function(FunctionId),
    /// A statement, or the condition of a loop or an `else if`.
    Statement,
    /// What an `if` executes.
    If,
    /// What an `else` executes.
    Else,
    /// The body of a loop.
    Loop,
    /// The statements of a `case` or `default`.
    Case,
    /// The value of `?:` if the condition is true.
    Yes,
    /// The value of `?:` if the condition is false.
    No,
    /// The right operand of `&&` or `||`.
    Right,
}

/// Code without jumps: the same pixels execute all of it.
#[derive(Debug, Clone, Default)]
pub(crate) struct BasicBlock {
    /// The number of operations of each origin.
    pub(crate) operations: Vec<(Origin, u64)>,
    /// The parts that begin in it.
    pub(crate) parts: Vec<PartId>,
    /// The number of components of texels that are read of each channel.
    pub(crate) texels: [u64; 4],
}

impl BasicBlock {
    /// Adds operations.
    pub(crate) fn add(&mut self, origin: Origin, cost: u64) {
        match self.operations.last_mut() {
            Some((last, count)) if *last == origin => *count += cost,
            _ => self.operations.push((origin, cost)),
        }
    }

    /// Returns the number of operations.
    pub(crate) fn cost(&self) -> u64 {
        self.operations.iter().map(|(_, count)| count).sum()
    }
}

/// What a profiled program counts.
#[derive(Debug, Clone, Default)]
pub(crate) struct ProfileSchema {
    pub(crate) blocks: Vec<BasicBlock>,
    pub(crate) parts: Vec<Part>,
    pub(crate) calls: Vec<Call>,
}

/// Returns the number of operations that an operation counts as: 1, or as many as compute an elementary
/// function in strict images.
pub(crate) fn cost(operation: Operation) -> u64 {
    use Operation as O;
    use toyproof_math as math;
    let graph = math::ExprGraph::default();
    let (x, y) = (graph.argument(0), graph.argument(1));
    match operation {
        O::Sin => math::sin(x),
        O::Cos => math::cos(x),
        O::Tan => math::tan(x),
        O::Asin => math::asin(x),
        O::Acos => math::acos(x),
        O::Atan => math::atan(x),
        O::Atan2 => math::atan2(y, x),
        O::Sinh => math::sinh(x),
        O::Cosh => math::cosh(x),
        O::Tanh => math::tanh(x),
        O::Asinh => math::asinh(x),
        O::Acosh => math::acosh(x),
        O::Atanh => math::atanh(x),
        O::Exp => math::exp(x),
        O::Exp2 => math::exp2(x),
        O::Log => math::log(x),
        O::Log2 => math::log2(x),
        O::Pow => math::pow(x, y),
        _ => return 1,
    };
    graph.operations() as u64
}
