//! Expressions (GLSL ES 3.00.6 §5).

use super::{BinaryOp, BuiltIn, FunctionId, Id, Place, StepOp, Type, UnaryOp, Value, VariableId};

/// Names an expression of a tree.
pub type ExprId = Id<Expr>;

/// An expression: typed, placed, and child of exactly one expression or statement, so that a pass may
/// change it where it stands.
#[derive(Debug, Clone)]
pub struct Expr {
    /// What it does.
    pub kind: ExprKind,
    /// The type of its value; the operands have exactly the types that the specification asks for: every
    /// conversion stands in the tree as a constructor.
    pub ty: Type,
    /// Whether it is a constant expression (§4.3.3); [`Tree::value`](super::Tree::value) then computes it.
    pub constant: bool,
    /// Where it stands.
    pub at: Place,
}

/// What an expression does. Operands are evaluated from left to right; `&&`, `||` and `?:` evaluate only
/// what they need.
#[derive(Debug, Clone)]
pub enum ExprKind {
    /// A number, or `true` or `false`.
    Literal(Literal),
    /// A variable's value, or the variable itself where an lvalue is asked for.
    Variable(VariableId),
    /// `-x`, `+x`, `!x`, `~x`.
    Unary {
        /// Which.
        op: UnaryOp,
        /// On what.
        operand: ExprId,
    },
    /// `a + b`, `a && b`, …
    Binary {
        /// Which.
        op: BinaryOp,
        /// The left side.
        left: ExprId,
        /// The right side.
        right: ExprId,
    },
    /// `a = b`, `a += b`, …: the value is what `target` then holds.
    Assign {
        /// The operation of `+=` and the like; none for `=`.
        op: Option<BinaryOp>,
        /// An lvalue; its indices are evaluated once.
        target: ExprId,
        /// What is assigned.
        value: ExprId,
    },
    /// `++x`, `x--`, …
    Step {
        /// Which.
        op: StepOp,
        /// Whether the value is that before the step: `x++`.
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
    /// `a, b`: both, the value is that of the second.
    Sequence {
        /// Evaluated first.
        first: ExprId,
        /// The value.
        second: ExprId,
    },
    /// A call of one of the author's functions. `in` arguments are copied in; `out` and `inout` arguments are
    /// lvalues, copied back after the call (§6.1.1).
    Call {
        /// Which.
        function: FunctionId,
        /// One for each parameter, of its type.
        arguments: Vec<ExprId>,
    },
    /// A call of a built-in function; the signature is told by the types of arguments and value.
    BuiltIn {
        /// Which.
        function: BuiltIn,
        /// As written.
        arguments: Vec<ExprId>,
    },
    /// `vec3(…)`, `Ray(…)`, `float[](…)`: makes a value of the expression's type.
    Construct {
        /// How.
        constructor: Constructor,
        /// As written.
        arguments: Vec<ExprId>,
    },
    /// `v.xy`.
    Swizzle {
        /// A vector.
        vector: ExprId,
        /// Which components.
        components: Swizzle,
    },
    /// `s.m`.
    Member {
        /// Of structure type.
        structure: ExprId,
        /// The index into [`Struct::members`](super::Struct::members).
        member: usize,
    },
    /// `a[i]` of an array, a matrix (a column) or a vector (a component).
    Index {
        /// What is indexed.
        base: ExprId,
        /// An `int` or `uint`; in range if it is a constant expression.
        index: ExprId,
    },
    /// `a.length()` of an array: a constant expression.
    Length {
        /// The array; it has no side effects that count.
        array: ExprId,
    },
}

/// A number as written, with the value it stands for.
#[derive(Debug, Clone, PartialEq)]
pub struct Literal {
    /// As written: `.5`, `1e3`, `0x1Fu`, `true`.
    pub text: Box<str>,
    /// What it stands for; floats as the nearest `f64`.
    pub value: Value,
}

/// How a constructor makes its value (§5.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Constructor {
    /// `float(x)`: the first component of one scalar, vector or matrix, converted. Under `lenient` also what an
    /// implicit conversion of a scalar becomes.
    Scalar,
    /// `vec3(s)`: a scalar in every component.
    Splat,
    /// `vec3(a, b, …)`, `vec3(v4)`, `ivec2(v2)`: the components of the arguments in order, converted; those left
    /// over in the last argument are not used.
    Vector,
    /// `mat3(s)`: a scalar along the diagonal, zero elsewhere.
    Diagonal,
    /// `mat3(m)`: another matrix's components where it has them, the identity's elsewhere.
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
    /// Those components, of which there are one to four.
    #[must_use]
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
    #[must_use]
    pub fn components(&self) -> &[u8] {
        &self.components[..usize::from(self.len)]
    }

    /// How many there are: the size of the value.
    #[must_use]
    pub fn size(self) -> u8 {
        self.len
    }

    /// Whether a component stands in it twice, as in `v.xx`: then it is no lvalue (§5.5).
    #[must_use]
    pub fn repeats(&self) -> bool {
        let mut seen = [false; 4];
        self.components()
            .iter()
            .any(|&c| std::mem::replace(&mut seen[usize::from(c)], true))
    }

    /// As written with x, y, z, w.
    #[must_use]
    pub fn name(&self) -> String {
        self.components()
            .iter()
            .map(|&c| char::from(b"xyzw"[usize::from(c)]))
            .collect()
    }
}

/// The one list of what is an operand: `$visit` gets a reference to each, in the order of evaluation.
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

    /// Calls `visit` with each operand, in the order of evaluation, to put another in its place.
    pub fn for_each_operand_mut(&mut self, mut visit: impl FnMut(&mut ExprId)) {
        visit_operands!(self, visit);
    }
}
