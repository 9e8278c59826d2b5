//! The grammar (GLSL ES 3.00.6 §9), by recursive descent.
//!
//! Each function parses one construct and calls the checker for its node. If a construct cannot be parsed,
//! the error has been reported, and [`Halt`] propagates to the enclosing list of statements, parameters or
//! declarations, which resumes after it.

mod brace;
mod bracket;
mod declaration;
mod expression;
mod recover;
mod statement;

use toyproof_diagnostic::{Code, Diagnostic, File, Fix, Span};

pub(super) use self::bracket::balance;
pub(crate) use self::expression::LiteralError;
pub(crate) use self::recover::Layout;
use crate::MAX_NESTING;
use crate::check::Checker;
use crate::foreign::Foreign;
use crate::keywords::{Interner, Keyword, Word};
use crate::preprocess::PreprocessorOutput;
use crate::token::{Punctuator, Symbol, Token, TokenKind};
use crate::tree::Place;

/// This construct cannot be parsed; the reason has been reported.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Halt;

type ParseResult<T> = Result<T, Halt>;

/// Parses tokens and calls the checker.
pub(crate) struct Parser<'a> {
    tokens: &'a [Token],
    interner: &'a Interner,
    layout: Layout<'a>,
    at: usize,
    /// The number of open constructs that count for [`MAX_NESTING`].
    depth: usize,
    /// The first token of the current recovery unit: a statement without its inner statements.
    unit_start: usize,
    /// The number of errors reported before the unit.
    errors_before_unit: usize,
    check: Checker<'a>,
}

impl<'a> Parser<'a> {
    /// Makes a parser for a text whose brackets are [balanced](balance).
    pub(crate) fn new(text: &'a PreprocessorOutput, file: &'a File, check: Checker<'a>) -> Self {
        Self {
            tokens: &text.tokens,
            interner: &text.interner,
            layout: Layout::new(file),
            at: 0,
            depth: 0,
            unit_start: 0,
            errors_before_unit: 0,
            check,
        }
    }

    /// Parses the whole text and returns the checker.
    pub(crate) fn parse(mut self) -> Checker<'a> {
        while !self.is_at_end() {
            self.recovering(Self::external_declaration);
        }
        self.check
    }

    fn token(&self) -> Token {
        self.peek(0)
    }

    /// The token `ahead` positions after the next one; after the end, always `End`.
    fn peek(&self, ahead: usize) -> Token {
        let last = self.tokens.len() - 1;
        self.tokens[(self.at + ahead).min(last)]
    }

    /// Whether the parser stops: at the end of the text, at the limit on errors, or at the deadline.
    fn is_at_end(&self) -> bool {
        self.kind() == TokenKind::End || self.check.is_full() || self.check.deadline.is_over()
    }

    fn kind(&self) -> TokenKind {
        self.token().kind
    }

    /// Consumes the next token.
    fn next(&mut self) -> Token {
        let token = self.token();
        self.at += 1;
        token
    }

    /// The place from `start` to the last consumed token.
    fn place_from(&self, start: Place) -> Place {
        start.to(self.tokens[self.at.saturating_sub(1).min(self.tokens.len() - 1)].at)
    }

    /// The byte at which a scope ends that ends here: after its `}` or `;`. Where neither is, the text up to
    /// the next token belongs to it, which an author may be writing.
    fn scope_end(&self) -> u32 {
        let last = self.tokens[self.at.saturating_sub(1).min(self.tokens.len() - 1)];
        match last.kind {
            TokenKind::Punctuator(Punctuator::RightBrace | Punctuator::Semicolon) if !last.reported => {
                last.at.span.end
            }
            _ => self.token().at.span.start,
        }
    }

    fn is(&self, punctuator: Punctuator) -> bool {
        self.kind() == TokenKind::Punctuator(punctuator)
    }

    /// Consumes the punctuator if it is the next token.
    fn eat(&mut self, punctuator: Punctuator) -> bool {
        let here = self.is(punctuator);
        self.at += usize::from(here);
        here
    }

    fn expect(&mut self, punctuator: Punctuator) -> ParseResult<Place> {
        if self.is(punctuator) {
            return Ok(self.next().at);
        }
        self.unexpected(&format!("`{}`", punctuator.text()))
    }

    /// Consumes the `;` that ends a statement or declaration. If it is missing and the next token begins a
    /// new construct, reports that and continues as if it were there.
    fn semicolon(&mut self, wanted: &str) -> ParseResult<()> {
        if self.eat(Punctuator::Semicolon) {
            return Ok(());
        }
        let previous = self.tokens[(self.at - 1).min(self.tokens.len() - 1)];
        let next = self.token();
        let begins_anew = match next.kind {
            TokenKind::Word(_) | TokenKind::Number(_) => {
                self.layout.line_between(previous, next) || self.keyword().is_some()
            }
            TokenKind::Punctuator(Punctuator::LeftBrace) => self.layout.line_between(previous, next),
            TokenKind::Punctuator(Punctuator::RightBrace) | TokenKind::End => true,
            _ => false,
        };
        if !begins_anew {
            return self.unexpected(wanted);
        }
        let end = previous.at.span.end;
        let at = Place::plain(Span::new(previous.at.span.file, end, end));
        let message = match self.spelling(previous) {
            Some(text) => format!("expected `;` after `{text}`"),
            None => "expected `;`".to_owned(),
        };
        self.check.report(
            Code::Syntax
                .at(at, message)
                .fix(Fix::new("add `;`", at.span, ";")),
        );
        Ok(())
    }

    /// The text of a token; `None` for tokens without a text.
    fn spelling(&self, token: Token) -> Option<&'a str> {
        match token.kind {
            TokenKind::Word(symbol) | TokenKind::Number(symbol) => Some(self.interner.text(symbol)),
            TokenKind::Punctuator(punctuator) => Some(punctuator.text()),
            TokenKind::Unknown(_) | TokenKind::Stray | TokenKind::Newline | TokenKind::End => None,
        }
    }

    fn word(&self) -> Option<Word> {
        match self.kind() {
            TokenKind::Word(symbol) => Some(self.interner.word(symbol)),
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

    /// Parses an identifier.
    fn name(&mut self) -> ParseResult<(Symbol, Place)> {
        match self.token() {
            Token {
                kind: TokenKind::Word(symbol),
                at,
                ..
            } if matches!(self.interner.word(symbol), Word::Name | Word::Reserved) => {
                self.at += 1;
                // A reserved word is reported where it is declared, and then treated as a name.
                if self.interner.word(symbol) == Word::Reserved {
                    self.check.report(self.reserved(symbol, at));
                }
                Ok((symbol, at))
            }
            _ => self.unexpected("a name"),
        }
    }

    /// Reports that the next token does not fit the grammar.
    fn unexpected<T>(&mut self, wanted: &str) -> ParseResult<T> {
        let Token { kind, at, .. } = self.token();
        let found = match kind {
            TokenKind::Word(symbol) if self.interner.word(symbol) == Word::Reserved => {
                return self.halt_with(self.reserved(symbol, at));
            }
            _ => match self.spelling(self.token()) {
                Some(text) => format!("`{text}`"),
                None => "the end of the file".to_owned(),
            },
        };
        let diagnostic = Code::Syntax.at(at, format!("expected {wanted}, found {found}"));
        self.halt_with(self.with_foreign_syntax_hint(diagnostic))
    }

    /// The error about a reserved word.
    fn reserved(&self, word: Symbol, at: Place) -> Diagnostic {
        let text = self.interner.text(word);
        let diagnostic = Code::ReservedWord.at(at, format!("`{text}` is a reserved word"));
        match Foreign::named(text) {
            Some(foreign) => foreign.advise(diagnostic, at, None).note(foreign.note()),
            None => diagnostic.label("choose a different name"),
        }
    }

    /// Reports an error and abandons the current recovery unit. Other errors of the unit may follow from this
    /// one and are dropped.
    fn halt<T>(&mut self, code: Code, at: Place, message: impl Into<String>) -> ParseResult<T> {
        self.halt_with(code.at(at, message))
    }

    fn halt_with<T>(&mut self, diagnostic: Diagnostic) -> ParseResult<T> {
        if self.is_reported() {
            return self.halt_silently();
        }
        self.check.errors.truncate(self.errors_before_unit);
        self.check.report(diagnostic);
        Err(Halt)
    }

    /// Gives up the current recovery unit, whose error has been reported.
    fn halt_silently<T>(&mut self) -> ParseResult<T> {
        self.check.errors.truncate(self.errors_before_unit);
        Err(Halt)
    }

    /// Parses a construct one nesting level deeper.
    fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> ParseResult<T>) -> ParseResult<T> {
        if self.depth == MAX_NESTING {
            let at = self.token().at;
            return self.halt(
                Code::TooDeep,
                at,
                format!("nesting deeper than {MAX_NESTING} levels"),
            );
        }
        if self.check.deadline.is_over() {
            return self.halt_silently();
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }
}
