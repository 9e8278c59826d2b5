//! Habits from other languages, of programmers and of people: what to write instead.

use toyproof_diagnostic::Diagnostic;

use super::Parser;
use crate::codes::Code;
use crate::foreign::Foreign;
use crate::token::{Punctuator, Token, TokenKind};
use crate::words::{Keyword, Word};

impl Parser<'_> {
    /// The diagnostic about the next token with what to write, where a habit from another language is at work.
    pub(super) fn with_habit(&self, diagnostic: Diagnostic) -> Diagnostic {
        use Punctuator::{Assign, Comma, Greater, LeftBrace, Less};
        let previous = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        match (previous.map(|token| token.kind), self.kind()) {
            (_, TokenKind::Word(symbol)) if let Some(foreign) = Foreign::named(self.words.text(symbol)) => {
                diagnostic.label(format!("write {}", foreign.instead()))
            }
            (Some(before), TokenKind::Punctuator(LeftBrace)) if self.comes_before_value(before) => diagnostic
                .note(
                    "GLSL ES has no lists in braces: write `vec3(…)` for a vector, `float[](…)` for an array",
                ),
            (Some(TokenKind::Punctuator(Assign)), TokenKind::Punctuator(comparison @ (Less | Greater))) => {
                diagnostic.label(format!("write `{}=`", comparison.text()))
            }
            (Some(TokenKind::Punctuator(Comma)), TokenKind::Number(_))
                if let Some(number) = self.decimal_comma(self.at - 1) =>
            {
                diagnostic.label(format!("write `{number}`: GLSL has a decimal point"))
            }
            _ => diagnostic,
        }
    }

    /// Whether a value follows such a token, and no block.
    fn comes_before_value(&self, kind: TokenKind) -> bool {
        use Punctuator::{Assign, Comma, LeftBrace, LeftParen};
        match kind {
            TokenKind::Punctuator(before) => matches!(before, Assign | Comma | LeftBrace | LeftParen),
            TokenKind::Word(symbol) => self.words.word(symbol) == Word::Keyword(Keyword::Return),
            _ => false,
        }
    }

    /// Whether the next word is what other languages write for `else if`, with a condition behind it.
    pub(super) fn is_others_else_if(&self) -> bool {
        let TokenKind::Word(symbol) = self.kind() else {
            return false;
        };
        let foreign = Foreign::named(self.words.text(symbol));
        foreign.is_some_and(|foreign| foreign.instead() == "`else if`")
            && !self.check.is_declared(symbol)
            && self.peek(1).kind == TokenKind::Punctuator(Punctuator::LeftParen)
    }

    /// Tells of one, which is then read as if it were `else if`.
    pub(super) fn tell_else_if(&mut self) {
        let token = self.token();
        let text = self.spelling(token).unwrap_or_default();
        let diagnostic = Code::Syntax.at(token.at, format!("GLSL has no `{text}`"));
        // What is wrong with the arm before is no reason not to tell of this.
        self.end_piece();
        self.check.report(diagnostic.label("write `else if`"));
        self.end_piece();
    }

    /// The number that two whole numbers and the comma between them were meant for, where no space parts them.
    fn decimal_comma(&self, comma: usize) -> Option<String> {
        let three = self.tokens.get(comma.checked_sub(1)?..comma + 2)?;
        let adjoin = |pair: &[Token]| pair[0].at.spelled.end == pair[1].at.spelled.start;
        let is_comma = three[1].kind == TokenKind::Punctuator(Punctuator::Comma);
        if !is_comma || !three.windows(2).all(adjoin) {
            return None;
        }
        let [whole, fraction] = [three[0], three[2]].map(|token| match token.kind {
            TokenKind::Number(text) => Some(self.words.text(text)),
            _ => None,
        });
        let (whole, fraction) = (whole?, fraction?);
        let is_whole = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        (is_whole(whole) && is_whole(fraction)).then(|| format!("{whole}.{fraction}"))
    }

    /// Adds to what is wrong with a list of arguments, told after `told` other errors, that a decimal comma may be to blame. The list ends
    /// here and begins at the token `start`.
    pub(super) fn note_decimal_comma(&mut self, told: usize, start: usize) {
        if self.check.errors.len() <= told {
            return;
        }
        let is_comma = |index: &usize| self.tokens[*index].kind == TokenKind::Punctuator(Punctuator::Comma);
        let commas = || (start..self.at.min(self.tokens.len() - 1)).filter(is_comma);
        // Who writes all commas without a space, and all numbers without a point, writes whole numbers.
        let is_spaced =
            |index: usize| self.tokens[index].at.spelled.end != self.tokens[index + 1].at.spelled.start;
        let has_point = |index: usize| match self.tokens[index].kind {
            TokenKind::Number(text) => self.words.text(text).contains('.'),
            _ => false,
        };
        let is_mixed = commas().any(|index| is_spaced(index) || has_point(index - 1) || has_point(index + 1));
        let meant = commas().find_map(|comma| self.decimal_comma(comma));
        if let Some(number) = meant.filter(|_| is_mixed)
            && let Some(error) = self.check.errors.pop()
        {
            let comma = number.replace('.', ",");
            let note = format!("is `{comma}` one number? write `{number}`: GLSL has a decimal point");
            self.check.errors.push(error.note(note));
        }
    }
}
