//! Unbalanced parentheses and square brackets: reported and repaired, so that the rest can be parsed.

use toyproof_diagnostic::{Code, Diagnostic, File, Fix, Span};

use super::brace;
use super::recover::Layout;
use crate::keywords::{Interner, Keyword, Word};
use crate::preprocess::PreprocessorOutput;
use crate::reporting::push_limited;
use crate::token::{Punctuator, Token, TokenKind};
use crate::tree::Place;

/// Balances the brackets of a text. An extra bracket becomes [`TokenKind::Stray`], a missing one is inserted;
/// both are reported. Afterwards every bracket has a partner.
pub(crate) fn balance(text: &mut PreprocessorOutput, file: &File) {
    let (tokens, mut reported) = pair(&text.tokens, &text.interner);
    let tokens = brace::pair(tokens, &text.interner, Layout::new(file), &mut reported);
    if !reported.is_empty() {
        text.tokens = tokens;
        for diagnostic in reported {
            push_limited(&mut text.diagnostics, diagnostic);
        }
    }
}

/// An inserted token, right before `next`.
pub(super) fn missing(punctuator: Punctuator, next: Token) -> Token {
    let span = next.at.span;
    Token {
        kind: TokenKind::Punctuator(punctuator),
        at: Place::plain(Span::new(span.file, span.start, span.start)),
        reported: true,
    }
}

/// Marks a token as stray and reported.
pub(super) fn stray(token: &mut Token) {
    token.kind = TokenKind::Stray;
    token.reported = true;
}

/// The closing bracket for an opening one.
pub(super) fn closing(open: Punctuator) -> Option<Punctuator> {
    match open {
        Punctuator::LeftParen => Some(Punctuator::RightParen),
        Punctuator::LeftBracket => Some(Punctuator::RightBracket),
        Punctuator::LeftBrace => Some(Punctuator::RightBrace),
        _ => None,
    }
}

/// An open bracket.
struct OpenBracket {
    token: Token,
    bracket: Punctuator,
    /// The number of `;` it may still contain: two in the head of a `for`.
    semicolons: usize,
}

/// Balances `()` and `[]`; both end before a `;`, `{` or `}` that they cannot contain.
fn pair(tokens: &[Token], interner: &Interner) -> (Vec<Token>, Vec<Diagnostic>) {
    let mut pairing = Pairing {
        done: Vec::with_capacity(tokens.len()),
        open: Vec::new(),
        reported: Vec::new(),
    };
    let keyword = |token: &Token| match token.kind {
        TokenKind::Word(word) => match interner.word(word) {
            Word::Keyword(keyword) => Some(keyword),
            _ => None,
        },
        _ => None,
    };
    for (index, &token) in tokens.iter().enumerate() {
        let before = |count: usize| keyword(&tokens[index.checked_sub(count)?]);
        let opener = match (before(2), before(1)) {
            (_, Some(Keyword::For)) => Opener::For,
            (Some(Keyword::Struct), _) | (_, Some(Keyword::Struct)) => Opener::Struct,
            _ => Opener::Other,
        };
        pairing.take(token, opener, &tokens[index + 1..]);
    }
    (pairing.done, pairing.reported)
}

/// The construct that a bracket follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Opener {
    For,
    /// `struct` or `struct name`: its `{` is not allowed in parentheses, but does not end them.
    Struct,
    Other,
}

struct Pairing {
    done: Vec<Token>,
    open: Vec<OpenBracket>,
    reported: Vec<Diagnostic>,
}

impl Pairing {
    fn take(&mut self, token: Token, opener: Opener, rest: &[Token]) {
        let TokenKind::Punctuator(punctuator) = token.kind else {
            if token.kind == TokenKind::End {
                self.close_up_to_brace(token);
            }
            self.done.push(token);
            return;
        };
        match punctuator {
            Punctuator::LeftParen | Punctuator::LeftBracket => self.open.push(OpenBracket {
                token,
                bracket: punctuator,
                semicolons: if opener == Opener::For { 2 } else { 0 },
            }),
            Punctuator::LeftBrace if opener != Opener::Struct && self.closes_later(rest) => {
                return self.report_misplaced(token, punctuator);
            }
            Punctuator::LeftBrace => {
                if opener != Opener::Struct {
                    self.close_up_to_brace(token);
                }
                self.open.push(OpenBracket {
                    token,
                    bracket: punctuator,
                    semicolons: usize::MAX,
                });
            }
            Punctuator::RightBrace => {
                self.close_up_to_brace(token);
                self.open.pop();
            }
            Punctuator::Semicolon
                if self.open.last().is_some_and(|open| open.semicolons == 0) && self.closes_later(rest) =>
            {
                return self.report_misplaced(token, punctuator);
            }
            Punctuator::Semicolon => {
                while self.open.last().is_some_and(|open| open.semicolons == 0) {
                    self.close_last(token);
                }
                if let Some(open) = self.open.last_mut() {
                    open.semicolons -= 1;
                }
            }
            Punctuator::RightParen | Punctuator::RightBracket => return self.close(token, punctuator, rest),
            _ => {}
        }
        self.done.push(token);
    }

    /// Consumes a `)` or `]`.
    fn close(&mut self, token: Token, punctuator: Punctuator, rest: &[Token]) {
        let closes = |open: &OpenBracket| closing(open.bracket) == Some(punctuator);
        match &self.open[..] {
            [.., last] if closes(last) => {
                self.open.pop();
                self.done.push(token);
            }
            // `f(a[i)`: the inner bracket is not closed.
            [.., outer, inner] if closes(outer) && inner.bracket != Punctuator::LeftBrace => {
                self.close_last(token);
                self.open.pop();
                self.done.push(token);
            }
            // `f(x];`: the wrong bracket, unless the right one follows.
            [.., last] if last.bracket != Punctuator::LeftBrace && !self.closes_later(rest) => {
                self.wrong_partner(token, punctuator);
            }
            _ => {
                let opening = if punctuator == Punctuator::RightParen {
                    "("
                } else {
                    "["
                };
                let message = format!("unmatched `{}`", punctuator.text());
                let help = format!("remove it, or add the missing `{opening}`");
                self.reported
                    .push(Code::Unclosed.at(token.at, message).help(help));
                self.push_stray(token);
            }
        }
    }

    /// Reports a `(` closed by a `]`, or the reverse, and closes it.
    fn wrong_partner(&mut self, token: Token, punctuator: Punctuator) {
        let Some(OpenBracket {
            token: open, bracket, ..
        }) = self.open.pop()
        else {
            return;
        };
        let Some(right) = closing(bracket) else {
            return;
        };
        let right_text = right.text();
        let message = format!(
            "mismatched bracket: expected `{right_text}`, found `{}`",
            punctuator.text()
        );
        self.reported.push(
            Code::Unclosed
                .at(token.at, message)
                .fix(Fix::new(
                    format!("write `{right_text}`"),
                    token.at.spelling,
                    right_text,
                ))
                .related(open.at.span, format!("`{}` opened here", bracket.text())),
        );
        self.done.push(Token {
            kind: TokenKind::Punctuator(right),
            reported: true,
            ..token
        });
    }

    fn push_stray(&mut self, mut token: Token) {
        stray(&mut token);
        self.done.push(token);
    }

    /// Whether all brackets opened since the last `{` are closed before the next `;` or brace: then the
    /// current token does not end them.
    fn closes_later(&self, rest: &[Token]) -> bool {
        let mut wanted = self
            .open
            .iter()
            .rev()
            .take_while(|open| open.bracket != Punctuator::LeftBrace)
            .count();
        if wanted == 0 {
            return false;
        }
        let mut depth = 0_usize;
        for token in rest {
            match token.kind {
                TokenKind::Punctuator(Punctuator::LeftParen | Punctuator::LeftBracket) => depth += 1,
                TokenKind::Punctuator(Punctuator::RightParen | Punctuator::RightBracket) if depth > 0 => {
                    depth -= 1;
                }
                TokenKind::Punctuator(Punctuator::RightParen | Punctuator::RightBracket) => wanted -= 1,
                TokenKind::Punctuator(
                    Punctuator::Semicolon | Punctuator::LeftBrace | Punctuator::RightBrace,
                )
                | TokenKind::End => return false,
                _ => {}
            }
            if wanted == 0 {
                return true;
            }
        }
        false
    }

    /// Reports a `;` or `{` in parentheses.
    fn report_misplaced(&mut self, token: Token, punctuator: Punctuator) {
        let diagnostic = Code::Syntax.at(
            token.at,
            format!("unexpected `{}` inside brackets", punctuator.text()),
        );
        let diagnostic = match (punctuator, self.open.last()) {
            (Punctuator::Semicolon, Some(open)) => diagnostic
                .related(open.token.at.span, "opened here")
                .fix(Fix::new("separate arguments with `,`", token.at.spelling, ",")),
            (_, Some(open)) => diagnostic.related(open.token.at.span, "opened here"),
            _ => diagnostic,
        };
        self.reported.push(diagnostic);
        self.push_stray(token);
    }

    /// Closes every `(` and `[` since the last `{`.
    fn close_up_to_brace(&mut self, next: Token) {
        while self
            .open
            .last()
            .is_some_and(|open| open.bracket != Punctuator::LeftBrace)
        {
            self.close_last(next);
        }
    }

    /// Closes the innermost bracket before `next`.
    fn close_last(&mut self, next: Token) {
        let Some(OpenBracket { token, bracket, .. }) = self.open.pop() else {
            return;
        };
        let Some(closing) = closing(bracket) else {
            return;
        };
        let message = format!("unclosed `{}`", bracket.text());
        let diagnostic = Code::Unclosed.at(token.at, message);
        self.reported.push(if next.kind == TokenKind::End {
            diagnostic.note(format!("the file ends before the matching `{}`", closing.text()))
        } else {
            let label = format!("expected `{}` before this", closing.text());
            diagnostic.related(next.at.span, label)
        });
        self.done.push(missing(closing, next));
    }
}
