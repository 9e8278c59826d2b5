//! Statements (GLSL ES 3.00.6 §6).

use super::{ExprId, Place, StructId, VariableId};

/// Statements in order. Its nesting is bounded by [`MAX_NESTING`](crate::MAX_NESTING); `else if` chains do not nest.
pub type Block = Vec<Statement>;

/// A statement.
#[derive(Debug, Clone)]
pub struct Statement {
    /// What it does.
    pub kind: StatementKind,
    /// Where it stands, up to its `;`; of statements that hold others, the word or `{` that they begin with.
    pub at: Place,
}

/// What a statement does.
#[derive(Debug, Clone)]
pub enum StatementKind {
    /// `f(x);`, `x = 1.;`.
    Expression(ExprId),
    /// Declares a local variable, in scope from here to the end of the enclosing block; its initialiser, if
    /// any, runs each time. `float a, b;` is two of these.
    Declare(VariableId),
    /// Declares a structure inside of a function.
    Struct(StructId),
    /// `{ … }`: a scope of its own.
    Block(Block),
    /// `if (a) … else if (b) … else …`.
    If {
        /// The conditions with what they guard, in order; at least one.
        arms: Vec<Arm>,
        /// What the last `else` guards.
        otherwise: Option<Block>,
    },
    /// `switch`.
    Switch {
        /// An `int` or `uint`.
        selector: ExprId,
        /// In order; control falls from one into the next (§6.2). All share one scope.
        cases: Vec<Case>,
    },
    /// `for (init; condition; step) …`.
    For {
        /// Declarations, or one expression; the loop is the scope of what they declare.
        init: Block,
        /// Endless if there is none.
        condition: Option<Condition>,
        /// Evaluated after each iteration and by `continue`.
        step: Option<ExprId>,
        /// The body.
        body: Block,
    },
    /// `while (condition) …`.
    While {
        /// Evaluated before each iteration.
        condition: Condition,
        /// The body.
        body: Block,
    },
    /// `do … while (condition);`.
    DoWhile {
        /// The body.
        body: Block,
        /// A `bool`, evaluated after each iteration and by `continue`.
        condition: ExprId,
    },
    /// `break;`.
    Break,
    /// `continue;`.
    Continue,
    /// `return;` or `return x;`: of exactly the function's type.
    Return(Option<ExprId>),
    /// `discard;`.
    Discard,
}

/// One condition of an `if` with what it guards.
#[derive(Debug, Clone)]
pub struct Arm {
    /// A `bool`.
    pub condition: ExprId,
    /// What runs if it is true and no earlier one was.
    pub body: Block,
}

/// The condition of a `for` or `while`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// A `bool`.
    Expression(ExprId),
    /// `while (bool b = f())`: a `bool` with initialiser, declared and tested before each iteration.
    Declare(VariableId),
}

/// The labels at one place of a `switch`, and the statements that follow them.
#[derive(Debug, Clone)]
pub struct Case {
    /// At least one: `case 0: case 1:` stand together.
    pub labels: Vec<Label>,
    /// The statements up to the next label; they end in no implied `break`.
    pub body: Block,
    /// Where the first label stands.
    pub at: Place,
}

/// A label of a `switch`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Label {
    /// `case x:`.
    Case {
        /// As written, of the selector's type.
        expr: ExprId,
        /// Its value; an `int` as its bits.
        value: u32,
    },
    /// `default:`.
    Default,
}

impl StatementKind {
    /// Whether it holds other statements.
    #[must_use]
    pub fn is_compound(&self) -> bool {
        matches!(
            self,
            Self::Block(_)
                | Self::If { .. }
                | Self::Switch { .. }
                | Self::For { .. }
                | Self::While { .. }
                | Self::DoWhile { .. }
        )
    }
}
