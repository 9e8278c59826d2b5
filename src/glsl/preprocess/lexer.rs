//! The lexer (GLSL ES 3.00.6 §3.1–3.4): line continuations, comments, words, numbers, punctuators.

use toyproof_diagnostic::{Code, Diagnostic, FileId, Span};

use crate::keywords::Interner;
use crate::token::{Punctuator, TokenKind};
use crate::tree::Place;

/// A token with the data that only the preprocessor needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct PpToken {
    pub(super) kind: TokenKind,
    pub(super) at: Place,
    /// Whether blanks or a comment precede it: `F (x)` defines an object-like macro, `F(x)` a function-like
    /// one.
    pub(super) spaced: bool,
    /// Whether the token is a macro's name in that macro's own expansion, and must never be expanded.
    pub(super) no_expand: bool,
}

/// A `// toyproof: …` comment.
#[derive(Debug, Clone, Copy)]
pub struct ControlComment {
    /// The span, from the `//` to the end of the line.
    pub at: Span,
    /// Whether only comments precede it in the file.
    pub first: bool,
    /// Whether the comment is alone on its line.
    pub alone: bool,
}

/// Tokenizes one file. Newlines are tokens; after the last token it returns `End` forever.
pub(super) struct Lexer<'a> {
    file: FileId,
    text: &'a str,
    at: usize,
    /// The text of the current word or number, without line continuations.
    scratch: String,
    /// Whether a token other than a newline was read.
    begun: bool,
    /// The `// toyproof:` comments so far.
    pub(super) control_comments: Vec<ControlComment>,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(file: FileId, text: &'a str) -> Self {
        Self {
            file,
            text,
            at: 0,
            scratch: String::new(),
            begun: false,
            control_comments: Vec::new(),
        }
    }

    /// Reads the next token. A comment counts as one blank, even across lines (§3.3).
    pub(super) fn next(&mut self, interner: &mut Interner, diagnostics: &mut Vec<Diagnostic>) -> PpToken {
        let begin = self.at;
        if let Err(error) = self.skip_blanks() {
            diagnostics.push(*error);
        }
        let spaced = self.at > begin;
        let start = self.at;
        let kind = match self.peek() {
            None => TokenKind::End,
            Some('\n') => {
                self.bump();
                TokenKind::Newline
            }
            Some(c) if is_word_start(c) => {
                self.take_while(|_, c| is_word_start(c) || c.is_ascii_digit());
                TokenKind::Word(interner.symbol(&self.scratch))
            }
            Some(c)
                if c.is_ascii_digit()
                    || (c == '.' && self.peek_second().is_some_and(|c| c.is_ascii_digit())) =>
            {
                // Like C's pp-number: everything that continues a digit is one token, valid or not.
                self.take_while(|so_far, c| {
                    let exponent = so_far.ends_with(['e', 'E']) && !so_far.starts_with("0x");
                    is_word_start(c) || c.is_ascii_digit() || c == '.' || (matches!(c, '+' | '-') && exponent)
                });
                TokenKind::Number(interner.symbol(&self.scratch))
            }
            Some(c) => self.punctuator(c),
        };
        self.begun |= kind != TokenKind::Newline;
        let span = Span::new(self.file, start as u32, self.at as u32);
        PpToken {
            kind,
            at: Place::plain(span),
            spaced,
            no_expand: false,
        }
    }

    /// The rest of the line, without surrounding blanks.
    pub(super) fn rest_of_line(&mut self) -> String {
        self.scratch.clear();
        while let Some(c) = self.peek().filter(|&c| c != '\n') {
            self.scratch.push(c);
            self.bump();
        }
        self.scratch.trim().to_owned()
    }

    /// Skips to the end of the text.
    pub(super) fn skip_to_end(&mut self) {
        self.at = self.text.len();
    }

    /// The current position.
    pub(super) fn place(&self) -> Place {
        Place::plain(Span::new(self.file, self.at as u32, self.at as u32))
    }

    fn punctuator(&mut self, first: char) -> TokenKind {
        // In the order of `ALL`, the longest match comes first.
        for &punctuator in Punctuator::ALL {
            let text = punctuator.text();
            if u8::try_from(first).is_ok_and(|first| text.as_bytes()[0] == first) {
                let start = self.at;
                if text.chars().all(|c| self.eat(c)) {
                    return TokenKind::Punctuator(punctuator);
                }
                self.at = start;
            }
        }
        self.bump();
        TokenKind::Unknown(first)
    }

    fn skip_blanks(&mut self) -> Result<(), Box<Diagnostic>> {
        loop {
            match self.peek() {
                Some(' ' | '\t' | '\u{b}' | '\u{c}') => self.bump(),
                Some('/') if self.peek_second() == Some('/') => {
                    self.line_comment();
                }
                Some('/') if self.peek_second() == Some('*') => self.block_comment()?,
                _ => return Ok(()),
            }
        }
    }

    fn line_comment(&mut self) {
        let start = self.at;
        while self.peek().is_some_and(|c| c != '\n') {
            self.bump();
        }
        if self.text[start + 2..self.at]
            .trim_start()
            .starts_with("toyproof:")
        {
            let before = self.text[..start].trim_end_matches([' ', '\t']);
            self.control_comments.push(ControlComment {
                at: Span::new(self.file, start as u32, self.at as u32),
                first: !self.begun,
                alone: before.is_empty() || before.ends_with(['\n', '\r']),
            });
        }
    }

    fn block_comment(&mut self) -> Result<(), Box<Diagnostic>> {
        let open = Span::new(self.file, self.at as u32, self.at as u32 + 2);
        self.bump();
        self.bump();
        while let Some(c) = self.peek() {
            self.bump();
            if c == '*' && self.eat('/') {
                return Ok(());
            }
        }
        Code::UnterminatedComment.refuse(Place::plain(open), "unterminated comment")
    }

    /// Appends characters to `scratch` while `accept(so_far, next)` holds.
    fn take_while(&mut self, accept: impl Fn(&str, char) -> bool) {
        self.scratch.clear();
        while let Some(c) = self.peek().filter(|&c| accept(&self.scratch, c)) {
            self.scratch.push(c);
            self.bump();
        }
    }

    fn eat(&mut self, wanted: char) -> bool {
        let here = self.peek() == Some(wanted);
        if here {
            self.bump();
        }
        here
    }

    /// The next character; `\r\n` and `\r` read as `\n`, and line continuations are skipped (§3.2).
    fn peek(&mut self) -> Option<char> {
        let bytes = self.text.as_bytes();
        loop {
            match bytes.get(self.at)? {
                b'\\' => match &bytes[self.at + 1..] {
                    [b'\r', b'\n', ..] => self.at += 3,
                    [b'\r' | b'\n', ..] => self.at += 2,
                    _ => return Some('\\'),
                },
                b'\r' => return Some('\n'),
                byte if byte.is_ascii() => return Some(char::from(*byte)),
                _ => return self.text[self.at..].chars().next(),
            }
        }
    }

    fn peek_second(&mut self) -> Option<char> {
        let start = self.at;
        self.peek()?;
        self.bump();
        let second = self.peek();
        self.at = start;
        second
    }

    /// Advances past the character that `peek` returned.
    fn bump(&mut self) {
        let rest = &self.text[self.at..];
        self.at += match rest.chars().next() {
            Some('\r') if rest[1..].starts_with('\n') => 2,
            Some(c) => c.len_utf8(),
            None => 0,
        };
    }
}

fn is_word_start(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_'
}
