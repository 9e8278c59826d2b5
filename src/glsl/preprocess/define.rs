//! `#define` and `#undef`.

use toyproof_diagnostic::Diagnostic;

use super::macros::{Body, Macro};
use super::{PpToken, Preprocessor};
use crate::codes::Code;
use crate::token::{Punctuator, Symbol, TokenKind};
use crate::tree::Place;

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
            let message = format!(
                "the macro `{}` is defined already, and differently",
                self.words.text(name)
            );
            return Err(Box::new(
                Code::BadMacro
                    .at(name_at, message)
                    .related(old.at.span, "first defined here"),
            ));
        }
        // A definition equal to the old one changes nothing, not even while the macro is being expanded.
        self.macros
            .entry(name)
            .or_insert_with(|| Macro::new(parameters, new, name_at));
        Ok(())
    }

    pub(super) fn undef(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let (name, _, rest) = self.macro_name(line, at)?;
        self.macros.remove(&name);
        nothing_left(rest)
    }

    /// The name that a directive begins with, if it may be defined and undefined.
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
            return Code::MalformedDirective.refuse(at, "the name of a macro is missing here");
        };
        let text = self.words.text(*name);
        let predefined = self.macros.get(name).is_some_and(|old| old.predefined);
        if predefined || text.starts_with("GL_") || text == "defined" {
            let message = format!("`{text}` belongs to GLSL and cannot be defined or undefined");
            return Code::BadMacro.refuse(*at, message);
        }
        if text.contains("__") {
            let message = format!("names with two underscores such as `{text}` belong to GLSL");
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
            let [name, after, tail @ ..] = rest else {
                let at = rest.first().map_or(open, |token| token.at);
                return Code::MalformedDirective.refuse(at, "the parameters of this macro have no `)`");
            };
            let TokenKind::Word(parameter) = name.kind else {
                return Code::MalformedDirective.refuse(name.at, "the name of a parameter is missing here");
            };
            if parameters.contains(&parameter) {
                let message = format!("this macro has two parameters `{}`", self.words.text(parameter));
                return Code::BadMacro.refuse(name.at, message);
            }
            parameters.push(parameter);
            rest = tail;
            match after.kind {
                TokenKind::Punctuator(Punctuator::RightParen) => return Ok((parameters, rest)),
                TokenKind::Punctuator(Punctuator::Comma) => {}
                _ => return Code::MalformedDirective.refuse(after.at, "`,` or `)` is missing here"),
            }
        }
    }
}

/// Whether a directive ends where it should.
pub(super) fn nothing_left(rest: &[PpToken]) -> Result<(), Box<Diagnostic>> {
    match rest {
        [] => Ok(()),
        [first, ..] => Code::MalformedDirective.refuse(first.at, "this is too much for the directive"),
    }
}

/// §3.4: the same tokens, with blanks at the same places.
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
