//! Declarations: types, variables, structures, functions (§4, §6.1).

use super::{Parsed, Parser};
use crate::glsl::check::{Declarator, Parameter, Qualifiers, Size, Specifier, Storage};
use crate::glsl::codes::Code;
use crate::glsl::token::{Keyword, Punctuator, Symbol, TokenKind, Word};
use crate::glsl::tree::{Direction, Item, Member, Place, Type, VariableId};

impl Parser<'_> {
    /// One declaration at global scope, or a function.
    pub(super) fn external_declaration(&mut self) -> Parsed<()> {
        if self.check.takes_stray_semicolons() && self.eat(Punctuator::Semicolon) {
            return Ok(());
        }
        if self.eat_keyword(Keyword::Precision) {
            return self.precision_statement();
        }
        let qualifiers = self.qualifiers()?;
        if qualifiers.interface.is_some() && self.is_redeclaration() {
            let (name, at) = self.name()?;
            self.check.invariant(name, at);
            self.expect(Punctuator::Semicolon)?;
            return Ok(());
        }
        let first = self.check.tree.structs.len();
        let specifier = self.type_specifier()?;
        let structs: Vec<_> = self
            .check
            .tree
            .structs
            .ids()
            .skip(first)
            .map(Item::Struct)
            .collect();
        self.check.tree.items.extend(structs);
        if self.eat(Punctuator::Semicolon) {
            return Ok(());
        }
        let empty_first = self.eat_empty_declarator();
        let (name, at) = self.name()?;
        if !empty_first && self.is(Punctuator::LeftParen) {
            return self.function(&qualifiers, &specifier, name, at);
        }
        let variables = self.declarators(&qualifiers, &specifier, name, at)?;
        self.check
            .tree
            .items
            .extend(variables.into_iter().map(Item::Variable));
        Ok(())
    }

    /// A declaration inside of a function, with its `;`.
    pub(super) fn local_declaration(&mut self) -> Parsed<Vec<VariableId>> {
        if self.eat_keyword(Keyword::Precision) {
            self.precision_statement()?;
            return Ok(Vec::new());
        }
        let qualifiers = self.qualifiers()?;
        let specifier = self.type_specifier()?;
        if self.eat(Punctuator::Semicolon) {
            return Ok(Vec::new());
        }
        self.eat_empty_declarator();
        let (name, at) = self.name()?;
        if self.is(Punctuator::LeftParen) {
            return self.halt(
                Code::Syntax,
                at,
                "a function cannot be declared inside of a function",
            );
        }
        self.declarators(&qualifiers, &specifier, name, at)
    }

    /// `bool b = f()` as the condition of a loop.
    pub(super) fn condition_declaration(&mut self) -> Parsed<VariableId> {
        let qualifiers = self.qualifiers()?;
        let specifier = self.type_specifier()?;
        let (name, at) = self.name()?;
        if !self.is(Punctuator::Assign) {
            return self.unexpected("`=`");
        }
        let declarator = self.declarator(name, at)?;
        if let Some(value) = declarator.initialiser {
            self.check.condition(value);
        }
        Ok(self.check.declare_variable(&qualifiers, &specifier, declarator))
    }

    /// `precision highp float;`: precision has no effect where everything is `highp`.
    fn precision_statement(&mut self) -> Parsed<()> {
        match self.keyword() {
            Some(Keyword::Highp | Keyword::Mediump | Keyword::Lowp) => self.next(),
            _ => return self.unexpected("`highp`, `mediump` or `lowp`"),
        };
        let specifier = self.named_type()?;
        self.check.precision(specifier.base, specifier.at);
        self.expect(Punctuator::Semicolon)?;
        Ok(())
    }

    /// Whether a name follows that is no type: `invariant x;`.
    fn is_redeclaration(&self) -> bool {
        matches!(self.kind(), TokenKind::Word(symbol)
            if self.words.word(symbol) == Word::Name && self.check.struct_named(symbol).is_none())
    }

    /// What stands before a type, in the order of §4.7: `invariant`, interpolation, layout, storage, precision.
    fn qualifiers(&mut self) -> Parsed<Qualifiers> {
        let mut qualifiers = Qualifiers::default();
        let mut last = 0;
        loop {
            let at = self.token().at;
            let Some(keyword) = self.keyword() else {
                return Ok(qualifiers);
            };
            let rank = match keyword {
                Keyword::Invariant => 1,
                Keyword::Flat | Keyword::Smooth => 2,
                Keyword::Layout => 3,
                Keyword::Const | Keyword::Centroid => 4,
                Keyword::In | Keyword::Out | Keyword::InOut | Keyword::Uniform => 5,
                Keyword::Highp | Keyword::Mediump | Keyword::Lowp => 6,
                _ => return Ok(qualifiers),
            };
            self.next();
            if rank <= last {
                let message = format!("`{}` cannot stand after what is before it", keyword.text());
                self.check.report(Code::BadQualifier.at(at, message));
            }
            last = rank;
            match keyword {
                Keyword::Const => qualifiers.is_const = Some(at),
                Keyword::Uniform => qualifiers.storage = Some((Storage::Uniform, at)),
                Keyword::In => qualifiers.storage = Some((Storage::In, at)),
                Keyword::Out => qualifiers.storage = Some((Storage::Out, at)),
                Keyword::InOut => qualifiers.storage = Some((Storage::InOut, at)),
                Keyword::Highp | Keyword::Mediump | Keyword::Lowp => {}
                _ => qualifiers.interface = Some(at),
            }
            if keyword == Keyword::Layout {
                self.layout()?;
            }
        }
    }

    /// `(location = 0, …)`: read and not kept; nobody asks for it.
    fn layout(&mut self) -> Parsed<()> {
        self.expect(Punctuator::LeftParen)?;
        loop {
            self.name()?;
            if self.eat(Punctuator::Assign) && !matches!(self.next().kind, TokenKind::Number(_)) {
                self.at -= 1;
                return self.unexpected("an integer");
            }
            if !self.eat(Punctuator::Comma) {
                self.expect(Punctuator::RightParen)?;
                return Ok(());
            }
        }
    }

    /// A type by name or a structure, and the sizes that follow.
    fn type_specifier(&mut self) -> Parsed<Specifier> {
        if self.keyword() != Some(Keyword::Struct) {
            return self.named_type();
        }
        let at = self.next().at;
        let base = self.structure(at)?;
        let sizes = self.sizes()?;
        Ok(Specifier { base, sizes, at })
    }

    pub(super) fn named_type(&mut self) -> Parsed<Specifier> {
        let at = self.token().at;
        let base = match self.kind() {
            TokenKind::Word(symbol) => match self.words.word(symbol) {
                Word::Type(ty) => Some(ty),
                Word::Name => self.check.struct_named(symbol).map(Type::Struct),
                Word::Keyword(_) | Word::Reserved => None,
            },
            _ => None,
        };
        let Some(base) = base else {
            return self.unexpected("a type");
        };
        self.next();
        let sizes = self.sizes()?;
        Ok(Specifier { base, sizes, at })
    }

    /// `[n][]…`.
    fn sizes(&mut self) -> Parsed<Vec<Size>> {
        let mut sizes = Vec::new();
        while self.is(Punctuator::LeftBracket) {
            let open = self.next().at;
            if self.is(Punctuator::RightBracket) {
                let close = self.next().at;
                sizes.push(Size::Inferred(open.to(close)));
                continue;
            }
            let size = self.nested(Self::conditional)?;
            sizes.push(self.check.array_size(size));
            self.expect(Punctuator::RightBracket)?;
        }
        Ok(sizes)
    }

    /// `struct name { members }`, after the word `struct`.
    fn structure(&mut self, at: Place) -> Parsed<Type> {
        let name = if self.is(Punctuator::LeftBrace) {
            None
        } else {
            Some(self.name()?)
        };
        self.expect(Punctuator::LeftBrace)?;
        let mut members = Vec::new();
        loop {
            self.members(&mut members)?;
            if self.eat(Punctuator::RightBrace) {
                break;
            }
        }
        let place = name.map_or(at, |(_, at)| at);
        let id = self
            .check
            .declare_struct(name.map(|(name, _)| name), members, place);
        Ok(Type::Struct(id))
    }

    /// `vec3 a, b[2];`.
    fn members(&mut self, members: &mut Vec<Member>) -> Parsed<()> {
        let qualifiers = self.qualifiers()?;
        if let Some((_, at)) = qualifiers.storage {
            self.check
                .report(Code::BadQualifier.at(at, "a member has no qualifier but its precision"));
        }
        if self.keyword() == Some(Keyword::Struct) {
            let at = self.token().at;
            return self.halt(
                Code::Syntax,
                at,
                "a structure cannot be declared inside of a structure",
            );
        }
        let specifier = self.named_type()?;
        loop {
            let (name, at) = self.name()?;
            let sizes = self.sizes()?;
            self.check.member(members, &specifier, name, &sizes, at);
            if !self.eat(Punctuator::Comma) {
                self.expect(Punctuator::Semicolon)?;
                return Ok(());
            }
        }
    }

    /// `float , a;`: the grammar of §9 lets the first declarator be empty.
    fn eat_empty_declarator(&mut self) -> bool {
        self.eat(Punctuator::Comma)
    }

    /// The rest of a declaration, from the sizes of its first name to the `;`.
    fn declarators(
        &mut self,
        qualifiers: &Qualifiers,
        specifier: &Specifier,
        name: Symbol,
        at: Place,
    ) -> Parsed<Vec<VariableId>> {
        let mut variables = Vec::new();
        let mut declarator = self.declarator(name, at)?;
        loop {
            variables.push(self.check.declare_variable(qualifiers, specifier, declarator));
            if !self.eat(Punctuator::Comma) {
                self.expect(Punctuator::Semicolon)?;
                return Ok(variables);
            }
            let (name, at) = self.name()?;
            declarator = self.declarator(name, at)?;
        }
    }

    /// `[n] = value`, both optional.
    fn declarator(&mut self, name: Symbol, at: Place) -> Parsed<Declarator> {
        let sizes = self.sizes()?;
        let initialiser = if self.eat(Punctuator::Assign) {
            Some(self.assignment()?)
        } else {
            None
        };
        Ok(Declarator {
            name,
            at,
            sizes,
            initialiser,
        })
    }

    /// The rest of a prototype or definition, from its `(`.
    fn function(
        &mut self,
        qualifiers: &Qualifiers,
        result: &Specifier,
        name: Symbol,
        at: Place,
    ) -> Parsed<()> {
        let qualifier = qualifiers
            .storage
            .map(|(_, at)| at)
            .or(qualifiers.is_const)
            .or(qualifiers.interface);
        if let Some(at) = qualifier {
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
        let body = self.block()?;
        self.check.close_body(function, body);
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
            parameters.push(self.parameter()?);
            if !self.eat(Punctuator::Comma) {
                self.expect(Punctuator::RightParen)?;
                return Ok(parameters);
            }
        }
    }

    fn parameter(&mut self) -> Parsed<Parameter> {
        let qualifiers = self.qualifiers()?;
        let direction = self.direction(&qualifiers);
        let mut specifier = self.type_specifier()?;
        let name = match self.kind() {
            TokenKind::Word(_) => Some(self.name()?),
            _ => None,
        };
        let at = name.map_or(specifier.at, |(_, at)| at);
        let mut sizes = self.sizes()?;
        sizes.append(&mut specifier.sizes);
        specifier.sizes = sizes;
        Ok(Parameter {
            name: name.map(|(name, _)| name),
            ty: self.check.parameter_type(&specifier, direction),
            direction,
            at,
        })
    }

    fn direction(&mut self, qualifiers: &Qualifiers) -> Direction {
        let wrong = match (qualifiers.storage, qualifiers.is_const, qualifiers.interface) {
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
