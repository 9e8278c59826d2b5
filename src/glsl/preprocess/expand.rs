//! Macro expansion (C++98 §16.3).

use toyproof_diagnostic::{Code, plural};

use super::macros::Body;
use super::{PpToken, Preprocessor};
use crate::reporting::given;
use crate::token::{Punctuator, Symbol, TokenKind};
use crate::tree::Place;

/// Maximum number of tokens that all macros of a file together may produce. Honest shaders need less than
/// 200,000; macros that double the count at each level need more.
pub(super) const MAX_EXPANSION_TOKENS: usize = 1 << 20;

/// Maximum nesting depth of macro calls in each other's arguments.
const MAX_ARGUMENT_NESTING: usize = 256;

/// A partially consumed list of tokens.
pub(super) struct Frame {
    tokens: std::vec::IntoIter<PpToken>,
    /// The macro that expanded to this list, if any.
    expanded_from: Option<Symbol>,
}

/// The source of tokens: frames on top of the file, or on top of nothing.
pub(super) enum Stream {
    Text(Vec<Frame>),
    List(Vec<Frame>),
}

impl Stream {
    fn frames(&mut self) -> &mut Vec<Frame> {
        match self {
            Self::Text(frames) | Self::List(frames) => frames,
        }
    }
}

impl Preprocessor<'_> {
    /// The next token after expansion of macros.
    pub(super) fn next_expanded(&mut self) -> PpToken {
        loop {
            let mut token = self.next_of_stream();
            let TokenKind::Word(name) = token.kind else {
                return token;
            };
            let Some(found) = self.macros.get(&name) else {
                return token;
            };
            if found.active_expansions > 0 || token.no_expand {
                token.no_expand = true;
                return token;
            }
            let function = found.parameters.as_ref().map(Vec::len);
            let (body, definition) = (found.body.clone(), found.definition);
            let mut used = token.at;
            let mut arguments = Vec::new();
            if let Some(count) = function {
                let Some(open) = self.open_paren() else {
                    return token;
                };
                match self.arguments(name, token.at, open) {
                    Some((given, close)) => {
                        arguments = given;
                        used = used.to(close);
                    }
                    None => return token,
                }
                if !self.check_argument_count(name, used, &mut arguments, count) {
                    return token;
                }
            }
            if let Some(definition) = definition {
                self.expansions.add_use(definition, used.span);
            }
            let tokens = self.substitute(body, used, arguments);
            if tokens.len() > self.budget {
                return self.give_up(token.at);
            }
            self.budget -= tokens.len();
            self.push(tokens, Some(name));
        }
    }

    /// Expands all tokens of a list, as if it were the whole input.
    pub(super) fn expand_list(&mut self, tokens: Vec<PpToken>) -> Vec<PpToken> {
        let outer = std::mem::replace(&mut self.stream, Stream::List(Vec::new()));
        self.push(tokens, None);
        let mut expanded = Vec::new();
        loop {
            let token = self.next_expanded();
            if token.kind == TokenKind::End {
                break;
            }
            if token.kind != TokenKind::Newline {
                expanded.push(token);
            }
        }
        self.stream = outer;
        expanded
    }

    /// Substitutes arguments for parameters in a body; each argument is expanded by itself first (C++98
    /// §16.3.1).
    fn substitute(&mut self, body: Body, used: Place, arguments: Vec<Vec<PpToken>>) -> Vec<PpToken> {
        let (tokens, parameter) = match body {
            Body::Tokens { tokens, parameter } => (tokens, parameter),
            Body::Line => {
                let line = self.line_of(used).wrapping_add(self.line_offset);
                return vec![self.number(line, used)];
            }
            Body::File => return vec![self.number(self.file_number, used)],
        };
        let mut arguments: Vec<_> = arguments.into_iter().map(Argument::Raw).collect();
        let mut result = Vec::with_capacity(tokens.len());
        for (token, parameter) in tokens.iter().zip(parameter.iter()) {
            let Some(argument) = parameter.and_then(|index| arguments.get_mut(index)) else {
                result.push(PpToken {
                    at: Place {
                        span: used.span,
                        spelling: token.at.spelling,
                    },
                    ..*token
                });
                continue;
            };
            if let Argument::Raw(raw) = argument {
                let raw = std::mem::take(raw);
                *argument = Argument::Expanded(self.expand_argument(raw, used));
            }
            if let Argument::Expanded(expanded) = argument {
                result.extend_from_slice(expanded);
            }
            if result.len() > self.budget {
                break;
            }
        }
        result
    }

    fn expand_argument(&mut self, tokens: Vec<PpToken>, used: Place) -> Vec<PpToken> {
        if self.depth == MAX_ARGUMENT_NESTING {
            self.give_up(used);
            return Vec::new();
        }
        self.depth += 1;
        let expanded = self.expand_list(tokens);
        self.depth -= 1;
        expanded
    }

    /// Reads the arguments of a macro call: the tokens between parentheses, split at commas outside inner
    /// parentheses. Also returns the place of the `)`.
    fn arguments(&mut self, name: Symbol, at: Place, open: Place) -> Option<(Vec<Vec<PpToken>>, Place)> {
        let mut arguments = vec![Vec::new()];
        let mut nesting = 0;
        loop {
            let token = self.next_of_stream();
            match token.kind {
                TokenKind::End => {
                    let message = format!("unclosed call of the macro `{}`", self.interner.text(name));
                    self.report(Code::BadMacroCall.at(at.to(open), message));
                    self.gave_up = true;
                    return None;
                }
                TokenKind::Newline => continue,
                TokenKind::Punctuator(Punctuator::RightParen) if nesting == 0 => {
                    return Some((arguments, token.at));
                }
                TokenKind::Punctuator(Punctuator::Comma) if nesting == 0 => {
                    arguments.push(Vec::new());
                    continue;
                }
                TokenKind::Punctuator(Punctuator::LeftParen) => nesting += 1,
                TokenKind::Punctuator(Punctuator::RightParen) => nesting -= 1,
                _ => {}
            }
            if let Some(last) = arguments.last_mut() {
                last.push(token);
            }
        }
    }

    fn check_argument_count(
        &mut self,
        name: Symbol,
        used: Place,
        arguments: &mut Vec<Vec<PpToken>>,
        wanted: usize,
    ) -> bool {
        // `F()` passes no argument to a macro without parameters, and an empty one to a macro with one
        // parameter.
        if wanted == 0 && matches!(&arguments[..], [only] if only.is_empty()) {
            arguments.clear();
        }
        if arguments.len() == wanted {
            return true;
        }
        let name = self.interner.text(name);
        let message = format!(
            "the macro `{name}` takes {wanted} {}, but {}",
            plural(wanted as u64, "argument", "arguments"),
            given(arguments.len())
        );
        self.report(Code::BadMacroCall.at(used, message));
        false
    }

    /// Consumes a `(` if it follows. Without it, the name of a function-like macro is an ordinary name.
    fn open_paren(&mut self) -> Option<Place> {
        let mut token = self.next_of_stream();
        while token.kind == TokenKind::Newline {
            token = self.next_of_stream();
        }
        if token.kind == TokenKind::Punctuator(Punctuator::LeftParen) {
            return Some(token.at);
        }
        self.push(vec![token], None);
        None
    }

    fn next_of_stream(&mut self) -> PpToken {
        while let Some(frame) = self.stream.frames().last_mut() {
            if let Some(token) = frame.tokens.next() {
                return token;
            }
            if let Some(done) = self.stream.frames().pop().and_then(|frame| frame.expanded_from)
                && let Some(definition) = self.macros.get_mut(&done)
            {
                definition.active_expansions -= 1;
            }
        }
        match self.stream {
            Stream::Text(_) => self.next_of_text(),
            Stream::List(_) => self.end(),
        }
    }

    fn push(&mut self, tokens: Vec<PpToken>, expanded_from: Option<Symbol>) {
        if let Some(definition) = expanded_from.and_then(|name| self.macros.get_mut(&name)) {
            definition.active_expansions += 1;
        }
        let tokens = tokens.into_iter();
        self.stream.frames().push(Frame {
            tokens,
            expanded_from,
        });
    }

    /// Stops preprocessing: reports that once, and returns the end of the text.
    fn give_up(&mut self, at: Place) -> PpToken {
        if !self.gave_up {
            self.report(Code::TooMuchExpansion.at(at, "macro expansion too large"));
        }
        self.gave_up = true;
        self.budget = 0;
        self.groups.clear();
        self.stream.frames().clear();
        self.lexer.skip_to_end();
        self.end()
    }

    fn number(&mut self, value: i64, at: Place) -> PpToken {
        PpToken {
            kind: TokenKind::Number(self.interner.symbol(&value.to_string())),
            at,
            spaced: false,
            no_expand: false,
        }
    }

    fn end(&self) -> PpToken {
        PpToken {
            kind: TokenKind::End,
            at: self.lexer.place(),
            spaced: false,
            no_expand: false,
        }
    }
}

/// An argument of a macro call, expanded at its first use.
enum Argument {
    Raw(Vec<PpToken>),
    Expanded(Vec<PpToken>),
}
