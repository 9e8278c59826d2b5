//! Declarations: types, variables, structures, functions (§4, §6.1).

use toyproof_diagnostic::{Code, Diagnostic};

use super::{Halt, ParseResult, Parser};
use crate::check::{Declarator, Initializer, Members, Parameter, Qualifiers, Size, Specifier, Storage};
use crate::keywords::{Keyword, Word};
use crate::token::{Punctuator, Symbol, TokenKind};
use crate::tree::{Direction, Item, Place, Type, VariableId};

impl Parser<'_> {
    /// Parses one declaration at global scope, or a function.
    pub(super) fn external_declaration(&mut self) -> ParseResult<()> {
        if self.check.takes_stray_semicolons() && self.eat(Punctuator::Semicolon) {
            return Ok(());
        }
        if self.eat_keyword(Keyword::Precision) {
            return self.precision_statement();
        }
        let qualifiers = self.qualifiers()?;
        if qualifiers.is_only(Keyword::Invariant) && self.is_redeclaration() {
            let (name, at) = self.name()?;
            self.check.invariant(name, at);
            return self.semicolon("`;`");
        }
        let first = self.check.tree.structs.len();
        if qualifiers.storage.is_some() && self.is_block() {
            let at = self.token().at;
            return self.halt(
                Code::BadQualifier,
                at,
                "interface blocks are not supported: ShaderToy binds none",
            );
        }
        let specifier = self.type_specifier()?;
        self.check.check_precision_qualifier(&qualifiers, &specifier);
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
        if self.ends_without_name() {
            return self.semicolon("`;`");
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

    /// Parses a declaration inside a function, with its `;`.
    pub(super) fn local_declaration(&mut self) -> ParseResult<Vec<VariableId>> {
        if self.eat_keyword(Keyword::Precision) {
            self.precision_statement()?;
            return Ok(Vec::new());
        }
        let qualifiers = self.qualifiers()?;
        let specifier = self.type_specifier()?;
        self.check.check_precision_qualifier(&qualifiers, &specifier);
        if self.eat(Punctuator::Semicolon) {
            return Ok(Vec::new());
        }
        if self.ends_without_name() {
            self.semicolon("`;`")?;
            return Ok(Vec::new());
        }
        self.eat_empty_declarator();
        let (name, at) = self.name()?;
        if self.is(Punctuator::LeftParen) {
            let diagnostic = Code::Syntax.at(at, "a function cannot be declared inside a function");
            let (ty, name) = (
                self.check.tree.type_name(specifier.base),
                self.interner.text(name),
            );
            let help = format!("to initialize a variable, write `{ty} {name} = {ty}(…);`");
            return self.halt_with(diagnostic.help(help));
        }
        self.declarators(&qualifiers, &specifier, name, at)
    }

    /// Parses `bool b = f()` as the condition of a loop.
    pub(super) fn condition_declaration(&mut self) -> ParseResult<VariableId> {
        let qualifiers = self.qualifiers()?;
        let specifier = self.named_type()?;
        self.check.check_precision_qualifier(&qualifiers, &specifier);
        let (name, at) = self.name()?;
        if !self.is(Punctuator::Assign) {
            return self.unexpected("`=`");
        }
        let declarator = self.declarator(name, at)?;
        if let Some(Initializer::Expression(value)) = declarator.initializer {
            self.check.condition(value);
        }
        Ok(self.check.declare_variable(&qualifiers, &specifier, declarator))
    }

    /// Parses `precision highp float;`, which has no effect because everything is `highp`.
    fn precision_statement(&mut self) -> ParseResult<()> {
        match self.keyword() {
            Some(Keyword::Highp | Keyword::Mediump | Keyword::Lowp) => self.next(),
            _ => return self.unexpected("`highp`, `mediump` or `lowp`"),
        };
        let specifier = self.named_type()?;
        self.check.precision(&specifier);
        self.semicolon("`;`")
    }

    /// Whether a name follows that is not a type: `invariant x;`.
    fn is_redeclaration(&self) -> bool {
        matches!(self.kind(), TokenKind::Word(symbol)
            if self.interner.word(symbol) == Word::Name && self.check.struct_named(symbol).is_none())
    }

    /// Whether an interface block, `uniform Name { … }` (§4.3.7), begins at its name.
    fn is_block(&self) -> bool {
        self.word() == Some(Word::Name) && self.peek(1).kind == TokenKind::Punctuator(Punctuator::LeftBrace)
    }

    /// Parses a type name or a structure, and the sizes that follow.
    fn type_specifier(&mut self) -> ParseResult<Specifier> {
        if self.keyword() != Some(Keyword::Struct) {
            return self.named_type();
        }
        let at = self.next().at;
        let base = self.structure(at)?;
        let sizes = self.sizes()?;
        Ok(Specifier { base, sizes, at })
    }

    pub(super) fn named_type(&mut self) -> ParseResult<Specifier> {
        let at = self.token().at;
        let base = match self.kind() {
            TokenKind::Word(symbol) => match self.interner.word(symbol) {
                Word::Type(ty) => Some(ty),
                Word::Name => self.check.struct_named(symbol).map(Type::Struct),
                Word::Keyword(_) | Word::Reserved => None,
            },
            _ => None,
        };
        let Some(base) = base.or_else(|| self.unknown_type()) else {
            return self.unexpected("a type");
        };
        self.check.named_type(base, at);
        self.next();
        let sizes = self.sizes()?;
        Ok(Specifier { base, sizes, at })
    }

    /// Handles an unknown name in the position of a type, followed by a name: reports it and returns the type
    /// that is probably intended.
    fn unknown_type(&mut self) -> Option<Type> {
        let TokenKind::Word(symbol) = self.kind() else {
            return None;
        };
        let begins_declaration = match (self.word(), self.peek(1).kind) {
            (Some(Word::Name), TokenKind::Word(_)) => true,
            // Excludes `static float x` and `class A {`.
            (Some(Word::Reserved), TokenKind::Word(name)) => {
                self.interner.word(name) == Word::Name
                    && self.peek(2).kind != TokenKind::Punctuator(Punctuator::LeftBrace)
            }
            _ => false,
        };
        begins_declaration.then(|| self.check.unknown_type(symbol, self.token().at))
    }

    /// Parses `[n][]…`.
    pub(super) fn sizes(&mut self) -> ParseResult<Vec<Size>> {
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

    /// Parses `struct name { members }`, after the keyword `struct`.
    fn structure(&mut self, at: Place) -> ParseResult<Type> {
        let name = if self.is(Punctuator::LeftBrace) {
            None
        } else {
            Some(self.name()?)
        };
        self.expect(Punctuator::LeftBrace)?;
        if self.is(Punctuator::RightBrace) {
            let at = self.token().at;
            return self.halt(Code::Syntax, at, "a structure must have at least one member");
        }
        let mut members = Members::default();
        let mut complete = true;
        loop {
            complete &= self.recovering(|parser| parser.members(&mut members)).is_some();
            if self.eat(Punctuator::RightBrace) || self.is_at_end() {
                break;
            }
        }
        let place = name.map_or(at, |(_, at)| at);
        let id = self
            .check
            .declare_struct(name.map(|(name, _)| name), members.all, place);
        if !complete {
            self.check.mark_incomplete(id);
        }
        Ok(Type::Struct(id))
    }

    /// Parses `vec3 a, b[2];`.
    fn members(&mut self, members: &mut Members) -> ParseResult<()> {
        let qualifiers = self.qualifiers()?;
        if let Some(at) = qualifiers.other_than_precision() {
            self.check
                .report(Code::BadQualifier.at(at, "a structure member can only have a precision qualifier"));
        }
        if self.keyword() == Some(Keyword::Struct) {
            let at = self.token().at;
            return self.halt(
                Code::Syntax,
                at,
                "a structure cannot be declared inside a structure",
            );
        }
        let specifier = self.named_type()?;
        self.check.check_precision_qualifier(&qualifiers, &specifier);
        loop {
            let (name, at) = self.name()?;
            let sizes = self.sizes()?;
            self.check.member(members, &specifier, name, &sizes, at);
            if !self.eat(Punctuator::Comma) {
                return self.semicolon("`;`, `,` or `[`");
            }
        }
    }

    /// Whether a structure was just parsed and a new line begins a different construct: then only its `;` is
    /// missing.
    fn ends_without_name(&self) -> bool {
        let previous = self.tokens[self.at - 1];
        previous.kind == TokenKind::Punctuator(Punctuator::RightBrace)
            && self.word() != Some(Word::Name)
            && self.layout.line_between(previous, self.token())
    }

    /// Consumes the comma of `float , a;`: the grammar of §9 allows an empty first declarator.
    fn eat_empty_declarator(&mut self) -> bool {
        self.eat(Punctuator::Comma)
    }

    /// Parses the rest of a declaration, from the sizes of its first name to the `;`.
    fn declarators(
        &mut self,
        qualifiers: &Qualifiers,
        specifier: &Specifier,
        name: Symbol,
        at: Place,
    ) -> ParseResult<Vec<VariableId>> {
        let mut variables = Vec::new();
        let (mut name, mut at) = (name, at);
        loop {
            let Ok(declarator) = self.declarator(name, at) else {
                self.check.declare_unparsed(name, at);
                return Err(Halt);
            };
            let wanted = if declarator.initializer.is_some() {
                "`;`, `,` or an operator"
            } else {
                "`=`, `;`, `,` or `[`"
            };
            variables.push(self.check.declare_variable(qualifiers, specifier, declarator));
            if !self.eat(Punctuator::Comma) {
                self.semicolon(wanted)?;
                return Ok(variables);
            }
            (name, at) = self.name()?;
        }
    }

    /// Parses `[n] = value`, both optional.
    fn declarator(&mut self, name: Symbol, at: Place) -> ParseResult<Declarator> {
        let sizes = self.sizes()?;
        let initializer = if self.eat(Punctuator::Assign) {
            Some(self.initializer()?)
        } else {
            None
        };
        Ok(Declarator {
            name,
            at,
            sizes,
            initializer,
        })
    }
}

impl Parser<'_> {
    /// Parses an expression, or `{…}` where the language has it.
    fn initializer(&mut self) -> ParseResult<Initializer> {
        if !self.check.takes_initializer_lists() || !self.is(Punctuator::LeftBrace) {
            return self.assignment().map(Initializer::Expression);
        }
        let open = self.next().at;
        let mut items = Vec::new();
        loop {
            items.push(self.nested(Self::initializer)?);
            let has_comma = self.eat(Punctuator::Comma);
            if !has_comma || self.is(Punctuator::RightBrace) {
                break;
            }
        }
        let close = self.token().at;
        self.expect(Punctuator::RightBrace)?;
        Ok(Initializer::List {
            items,
            at: open.to(close),
        })
    }
}

// Qualifiers (§4.3–§4.7).

/// The error about a vertex shader's input.
fn vertex_shader(at: Place) -> Diagnostic {
    let diagnostic = Code::BadQualifier.at(at, "`attribute` belongs to a vertex shader");
    diagnostic.help("toyproof runs fragment shaders that cover the image: give it the fragment shader alone")
}

impl Parser<'_> {
    /// Parses the qualifiers before a type, in the order of §4.7: `invariant`, interpolation, layout,
    /// storage, precision.
    pub(super) fn qualifiers(&mut self) -> ParseResult<Qualifiers> {
        let mut qualifiers = Qualifiers::default();
        let mut last = 0;
        loop {
            let at = self.token().at;
            let Some(keyword) = self.keyword() else {
                return Ok(qualifiers);
            };
            if keyword == Keyword::Attribute {
                return self.halt_with(vertex_shader(at));
            }
            let rank = match keyword {
                Keyword::Invariant => 1,
                Keyword::Flat | Keyword::Smooth => 2,
                Keyword::Layout => 3,
                Keyword::Const | Keyword::Centroid => 4,
                Keyword::In | Keyword::Out | Keyword::InOut | Keyword::Uniform | Keyword::Varying => 5,
                Keyword::Highp | Keyword::Mediump | Keyword::Lowp => 6,
                _ => return Ok(qualifiers),
            };
            self.next();
            if rank <= last {
                let message = format!("qualifier `{}` is out of order or repeated", keyword.text());
                self.check.report(Code::BadQualifier.at(at, message));
            }
            last = rank;
            match keyword {
                Keyword::Const => qualifiers.is_const = Some(at),
                Keyword::Uniform => qualifiers.storage = Some((Storage::Uniform, at)),
                Keyword::In => qualifiers.storage = Some((Storage::In, at)),
                Keyword::Varying => qualifiers.storage = Some((Storage::Varying, at)),
                Keyword::Out => qualifiers.storage = Some((Storage::Out, at)),
                Keyword::InOut => qualifiers.storage = Some((Storage::InOut, at)),
                Keyword::Highp | Keyword::Mediump | Keyword::Lowp => qualifiers.precision = Some(at),
                _ => qualifiers.interface.push((keyword, at)),
            }
            if keyword == Keyword::Layout {
                self.layout()?;
            }
        }
    }

    /// Parses `(location = 0, …)`, which is checked but not stored.
    fn layout(&mut self) -> ParseResult<()> {
        self.expect(Punctuator::LeftParen)?;
        loop {
            let (name, at) = self.name()?;
            self.check.layout(name, at);
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
}

// Functions (§6.1).

impl Parser<'_> {
    /// Parses the rest of a prototype or definition, from its `(`.
    pub(super) fn function(
        &mut self,
        qualifiers: &Qualifiers,
        result: &Specifier,
        name: Symbol,
        at: Place,
    ) -> ParseResult<()> {
        if let Some(at) = qualifiers.other_than_precision() {
            self.check
                .report(Code::BadQualifier.at(at, "a return type can only have a precision qualifier"));
        }
        let parameters = self.parameters()?;
        let function = self.check.declare_function(result, name, at, &parameters);
        if self.eat(Punctuator::Semicolon) {
            self.check.prototype(function, &parameters);
            return Ok(());
        }
        if !self.is(Punctuator::LeftBrace) {
            return self.unexpected("`{` or `;`");
        }
        self.check.open_body(function, at, &parameters);
        let body = self.block();
        let end = self.scope_end();
        self.check.close_body(function, body?, end);
        Ok(())
    }

    /// Parses `(in vec3 p, float t)`, `()` or `(void)`.
    fn parameters(&mut self) -> ParseResult<Vec<Parameter>> {
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
                None => parameters.push(self.placeholder_parameter(start)),
            }
            if !self.eat(Punctuator::Comma) {
                self.expect(Punctuator::RightParen)?;
                return Ok(parameters);
            }
        }
    }

    fn parameter(&mut self) -> ParseResult<Parameter> {
        let qualifiers = self.qualifiers()?;
        let direction = self.direction(&qualifiers);
        let mut specifier = self.named_type()?;
        self.check.check_precision_qualifier(&qualifiers, &specifier);
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

    /// The replacement for a parameter that cannot be parsed: of type `Error`, with the last name in its
    /// text.
    fn placeholder_parameter(&self, start: usize) -> Parameter {
        let tokens = &self.tokens[start..self.at.min(self.tokens.len())];
        let name = tokens.iter().rev().find_map(|token| match token.kind {
            TokenKind::Word(word) if self.interner.word(word) == Word::Name => Some((word, token.at)),
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
            (_, _, Some(at)) | (Some((Storage::Uniform | Storage::Varying, at)), _, _) => {
                Some((at, "a parameter can only be `const`, `in`, `out` or `inout`"))
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
