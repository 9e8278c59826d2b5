//! Error recovery: skipping text that cannot be parsed, source layout, and hints about foreign syntax.

use toyproof_diagnostic::{Code, Diagnostic, File, Fix, Span};

use super::bracket::closing;
use super::{Halt, ParseResult, Parser};
use crate::foreign::Foreign;
use crate::keywords::{Keyword, Word};
use crate::token::{Punctuator, Token, TokenKind};

impl Parser<'_> {
    /// Parses one of a list of statements or declarations; if it cannot be parsed, skips it.
    pub(super) fn recovering<T>(&mut self, read: impl FnOnce(&mut Self) -> ParseResult<T>) -> Option<T> {
        let start = self.at;
        self.end_unit();
        let result = read(self);
        if result.is_err() {
            self.skip_construct(start);
            self.mark_names_maybe_declared(start);
        }
        self.end_unit();
        result.ok()
    }

    /// Starts a new recovery unit. Errors of a unit that contains a reported token may follow from that error
    /// and are dropped.
    pub(super) fn end_unit(&mut self) {
        if self.is_reported() {
            self.check.errors.truncate(self.errors_before_unit);
        }
        self.unit_start = self.at;
        self.errors_before_unit = self.check.errors.len();
    }

    /// Whether the current recovery unit contains a token whose error has been reported.
    pub(super) fn is_reported(&self) -> bool {
        let end = (self.at + 1).min(self.tokens.len());
        self.tokens[self.unit_start.min(end)..end]
            .iter()
            .any(|token| token.reported)
    }

    /// Skips the rest of the statement or declaration that began at `start`: up to its `;` or past its `{…}`,
    /// but never past the enclosing `}`, nor past a line that begins a statement. At least one token is
    /// skipped.
    fn skip_construct(&mut self, start: usize) {
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

    /// Whether the next token is the first of its line and can only begin a new statement or declaration.
    fn begins_statement(&self) -> bool {
        let begins = match self.word() {
            Some(Word::Keyword(Keyword::Else | Keyword::True | Keyword::False)) => false,
            Some(Word::Keyword(_)) => true,
            // A constructor is not a declaration.
            Some(Word::Type(_)) => matches!(self.peek(1).kind, TokenKind::Word(_)),
            _ => false,
        };
        begins && self.layout.begins_line(self.token())
    }

    /// Marks every name that the skipped text may declare, so that it is not reported as undeclared.
    fn mark_names_maybe_declared(&mut self, start: usize) {
        let interner = self.interner;
        self.check.assume_returns();
        for pair in self.tokens[start..self.at.min(self.tokens.len())].windows(2) {
            let declares = match pair[0].kind {
                TokenKind::Word(word) => !matches!(interner.word(word), Word::Keyword(Keyword::Return)),
                TokenKind::Punctuator(punctuator) => punctuator == Punctuator::Comma,
                TokenKind::Number(_) => true,
                _ => false,
            };
            if let TokenKind::Word(name) = pair[1].kind
                && declares
                && interner.word(name) == Word::Name
            {
                self.check.mark_maybe_declared(name);
            }
        }
    }

    /// Parses a parenthesized construct such as the head of an `if`; if it cannot be parsed, resumes after
    /// the `)` and returns `None`.
    pub(super) fn parenthesized<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> ParseResult<T>,
    ) -> ParseResult<Option<T>> {
        let open = self.at;
        self.expect(Punctuator::LeftParen)?;
        let result = read(self).and_then(|value| {
            self.expect(Punctuator::RightParen)?;
            Ok(value)
        });
        if result.is_err() {
            self.at = self.partner(open).ok_or(Halt)? + 1;
            self.mark_names_maybe_declared(open);
        }
        self.end_unit();
        Ok(result.ok())
    }

    /// The index of the bracket that closes the one at `open`.
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

    /// Parses one item of a comma-separated list; if it cannot be parsed, skips to the comma or closing
    /// bracket.
    pub(super) fn recovering_item<T>(&mut self, read: impl FnOnce(&mut Self) -> ParseResult<T>) -> Option<T> {
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
            self.mark_names_maybe_declared(start);
        }
        self.end_unit();
        result.ok()
    }
}

fn is_closing(punctuator: Punctuator) -> bool {
    matches!(
        punctuator,
        Punctuator::RightParen | Punctuator::RightBracket | Punctuator::RightBrace
    )
}

// Source layout: where lines begin, and their indentation. It does not matter in GLSL, but shows the author's
// intention where brackets do not match.

/// The width of a tab in columns, as in most editors.
const TAB_WIDTH: usize = 4;

/// The source text of the tokens.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout<'a> {
    text: &'a str,
}

impl<'a> Layout<'a> {
    pub(crate) fn new(file: &'a File) -> Self {
        Self { text: file.text() }
    }

    /// Whether only blanks precede the token on its line.
    pub(super) fn begins_line(self, token: Token) -> bool {
        let before = &self.text.as_bytes()[..token.at.span.start as usize];
        let last = before.iter().rev().find(|byte| !matches!(byte, b' ' | b'\t'));
        matches!(last, None | Some(b'\n' | b'\r'))
    }

    /// The indentation of the token's line in columns.
    pub(crate) fn indent(self, token: Token) -> usize {
        let before = &self.text[..token.at.span.start as usize];
        let line = before.rfind('\n').map_or(0, |newline| newline + 1);
        let blanks = self.text[line..]
            .bytes()
            .take_while(|byte| matches!(byte, b' ' | b'\t'));
        blanks.fold(0, |width, byte| {
            if byte == b'\t' {
                width - width % TAB_WIDTH + TAB_WIDTH
            } else {
                width + 1
            }
        })
    }

    /// Whether a line ends between two consecutive tokens.
    pub(super) fn line_between(self, first: Token, second: Token) -> bool {
        let gap = self
            .text
            .get(first.at.span.end as usize..second.at.span.start as usize);
        gap.is_some_and(|gap| gap.contains('\n'))
    }
}

// Hints about syntax of other languages and notations: the GLSL to write instead.

impl Parser<'_> {
    /// Adds a hint to a diagnostic about the next token if it looks like syntax of another language.
    pub(super) fn with_foreign_syntax_hint(&self, diagnostic: Diagnostic) -> Diagnostic {
        use Punctuator::{Assign, Comma, Greater, LeftBrace, Less};
        let previous = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        match (previous.map(|token| token.kind), self.kind()) {
            (_, TokenKind::Word(symbol)) => match Foreign::named(self.interner.text(symbol)) {
                Some(foreign) => foreign.advise(diagnostic, self.token().at, None),
                None => diagnostic,
            },
            (Some(before), TokenKind::Punctuator(LeftBrace)) if self.comes_before_value(before) => diagnostic
                .help("GLSL ES has no initializer lists: write `vec3(…)` for a vector, `float[](…)` for an array"),
            (Some(TokenKind::Punctuator(Assign)), TokenKind::Punctuator(comparison @ (Less | Greater))) => {
                let meant = format!("{}=", comparison.text());
                let both = self.tokens[self.at - 1].at.spelling.to(self.token().at.spelling);
                diagnostic.fix(Fix::new(format!("write `{meant}`"), both, meant))
            }
            (Some(TokenKind::Punctuator(Comma)), TokenKind::Number(_)) => {
                match self.decimal_comma(self.at - 1) {
                    Some((number, span)) => {
                        let message = format!("write `{number}`: the decimal separator is a point");
                        diagnostic.fix(Fix::new(message, span, number))
                    }
                    None => diagnostic,
                }
            }
            _ => diagnostic,
        }
    }

    /// Whether a value, and not a block, follows such a token.
    fn comes_before_value(&self, kind: TokenKind) -> bool {
        use Punctuator::{Assign, Comma, LeftBrace, LeftParen};
        match kind {
            TokenKind::Punctuator(before) => matches!(before, Assign | Comma | LeftBrace | LeftParen),
            TokenKind::Word(symbol) => self.interner.word(symbol) == Word::Keyword(Keyword::Return),
            _ => false,
        }
    }

    /// Whether the next word is another language's `else if`, followed by a condition.
    pub(super) fn is_foreign_else_if(&self) -> bool {
        let TokenKind::Word(symbol) = self.kind() else {
            return false;
        };
        let foreign = Foreign::named(self.interner.text(symbol));
        foreign.is_some_and(|foreign| foreign.replacement() == "`else if`")
            && !self.check.is_declared(symbol)
            && self.peek(1).kind == TokenKind::Punctuator(Punctuator::LeftParen)
    }

    /// Reports a foreign `else if`, which is then parsed as `else if`.
    pub(super) fn report_foreign_else_if(&mut self) {
        let token = self.token();
        let text = self.spelling(token).unwrap_or_default();
        let diagnostic = Code::Syntax.at(token.at, format!("`{text}` is not a GLSL keyword"));
        // Errors in the preceding arm must not suppress this one.
        self.end_unit();
        self.check
            .report(diagnostic.fix(Fix::new("write `else if`", token.at.spelling, "else if")));
        self.end_unit();
    }

    /// The decimal number that is probably meant by two integers with a comma but no space between them, and
    /// their span.
    fn decimal_comma(&self, comma: usize) -> Option<(String, Span)> {
        let three = self.tokens.get(comma.checked_sub(1)?..comma + 2)?;
        let adjoin = |pair: &[Token]| pair[0].at.spelling.end == pair[1].at.spelling.start;
        let is_comma = three[1].kind == TokenKind::Punctuator(Punctuator::Comma);
        if !is_comma || !three.windows(2).all(adjoin) {
            return None;
        }
        let [whole, fraction] = [three[0], three[2]].map(|token| match token.kind {
            TokenKind::Number(text) => Some(self.interner.text(text)),
            _ => None,
        });
        let (whole, fraction) = (whole?, fraction?);
        let is_whole = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        let span = three[0].at.spelling.to(three[2].at.spelling);
        (is_whole(whole) && is_whole(fraction)).then(|| (format!("{whole}.{fraction}"), span))
    }

    /// Adds a note about a decimal comma to the last error about a list of arguments, if an error was
    /// reported after the first `reported` ones. The list begins at the token `start` and ends here.
    pub(super) fn note_decimal_comma(&mut self, reported: usize, start: usize) {
        if self.check.errors.len() <= reported {
            return;
        }
        let is_comma = |index: &usize| self.tokens[*index].kind == TokenKind::Punctuator(Punctuator::Comma);
        let commas = || (start..self.at.min(self.tokens.len() - 1)).filter(is_comma);
        // If no comma is followed by a space and no number has a point, the author means integers.
        let is_spaced =
            |index: usize| self.tokens[index].at.spelling.end != self.tokens[index + 1].at.spelling.start;
        let has_point = |index: usize| match self.tokens[index].kind {
            TokenKind::Number(text) => self.interner.text(text).contains('.'),
            _ => false,
        };
        let is_mixed = commas().any(|index| is_spaced(index) || has_point(index - 1) || has_point(index + 1));
        let meant = commas().find_map(|comma| self.decimal_comma(comma));
        if let Some((number, span)) = meant.filter(|_| is_mixed)
            && let Some(error) = self.check.errors.pop()
        {
            let message = format!("write `{number}` if this is one number");
            self.check.errors.push(error.fix(Fix::new(message, span, number)));
        }
    }
}
