//! Expressions and operators (GLSL ES 3.00.6 §5).

use super::{BuiltIn, FunctionId, Id, Place, Type, Value, VariableId};

/// The id of an expression.
pub type ExprId = Id<Expr>;

/// An expression. Each is the child of exactly one expression or statement, so that a pass may change it in
/// place.
#[derive(Debug, Clone)]
pub struct Expr {
    /// The operation.
    pub kind: ExprKind,
    /// The type of the value. Operands have exactly the types that the specification requires: every
    /// conversion is an explicit constructor.
    pub ty: Type,
    /// Whether this is a constant expression (§4.3.3), which [`Tree::value`](super::Tree::value) evaluates.
    pub constant: bool,
    /// The place in the source text.
    pub at: Place,
}

/// The kind of an expression. Operands are evaluated from left to right; `&&`, `||` and `?:` short-circuit.
#[derive(Debug, Clone, PartialEq)]
pub enum ExprKind {
    /// A number, or `true` or `false`.
    Literal(Literal),
    /// A variable: its value, or an lvalue.
    Variable(VariableId),
    /// `-x`, `+x`, `!x`, `~x`.
    Unary {
        /// The operator.
        op: UnaryOp,
        /// The operand.
        operand: ExprId,
    },
    /// `a + b`, `a && b`, …
    Binary {
        /// The operator.
        op: BinaryOp,
        /// The left side.
        left: ExprId,
        /// The right side.
        right: ExprId,
    },
    /// `a = b`, `a += b`, …: the value is that of `target` after the assignment.
    Assign {
        /// The operator of a compound assignment such as `+=`; `None` for `=`.
        op: Option<BinaryOp>,
        /// An lvalue; its indices are evaluated once.
        target: ExprId,
        /// The right side.
        value: ExprId,
    },
    /// `++x`, `x--`, …
    Step {
        /// The operator.
        op: StepOp,
        /// Whether this is the postfix form `x++`, whose value is that before the step.
        postfix: bool,
        /// An lvalue; its indices are evaluated once.
        target: ExprId,
    },
    /// `condition ? yes : no`.
    Conditional {
        /// A `bool`.
        condition: ExprId,
        /// The value if true.
        yes: ExprId,
        /// The value if false.
        no: ExprId,
    },
    /// `a, b`: evaluates both; the value is that of the second.
    Sequence {
        /// Evaluated first.
        first: ExprId,
        /// The value.
        second: ExprId,
    },
    /// A call of a user function. `in` arguments are copied in; `out` and `inout` arguments are lvalues,
    /// copied back after the call (§6.1.1).
    Call {
        /// The function.
        function: FunctionId,
        /// One argument for each parameter, of its type.
        arguments: Vec<ExprId>,
    },
    /// A call of a built-in function; the types of arguments and value determine the signature.
    BuiltIn {
        /// The function.
        function: BuiltIn,
        /// The arguments as written.
        arguments: Vec<ExprId>,
    },
    /// `vec3(…)`, `Ray(…)`, `float[](…)`: makes a value of the expression's type.
    Construct {
        /// The kind of constructor.
        constructor: Constructor,
        /// The arguments as written.
        arguments: Vec<ExprId>,
    },
    /// `v.xy`.
    Swizzle {
        /// A vector.
        vector: ExprId,
        /// The selected components.
        components: Swizzle,
    },
    /// `s.m`.
    Member {
        /// An expression of structure type.
        structure: ExprId,
        /// The index into [`Struct::members`](super::Struct::members).
        member: usize,
    },
    /// `a[i]` of an array, a matrix (a column) or a vector (a component).
    Index {
        /// The indexed value.
        base: ExprId,
        /// An `int` or `uint`; in range if it is a constant expression.
        index: ExprId,
    },
    /// `a.length()` of an array, a constant expression.
    Length {
        /// The array; its side effects do not count.
        array: ExprId,
    },
}

/// A literal with its text and value.
#[derive(Debug, Clone, PartialEq)]
pub struct Literal {
    /// As written: `.5`, `1e3`, `0x1Fu`, `true`.
    pub text: Box<str>,
    /// The value; floats as the nearest `f64`.
    pub value: Value,
}

impl From<Value> for Literal {
    fn from(value: Value) -> Self {
        let text = match value {
            Value::Bool(value) => value.to_string(),
            Value::Int(value) => value.to_string(),
            Value::Uint(value) => format!("{value}u"),
            Value::Float(value) => format!("{value:?}"),
        };
        Self::new(text, value)
    }
}

impl Literal {
    /// A literal as it is written, with its value.
    pub fn new(text: impl Into<Box<str>>, value: Value) -> Self {
        Self {
            text: text.into(),
            value,
        }
    }
}

/// The kind of a constructor (§5.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Constructor {
    /// `float(x)`: the first component of one scalar, vector or matrix, converted. Under `lenient` also an
    /// implicit conversion of a scalar.
    Scalar,
    /// `vec3(s)`: a scalar in every component.
    Splat,
    /// `vec3(a, b, …)`, `vec3(v4)`, `ivec2(v2)`: the components of the arguments in order, converted; surplus
    /// components of the last argument are dropped.
    Vector,
    /// `mat3(s)`: a scalar along the diagonal, zero elsewhere.
    Diagonal,
    /// `mat3(m)`: the components of a matrix of a different size where it has them, otherwise the identity's.
    Resize,
    /// `mat2(a, b, …)`, `mat2(v4)`: components in column order.
    Matrix,
    /// `Ray(o, d)`: one argument for each member, of its type.
    Struct,
    /// `float[2](a, b)`: one argument for each element, of its type.
    Array,
}

/// Up to four components of a vector: 0 for x, r, s to 3 for w, a, q.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Swizzle {
    components: [u8; 4],
    len: u8,
}

impl Swizzle {
    /// Makes a swizzle of one to four components; `None` for other counts or components over 3.
    pub fn new(components: &[u8]) -> Option<Self> {
        if components.is_empty() || components.len() > 4 || components.iter().any(|&c| c > 3) {
            return None;
        }
        let mut all = [0; 4];
        all[..components.len()].copy_from_slice(components);
        Some(Self {
            components: all,
            len: components.len() as u8,
        })
    }

    /// The components in order.
    pub fn components(&self) -> &[u8] {
        &self.components[..usize::from(self.len)]
    }

    /// The number of components: the size of the value.
    pub fn size(self) -> u8 {
        self.len
    }

    /// Whether a component occurs twice, as in `v.xx`: then it is not an lvalue (§5.5).
    pub fn repeats(&self) -> bool {
        let mut seen = [false; 4];
        self.components()
            .iter()
            .any(|&c| std::mem::replace(&mut seen[usize::from(c)], true))
    }

    /// The swizzle in x, y, z, w.
    pub fn name(&self) -> String {
        self.components()
            .iter()
            .map(|&c| char::from(b"xyzw"[usize::from(c)]))
            .collect()
    }
}

/// The only list of operands: `$visit` gets a reference to each, in the order of evaluation.
macro_rules! visit_operands {
    ($kind:expr, $visit:ident) => {
        match $kind {
            Self::Literal(_) | Self::Variable(_) => {}
            Self::Unary { operand: only, .. }
            | Self::Step { target: only, .. }
            | Self::Swizzle { vector: only, .. }
            | Self::Member { structure: only, .. }
            | Self::Length { array: only } => $visit(only),
            Self::Binary {
                left: a, right: b, ..
            }
            | Self::Assign {
                target: a, value: b, ..
            }
            | Self::Sequence { first: a, second: b }
            | Self::Index { base: a, index: b } => {
                $visit(a);
                $visit(b);
            }
            Self::Conditional { condition, yes, no } => {
                $visit(condition);
                $visit(yes);
                $visit(no);
            }
            Self::Call { arguments, .. }
            | Self::BuiltIn { arguments, .. }
            | Self::Construct { arguments, .. } => {
                for argument in arguments {
                    $visit(argument);
                }
            }
        }
    };
}

impl ExprKind {
    /// Calls `visit` with each operand, in the order of evaluation.
    pub fn for_each_operand(&self, mut visit: impl FnMut(ExprId)) {
        let mut visit = |operand: &ExprId| visit(*operand);
        visit_operands!(self, visit);
    }

    /// Calls `visit` with a mutable reference to each operand, in the order of evaluation.
    pub fn for_each_operand_mut(&mut self, mut visit: impl FnMut(&mut ExprId)) {
        visit_operands!(self, visit);
    }
}

// Operators (GLSL ES 3.00.6 §5.1).

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

/// The binary operators; `=` and `,` are separate expressions.
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
    /// `a == b` for all types except samplers; the result is one `bool`.
    Equal,
    /// `a != b` for all types except samplers; the result is one `bool`.
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
    /// The operator with exchanged sides: `a < b` is `b > a`. Operators other than comparisons are unchanged.
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
    /// The operator's symbol in GLSL.
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
    /// The operator's symbol in GLSL.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Increment => "++",
            Self::Decrement => "--",
        }
    }
}

impl BinaryOp {
    /// The operator's symbol in GLSL.
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

    /// The precedence, from 1 (`||`) to 11 (`*`), as in the table of §5.1; all are left-associative.
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
