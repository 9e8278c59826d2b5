//! Tokens and punctuators.

use super::tree::{BinaryOp, Place};

/// A token, as the preprocessor passes it to the parser.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Token {
    pub(crate) kind: TokenKind,
    pub(crate) at: Place,
    /// Whether an error about it has been reported: errors nearby may follow from that one.
    pub(crate) reported: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// A keyword or name.
    Word(Symbol),
    /// Text that begins like a number; the parser decides whether it is valid.
    Number(Symbol),
    /// An operator or bracket.
    Punctuator(Punctuator),
    /// A character that is not in GLSL's character set; the parser never sees it.
    Unknown(char),
    /// A misplaced token that has been reported.
    Stray,
    /// The end of a line; the parser never sees it.
    Newline,
    /// The end of the text.
    End,
}

/// The id of a text in an [`Interner`](crate::keywords::Interner).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Symbol(pub(super) u32);

/// Defines an enumeration of items with fixed text.
macro_rules! named {
    ($(#[$doc:meta])* $type:ident { $($variant:ident $text:literal,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(crate) enum $type {
            $(#[doc = concat!("`", $text, "`")] $variant,)*
        }

        impl $type {
            /// All items.
            pub(crate) const ALL: &[Self] = &[$(Self::$variant),*];

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
    /// An operator or bracket. If one is a prefix of another, the longer one comes first.
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
    /// The binary operator that it denotes between two operands.
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

    /// The operator of a compound assignment such as `+=`.
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
    fn longer_punctuators_precede_their_prefixes() {
        for (at, long) in Punctuator::ALL.iter().enumerate() {
            for short in &Punctuator::ALL[..at] {
                assert!(!long.text().starts_with(short.text()), "{short:?} hides {long:?}");
            }
        }
    }
}
