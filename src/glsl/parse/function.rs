//! Functions (§6.1).

use super::{Parsed, Parser};
use crate::check::{Parameter, Qualifiers, Specifier, Storage};
use crate::codes::Code;
use crate::token::{Punctuator, Symbol, TokenKind};
use crate::tree::{Direction, Place, Type};
use crate::words::Word;

impl Parser<'_> {
    /// The rest of a prototype or definition, from its `(`.
    pub(super) fn function(
        &mut self,
        qualifiers: &Qualifiers,
        result: &Specifier,
        name: Symbol,
        at: Place,
    ) -> Parsed<()> {
        if let Some(at) = qualifiers.other_than_precision() {
            self.check
                .report(Code::BadQualifier.at(at, "a result has no qualifier but its precision"));
        }
        let parameters = self.parameters()?;
        let function = self.check.declare_function(result, name, at, &parameters);
        if self.eat(Punctuator::Semicolon) {
            self.check.prototype(function);
            return Ok(());
        }
        if !self.is(Punctuator::LeftBrace) {
            return self.unexpected("`{` or `;`");
        }
        self.check.open_body(function, at, &parameters);
        let body = self.block();
        self.check.close_body(function, body?);
        Ok(())
    }

    /// `(in vec3 p, float t)`, `()` or `(void)`.
    fn parameters(&mut self) -> Parsed<Vec<Parameter>> {
        self.expect(Punctuator::LeftParen)?;
        let void = self.word() == Some(Word::Type(Type::Void));
        if void && self.peek(1).kind == TokenKind::Punctuator(Punctuator::RightParen) {
            self.next();
        }
        let mut parameters = Vec::new();
        if self.eat(Punctuator::RightParen) {
            return Ok(parameters);
        }
        loop {
            let start = self.at;
            match self.recovering_item(Self::parameter) {
                Some(parameter) => parameters.push(parameter),
                None => parameters.push(self.unread_parameter(start)),
            }
            if !self.eat(Punctuator::Comma) {
                self.expect(Punctuator::RightParen)?;
                return Ok(parameters);
            }
        }
    }

    fn parameter(&mut self) -> Parsed<Parameter> {
        let qualifiers = self.qualifiers()?;
        let direction = self.direction(&qualifiers);
        let mut specifier = self.named_type()?;
        self.check.precision_fits(&qualifiers, &specifier);
        let name = match self.kind() {
            TokenKind::Word(_) => Some(self.name()?),
            _ => None,
        };
        let at = name.map_or(specifier.at, |(_, at)| at);
        let mut sizes = self.sizes()?;
        sizes.append(&mut specifier.sizes);
        specifier.sizes = sizes;
        let parameter = Parameter {
            name: name.map(|(name, _)| name),
            ty: self.check.parameter_type(&specifier, direction),
            direction,
            at,
        };
        if !self.is(Punctuator::Comma) && !self.is(Punctuator::RightParen) {
            return self.unexpected("`,` or `)`");
        }
        Ok(parameter)
    }

    /// What stands for a parameter that cannot be read: anything, by the name that comes last.
    fn unread_parameter(&self, start: usize) -> Parameter {
        let tokens = &self.tokens[start..self.at.min(self.tokens.len())];
        let name = tokens.iter().rev().find_map(|token| match token.kind {
            TokenKind::Word(word) if self.words.word(word) == Word::Name => Some((word, token.at)),
            _ => None,
        });
        Parameter {
            name: name.map(|(name, _)| name),
            ty: Type::Error,
            direction: Direction::In,
            at: name.map_or(self.tokens[start].at, |(_, at)| at),
        }
    }

    fn direction(&mut self, qualifiers: &Qualifiers) -> Direction {
        let interface = qualifiers.interface.first().map(|&(_, at)| at);
        let wrong = match (qualifiers.storage, qualifiers.is_const, interface) {
            (_, _, Some(at)) | (Some((Storage::Uniform, at)), _, _) => {
                Some((at, "a parameter can be `const`, `in`, `out` or `inout`"))
            }
            (Some((Storage::Out | Storage::InOut, at)), Some(_), None) => {
                Some((at, "a `const` parameter can only be `in`"))
            }
            _ => None,
        };
        if let Some((at, message)) = wrong {
            self.check.report(Code::BadQualifier.at(at, message));
        }
        match qualifiers.storage {
            Some((Storage::Out, _)) => Direction::Out,
            Some((Storage::InOut, _)) => Direction::InOut,
            _ if qualifiers.is_const.is_some() => Direction::ConstIn,
            _ => Direction::In,
        }
    }
}
