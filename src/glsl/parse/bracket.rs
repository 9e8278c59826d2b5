//! Brackets that the author forgot to close.

use crate::glsl::token::{Punctuator, Token, TokenKind};

/// The innermost bracket that is still open at the end of the tokens, and how it is closed.
pub(super) fn unclosed(tokens: &[Token]) -> Option<(Token, Punctuator)> {
    let mut open: Vec<(Token, Punctuator)> = Vec::new();
    for &token in tokens {
        let TokenKind::Punctuator(punctuator) = token.kind else {
            continue;
        };
        match punctuator {
            Punctuator::LeftParen => open.push((token, Punctuator::RightParen)),
            Punctuator::LeftBracket => open.push((token, Punctuator::RightBracket)),
            Punctuator::LeftBrace => open.push((token, Punctuator::RightBrace)),
            _ if open.last().is_some_and(|&(_, closing)| closing == punctuator) => {
                open.pop();
            }
            _ => {}
        }
    }
    open.pop()
}
