//! The preprocessor (GLSL ES 3.00.6 §3.4): from an author's text to the tokens that remain.
//!
//! Token based, as in C++98: each token keeps the place where its characters stand and, out of a macro, where that macro was used. Time is
//! linear in what is read and expanded, and expansion has a budget, so that hostile macros end in a diagnostic.

mod condition;
mod define;
mod directive;
mod expand;
mod integer;
mod lexer;
mod macros;

use std::collections::HashMap;

use toyproof_diagnostic::{Deadline, Diagnostic, FileId, Files};

use self::condition::Group;
use self::expand::Stream;
pub use self::lexer::Remark;
use self::lexer::{Lexer, PpToken};
use self::macros::Macro;
use super::codes::{Code, tell};
use super::token::{Punctuator, Symbol, Token, TokenKind};
use super::words::Words;

/// How long a name may be (WebGL 2, §4.3.1).
const MAX_NAME: usize = 1024;

/// What a text is after preprocessing.
pub(crate) struct Preprocessed {
    /// The tokens, ending in one [`TokenKind::End`].
    pub(crate) tokens: Vec<Token>,
    /// Their texts.
    pub(crate) words: Words,
    /// What its comments say to us.
    pub(crate) remarks: Vec<Remark>,
    /// Errors and warnings.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Whether so much of the text is lost to errors that the rest means nothing.
    pub(crate) incomplete: bool,
    /// Whether names may be lost to errors: of macros, and of what an `#include` was to declare.
    pub(crate) lacks_names: bool,
}

/// Errors after which nothing is known of the text: what is commented out, which branch of an `#if` is read.
const LOSES_TEXT: [Code; 3] = [
    Code::UnterminatedComment,
    Code::BadCondition,
    Code::UnbalancedCondition,
];

/// Errors after which names may lack their meaning.
const LOSES_NAMES: [Code; 5] = [
    Code::UnknownDirective,
    Code::MalformedDirective,
    Code::BadMacro,
    Code::BadMacroCall,
    Code::PasteOperator,
];

/// Preprocesses one file, to its end whatever is wrong with it, or to where it is when the time is over.
#[must_use]
pub(crate) fn preprocess(files: &Files, file: FileId, deadline: &Deadline) -> Preprocessed {
    let mut preprocessor = Preprocessor::new(files, file);
    let mut tokens = Vec::new();
    loop {
        let mut token = preprocessor.next_expanded();
        preprocessor.past = Past::Text;
        match token.kind {
            TokenKind::Newline => continue,
            TokenKind::Unknown(c) => {
                let shown = if c.is_control() {
                    c.escape_default().to_string()
                } else {
                    c.to_string()
                };
                let message = format!("`{shown}` is no character of GLSL");
                let diagnostic = Code::UnknownCharacter.at(token.at, message);
                preprocessor.report(match lookalike(c) {
                    Some(meant) => diagnostic.label(format!("write `{meant}`")),
                    None => diagnostic,
                });
                token.kind = TokenKind::Stray;
            }
            TokenKind::Punctuator(Punctuator::Hash | Punctuator::Paste) => {
                // A macro with one is harmless until it is used.
                let message = if token.at.is_expanded() {
                    "GLSL ES has no `#` and no `##` in macros"
                } else {
                    "`#` is not at the beginning of its line"
                };
                preprocessor.report(Code::PasteOperator.at(token.at, message));
                token.kind = TokenKind::Stray;
            }
            _ => {}
        }
        if let TokenKind::Word(word) = token.kind
            && preprocessor.words.text(word).len() > MAX_NAME
        {
            let message = format!("WebGL takes no name of more than {MAX_NAME} characters");
            preprocessor.report(Code::Syntax.at(token.at, message));
        }
        tokens.push(Token {
            kind: token.kind,
            at: token.at,
            told: token.kind == TokenKind::Stray,
        });
        if token.kind == TokenKind::End || deadline.is_over() {
            break;
        }
    }
    let diagnostics = preprocessor.diagnostics;
    let any_of = |codes: &[Code]| {
        let told = |code: &Code| {
            diagnostics
                .iter()
                .any(|diagnostic| diagnostic.code == code.as_str())
        };
        codes.iter().any(told)
    };
    Preprocessed {
        tokens,
        words: preprocessor.words,
        remarks: preprocessor.lexer.remarks,
        incomplete: preprocessor.gave_up || any_of(&LOSES_TEXT),
        lacks_names: any_of(&LOSES_NAMES),
        diagnostics,
    }
}

/// What came already.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Past {
    Nothing,
    /// `#version` may not follow.
    Directive,
    /// A token that is no directive's: `#extension` may not follow (§3.5).
    Text,
}

/// The character of GLSL that one from elsewhere looks like.
fn lookalike(c: char) -> Option<&'static str> {
    Some(match c {
        '–' | '—' | '−' | '‐' => "-",
        '×' | '·' | '⋅' | '∗' => "*",
        '÷' | '∕' => "/",
        '≤' => "<=",
        '≥' => ">=",
        '≠' => "!=",
        '，' => ",",
        '；' | '\u{37e}' => ";",
        '（' => "(",
        '）' => ")",
        '\u{a0}' | '\u{3000}' => " ",
        _ => return None,
    })
}

struct Preprocessor<'a> {
    text: &'a str,
    lexer: Lexer<'a>,
    words: Words,
    macros: HashMap<Symbol, Macro>,
    /// The macro bodies being read, the innermost last; below them the lexer.
    stream: Stream,
    /// The `#if` groups that are open.
    groups: Vec<Group>,
    /// Whether the next token begins a line.
    line_start: bool,
    past: Past,
    /// What `#line` adds to line numbers, and the number it gives the file: seen by `__LINE__` and `__FILE__` only.
    line_offset: i64,
    file_number: i64,
    /// A byte and its line, for counting on.
    counted: (usize, i64),
    /// How many tokens macros may still produce.
    budget: usize,
    /// Whether they took all that followed: produced more, nested too deep, or had no `)`.
    gave_up: bool,
    /// How deep macro calls stand in arguments of macro calls.
    depth: usize,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Preprocessor<'a> {
    fn new(files: &'a Files, file: FileId) -> Self {
        let mut words = Words::default();
        let macros = Macro::predefined(file, &mut words);
        let text = files.get(file).text();
        Self {
            text,
            lexer: Lexer::new(file, text),
            words,
            macros,
            stream: Stream::Text(Vec::new()),
            groups: Vec::new(),
            line_start: true,
            past: Past::Nothing,
            line_offset: 0,
            file_number: 0,
            counted: (0, 1),
            budget: expand::BUDGET,
            gave_up: false,
            depth: 0,
            diagnostics: Vec::new(),
        }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        tell(&mut self.diagnostics, diagnostic);
    }

    fn lex(&mut self) -> PpToken {
        self.lexer.next(&mut self.words, &mut self.diagnostics)
    }

    /// The next token of the running text; directives are obeyed and skipped groups passed over on the way.
    fn next_of_text(&mut self) -> PpToken {
        loop {
            let remarks = self.lexer.remarks.len();
            let token = self.lex();
            if !self.is_active() {
                self.lexer.remarks.truncate(remarks);
            }
            match token.kind {
                TokenKind::Newline => self.line_start = true,
                TokenKind::Punctuator(Punctuator::Hash) if self.line_start => {
                    self.directive(token.at);
                    self.past = self.past.max(Past::Directive);
                }
                TokenKind::End => {
                    while let Some(group) = self.groups.pop() {
                        self.report(Code::UnbalancedCondition.at(group.at, "this has no `#endif`"));
                    }
                    return token;
                }
                _ => {
                    self.line_start = false;
                    if self.is_active() {
                        return token;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
