//! Operators (GLSL ES 3.00.6 §5.1).

/// The unary operators that have no side effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// `+x`.
    Plus,
    /// `-x`.
    Minus,
    /// `!x` of a `bool`.
    Not,
    /// `~x` of integers.
    BitNot,
}

/// `++` or `--`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StepOp {
    /// `++`.
    Increment,
    /// `--`.
    Decrement,
}

/// The binary operators; `=` and `,` have expressions of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// `a * b`: also the linear-algebraic product of matrices and vectors (§5.9).
    Multiply,
    /// `a / b`.
    Divide,
    /// `a % b` of integers.
    Remainder,
    /// `a + b`.
    Add,
    /// `a - b`.
    Subtract,
    /// `a << b`.
    ShiftLeft,
    /// `a >> b`.
    ShiftRight,
    /// `a < b` of scalars.
    Less,
    /// `a > b` of scalars.
    Greater,
    /// `a <= b` of scalars.
    LessEqual,
    /// `a >= b` of scalars.
    GreaterEqual,
    /// `a == b` of any type but samplers: one `bool`.
    Equal,
    /// `a != b` of any type but samplers: one `bool`.
    NotEqual,
    /// `a & b`.
    BitAnd,
    /// `a ^ b`.
    BitXor,
    /// `a | b`.
    BitOr,
    /// `a && b`: evaluates `b` only if `a` is true.
    And,
    /// `a ^^ b`.
    Xor,
    /// `a || b`: evaluates `b` only if `a` is false.
    Or,
}

impl BinaryOp {
    /// The operator that says the same with its sides exchanged: `a < b` is `b > a`. Itself for all that are no order.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Self::Less => Self::Greater,
            Self::Greater => Self::Less,
            Self::LessEqual => Self::GreaterEqual,
            Self::GreaterEqual => Self::LessEqual,
            other => other,
        }
    }
}

impl UnaryOp {
    /// The operator as written.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Plus => "+",
            Self::Minus => "-",
            Self::Not => "!",
            Self::BitNot => "~",
        }
    }
}

impl StepOp {
    /// The operator as written.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Increment => "++",
            Self::Decrement => "--",
        }
    }
}

impl BinaryOp {
    /// The operator as written.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Remainder => "%",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::ShiftLeft => "<<",
            Self::ShiftRight => ">>",
            Self::Less => "<",
            Self::Greater => ">",
            Self::LessEqual => "<=",
            Self::GreaterEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::BitAnd => "&",
            Self::BitXor => "^",
            Self::BitOr => "|",
            Self::And => "&&",
            Self::Xor => "^^",
            Self::Or => "||",
        }
    }

    /// How tightly it binds, from 1 (`||`) to 11 (`*`), as in the table of §5.1; all group to the left.
    #[must_use]
    pub fn precedence(self) -> u8 {
        match self {
            Self::Multiply | Self::Divide | Self::Remainder => 11,
            Self::Add | Self::Subtract => 10,
            Self::ShiftLeft | Self::ShiftRight => 9,
            Self::Less | Self::Greater | Self::LessEqual | Self::GreaterEqual => 8,
            Self::Equal | Self::NotEqual => 7,
            Self::BitAnd => 6,
            Self::BitXor => 5,
            Self::BitOr => 4,
            Self::And => 3,
            Self::Xor => 2,
            Self::Or => 1,
        }
    }
}
