//! The grammar (GLSL ES 3.00.6 §9), by recursive descent.
//!
//! Each function reads one construct and asks the checker for its node. What does not fit the grammar stops the parser: it has then
//! told the checker why, and [`Halt`] travels up to who can go on.

mod bracket;
mod control;
mod declaration;
mod expression;
mod function;
mod number;
mod qualifier;
mod statement;

use super::MAX_NESTING;
use super::check::Checker;
use super::codes::Code;
use super::preprocess::Preprocessed;
use super::token::{Punctuator, Symbol, Token, TokenKind};
use super::tree::Place;
use super::words::{Keyword, Word, Words};

/// The reason was told; there is no way on from here.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Halt;

type Parsed<T> = Result<T, Halt>;

/// Reads tokens and asks the checker.
pub(crate) struct Parser<'a> {
    tokens: &'a [Token],
    words: &'a Words,
    at: usize,
    /// How many constructs are open that count for [`MAX_NESTING`].
    depth: usize,
    check: Checker<'a>,
}

impl<'a> Parser<'a> {
    pub(crate) fn new(text: &'a Preprocessed, check: Checker<'a>) -> Self {
        Self {
            tokens: &text.tokens,
            words: &text.words,
            at: 0,
            depth: 0,
            check,
        }
    }

    /// Reads everything, as far as it can be read.
    pub(crate) fn parse(mut self) -> Checker<'a> {
        while self.kind() != TokenKind::End && !self.check.is_full() {
            if self.external_declaration().is_err() {
                break;
            }
        }
        self.check
    }

    fn token(&self) -> Token {
        self.peek(0)
    }

    /// The token that many after the next; the text ends in `End` for ever.
    fn peek(&self, ahead: usize) -> Token {
        let last = self.tokens.len() - 1;
        self.tokens[(self.at + ahead).min(last)]
    }

    fn kind(&self) -> TokenKind {
        self.token().kind
    }

    /// Takes the next token.
    fn next(&mut self) -> Token {
        let token = self.token();
        self.at += 1;
        token
    }

    /// From there to the token taken last.
    fn since(&self, start: Place) -> Place {
        start.to(self.tokens[self.at.saturating_sub(1).min(self.tokens.len() - 1)].at)
    }

    fn is(&self, punctuator: Punctuator) -> bool {
        self.kind() == TokenKind::Punctuator(punctuator)
    }

    /// Takes the punctuator if it comes next.
    fn eat(&mut self, punctuator: Punctuator) -> bool {
        let here = self.is(punctuator);
        self.at += usize::from(here);
        here
    }

    fn expect(&mut self, punctuator: Punctuator) -> Parsed<Place> {
        if self.is(punctuator) {
            return Ok(self.next().at);
        }
        self.unexpected(&format!("`{}`", punctuator.text()))
    }

    fn word(&self) -> Option<Word> {
        match self.kind() {
            TokenKind::Word(symbol) => Some(self.words.word(symbol)),
            _ => None,
        }
    }

    fn keyword(&self) -> Option<Keyword> {
        match self.word() {
            Some(Word::Keyword(keyword)) => Some(keyword),
            _ => None,
        }
    }

    fn eat_keyword(&mut self, keyword: Keyword) -> bool {
        let here = self.keyword() == Some(keyword);
        self.at += usize::from(here);
        here
    }

    /// A name of the author's.
    fn name(&mut self) -> Parsed<(Symbol, Place)> {
        match self.token() {
            Token {
                kind: TokenKind::Word(symbol),
                at,
            } if self.words.word(symbol) == Word::Name => {
                self.at += 1;
                Ok((symbol, at))
            }
            _ => self.unexpected("a name"),
        }
    }

    /// Tells that the next token is not what the grammar has here.
    fn unexpected<T>(&mut self, wanted: &str) -> Parsed<T> {
        let Token { kind, at } = self.token();
        let found = match kind {
            TokenKind::Word(symbol) if self.words.word(symbol) == Word::Reserved => {
                let message = format!("`{}` is reserved for future use", self.words.text(symbol));
                return self.halt(Code::ReservedWord, at, message);
            }
            TokenKind::Word(symbol) | TokenKind::Number(symbol) => format!("`{}`", self.words.text(symbol)),
            TokenKind::Punctuator(punctuator) => format!("`{}`", punctuator.text()),
            TokenKind::Unknown(c) => format!("`{c}`"),
            TokenKind::Newline | TokenKind::End => match bracket::unclosed(self.tokens) {
                Some((open, closing)) => return self.never_closed(open, closing),
                None => "the end of the text".to_owned(),
            },
        };
        self.halt(Code::Syntax, at, format!("expected {wanted}, found {found}"))
    }

    /// Tells that the text ends before a bracket's partner.
    fn never_closed<T>(&mut self, open: Token, closing: Punctuator) -> Parsed<T> {
        let opening = match closing {
            Punctuator::RightParen => Punctuator::LeftParen,
            Punctuator::RightBracket => Punctuator::LeftBracket,
            _ => Punctuator::LeftBrace,
        };
        let message = format!("this `{}` is never closed", opening.text());
        let note = format!("the text ends before its `{}`", closing.text());
        self.check.report(Code::Unclosed.at(open.at, message).note(note));
        Err(Halt)
    }

    fn halt<T>(&mut self, code: Code, at: Place, message: impl Into<String>) -> Parsed<T> {
        self.check.report(code.at(at, message));
        Err(Halt)
    }

    /// Reads something one level deeper.
    fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == MAX_NESTING {
            let at = self.token().at;
            return self.halt(
                Code::TooDeep,
                at,
                format!("this is nested more than {MAX_NESTING} deep"),
            );
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }
}
