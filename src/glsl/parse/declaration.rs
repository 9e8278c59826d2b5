//! Declarations: types, variables, structures, functions (§4, §6.1).

use super::{Halt, Parsed, Parser};
use crate::check::{Declarator, Members, Qualifiers, Size, Specifier};
use crate::codes::Code;
use crate::token::{Punctuator, Symbol, TokenKind};
use crate::tree::{Item, Place, Type, VariableId};
use crate::words::{Keyword, Word};

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
                "ShaderToy has nothing to bind to an interface block",
            );
        }
        let specifier = self.type_specifier()?;
        self.check.precision_fits(&qualifiers, &specifier);
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

    /// A declaration inside of a function, with its `;`.
    pub(super) fn local_declaration(&mut self) -> Parsed<Vec<VariableId>> {
        if self.eat_keyword(Keyword::Precision) {
            self.precision_statement()?;
            return Ok(Vec::new());
        }
        let qualifiers = self.qualifiers()?;
        let specifier = self.type_specifier()?;
        self.check.precision_fits(&qualifiers, &specifier);
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
            let diagnostic = Code::Syntax.at(at, "a function cannot be declared inside of a function");
            let (ty, name) = (self.check.tree.type_name(specifier.base), self.words.text(name));
            let note = format!("a variable gets its value by `{ty} {name} = {ty}(…);`");
            return self.halt_with(diagnostic.note(note));
        }
        self.declarators(&qualifiers, &specifier, name, at)
    }

    /// `bool b = f()` as the condition of a loop.
    pub(super) fn condition_declaration(&mut self) -> Parsed<VariableId> {
        let qualifiers = self.qualifiers()?;
        let specifier = self.named_type()?;
        self.check.precision_fits(&qualifiers, &specifier);
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
        self.check.precision(&specifier);
        self.semicolon("`;`")
    }

    /// Whether a name follows that is no type: `invariant x;`.
    fn is_redeclaration(&self) -> bool {
        matches!(self.kind(), TokenKind::Word(symbol)
            if self.words.word(symbol) == Word::Name && self.check.struct_named(symbol).is_none())
    }

    /// `uniform Name { … }` (§4.3.7), at its name.
    fn is_block(&self) -> bool {
        self.word() == Some(Word::Name) && self.peek(1).kind == TokenKind::Punctuator(Punctuator::LeftBrace)
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
        let Some(base) = base.or_else(|| self.unknown_type()) else {
            return self.unexpected("a type");
        };
        self.next();
        let sizes = self.sizes()?;
        Ok(Specifier { base, sizes, at })
    }

    /// What a name stands for that is no type and stands where one must, a name after it: told, and taken for what it may mean.
    fn unknown_type(&mut self) -> Option<Type> {
        let TokenKind::Word(symbol) = self.kind() else {
            return None;
        };
        let begins_declaration = match (self.word(), self.peek(1).kind) {
            (Some(Word::Name), TokenKind::Word(_)) => true,
            // Not `static float x` nor `class A {`.
            (Some(Word::Reserved), TokenKind::Word(name)) => {
                self.words.word(name) == Word::Name
                    && self.peek(2).kind != TokenKind::Punctuator(Punctuator::LeftBrace)
            }
            _ => false,
        };
        begins_declaration.then(|| self.check.unknown_type(symbol, self.token().at))
    }

    /// `[n][]…`.
    pub(super) fn sizes(&mut self) -> Parsed<Vec<Size>> {
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
        if self.is(Punctuator::RightBrace) {
            let at = self.token().at;
            return self.halt(Code::Syntax, at, "a structure has at least one member");
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
            self.check.lacks_members(id);
        }
        Ok(Type::Struct(id))
    }

    /// `vec3 a, b[2];`.
    fn members(&mut self, members: &mut Members) -> Parsed<()> {
        let qualifiers = self.qualifiers()?;
        if let Some(at) = qualifiers.other_than_precision() {
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
        self.check.precision_fits(&qualifiers, &specifier);
        loop {
            let (name, at) = self.name()?;
            let sizes = self.sizes()?;
            self.check.member(members, &specifier, name, &sizes, at);
            if !self.eat(Punctuator::Comma) {
                return self.semicolon("`;`, `,` or `[`");
            }
        }
    }

    /// Whether a structure has just been read and a new line begins something else: then only its `;` is missing.
    fn ends_without_name(&self) -> bool {
        let previous = self.tokens[self.at - 1];
        previous.kind == TokenKind::Punctuator(Punctuator::RightBrace)
            && self.word() != Some(Word::Name)
            && self.layout.line_between(previous, self.token())
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
        let (mut name, mut at) = (name, at);
        loop {
            let Ok(declarator) = self.declarator(name, at) else {
                self.check.declare_unread(name, at);
                return Err(Halt);
            };
            let wanted = if declarator.initialiser.is_some() {
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
}
