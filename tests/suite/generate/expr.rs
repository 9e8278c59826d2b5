//! An expression's text, how tightly it binds, and what its floats can be.

use super::types::{Scalar, Type};

/// How tightly operators bind, loosest first, as the grammar of GLSL has it (§5.1).
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
    /// The next that binds more tightly.
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

/// What floats can be: multiples of 2^-`grain` of at most `size`. While both fit 23 bits, arithmetic is exact in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub(crate) size: f64,
    pub(crate) grain: i32,
}

impl Range {
    /// What a variable may hold.
    pub(crate) const VARIABLE: Self = Self { size: 64.0, grain: 4 };

    pub(crate) const fn new(size: f64, grain: i32) -> Self {
        Self { size, grain }
    }

    /// Whether all of it lies in the other.
    pub(crate) fn fits(self, other: Self) -> bool {
        self.size <= other.size && self.grain <= other.grain
    }

    /// Whether such floats are exact in 32 bits.
    pub(crate) fn is_exact(self) -> bool {
        self.size.log2() + f64::from(self.grain) <= 23.0
    }

    /// Sums of these and those.
    pub(crate) fn sum(self, other: Self) -> Self {
        Self::new(self.size + other.size, self.grain.max(other.grain))
    }

    /// Sums of `count` products.
    pub(crate) fn products(self, other: Self, count: u8) -> Self {
        Self::new(
            self.size * other.size * f64::from(count),
            self.grain + other.grain,
        )
    }

    /// Either.
    pub(crate) fn or(self, other: Self) -> Self {
        Self::new(self.size.max(other.size), self.grain.max(other.grain))
    }
}

/// A typed expression.
#[derive(Debug, Clone)]
pub(crate) struct Expr {
    pub(crate) text: String,
    pub(crate) level: Level,
    /// Of the floats in it, if there are any.
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

    /// One without floats in it, or with those of a variable.
    pub(crate) fn plain(text: impl Into<String>, level: Level) -> Self {
        Self::new(text, level, Range::VARIABLE)
    }

    /// The text where something binds this tightly.
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
        // `- -x` is no `--x`.
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

    /// `MACRO(arguments)`: commas outside of round brackets would part them.
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

/// Whether a comma stands outside of round brackets.
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

/// The digits of a literal of that type.
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
