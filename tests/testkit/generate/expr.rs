//! An expression's text, its precedence, and the range of its floats.

use super::types::{Scalar, Type};

/// Operator precedence, loosest first, as in the grammar of GLSL (§5.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    Sequence,
    Assignment,
    Conditional,
    LogicalOr,
    LogicalXor,
    LogicalAnd,
    Or,
    Xor,
    And,
    Equality,
    Relation,
    Shift,
    Sum,
    Product,
    Unary,
    Primary,
}

impl Level {
    /// The next tighter level.
    pub(crate) fn above(self) -> Self {
        const ALL: [Level; 16] = [
            Level::Sequence,
            Level::Assignment,
            Level::Conditional,
            Level::LogicalOr,
            Level::LogicalXor,
            Level::LogicalAnd,
            Level::Or,
            Level::Xor,
            Level::And,
            Level::Equality,
            Level::Relation,
            Level::Shift,
            Level::Sum,
            Level::Product,
            Level::Unary,
            Level::Primary,
        ];
        ALL[(self as usize + 1).min(ALL.len() - 1)]
    }
}

/// The range of floats: multiples of 2^-`grain` of at most `size`. While both fit 23 bits, arithmetic is
/// exact in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub(crate) size: f64,
    pub(crate) grain: i32,
}

impl Range {
    /// The range of variables.
    pub(crate) const VARIABLE: Self = Self { size: 64.0, grain: 4 };

    pub(crate) const fn new(size: f64, grain: i32) -> Self {
        Self { size, grain }
    }

    /// Returns whether it is contained in the other.
    pub(crate) fn fits(self, other: Self) -> bool {
        self.size <= other.size && self.grain <= other.grain
    }

    /// Returns whether such floats are exact in 32 bits.
    pub(crate) fn is_exact(self) -> bool {
        self.size.log2() + f64::from(self.grain) <= 23.0
    }

    /// The range of sums.
    pub(crate) fn sum(self, other: Self) -> Self {
        Self::new(self.size + other.size, self.grain.max(other.grain))
    }

    /// The range of sums of `count` products.
    pub(crate) fn products(self, other: Self, count: u8) -> Self {
        Self::new(
            self.size * other.size * f64::from(count),
            self.grain + other.grain,
        )
    }

    /// The union of both ranges.
    pub(crate) fn or(self, other: Self) -> Self {
        Self::new(self.size.max(other.size), self.grain.max(other.grain))
    }
}

/// A typed expression.
#[derive(Debug, Clone)]
pub(crate) struct Expr {
    pub(crate) text: String,
    pub(crate) level: Level,
    /// The range of its floats, if there are any.
    pub(crate) range: Range,
}

impl Expr {
    pub(crate) fn new(text: impl Into<String>, level: Level, range: Range) -> Self {
        Self {
            text: text.into(),
            level,
            range,
        }
    }

    /// A name, a literal, a call.
    pub(crate) fn primary(text: impl Into<String>, range: Range) -> Self {
        Self::new(text, Level::Primary, range)
    }

    /// An expression without floats, or with floats in the range of variables.
    pub(crate) fn plain(text: impl Into<String>, level: Level) -> Self {
        Self::new(text, level, Range::VARIABLE)
    }

    /// The text as an operand at this level, in parentheses if needed.
    pub(crate) fn at(&self, level: Level) -> String {
        if self.level < level {
            format!("({})", self.text)
        } else {
            self.text.clone()
        }
    }

    /// `left op right`, grouping from the left.
    pub(crate) fn binary(left: &Self, op: &str, right: &Self, level: Level, range: Range) -> Self {
        let (left, right) = (left.at(level), right.at(level.above()));
        Self::new(format!("{left} {op} {right}"), level, range)
    }

    /// `op operand`.
    pub(crate) fn unary(op: &str, operand: &Self) -> Self {
        let operand_text = operand.at(Level::Unary);
        // `- -x` is not `--x`.
        let gap = if operand_text.starts_with(op) { " " } else { "" };
        Self::new(format!("{op}{gap}{operand_text}"), Level::Unary, operand.range)
    }

    /// `name(arguments)`.
    pub(crate) fn call(name: &str, arguments: &[Self], range: Range) -> Self {
        let arguments: Vec<_> = arguments
            .iter()
            .map(|argument| argument.at(Level::Assignment))
            .collect();
        Self::primary(format!("{name}({})", arguments.join(", ")), range)
    }

    /// `MACRO(arguments)`: commas outside of parentheses would separate arguments.
    pub(crate) fn expanded(name: &str, arguments: &[Self], range: Range) -> Self {
        let arguments: Vec<_> = arguments
            .iter()
            .map(|argument| {
                if has_open_comma(&argument.text) {
                    Self::primary(format!("({})", argument.text), argument.range)
                } else {
                    argument.clone()
                }
            })
            .collect();
        Self::call(name, &arguments, range)
    }
}

/// Returns whether a comma is outside of parentheses.
fn has_open_comma(text: &str) -> bool {
    let mut depth = 0;
    text.chars().any(|c| {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        c == ',' && depth == 0
    })
}

/// A literal of that type.
pub(crate) fn literal(ty: Type, number: usize, style: usize) -> Expr {
    let text = match ty.base.scalar() {
        Some(Scalar::Float) => {
            let quarters = number % 33;
            let value = quarters as f64 / 4.0;
            let text = match style {
                1 => format!("{value:e}"),
                2 if quarters.is_multiple_of(4) => format!("{}.", quarters / 4),
                3 if quarters < 4 => format!(".{}", ["0", "25", "5", "75"][quarters]),
                _ => format!("{value:?}"),
            };
            return Expr::primary(text, Range::new(8.0, 2));
        }
        Some(Scalar::Bool) => ["false", "true"][number % 2].to_owned(),
        scalar => {
            let suffix = if scalar == Some(Scalar::Uint) { "u" } else { "" };
            match style {
                1 => format!("{number:#x}{suffix}"),
                2 => format!("0{number:o}{suffix}"),
                3 if scalar == Some(Scalar::Int) && number < 50 => "THREE".to_owned(),
                3 if number > 200 => format!("{}{suffix}", 0x7fff_ffff - (255 - number)),
                _ => format!("{}{suffix}", number % 16),
            }
        }
    };
    Expr::primary(text, Range::VARIABLE)
}
