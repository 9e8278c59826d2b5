//! Macros: definitions, `#define`, `#undef`, and predefined macros.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::rc::Rc;

use toyproof_diagnostic::{Code, Diagnostic, FileId, Span};

use super::{PpToken, Preprocessor};
use crate::dialect::{Version, Wrapping};
use crate::keywords::Interner;
use crate::stage::Stage;
use crate::token::{Punctuator, Symbol, TokenKind};
use crate::tree::Place;

#[derive(Debug, Clone)]
pub(super) struct Macro {
    /// The parameters of a function-like macro; `None` for an object-like macro.
    pub(super) parameters: Option<Vec<Symbol>>,
    pub(super) body: Body,
    /// The place of the macro's name in the definition.
    pub(super) at: Place,
    /// The number of active expansions; while there is one, the name is not expanded.
    pub(super) active_expansions: usize,
    pub(super) predefined: bool,
    /// The index in [`Expansions`](super::Expansions); `None` for a predefined macro.
    pub(super) definition: Option<usize>,
}

/// The replacement of a macro.
#[derive(Debug, Clone)]
pub(super) enum Body {
    /// The tokens of the definition; `parameter[i]` is the index of the parameter that token `i` names, if
    /// any.
    Tokens {
        tokens: Rc<[PpToken]>,
        parameter: Rc<[Option<usize>]>,
    },
    /// `__LINE__`.
    Line,
    /// `__FILE__`.
    File,
}

impl Macro {
    pub(super) fn new(parameters: Option<Vec<Symbol>>, body: Body, at: Place) -> Self {
        Self {
            parameters,
            body,
            at,
            active_expansions: 0,
            predefined: false,
            definition: None,
        }
    }

    /// The predefined macros: those of §3.4, and ShaderToy's `HW_PERFORMANCE`.
    /// Common, compiled alone, has only those of §3.4.
    pub(super) fn predefined(
        file: FileId,
        stage: Stage,
        Wrapping { dialect, language }: Wrapping,
        interner: &mut Interner,
    ) -> HashMap<Symbol, Self> {
        let at = Place::plain(Span::new(file, 0, 0));
        let mut number = |text: &str| {
            let token = PpToken {
                kind: TokenKind::Number(interner.symbol(text)),
                at,
                spaced: false,
                no_expand: false,
            };
            Body::Tokens {
                tokens: [token].into(),
                parameter: [None].into(),
            }
        };
        let version = language.version;
        let (one, number) = (number("1"), number(&version.number().to_string()));
        let has_host = dialect.calls_main_image() && stage != Stage::Common;
        // Whether it exists, and whether it is one of the language's.
        let all = [
            ("__LINE__", Body::Line, true, true),
            ("__FILE__", Body::File, true, true),
            ("__VERSION__", number, true, true),
            ("GL_ES", one.clone(), version.is_es(), true),
            ("GL_FRAGMENT_PRECISION_HIGH", one.clone(), version.is_es(), true),
            (
                "GL_OES_standard_derivatives",
                one.clone(),
                version == Version::Es100,
                true,
            ),
            (
                "GL_EXT_shader_texture_lod",
                one.clone(),
                version == Version::Es100,
                true,
            ),
            ("HW_PERFORMANCE", one, has_host, false),
        ];
        all.into_iter()
            .filter(|(_, _, is_defined, _)| *is_defined)
            .map(|(name, body, _, predefined)| {
                let definition = Self {
                    predefined,
                    ..Self::new(None, body, at)
                };
                (interner.symbol(name), definition)
            })
            .collect()
    }
}

// `#define` and `#undef`.

impl Preprocessor<'_> {
    pub(super) fn define(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let (name, name_at, rest) = self.macro_name(line, at)?;
        let (parameters, body) = match rest {
            [first, rest @ ..]
                if first.kind == TokenKind::Punctuator(Punctuator::LeftParen) && !first.spaced =>
            {
                let (parameters, body) = self.parameters(rest, first.at)?;
                (Some(parameters), body)
            }
            body => (None, body),
        };
        let parameter = |token: &PpToken| match (token.kind, &parameters) {
            (TokenKind::Word(word), Some(parameters)) => parameters.iter().position(|&p| p == word),
            _ => None,
        };
        let new = Body::Tokens {
            parameter: body.iter().map(parameter).collect(),
            tokens: body.into(),
        };
        if let Some(old) = self.macros.get(&name)
            && !(old.parameters == parameters && same_body(&old.body, &new))
        {
            let message = format!("redefinition of the macro `{}`", self.interner.text(name));
            return Err(Box::new(
                Code::BadMacro
                    .at(name_at, message)
                    .related(old.at.span, "previous definition")
                    .help("remove one of them, or write `#undef` between them"),
            ));
        }
        // Redefining a macro identically changes nothing, even during its expansion.
        if let Entry::Vacant(entry) = self.macros.entry(name) {
            let names = parameters.iter().flatten();
            let names = names.map(|&name| self.interner.text(name).to_owned()).collect();
            let names = parameters.as_ref().map(|_| names);
            let definition = self
                .expansions
                .define(self.interner.text(name), name_at.span, names, rest);
            entry.insert(Macro {
                definition: Some(definition),
                ..Macro::new(parameters, new, name_at)
            });
            self.note_unexpanded(rest);
        }
        Ok(())
    }

    pub(super) fn undef(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let (name, _, rest) = self.macro_name(line, at)?;
        self.macros.remove(&name);
        expect_end_of_directive(rest)
    }

    /// The macro name that a directive begins with, if it may be defined and undefined; also returns its
    /// place and the rest of the line.
    fn macro_name<'t>(
        &mut self,
        line: &'t [PpToken],
        at: Place,
    ) -> Result<(Symbol, Place, &'t [PpToken]), Box<Diagnostic>> {
        let [
            PpToken {
                kind: TokenKind::Word(name),
                at,
                ..
            },
            rest @ ..,
        ] = line
        else {
            let at = line.first().map_or(at, |token| token.at);
            return Code::MalformedDirective.refuse(at, "expected the name of a macro");
        };
        let text = self.interner.text(*name);
        let predefined = self.macros.get(name).is_some_and(|old| old.predefined);
        if predefined || text.starts_with("GL_") || text == "defined" {
            let message = format!("`{text}` is reserved and cannot be defined or undefined");
            return Code::BadMacro.refuse(*at, message);
        }
        if text.contains("__") {
            let message = format!("`{text}` contains `__`, which is reserved");
            self.report(Code::ReservedName.at(*at, message));
        }
        Ok((*name, *at, rest))
    }

    fn parameters<'t>(
        &self,
        line: &'t [PpToken],
        open: Place,
    ) -> Result<(Vec<Symbol>, &'t [PpToken]), Box<Diagnostic>> {
        let mut parameters = Vec::new();
        let mut rest = line;
        if let [
            PpToken {
                kind: TokenKind::Punctuator(Punctuator::RightParen),
                ..
            },
            body @ ..,
        ] = rest
        {
            return Ok((parameters, body));
        }
        loop {
            let unclosed = |at| Code::MalformedDirective.refuse(at, "unclosed parameter list of a macro");
            let [name, tail @ ..] = rest else {
                return unclosed(open);
            };
            let TokenKind::Word(parameter) = name.kind else {
                return Code::MalformedDirective.refuse(name.at, "expected the name of a parameter");
            };
            let [after, tail @ ..] = tail else {
                return unclosed(name.at);
            };
            if parameters.contains(&parameter) {
                let message = format!("duplicate parameter `{}`", self.interner.text(parameter));
                return Code::BadMacro.refuse(name.at, message);
            }
            parameters.push(parameter);
            rest = tail;
            match after.kind {
                TokenKind::Punctuator(Punctuator::RightParen) => return Ok((parameters, rest)),
                TokenKind::Punctuator(Punctuator::Comma) => {}
                _ => return Code::MalformedDirective.refuse(after.at, "expected `,` or `)`"),
            }
        }
    }
}

/// Checks that no tokens follow a directive.
pub(super) fn expect_end_of_directive(rest: &[PpToken]) -> Result<(), Box<Diagnostic>> {
    match rest {
        [] => Ok(()),
        [first, ..] => Code::MalformedDirective.refuse(first.at, "unexpected text after the directive"),
    }
}

/// Whether two bodies have the same tokens with blanks in the same positions (§3.4).
fn same_body(old: &Body, new: &Body) -> bool {
    let (Body::Tokens { tokens: old, .. }, Body::Tokens { tokens: new, .. }) = (old, new) else {
        return false;
    };
    old.len() == new.len()
        && old
            .iter()
            .zip(new.iter())
            .enumerate()
            .all(|(index, (old, new))| old.kind == new.kind && (index == 0 || old.spaced == new.spaced))
}
