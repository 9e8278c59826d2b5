//! Statements (§6).

use super::{Parsed, Parser};
use crate::codes::Code;
use crate::token::{Punctuator, TokenKind};
use crate::tree::{Block, Place, Statement, StatementKind};
use crate::words::{Keyword, Word};

impl Parser<'_> {
    /// `{ … }` without a scope of its own: the caller has opened one.
    pub(super) fn block(&mut self) -> Parsed<Block> {
        self.expect(Punctuator::LeftBrace)?;
        let mut block = Block::new();
        while !self.eat(Punctuator::RightBrace) {
            if self.is_at_end() {
                return self.unexpected("`}`");
            }
            self.recovering(|parser| parser.statement(&mut block));
        }
        self.end_piece();
        Ok(block)
    }

    /// One statement of the text, appended as the none, one or several that it is in the tree.
    pub(super) fn statement(&mut self, block: &mut Block) -> Parsed<()> {
        self.nested(|parser| {
            let at = parser.token().at;
            let kind = match parser.kind() {
                TokenKind::Punctuator(Punctuator::LeftBrace) => {
                    StatementKind::Block(parser.scoped(Self::block)?)
                }
                TokenKind::Punctuator(Punctuator::Semicolon) => {
                    parser.next();
                    return Ok(());
                }
                _ => match parser.keyword() {
                    Some(keyword) => match parser.keyword_statement(keyword, at)? {
                        Some(kind) => kind,
                        None => return parser.declaration_statement(block),
                    },
                    None => return parser.simple_statement(block),
                },
            };
            let at = if kind.is_compound() { at } else { parser.since(at) };
            block.push(Statement { kind, at });
            Ok(())
        })
    }

    /// A statement that begins with a keyword; none if the keyword begins a declaration.
    fn keyword_statement(&mut self, keyword: Keyword, at: Place) -> Parsed<Option<StatementKind>> {
        Ok(Some(match keyword {
            Keyword::If => self.if_statement()?,
            Keyword::Switch => self.switch_statement()?,
            Keyword::For => self.scoped(Self::for_statement)?,
            Keyword::While => self.scoped(Self::while_statement)?,
            Keyword::Do => self.do_statement()?,
            Keyword::Break => {
                self.next();
                self.check.break_statement(at);
                self.end(StatementKind::Break)?
            }
            Keyword::Continue => {
                self.next();
                self.check.continue_statement(at);
                self.end(StatementKind::Continue)?
            }
            Keyword::Discard => {
                self.next();
                self.end(StatementKind::Discard)?
            }
            Keyword::Return => {
                self.next();
                let value = if self.is(Punctuator::Semicolon) {
                    None
                } else {
                    Some(self.expression()?)
                };
                let value = self.check.return_statement(value, at);
                self.end(StatementKind::Return(value))?
            }
            Keyword::True | Keyword::False => {
                let expr = self.expression()?;
                self.end(StatementKind::Expression(expr))?
            }
            Keyword::Case | Keyword::Default => {
                self.check
                    .misplaced_label(at, "a label stands directly in a `switch` or nowhere");
                return Err(super::Halt);
            }
            Keyword::Else => {
                let diagnostic = Code::Syntax.at(at, "this `else` has no `if`");
                let note = "between `if (…)` and `else` stands one statement, or a block in `{ }`";
                return self.halt_with(diagnostic.note(note));
            }
            _ => return Ok(None),
        }))
    }

    /// The `;` that ends a statement.
    pub(super) fn end(&mut self, kind: StatementKind) -> Parsed<StatementKind> {
        self.semicolon("`;` or an operator")?;
        Ok(kind)
    }

    /// A declaration or an expression; only what follows the name of a type tells them apart.
    pub(super) fn simple_statement(&mut self, block: &mut Block) -> Parsed<()> {
        if self.is_declaration() {
            return self.declaration_statement(block);
        }
        let at = self.token().at;
        let expr = self.expression()?;
        let kind = self.end(StatementKind::Expression(expr))?;
        let at = self.since(at);
        block.push(Statement { kind, at });
        Ok(())
    }

    /// Whether a declaration begins here: with a qualifier, or with a type that no constructor's `(` follows.
    pub(super) fn is_declaration(&self) -> bool {
        let TokenKind::Word(symbol) = self.kind() else {
            return false;
        };
        let is_type = match self.words.word(symbol) {
            Word::Keyword(keyword) => return !matches!(keyword, Keyword::True | Keyword::False),
            Word::Type(_) => true,
            Word::Name if self.check.struct_named(symbol).is_some() => true,
            // A type that does not exist; what has a meaning is rather followed by a mistake.
            Word::Name if self.check.is_declared(symbol) => false,
            Word::Name | Word::Reserved => {
                return self.names_variable(1) && !self.layout.line_between(self.token(), self.peek(1));
            }
        };
        if !is_type {
            return false;
        }
        // Past any `[n]`: names follow declarations' types, `(` follows constructors'.
        let mut ahead = 1;
        let mut nesting = 0;
        loop {
            match self.peek(ahead).kind {
                TokenKind::Punctuator(Punctuator::LeftBracket) => nesting += 1,
                TokenKind::Punctuator(Punctuator::RightBracket) => nesting -= 1,
                TokenKind::Punctuator(Punctuator::LeftParen) if nesting == 0 => return false,
                TokenKind::End => return true,
                _ if nesting == 0 => return true,
                _ => {}
            }
            ahead += 1;
        }
    }

    /// Whether the token that many after the next is a name that is being declared.
    fn names_variable(&self, ahead: usize) -> bool {
        use Punctuator::{Assign, Comma, LeftBracket, LeftParen, Semicolon};
        let is_name =
            matches!(self.peek(ahead).kind, TokenKind::Word(symbol) if self.words.word(symbol) == Word::Name);
        is_name
            && matches!(
                self.peek(ahead + 1).kind,
                TokenKind::Punctuator(Assign | Comma | LeftBracket | LeftParen | Semicolon)
            )
    }

    fn declaration_statement(&mut self, block: &mut Block) -> Parsed<()> {
        let at = self.token().at;
        let first = self.check.tree.structs.len();
        let variables = self.local_declaration()?;
        let at = self.since(at);
        let structs = self
            .check
            .tree
            .structs
            .ids()
            .skip(first)
            .map(StatementKind::Struct);
        let declared = structs.collect::<Vec<_>>().into_iter();
        let all = declared.chain(variables.into_iter().map(StatementKind::Declare));
        block.extend(all.map(|kind| Statement { kind, at }));
        Ok(())
    }

    pub(super) fn scoped<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        self.check.open_scope();
        let result = read(self);
        self.check.close_scope();
        result
    }

    /// What an `if`, `else` or loop guards: a block, or one statement. The caller has opened a scope.
    pub(super) fn guarded(&mut self) -> Parsed<Block> {
        if self.is(Punctuator::LeftBrace) {
            return self.nested(Self::block);
        }
        let mut block = Block::new();
        self.statement(&mut block)?;
        Ok(block)
    }
}
