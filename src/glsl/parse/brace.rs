//! Unbalanced braces. The grammar cannot determine which brace is at fault, but the indentation of the lines
//! often can.

use toyproof_diagnostic::{Code, Diagnostic};

use super::bracket::{missing, stray};
use super::recover::Layout;
use crate::keywords::{Interner, Keyword, Word};
use crate::token::{Punctuator, Token, TokenKind};

/// Maximum number of faults that are repaired one by one.
const MAX_REPAIRS: usize = 16;

/// Maximum number of tokens in which the end of a function's header is searched.
const MAX_HEADER_TOKENS: usize = 1000;

/// A fault in the pairing of braces; positions are token indices.
enum Fault {
    /// `open` has no partner, which belongs before `before`.
    NeverClosed { open: usize, before: usize },
    /// A `{` is missing after `after`, for the `}` at `close`.
    NeverOpened { after: usize, close: usize },
    /// The `}` at `close` has no partner.
    Stray { close: usize },
}

/// Balances the braces of a text whose other brackets are balanced.
pub(super) fn pair(
    mut tokens: Vec<Token>,
    interner: &Interner,
    layout: Layout,
    reported: &mut Vec<Diagnostic>,
) -> Vec<Token> {
    for _ in 0..MAX_REPAIRS {
        let Some(fault) = (Search {
            tokens: &tokens,
            interner,
            layout,
        })
        .fault() else {
            break;
        };
        reported.push(diagnose(&fault, &tokens));
        match fault {
            Fault::NeverClosed { before, .. } => {
                tokens.insert(before, missing(Punctuator::RightBrace, tokens[before]));
            }
            Fault::NeverOpened { after, .. } => {
                tokens.insert(after + 1, missing(Punctuator::LeftBrace, tokens[after + 1]));
            }
            Fault::Stray { close } => stray(&mut tokens[close]),
        }
    }
    tokens
}

fn diagnose(fault: &Fault, tokens: &[Token]) -> Diagnostic {
    match *fault {
        Fault::NeverClosed { open, before } => {
            let diagnostic = Code::Unclosed.at(tokens[open].at, "unclosed `{`");
            match tokens[before].kind {
                TokenKind::End => diagnostic.note("the file ends before the matching `}`"),
                _ => diagnostic.related(tokens[before].at.span, "expected `}` before this"),
            }
        }
        Fault::NeverOpened { after, close } => Code::Unclosed
            .at(tokens[close].at, "unmatched `}`")
            .related(tokens[after].at.span, "is a `{` missing after this?"),
        Fault::Stray { close } => Code::Unclosed
            .at(tokens[close].at, "unmatched `}`")
            .help("remove it, or add the missing `{`"),
    }
}

struct Search<'a> {
    tokens: &'a [Token],
    interner: &'a Interner,
    layout: Layout<'a>,
}

impl Search<'_> {
    /// Whether every brace has a partner, at any position.
    fn is_paired(&self) -> bool {
        let mut depth = 0_usize;
        for token in self.tokens {
            match token.kind {
                TokenKind::Punctuator(Punctuator::LeftBrace) => depth += 1,
                TokenKind::Punctuator(Punctuator::RightBrace) if depth == 0 => return false,
                TokenKind::Punctuator(Punctuator::RightBrace) => depth -= 1,
                _ => {}
            }
        }
        depth == 0
    }

    /// The first fault, or `None` if the braces are balanced.
    fn fault(&self) -> Option<Fault> {
        if self.is_paired() {
            return None;
        }
        let mut open = Vec::new();
        // The pairs of the current function, in the order of their `}`.
        let mut pairs = Vec::new();
        // The end of a header that is not followed by `{`.
        let mut bare = None;
        for (index, token) in self.tokens.iter().enumerate() {
            match token.kind {
                TokenKind::Punctuator(Punctuator::LeftBrace) => open.push(index),
                TokenKind::Punctuator(Punctuator::RightBrace) => match open.pop() {
                    Some(partner) => pairs.push((partner, index)),
                    None => return Some(self.extra_close(&pairs, bare, index)),
                },
                _ if open
                    .last()
                    .is_some_and(|&last| self.opens_structure(last) && self.ends_structure(index)) =>
                {
                    let before = index;
                    return open.pop().map(|open| Fault::NeverClosed { open, before });
                }
                TokenKind::Word(_) => {
                    let Some(end) = self.header(index) else {
                        continue;
                    };
                    let has_body = self.is(end + 1, Punctuator::LeftBrace);
                    match open.last() {
                        Some(&last) if has_body => return Some(self.missing_close(&pairs, last, index)),
                        Some(_) => {}
                        None => {
                            pairs.clear();
                            bare = (!has_body && !self.is(end + 1, Punctuator::Semicolon)).then_some(end);
                        }
                    }
                }
                _ => {}
            }
        }
        let last = *open.last()?;
        Some(self.missing_close(&pairs, last, self.tokens.len() - 1))
    }

    /// The fault if blocks are open at `here` where none should be: the first block whose `}` is indented
    /// less than its line, otherwise the innermost one.
    fn missing_close(&self, pairs: &[(usize, usize)], last: usize, here: usize) -> Fault {
        let indent = |index: usize| self.layout.indent(self.tokens[index]);
        let dedents = |&&(open, close): &&(usize, usize)| {
            self.layout.begins_line(self.tokens[close]) && indent(close) < indent(open)
        };
        let Some(&(open, close)) = pairs.iter().filter(dedents).min() else {
            return Fault::NeverClosed {
                open: last,
                before: here,
            };
        };
        let wanted = indent(open);
        let before = (open + 1..close).find(|&index| {
            self.layout
                .line_between(self.tokens[index - 1], self.tokens[index])
                && indent(index) <= wanted
        });
        Fault::NeverClosed {
            open,
            before: before.unwrap_or(close),
        }
    }

    /// The fault if the `}` at `here` has no partner: an earlier `}` that is indented deeper than its block
    /// may have taken it.
    fn extra_close(&self, pairs: &[(usize, usize)], bare: Option<usize>, here: usize) -> Fault {
        if let Some(after) = bare {
            return Fault::NeverOpened { after, close: here };
        }
        let indent = |index: usize| self.layout.indent(self.tokens[index]);
        let deeper = |&&(open, close): &&(usize, usize)| {
            self.layout.begins_line(self.tokens[close]) && indent(close) > indent(open)
        };
        let Some(&(open, close)) = pairs.iter().find(deeper) else {
            return Fault::Stray { close: here };
        };
        // The last line with the indentation of the `}` that ends with the head of a block.
        let wanted = indent(close);
        let head = (open + 1..close - 1).rev().find(|&index| {
            let ends_line = self
                .layout
                .line_between(self.tokens[index], self.tokens[index + 1]);
            ends_line && self.is_end_of_head(index) && indent(index) == wanted
        });
        match head {
            Some(after) => Fault::NeverOpened { after, close },
            None => Fault::Stray { close },
        }
    }

    /// Whether the `{` at `open` begins a structure's members.
    fn opens_structure(&self, open: usize) -> bool {
        let is_struct = |before: usize| {
            let token = open.checked_sub(before).map(|index| self.tokens[index].kind);
            matches!(token, Some(TokenKind::Word(word)) if self.interner.word(word) == Word::Keyword(Keyword::Struct))
        };
        is_struct(1) || is_struct(2)
    }

    /// Whether the token cannot be in a member list: it begins another structure or a constant, or is a `;`
    /// after a `;`.
    fn ends_structure(&self, index: usize) -> bool {
        match self.tokens[index].kind {
            TokenKind::Word(word) => matches!(
                self.interner.word(word),
                Word::Keyword(Keyword::Struct | Keyword::Const)
            ),
            TokenKind::Punctuator(Punctuator::Semicolon) => self.is(index - 1, Punctuator::Semicolon),
            _ => false,
        }
    }

    fn is_end_of_head(&self, index: usize) -> bool {
        match self.tokens[index].kind {
            TokenKind::Punctuator(punctuator) => punctuator == Punctuator::RightParen,
            TokenKind::Word(word) => {
                matches!(
                    self.interner.word(word),
                    Word::Keyword(Keyword::Else | Keyword::Do)
                )
            }
            _ => false,
        }
    }

    /// The index of the `)` of a function's header, `type name(…)`, if one begins at `start`.
    fn header(&self, start: usize) -> Option<usize> {
        let word = |index: usize| match self.tokens.get(index)?.kind {
            TokenKind::Word(word) => Some(self.interner.word(word)),
            _ => None,
        };
        let is_header = matches!(word(start)?, Word::Type(_) | Word::Name)
            && word(start + 1)? == Word::Name
            && self.is(start + 2, Punctuator::LeftParen);
        if !is_header {
            return None;
        }
        let mut depth = 0;
        for index in (start + 2..self.tokens.len()).take(MAX_HEADER_TOKENS) {
            match self.tokens[index].kind {
                TokenKind::Punctuator(Punctuator::LeftParen) => depth += 1,
                TokenKind::Punctuator(Punctuator::RightParen) => depth -= 1,
                TokenKind::Punctuator(
                    Punctuator::Semicolon | Punctuator::LeftBrace | Punctuator::RightBrace,
                ) => return None,
                _ => {}
            }
            if depth == 0 {
                return Some(index);
            }
        }
        None
    }

    fn is(&self, index: usize, punctuator: Punctuator) -> bool {
        self.tokens
            .get(index)
            .is_some_and(|token| token.kind == TokenKind::Punctuator(punctuator))
    }
}
