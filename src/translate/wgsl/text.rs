//! Values in words, and where they need parentheses.

use toyproof_glsl::tree::BinaryOp;

use super::Unprintable;

/// What an expression is at its top: what may take it as an operand without parentheses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    Primary,
    Unary,
    Product,
    Sum,
    Relation,
    /// One of the operators that only chains of itself need no parentheses for.
    Chain(BinaryOp),
}

/// A value in words.
#[derive(Debug, Clone)]
pub(super) struct Text {
    pub(super) words: String,
    pub(super) class: Class,
}

pub(super) type Printed = Result<Text, Unprintable>;

impl Text {
    pub(super) fn primary(words: impl Into<String>) -> Self {
        Self {
            words: words.into(),
            class: Class::Primary,
        }
    }

    /// The same in parentheses, unless it is of one of those classes.
    pub(super) fn within(self, bare: &[Class]) -> String {
        if bare.contains(&self.class) {
            self.words
        } else {
            format!("({})", self.words)
        }
    }

    /// As a side of a comparison.
    pub(super) fn term(self) -> String {
        self.within(&[Class::Primary, Class::Unary, Class::Product, Class::Sum])
    }

    /// As what a `.`, `[` or unary operator is put to.
    pub(super) fn operand(self) -> String {
        self.within(&[Class::Primary])
    }
}
