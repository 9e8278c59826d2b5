//! The preprocessor (GLSL ES 3.00.6 §3.4): turns source text into the tokens that remain.
//!
//! It works on tokens, as in C++98: each token keeps the place of its characters and, if it comes from a
//! macro, the place where that macro was used. Time is linear in the text and its expansion, and expansion
//! has a budget, so that hostile macros end in a diagnostic.

mod condition;
mod directive;
mod expand;
mod expansions;
mod include;
mod lexer;
mod macros;

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::{Code, Deadline, Diagnostic, FileId, Files, Fix, grouped};

use self::condition::Group;
pub(crate) use self::directive::DIRECTIVES;
use self::expand::Stream;
pub use self::expansions::{Expansions, MacroDefinition};
use self::include::Inclusion;
pub use self::include::ReadInclude;
pub(crate) use self::include::with_includes;
pub use self::lexer::ControlComment;
use self::lexer::{Lexer, PpToken};
use self::macros::Macro;
use super::token::{Punctuator, Symbol, Token, TokenKind};
use crate::dialect::{Version, Wrapping};
use crate::keywords::Interner;
use crate::reporting::push_limited;
use crate::stage::Stage;

/// Maximum length of a name in bytes (WebGL 2, §4.3.1).
const MAX_NAME_BYTES: usize = 1024;

/// The result of preprocessing.
pub(crate) struct PreprocessorOutput {
    /// The tokens, ending in one [`TokenKind::End`].
    pub(crate) tokens: Vec<Token>,
    /// The texts of the tokens.
    pub(crate) interner: Interner,
    /// The `// toyproof:` comments.
    pub(crate) control_comments: Vec<ControlComment>,
    /// The macros and their uses.
    pub(crate) expansions: Expansions,
    /// The names in branches that are not compiled, and in the replacements of macros.
    pub(crate) unexpanded_names: HashSet<Symbol>,
    /// Whether the extension of derivatives is enabled, which WebGL 1 requires for them.
    pub(crate) enables_derivatives: bool,
    /// Errors and warnings.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Whether errors made so much of the text unusable that the rest must not be parsed.
    pub(crate) incomplete: bool,
    /// Whether errors may hide names: of macros, or of declarations in an `#include`.
    pub(crate) lacks_names: bool,
}

/// Errors after which the active text is unknown: the extent of a comment, or the branch of an `#if`.
const LOSES_TEXT: [Code; 3] = [
    Code::UnterminatedComment,
    Code::BadCondition,
    Code::UnbalancedCondition,
];

/// Errors after which declarations of names may be missing.
const LOSES_NAMES: [Code; 6] = [
    Code::UnknownDirective,
    Code::BadInclude,
    Code::MalformedDirective,
    Code::BadMacro,
    Code::BadMacroCall,
    Code::PasteOperator,
];

/// Preprocesses one file to its end despite errors, or until the deadline.
pub(crate) fn preprocess(
    files: &Files,
    file: FileId,
    stage: Stage,
    wrapping: Wrapping,
    deadline: &Deadline,
) -> PreprocessorOutput {
    let mut preprocessor = Preprocessor::new(files, file, stage, wrapping);
    let mut tokens = Vec::new();
    loop {
        let mut token = preprocessor.next_expanded();
        preprocessor.seen = Prefix::Text;
        match token.kind {
            TokenKind::Newline => continue,
            TokenKind::Unknown(c) => {
                let shown = if c.is_control() {
                    c.escape_default().to_string()
                } else {
                    c.to_string()
                };
                let message = format!("invalid character `{shown}`");
                let diagnostic = Code::UnknownCharacter.at(token.at, message);
                preprocessor.report(match lookalike(c) {
                    Some(meant) => {
                        diagnostic.fix(Fix::new(format!("write `{meant}`"), token.at.spelling, meant))
                    }
                    None => diagnostic,
                });
                token.kind = TokenKind::Stray;
            }
            TokenKind::Punctuator(Punctuator::Hash | Punctuator::Paste) => {
                // A macro that contains one is harmless until it is used.
                let message = if token.at.is_expanded() {
                    "`#` and `##` are not available in macros of GLSL ES"
                } else {
                    "`#` must be the first character of its line"
                };
                preprocessor.report(Code::PasteOperator.at(token.at, message));
                token.kind = TokenKind::Stray;
            }
            _ => {}
        }
        if let TokenKind::Word(word) = token.kind
            && preprocessor.interner.text(word).len() > MAX_NAME_BYTES
        {
            let message = format!(
                "name longer than {} characters, the limit of WebGL",
                grouped(MAX_NAME_BYTES as u64)
            );
            preprocessor.report(Code::Syntax.at(token.at, message));
        }
        tokens.push(Token {
            kind: token.kind,
            at: token.at,
            reported: token.kind == TokenKind::Stray,
        });
        if token.kind == TokenKind::End || deadline.is_over() {
            break;
        }
    }
    let diagnostics = preprocessor.diagnostics;
    let any_of = |codes: &[Code]| {
        let reported = |code: &Code| diagnostics.iter().any(|diagnostic| diagnostic.code == *code);
        codes.iter().any(reported)
    };
    PreprocessorOutput {
        tokens,
        interner: preprocessor.interner,
        control_comments: preprocessor.lexer.control_comments,
        expansions: preprocessor.expansions,
        unexpanded_names: preprocessor.unexpanded_names,
        enables_derivatives: preprocessor.enables_derivatives,
        incomplete: preprocessor.gave_up || any_of(&LOSES_TEXT),
        lacks_names: any_of(&LOSES_NAMES),
        diagnostics,
    }
}

impl PreprocessorOutput {
    /// The diagnostics, with the names of macros.
    pub(crate) fn named_diagnostics(&self, files: &Files) -> Vec<Diagnostic> {
        let diagnostics = self.diagnostics.iter();
        let named = |diagnostic: &Diagnostic| self.expansions.named(diagnostic.clone(), files);
        diagnostics.map(named).collect()
    }

    /// Whether it defines or declares a function `void main(`.
    pub(crate) fn defines_main(&self) -> bool {
        let Some(main) = self.interner.find("main") else {
            return false;
        };
        let is_main = |tokens: &[Token]| {
            tokens[1].kind == TokenKind::Word(main)
                && tokens[2].kind == TokenKind::Punctuator(Punctuator::LeftParen)
                && matches!(tokens[0].kind, TokenKind::Word(word) if self.interner.text(word) == "void")
        };
        self.tokens.windows(3).any(is_main)
    }
}

/// The version that `#version` in front of a text selects.
pub(crate) fn declared_version(files: &Files, file: FileId) -> Option<Version> {
    let text = files.get(file).text();
    if !text.contains("version") {
        return None;
    }
    let mut interner = Interner::default();
    let mut lexer = Lexer::new(file, text);
    let mut ignored = Vec::new();
    let mut next = || lexer.next(&mut interner, &mut ignored).kind;
    let first = std::iter::repeat_with(&mut next).find(|&kind| kind != TokenKind::Newline);
    if first != Some(TokenKind::Punctuator(Punctuator::Hash)) {
        return None;
    }
    let line: Vec<TokenKind> = std::iter::repeat_with(next)
        .take_while(|kind| !matches!(kind, TokenKind::Newline | TokenKind::End))
        .collect();
    let words = line.iter().map(|kind| match kind {
        TokenKind::Word(word) | TokenKind::Number(word) => interner.text(*word),
        _ => "",
    });
    match words.collect::<Vec<_>>()[..] {
        ["version", number] => Version::parse(number, None),
        ["version", number, profile] => Version::parse(number, Some(profile)),
        _ => None,
    }
}

/// The tokens of a text as it is written, and their texts: directives are not executed, macros not expanded,
/// and ends of lines are tokens. Errors are not reported.
pub(crate) fn source_tokens(files: &Files, file: FileId) -> (Vec<Token>, Interner) {
    let mut interner = Interner::default();
    let mut lexer = Lexer::new(file, files.get(file).text());
    let mut ignored = Vec::new();
    let mut tokens = Vec::new();
    loop {
        let PpToken { kind, at, .. } = lexer.next(&mut interner, &mut ignored);
        if kind == TokenKind::End {
            return (tokens, interner);
        }
        tokens.push(Token {
            kind,
            at,
            reported: false,
        });
    }
}

/// The kinds of tokens seen so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Prefix {
    Nothing,
    /// A directive: `#version` may not follow.
    Directive,
    /// A token outside directives: `#extension` may not follow (§3.5).
    Text,
}

/// The GLSL punctuator that a Unicode character resembles.
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
    wrapping: Wrapping,
    interner: Interner,
    macros: HashMap<Symbol, Macro>,
    expansions: Expansions,
    unexpanded_names: HashSet<Symbol>,
    /// Whether the extension of derivatives is enabled.
    enables_derivatives: bool,
    /// The macro bodies being expanded, innermost last; below them the lexer.
    stream: Stream,
    /// The open `#if` groups.
    groups: Vec<Group>,
    /// Whether the next token begins a line.
    line_start: bool,
    seen: Prefix,
    /// The offset that `#line` adds to line numbers, visible to `__LINE__` only.
    line_offset: i64,
    /// The file number that `#line` sets, visible to `__FILE__` only.
    file_number: i64,
    /// A byte position and its line, from which lines are counted.
    counted: (usize, i64),
    /// The number of tokens that macros may still produce.
    budget: usize,
    /// Whether preprocessing stopped because macros produced too many tokens, nested too deep, or a call had
    /// no `)`.
    gave_up: bool,
    /// Nesting depth of macro calls in arguments of macro calls.
    depth: usize,
    diagnostics: Vec<Diagnostic>,
    /// The included texts, while they replace their directives.
    inclusion: Option<Inclusion<'a>>,
}

impl<'a> Preprocessor<'a> {
    fn new(files: &'a Files, file: FileId, stage: Stage, wrapping: Wrapping) -> Self {
        let mut interner = Interner::new(wrapping.language);
        let macros = Macro::predefined(file, stage, wrapping, &mut interner);
        let text = files.get(file).text();
        Self {
            text,
            lexer: Lexer::new(file, text),
            wrapping,
            interner,
            macros,
            expansions: Expansions::default(),
            unexpanded_names: HashSet::new(),
            enables_derivatives: false,
            stream: Stream::Text(Vec::new()),
            groups: Vec::new(),
            line_start: true,
            seen: Prefix::Nothing,
            line_offset: 0,
            file_number: 0,
            counted: (0, 1),
            budget: expand::MAX_EXPANSION_TOKENS,
            gave_up: false,
            depth: 0,
            diagnostics: Vec::new(),
            inclusion: None,
        }
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        push_limited(&mut self.diagnostics, diagnostic);
    }

    /// Records the names among tokens that are not compiled where they are written.
    fn note_unexpanded(&mut self, tokens: &[PpToken]) {
        let names = tokens.iter().filter_map(|token| match token.kind {
            TokenKind::Word(name) => Some(name),
            _ => None,
        });
        self.unexpanded_names.extend(names);
    }

    fn lex(&mut self) -> PpToken {
        self.lexer.next(&mut self.interner, &mut self.diagnostics)
    }

    /// The next token of the file; executes directives and skips inactive groups on the way.
    fn next_of_text(&mut self) -> PpToken {
        loop {
            let control_comments = self.lexer.control_comments.len();
            let token = self.lex();
            if !self.is_active() {
                self.lexer.control_comments.truncate(control_comments);
            }
            match token.kind {
                TokenKind::Newline => self.line_start = true,
                TokenKind::Punctuator(Punctuator::Hash) if self.line_start => {
                    self.expansions.end_skipped();
                    self.directive(token.at);
                    self.seen = self.seen.max(Prefix::Directive);
                }
                TokenKind::End if self.end_include() => {}
                TokenKind::End => {
                    while let Some(group) = self.groups.pop() {
                        self.report(
                            Code::UnbalancedCondition.at(group.at, "conditional directive without `#endif`"),
                        );
                    }
                    return token;
                }
                _ => {
                    self.line_start = false;
                    if self.is_active() {
                        return token;
                    }
                    self.expansions.skip(token.at.span);
                    self.note_unexpanded(&[token]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
