//! Ranges of numbers: what is known of a scalar's value.

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Input, UnaryOp, Value, VariableKind,
};

use super::super::program::Program;
use super::known::Known;

/// How deep an expression is looked into.
const MAX_DEPTH: u32 = 12;

/// The values that a scalar may have; `bool`s are 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub(super) least: f64,
    pub(super) most: f64,
}

impl Range {
    pub(super) const ANY: Self = Self {
        least: f64::NEG_INFINITY,
        most: f64::INFINITY,
    };
    pub(super) const NOT_NEGATIVE: Self = Self {
        least: 0.0,
        most: f64::INFINITY,
    };

    /// One number.
    pub(super) fn only(value: f64) -> Self {
        Self {
            least: value,
            most: value,
        }
    }

    /// The value of a literal or a constant.
    pub(super) fn of(value: Value) -> Self {
        Self::only(match value {
            Value::Bool(value) => f64::from(u8::from(value)),
            Value::Int(value) => f64::from(value),
            Value::Uint(value) => f64::from(value),
            Value::Float(value) => value,
        })
    }

    /// Whether all values of one compare so with all of another, where that is the same for all.
    pub(super) fn compare(self, op: BinaryOp, other: Self) -> Option<bool> {
        let less = |a: Self, b: Self| {
            if a.most < b.least {
                Some(true)
            } else if a.least >= b.most {
                Some(false)
            } else {
                None
            }
        };
        let equal = || {
            if self.least == self.most && self == other {
                Some(true)
            } else if self.most < other.least || other.most < self.least {
                Some(false)
            } else {
                None
            }
        };
        match op {
            BinaryOp::Less => less(self, other),
            BinaryOp::Greater => less(other, self),
            BinaryOp::LessEqual => less(other, self).map(|less| !less),
            BinaryOp::GreaterEqual => less(self, other).map(|less| !less),
            BinaryOp::Equal => equal(),
            BinaryOp::NotEqual => equal().map(|equal| !equal),
            _ => None,
        }
    }

    /// What is left of it when `op bound` held, or did not; none where that tells nothing. Whole numbers that are less are less by one.
    pub(super) fn narrowed(self, op: BinaryOp, holds: bool, bound: Self, whole: bool) -> Option<Self> {
        let gap = if whole { 1.0 } else { 0.0 };
        let mut range = self;
        match (op, holds) {
            (BinaryOp::Less, true) | (BinaryOp::GreaterEqual, false) => {
                range.most = range.most.min(bound.most - gap);
            }
            (BinaryOp::LessEqual, true) | (BinaryOp::Greater, false) => {
                range.most = range.most.min(bound.most);
            }
            (BinaryOp::Greater, true) | (BinaryOp::LessEqual, false) => {
                range.least = range.least.max(bound.least + gap);
            }
            (BinaryOp::GreaterEqual, true) | (BinaryOp::Less, false) => {
                range.least = range.least.max(bound.least);
            }
            (BinaryOp::Equal, true) | (BinaryOp::NotEqual, false) => range = bound,
            _ => return None,
        }
        Some(range)
    }
}

/// The values that an expression may have, where they are known.
pub(super) fn range(program: &Program, known: &Known, expr: ExprId, depth: u32) -> Option<Range> {
    let tree = program.tree;
    if depth > MAX_DEPTH {
        return None;
    }
    let of = |expr: ExprId| range(program, known, expr, depth + 1);
    match &tree[expr].kind {
        ExprKind::Literal(literal) => Some(Range::of(literal.value)),
        ExprKind::Variable(variable) => known.range(*variable).or_else(|| match tree[*variable].kind {
            VariableKind::Input(Input::Frame | Input::Time | Input::TimeDelta) => Some(Range::NOT_NEGATIVE),
            _ => match *program.constant(expr)?.components() {
                [value] => Some(Range::of(value)),
                _ => None,
            },
        }),
        ExprKind::Unary {
            op: UnaryOp::Minus,
            operand,
        } => {
            let Range { least, most } = of(*operand)?;
            Some(Range {
                least: -most,
                most: -least,
            })
        }
        &ExprKind::Binary {
            op: op @ (BinaryOp::Add | BinaryOp::Subtract),
            left,
            right,
        } => {
            let (a, b) = (of(left)?, of(right)?);
            Some(if op == BinaryOp::Add {
                Range {
                    least: a.least + b.least,
                    most: a.most + b.most,
                }
            } else {
                Range {
                    least: a.least - b.most,
                    most: a.most - b.least,
                }
            })
        }
        ExprKind::Construct {
            constructor: Constructor::Scalar,
            arguments,
        } => {
            let range = of(arguments[0])?;
            let whole = range.least.fract() == 0.0 && range.most.fract() == 0.0;
            whole.then_some(range)
        }
        ExprKind::BuiltIn { function, arguments } => match (function, &arguments[..]) {
            (BuiltIn::Min | BuiltIn::Max, &[a, b]) => {
                let (a, b) = (of(a), of(b));
                a.or(b)?;
                let (a, b) = (a.unwrap_or(Range::ANY), b.unwrap_or(Range::ANY));
                Some(if *function == BuiltIn::Min {
                    Range {
                        least: a.least.min(b.least),
                        most: a.most.min(b.most),
                    }
                } else {
                    Range {
                        least: a.least.max(b.least),
                        most: a.most.max(b.most),
                    }
                })
            }
            (BuiltIn::Abs | BuiltIn::Length | BuiltIn::Distance | BuiltIn::Sqrt | BuiltIn::Exp, _) => {
                Some(Range::NOT_NEGATIVE)
            }
            _ => None,
        },
        _ => None,
    }
}
