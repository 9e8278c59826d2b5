//! Tokens, and the words that they are made of.

use super::tree::{BinaryOp, Place};

/// A piece of the author's text, as the preprocessor hands it to the parser.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Token {
    /// What it is.
    pub(crate) kind: TokenKind,
    /// Where it stands.
    pub(crate) at: Place,
    /// Whether it stands for something whose mistake has been told: what is wrong around it may come from that.
    pub(crate) told: bool,
}

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// A keyword or name.
    Word(Symbol),
    /// Something that begins like a number; whether it is one, the parser decides.
    Number(Symbol),
    /// An operator or bracket.
    Punctuator(Punctuator),
    /// A character that GLSL does not know; the parser never sees it.
    Unknown(char),
    /// What does not belong there and has been told.
    Stray,
    /// The end of a line; the parser never sees it.
    Newline,
    /// The end of the text.
    End,
}

/// Names a text that [`Words`](super::words::Words) holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Symbol(pub(super) u32);

/// An enumeration of what has a fixed text.
macro_rules! named {
    ($(#[$doc:meta])* $type:ident { $($variant:ident $text:literal,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(crate) enum $type {
            $(#[doc = concat!("`", $text, "`")] $variant,)*
        }

        impl $type {
            /// All of them.
            pub(crate) const ALL: &[Self] = &[$(Self::$variant),*];

            /// As written.
            #[must_use]
            pub(crate) fn text(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)*
                }
            }
        }
    };
}

pub(super) use named;

named! {
    /// An operator or bracket. Where one is the beginning of another, the longer stands first.
    Punctuator {
        ShiftLeftAssign "<<=",
        ShiftRightAssign ">>=",
        Paste "##",
        Increment "++",
        Decrement "--",
        LessEqual "<=",
        GreaterEqual ">=",
        EqualEqual "==",
        NotEqual "!=",
        AndAnd "&&",
        OrOr "||",
        XorXor "^^",
        ShiftLeft "<<",
        ShiftRight ">>",
        AddAssign "+=",
        SubtractAssign "-=",
        MultiplyAssign "*=",
        DivideAssign "/=",
        RemainderAssign "%=",
        AndAssign "&=",
        OrAssign "|=",
        XorAssign "^=",
        LeftParen "(",
        RightParen ")",
        LeftBracket "[",
        RightBracket "]",
        LeftBrace "{",
        RightBrace "}",
        Dot ".",
        Comma ",",
        Colon ":",
        Semicolon ";",
        Question "?",
        Assign "=",
        Not "!",
        Tilde "~",
        Plus "+",
        Minus "-",
        Star "*",
        Slash "/",
        Percent "%",
        Less "<",
        Greater ">",
        And "&",
        Or "|",
        Xor "^",
        Hash "#",
    }
}

impl Punctuator {
    /// The binary operator that it is between two operands.
    #[must_use]
    pub(crate) fn binary_operator(self) -> Option<BinaryOp> {
        Some(match self {
            Self::Star => BinaryOp::Multiply,
            Self::Slash => BinaryOp::Divide,
            Self::Percent => BinaryOp::Remainder,
            Self::Plus => BinaryOp::Add,
            Self::Minus => BinaryOp::Subtract,
            Self::ShiftLeft => BinaryOp::ShiftLeft,
            Self::ShiftRight => BinaryOp::ShiftRight,
            Self::Less => BinaryOp::Less,
            Self::Greater => BinaryOp::Greater,
            Self::LessEqual => BinaryOp::LessEqual,
            Self::GreaterEqual => BinaryOp::GreaterEqual,
            Self::EqualEqual => BinaryOp::Equal,
            Self::NotEqual => BinaryOp::NotEqual,
            Self::And => BinaryOp::BitAnd,
            Self::Xor => BinaryOp::BitXor,
            Self::Or => BinaryOp::BitOr,
            Self::AndAnd => BinaryOp::And,
            Self::XorXor => BinaryOp::Xor,
            Self::OrOr => BinaryOp::Or,
            _ => return None,
        })
    }

    /// The operator of `+=` and the like.
    #[must_use]
    pub(crate) fn assignment_operator(self) -> Option<BinaryOp> {
        Some(match self {
            Self::MultiplyAssign => BinaryOp::Multiply,
            Self::DivideAssign => BinaryOp::Divide,
            Self::RemainderAssign => BinaryOp::Remainder,
            Self::AddAssign => BinaryOp::Add,
            Self::SubtractAssign => BinaryOp::Subtract,
            Self::ShiftLeftAssign => BinaryOp::ShiftLeft,
            Self::ShiftRightAssign => BinaryOp::ShiftRight,
            Self::AndAssign => BinaryOp::BitAnd,
            Self::XorAssign => BinaryOp::BitXor,
            Self::OrAssign => BinaryOp::BitOr,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_longer_punctuator_stands_before_its_beginning() {
        for (at, long) in Punctuator::ALL.iter().enumerate() {
            for short in &Punctuator::ALL[..at] {
                assert!(!long.text().starts_with(short.text()), "{short:?} hides {long:?}");
            }
        }
    }
}
