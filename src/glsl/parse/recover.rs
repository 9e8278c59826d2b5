//! Going on after what cannot be read.

use super::bracket::closing;
use super::{Halt, Parsed, Parser};
use crate::token::{Punctuator, TokenKind};
use crate::words::{Keyword, Word};

impl Parser<'_> {
    /// Reads one of a list of statements or declarations; if it cannot be read, passes over it.
    pub(super) fn recovering<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Option<T> {
        let start = self.at;
        self.end_piece();
        let result = read(self);
        if result.is_err() {
            self.pass_over(start);
            self.unread(start);
        }
        self.end_piece();
        result.ok()
    }

    /// Another piece begins here. What seemed wrong in one that holds a mistake told before may come from that, and is not told.
    pub(super) fn end_piece(&mut self) {
        if self.is_told() {
            self.check.errors.truncate(self.told_before);
        }
        self.piece = self.at;
        self.told_before = self.check.errors.len();
    }

    /// Whether the piece that is being read holds a mistake that has been told.
    pub(super) fn is_told(&self) -> bool {
        let end = (self.at + 1).min(self.tokens.len());
        self.tokens[self.piece.min(end)..end]
            .iter()
            .any(|token| token.told)
    }

    /// Passes over what is left of the statement or declaration that began at `start`: up to its `;` or past its `{…}`, but never past the
    /// `}` around it, nor over a line that begins a statement. At least one token is passed.
    fn pass_over(&mut self, start: usize) {
        let begun = self.tokens[start..self.at.min(self.tokens.len())].iter();
        let mut depth = begun.fold(0_usize, |depth, token| match token.kind {
            TokenKind::Punctuator(punctuator) if closing(punctuator).is_some() => depth + 1,
            TokenKind::Punctuator(punctuator) if is_closing(punctuator) => depth.saturating_sub(1),
            _ => depth,
        });
        loop {
            let fresh = self.at > start && depth == 0;
            match self.kind() {
                TokenKind::End => return,
                TokenKind::Punctuator(Punctuator::Semicolon) if depth == 0 => {
                    self.next();
                    return;
                }
                TokenKind::Punctuator(Punctuator::RightBrace) if fresh => return,
                TokenKind::Punctuator(punctuator) if closing(punctuator).is_some() => depth += 1,
                TokenKind::Punctuator(punctuator) if is_closing(punctuator) => {
                    depth = depth.saturating_sub(1);
                    if depth == 0 && punctuator == Punctuator::RightBrace {
                        self.next();
                        self.eat(Punctuator::Semicolon);
                        return;
                    }
                }
                TokenKind::Word(_) if fresh && self.begins_statement() => return,
                _ => {}
            }
            self.next();
        }
    }

    /// Whether the next token begins a line with what only a new statement or declaration begins with.
    pub(super) fn begins_statement(&self) -> bool {
        let begins = match self.word() {
            Some(Word::Keyword(Keyword::Else | Keyword::True | Keyword::False)) => false,
            Some(Word::Keyword(_)) => true,
            // A constructor is no declaration.
            Some(Word::Type(_)) => matches!(self.peek(1).kind, TokenKind::Word(_)),
            _ => false,
        };
        begins && self.layout.begins_line(self.token())
    }

    /// Every name that may have been declared in what could not be read is doubtful from now on: that it is not declared is not told.
    fn unread(&mut self, start: usize) {
        let words = self.words;
        self.check.may_return();
        for pair in self.tokens[start..self.at.min(self.tokens.len())].windows(2) {
            let declares = match pair[0].kind {
                TokenKind::Word(word) => !matches!(words.word(word), Word::Keyword(Keyword::Return)),
                TokenKind::Punctuator(punctuator) => punctuator == Punctuator::Comma,
                TokenKind::Number(_) => true,
                _ => false,
            };
            if let TokenKind::Word(name) = pair[1].kind
                && declares
                && words.word(name) == Word::Name
            {
                self.check.doubt(name);
            }
        }
    }

    /// Reads what stands in parentheses, such as the head of an `if`; if it cannot be read, goes on after the `)` with nothing.
    pub(super) fn parenthesised<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Parsed<T>,
    ) -> Parsed<Option<T>> {
        let open = self.at;
        self.expect(Punctuator::LeftParen)?;
        let result = read(self).and_then(|value| {
            self.expect(Punctuator::RightParen)?;
            Ok(value)
        });
        if result.is_err() {
            self.at = self.partner(open).ok_or(Halt)? + 1;
            self.unread(open);
        }
        self.end_piece();
        Ok(result.ok())
    }

    /// The bracket that closes the one at `open`.
    fn partner(&self, open: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for (index, token) in self.tokens.iter().enumerate().skip(open) {
            match token.kind {
                TokenKind::Punctuator(punctuator) if closing(punctuator).is_some() => depth += 1,
                TokenKind::Punctuator(punctuator) if is_closing(punctuator) => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return Some(index);
            }
        }
        None
    }

    /// Reads one of a list that commas separate; if it cannot be read, passes over it up to the comma or closing bracket.
    pub(super) fn recovering_item<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Option<T> {
        let start = self.at;
        let result = read(self);
        if result.is_err() {
            self.at = start;
            let mut depth = 0_usize;
            loop {
                match self.kind() {
                    TokenKind::End => break,
                    TokenKind::Punctuator(Punctuator::Comma) if depth == 0 => break,
                    TokenKind::Punctuator(punctuator) if closing(punctuator).is_some() => depth += 1,
                    TokenKind::Punctuator(punctuator) if is_closing(punctuator) && depth == 0 => break,
                    TokenKind::Punctuator(punctuator) if is_closing(punctuator) => depth -= 1,
                    _ => {}
                }
                self.next();
            }
            self.unread(start);
        }
        self.end_piece();
        result.ok()
    }
}

fn is_closing(punctuator: Punctuator) -> bool {
    matches!(
        punctuator,
        Punctuator::RightParen | Punctuator::RightBracket | Punctuator::RightBrace
    )
}
