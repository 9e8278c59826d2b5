//! The text to which the use of a macro expands, for readers.

use toyproof_diagnostic::{FileId, Files, Span};

use crate::Options;
use crate::keywords::Interner;
use crate::token::{Punctuator, Token, TokenKind};

/// Maximum length of an expansion in bytes, after which `…` stands for the rest.
const MAX_SHOWN_BYTES: usize = 400;

/// The text to which the macro that is used at a span of a file expands, on one line; `None` if no macro is
/// used there. Macros in the expansion are expanded, too.
///
/// ```
/// use toyproof_diagnostic::{File, Files, Span};
/// use toyproof_glsl::{Options, expanded};
///
/// let mut files = Files::default();
/// let file = files.add(File::new("a.glsl", "#define TWICE(x) ((x) + (x))\nfloat a = TWICE(-1.);"));
/// let text = expanded(&files, file, &Options::default(), Span::new(file, 39, 49));
/// assert_eq!(text.as_deref(), Some("((-1.) + (-1.))"));
/// ```
pub fn expanded(files: &Files, file: FileId, options: &Options, used: Span) -> Option<String> {
    let (_, text) = crate::preprocess(files, file, options);
    text.expansions.definition_at(used)?;
    let within =
        |token: &&Token| used.start <= token.at.span.start && token.at.span.end <= used.end.max(used.start);
    let tokens = text.tokens.iter().filter(within);
    Some(one_line(tokens, &text.interner))
}

/// Tokens with the usual spaces between them.
fn one_line<'t>(tokens: impl Iterator<Item = &'t Token>, interner: &Interner) -> String {
    let mut line = String::new();
    let mut before: Option<TokenKind> = None;
    // Whether the last token is a sign rather than an operator.
    let mut is_sign = false;
    for token in tokens {
        let text = match token.kind {
            TokenKind::Word(symbol) | TokenKind::Number(symbol) => interner.text(symbol),
            TokenKind::Punctuator(punctuator) => punctuator.text(),
            TokenKind::Unknown(_) | TokenKind::Stray | TokenKind::Newline | TokenKind::End => continue,
        };
        if line.len() + text.len() > MAX_SHOWN_BYTES {
            line.push('…');
            break;
        }
        if before.is_some_and(|before| !is_sign && has_space(before, token.kind)) {
            line.push(' ');
        }
        line.push_str(text);
        let may_be_sign = matches!(
            token.kind,
            TokenKind::Punctuator(Punctuator::Minus | Punctuator::Plus | Punctuator::Not | Punctuator::Tilde)
        );
        is_sign = may_be_sign && !before.is_some_and(ends_operand);
        before = Some(token.kind);
    }
    line
}

fn ends_operand(kind: TokenKind) -> bool {
    match kind {
        TokenKind::Word(_) | TokenKind::Number(_) => true,
        TokenKind::Punctuator(punctuator) => matches!(
            punctuator,
            Punctuator::RightParen | Punctuator::RightBracket | Punctuator::Increment | Punctuator::Decrement
        ),
        _ => false,
    }
}

fn has_space(before: TokenKind, after: TokenKind) -> bool {
    use Punctuator::{
        Comma, Decrement, Dot, Increment, LeftBracket, LeftParen, RightBracket, RightParen, Semicolon,
    };
    match (before, after) {
        (TokenKind::Punctuator(LeftParen | LeftBracket | Dot), _)
        | (
            _,
            TokenKind::Punctuator(
                RightParen | RightBracket | Dot | Comma | Semicolon | Increment | Decrement,
            ),
        )
        | (TokenKind::Punctuator(Increment | Decrement), TokenKind::Word(_)) => false,
        (before, TokenKind::Punctuator(LeftParen | LeftBracket)) => !ends_operand(before),
        _ => true,
    }
}
