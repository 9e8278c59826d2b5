//! The tokens of a source text as it is written, with their lines: where an edit may be made.

use toyproof_diagnostic::{FileId, Files, Span};

use crate::keywords::{Interner, Keyword, Word};
use crate::parse::Layout;
use crate::preprocess::source_tokens;
use crate::token::{Punctuator, Symbol, Token, TokenKind};

/// Maximum number of tokens to search for the partner of a bracket or for the begin of a statement.
const MAX_SEARCHED_TOKENS: usize = 200;

/// Maximum length in bytes of the text that a message quotes.
const MAX_QUOTED_BYTES: usize = 32;

/// The line of a token.
#[derive(Debug, Clone, Copy)]
struct Line {
    number: usize,
    indent: usize,
    /// Whether the line is a preprocessor directive.
    is_directive: bool,
}

/// A token of a text as it is written: directives are not executed, macros not expanded, comments not tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lexeme {
    /// Its characters.
    pub span: Span,
    /// Whether it is part of a preprocessor directive.
    pub is_in_directive: bool,
    /// The number of its line from 0; lines that a `\\` continues are one.
    pub line: usize,
}

/// The tokens of a text, valid or not, for edits of the text.
///
/// ```
/// use toyproof_diagnostic::{File, Files};
///
/// let mut files = Files::default();
/// let file = files.add(File::new("a.glsl", "#define A 1. // one\nfloat x;"));
/// let lexemes = toyproof_glsl::lexemes(&files, file);
/// let texts: Vec<_> = lexemes.iter().map(|lexeme| files.text(lexeme.span)).collect();
/// assert_eq!(texts, ["#", "define", "A", "1.", "float", "x", ";"]);
/// assert!(lexemes[3].is_in_directive && !lexemes[4].is_in_directive);
/// ```
pub fn lexemes(files: &Files, file: FileId) -> Vec<Lexeme> {
    let source = Source::new(files, file);
    let tokens = source.tokens.iter().zip(&source.lines);
    tokens
        .map(|(token, line)| Lexeme {
            span: token.at.span,
            is_in_directive: line.is_directive,
            line: line.number,
        })
        .collect()
}

/// A source text as tokens. An index past the last token is valid and has no token.
pub(crate) struct Source<'a> {
    pub(crate) text: &'a str,
    pub(crate) file: FileId,
    pub(crate) interner: Interner,
    tokens: Vec<Token>,
    lines: Vec<Line>,
}

impl<'a> Source<'a> {
    pub(crate) fn new(files: &'a Files, file: FileId) -> Self {
        let layout = Layout::new(files.get(file));
        let (written, interner) = source_tokens(files, file);
        let (mut tokens, mut lines) = (Vec::with_capacity(written.len()), Vec::new());
        let mut number = 0;
        let mut line: Option<Line> = None;
        for token in written {
            if token.kind == TokenKind::Newline {
                number += 1;
                line = None;
                continue;
            }
            let line = *line.get_or_insert_with(|| Line {
                number,
                indent: layout.indent(token),
                is_directive: token.kind == TokenKind::Punctuator(Punctuator::Hash),
            });
            tokens.push(token);
            lines.push(line);
        }
        let text = files.get(file).text();
        Self {
            text,
            file,
            interner,
            tokens,
            lines,
        }
    }

    /// The number of tokens.
    pub(crate) fn len(&self) -> usize {
        self.tokens.len()
    }

    /// The index of the first token that ends after a byte.
    pub(crate) fn index_at(&self, byte: u32) -> usize {
        self.tokens.partition_point(|token| token.at.span.end <= byte)
    }

    /// The span of a token; past the last one, the end of the text.
    pub(crate) fn span(&self, index: usize) -> Span {
        let end = self.text.len() as u32;
        let end = Span::new(self.file, end, end);
        self.tokens.get(index).map_or(end, |token| token.at.span)
    }

    pub(crate) fn token_text(&self, index: usize) -> &'a str {
        self.slice(self.span(index))
    }

    /// The text of a span.
    pub(crate) fn slice(&self, span: Span) -> &'a str {
        self.text
            .get(span.start as usize..span.end as usize)
            .unwrap_or_default()
    }

    fn kind(&self, index: usize) -> TokenKind {
        self.tokens.get(index).map_or(TokenKind::End, |token| token.kind)
    }

    pub(crate) fn punctuator(&self, index: usize) -> Option<Punctuator> {
        match self.kind(index) {
            TokenKind::Punctuator(punctuator) => Some(punctuator),
            _ => None,
        }
    }

    pub(crate) fn is(&self, index: usize, punctuator: Punctuator) -> bool {
        self.punctuator(index) == Some(punctuator)
    }

    pub(crate) fn symbol(&self, index: usize) -> Option<Symbol> {
        match self.kind(index) {
            TokenKind::Word(symbol) => Some(symbol),
            _ => None,
        }
    }

    pub(crate) fn word(&self, index: usize) -> Option<Word> {
        self.symbol(index).map(|symbol| self.interner.word(symbol))
    }

    pub(crate) fn keyword(&self, index: usize) -> Option<Keyword> {
        match self.word(index) {
            Some(Word::Keyword(keyword)) => Some(keyword),
            _ => None,
        }
    }

    pub(crate) fn is_name(&self, index: usize) -> bool {
        self.word(index) == Some(Word::Name)
    }

    pub(crate) fn is_type(&self, index: usize) -> bool {
        matches!(self.word(index), Some(Word::Type(_)))
    }

    pub(crate) fn is_number(&self, index: usize) -> bool {
        matches!(self.kind(index), TokenKind::Number(_))
    }

    pub(crate) fn is_in_directive(&self, index: usize) -> bool {
        self.lines.get(index).is_some_and(|line| line.is_directive)
    }

    /// The number of a token's line, from 0.
    pub(crate) fn line(&self, index: usize) -> usize {
        let last = self.lines.last().map_or(0, |line| line.number + 1);
        self.lines.get(index).map_or(last, |line| line.number)
    }

    /// The indentation of a token's line in columns.
    pub(crate) fn indent(&self, index: usize) -> usize {
        self.lines.get(index).map_or(0, |line| line.indent)
    }

    /// Whether the token is the first of its line.
    pub(crate) fn begins_line(&self, index: usize) -> bool {
        index == 0 || self.line(index) != self.line(index - 1)
    }

    /// Whether an expression may end with the token.
    pub(crate) fn ends_operand(&self, index: usize) -> bool {
        match self.kind(index) {
            TokenKind::Number(_) => true,
            TokenKind::Word(_) => matches!(
                self.word(index),
                Some(Word::Name | Word::Keyword(Keyword::True | Keyword::False))
            ),
            TokenKind::Punctuator(punctuator) => matches!(
                punctuator,
                Punctuator::RightParen
                    | Punctuator::RightBracket
                    | Punctuator::Increment
                    | Punctuator::Decrement
            ),
            _ => false,
        }
    }

    /// Whether an expression may begin with the token.
    pub(crate) fn begins_operand(&self, index: usize) -> bool {
        match self.kind(index) {
            TokenKind::Number(_) => true,
            TokenKind::Word(_) => matches!(
                self.word(index),
                Some(Word::Name | Word::Type(_) | Word::Keyword(Keyword::True | Keyword::False))
            ),
            TokenKind::Punctuator(punctuator) => matches!(
                punctuator,
                Punctuator::LeftParen
                    | Punctuator::Not
                    | Punctuator::Tilde
                    | Punctuator::Plus
                    | Punctuator::Minus
                    | Punctuator::Increment
                    | Punctuator::Decrement
            ),
            _ => false,
        }
    }

    /// Whether a statement or a block ends before the token.
    pub(crate) fn follows_statement(&self, index: usize) -> bool {
        let Some(before) = index.checked_sub(1) else {
            return true;
        };
        self.is_in_directive(before)
            || matches!(
                self.punctuator(before),
                Some(Punctuator::Semicolon | Punctuator::LeftBrace | Punctuator::RightBrace)
            )
    }

    /// The index after the operand that begins with the word at `index`: with arguments, indices and members.
    pub(crate) fn operand_end(&self, index: usize) -> usize {
        let mut end = index + 1;
        loop {
            if matches!(
                self.punctuator(end),
                Some(Punctuator::LeftParen | Punctuator::LeftBracket)
            ) {
                match self.partner(end) {
                    Some(close) => end = close + 1,
                    None => return end,
                }
            } else if self.is(end, Punctuator::Dot) && self.is_name(end + 1) {
                end += 2;
            } else {
                return end;
            }
        }
    }

    /// The index of the bracket that closes the one at `open`, if it is near.
    pub(crate) fn partner(&self, open: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for index in (open..self.len()).take(MAX_SEARCHED_TOKENS) {
            match self.punctuator(index) {
                Some(Punctuator::LeftParen | Punctuator::LeftBracket) => depth += 1,
                Some(Punctuator::RightParen | Punctuator::RightBracket) => depth = depth.saturating_sub(1),
                Some(Punctuator::Semicolon | Punctuator::LeftBrace | Punctuator::RightBrace)
                    if !self.is_for_head(open) =>
                {
                    return None;
                }
                _ => {}
            }
            if depth == 0 {
                return Some(index);
            }
        }
        None
    }

    fn is_for_head(&self, open: usize) -> bool {
        open > 0 && self.keyword(open - 1) == Some(Keyword::For)
    }

    /// The end of the text before a byte, as a message quotes it: the last token, or a short call.
    pub(crate) fn quoted_end(&self, byte: u32) -> &'a str {
        let index = self.index_at(byte);
        let span = self.span(index);
        if span.start < byte {
            return self.slice(Span::new(self.file, span.start, byte));
        }
        let Some(last) = index.checked_sub(1) else {
            return "";
        };
        let is_closing = |punctuator| matches!(punctuator, Punctuator::RightParen | Punctuator::RightBracket);
        let begin = self
            .punctuator(last)
            .filter(|&punctuator| is_closing(punctuator))
            .and_then(|_| self.call_begin(last));
        let whole = self.slice(self.span(begin.unwrap_or(last)).to(self.span(last)));
        if whole.len() <= MAX_QUOTED_BYTES && !whole.contains(['\n', '\r']) {
            whole
        } else {
            self.token_text(last)
        }
    }

    /// The index of the name of the call, or of the `(`, that the `)` at `close` ends, if it is near.
    fn call_begin(&self, close: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for index in (0..=close).rev().take(MAX_QUOTED_BYTES) {
            match self.punctuator(index) {
                Some(Punctuator::RightParen | Punctuator::RightBracket) => depth += 1,
                Some(Punctuator::LeftParen | Punctuator::LeftBracket) => depth = depth.checked_sub(1)?,
                _ => {}
            }
            if depth == 0 {
                let name = index.checked_sub(1).filter(|&name| self.symbol(name).is_some());
                return Some(name.unwrap_or(index));
            }
        }
        None
    }
}
