//! The grammar (GLSL ES 3.00.6 §9), by recursive descent.
//!
//! Each function reads one construct and asks the checker for its node. What does not fit the grammar cannot be read: it has then
//! been told why, and [`Halt`] travels up to who can go on, which is the list of statements, parameters or declarations around it.

mod brace;
mod bracket;
mod control;
mod declaration;
mod expression;
mod function;
mod habit;
mod layout;
mod number;
mod qualifier;
mod recover;
mod statement;

pub(super) use bracket::balance;
use layout::Layout;
use toyproof_diagnostic::{Diagnostic, File, Span};

use super::MAX_NESTING;
use super::check::Checker;
use super::codes::Code;
use super::foreign::Foreign;
use super::preprocess::Preprocessed;
use super::token::{Punctuator, Symbol, Token, TokenKind};
use super::tree::Place;
use super::words::{Keyword, Word, Words};

/// The reason was told; this construct cannot be read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Halt;

type Parsed<T> = Result<T, Halt>;

/// Reads tokens and asks the checker.
pub(crate) struct Parser<'a> {
    tokens: &'a [Token],
    words: &'a Words,
    layout: Layout<'a>,
    at: usize,
    /// How many constructs are open that count for [`MAX_NESTING`].
    depth: usize,
    /// Where the piece begins that is being read: a statement without those inside of it.
    piece: usize,
    /// How many errors were told before it.
    told_before: usize,
    check: Checker<'a>,
}

impl<'a> Parser<'a> {
    /// The brackets of the text are [balanced](balance).
    pub(crate) fn new(text: &'a Preprocessed, file: &'a File, check: Checker<'a>) -> Self {
        Self {
            tokens: &text.tokens,
            words: &text.words,
            layout: Layout::new(file),
            at: 0,
            depth: 0,
            piece: 0,
            told_before: 0,
            check,
        }
    }

    /// Reads everything, up to what can be read.
    pub(crate) fn parse(mut self) -> Checker<'a> {
        while !self.is_at_end() {
            self.recovering(Self::external_declaration);
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

    /// Whether there is nothing left to read, nothing left to tell, or no time.
    fn is_at_end(&self) -> bool {
        self.kind() == TokenKind::End || self.check.is_full() || self.check.deadline.is_over()
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

    /// The `;` that ends a statement or declaration. Where it is missing and the next token begins something new, all goes on as if it stood
    /// there.
    fn semicolon(&mut self, wanted: &str) -> Parsed<()> {
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
            Some(text) => format!("`;` is missing after `{text}`"),
            None => "`;` is missing".to_owned(),
        };
        self.check
            .report(Code::Syntax.at(at, message).label("put a `;` here"));
        Ok(())
    }

    /// What the author wrote for a token.
    fn spelling(&self, token: Token) -> Option<&'a str> {
        match token.kind {
            TokenKind::Word(symbol) | TokenKind::Number(symbol) => Some(self.words.text(symbol)),
            TokenKind::Punctuator(punctuator) => Some(punctuator.text()),
            TokenKind::Unknown(_) | TokenKind::Stray | TokenKind::Newline | TokenKind::End => None,
        }
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
                ..
            } if matches!(self.words.word(symbol), Word::Name | Word::Reserved) => {
                self.at += 1;
                // One that is reserved is told of where it is declared, and then read as a name.
                if self.words.word(symbol) == Word::Reserved {
                    self.check.report(self.reserved(symbol, at));
                }
                Ok((symbol, at))
            }
            _ => self.unexpected("a name"),
        }
    }

    /// Tells that the next token is not what the grammar has here.
    fn unexpected<T>(&mut self, wanted: &str) -> Parsed<T> {
        let Token { kind, at, .. } = self.token();
        let found = match kind {
            TokenKind::Word(symbol) if self.words.word(symbol) == Word::Reserved => {
                return self.halt_with(self.reserved(symbol, at));
            }
            _ => match self.spelling(self.token()) {
                Some(text) => format!("`{text}`"),
                None => "the end of the text".to_owned(),
            },
        };
        let diagnostic = Code::Syntax.at(at, format!("expected {wanted}, found {found}"));
        self.halt_with(self.with_habit(diagnostic))
    }

    /// What is said of a word that may not be used.
    fn reserved(&self, word: Symbol, at: Place) -> Diagnostic {
        let text = self.words.text(word);
        let diagnostic = Code::ReservedWord.at(at, format!("`{text}` is a word that GLSL reserves"));
        match Foreign::named(text) {
            Some(foreign) => diagnostic
                .label(format!("write {}", foreign.instead()))
                .note(foreign.note()),
            None => diagnostic.label("choose another name"),
        }
    }

    /// Gives the piece up that is being read, and tells why. What else is wrong with it may come from that and is not told.
    fn halt<T>(&mut self, code: Code, at: Place, message: impl Into<String>) -> Parsed<T> {
        self.halt_with(code.at(at, message))
    }

    fn halt_with<T>(&mut self, diagnostic: Diagnostic) -> Parsed<T> {
        if self.is_told() {
            return self.halt_silently();
        }
        self.check.errors.truncate(self.told_before);
        self.check.report(diagnostic);
        Err(Halt)
    }

    /// The same where the reason has been told.
    fn halt_silently<T>(&mut self) -> Parsed<T> {
        self.check.errors.truncate(self.told_before);
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
        if self.check.deadline.is_over() {
            return self.halt_silently();
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }
}
