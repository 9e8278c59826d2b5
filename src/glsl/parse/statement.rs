//! Statements (§6).

use super::{Parsed, Parser};
use crate::glsl::token::{Keyword, Punctuator, TokenKind, Word};
use crate::glsl::tree::{Arm, Block, Case, Condition, Place, Statement, StatementKind};

impl Parser<'_> {
    /// `{ … }` without a scope of its own: the caller has opened one.
    pub(super) fn block(&mut self) -> Parsed<Block> {
        self.expect(Punctuator::LeftBrace)?;
        let mut block = Block::new();
        while !self.is(Punctuator::RightBrace) {
            self.statement(&mut block)?;
        }
        self.next();
        Ok(block)
    }

    /// One statement of the text, appended as the none, one or several that it is in the tree.
    fn statement(&mut self, block: &mut Block) -> Parsed<()> {
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
            Keyword::Else => return self.unexpected("a statement: this `else` has no `if`"),
            _ => return Ok(None),
        }))
    }

    /// The `;` that ends a statement.
    fn end(&mut self, kind: StatementKind) -> Parsed<StatementKind> {
        self.expect(Punctuator::Semicolon)?;
        Ok(kind)
    }

    /// A declaration or an expression; only what follows the name of a type tells them apart.
    fn simple_statement(&mut self, block: &mut Block) -> Parsed<()> {
        if self.is_declaration() {
            return self.declaration_statement(block);
        }
        let at = self.token().at;
        let expr = self.expression()?;
        let kind = self.end(StatementKind::Expression(expr))?;
        block.push(Statement { kind, at });
        Ok(())
    }

    /// Whether a declaration begins here: with a qualifier, or with a type that no constructor's `(` follows.
    fn is_declaration(&self) -> bool {
        let TokenKind::Word(symbol) = self.kind() else {
            return false;
        };
        let is_type = match self.words.word(symbol) {
            Word::Keyword(keyword) => return !matches!(keyword, Keyword::True | Keyword::False),
            Word::Type(_) => true,
            Word::Name => self.check.struct_named(symbol).is_some(),
            Word::Reserved => false,
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

    fn declaration_statement(&mut self, block: &mut Block) -> Parsed<()> {
        let at = self.token().at;
        let first = self.check.tree.structs.len();
        let variables = self.local_declaration()?;
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

    fn scoped<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        self.check.open_scope();
        let result = read(self);
        self.check.close_scope();
        result
    }

    /// What an `if`, `else` or loop guards: a block, or one statement. The caller has opened a scope.
    fn guarded(&mut self) -> Parsed<Block> {
        if self.is(Punctuator::LeftBrace) {
            return self.nested(Self::block);
        }
        let mut block = Block::new();
        self.statement(&mut block)?;
        Ok(block)
    }

    /// `if … else if … else …`, the whole chain in one loop.
    fn if_statement(&mut self) -> Parsed<StatementKind> {
        let mut arms = Vec::new();
        loop {
            self.next();
            self.expect(Punctuator::LeftParen)?;
            let condition = self.expression()?;
            let condition = self.check.condition(condition);
            self.expect(Punctuator::RightParen)?;
            let body = self.scoped(Self::guarded)?;
            arms.push(Arm { condition, body });
            if !self.eat_keyword(Keyword::Else) {
                return Ok(StatementKind::If {
                    arms,
                    otherwise: None,
                });
            }
            if self.keyword() != Some(Keyword::If) {
                let otherwise = Some(self.scoped(Self::guarded)?);
                return Ok(StatementKind::If { arms, otherwise });
            }
        }
    }

    fn switch_statement(&mut self) -> Parsed<StatementKind> {
        self.next();
        self.expect(Punctuator::LeftParen)?;
        let selector = self.expression()?;
        let mut labels = self.check.selector(selector);
        self.expect(Punctuator::RightParen)?;
        self.expect(Punctuator::LeftBrace)?;
        self.check.enter_switch();
        let cases = self.scoped(|parser| {
            let mut cases: Vec<Case> = Vec::new();
            // Whether no statement came since the last label: a label that comes now stands beside it.
            let mut bare = false;
            while !parser.is(Punctuator::RightBrace) {
                let at = parser.token().at;
                let label = match parser.keyword() {
                    Some(Keyword::Case) => {
                        parser.next();
                        let expr = parser.expression()?;
                        parser.check.case(&mut labels, expr)
                    }
                    Some(Keyword::Default) => {
                        parser.next();
                        parser.check.default(&mut labels, at)
                    }
                    _ => {
                        let Some(case) = cases.last_mut() else {
                            parser.check.misplaced_label(at, "a `switch` begins with a label");
                            return Err(super::Halt);
                        };
                        parser.statement(&mut case.body)?;
                        bare = false;
                        continue;
                    }
                };
                parser.expect(Punctuator::Colon)?;
                match cases.last_mut() {
                    Some(case) if bare => case.labels.push(label),
                    _ => cases.push(Case {
                        labels: vec![label],
                        body: Block::new(),
                        at,
                    }),
                }
                bare = true;
            }
            // §6.2: something must follow the last label.
            if bare {
                let close = parser.token().at;
                parser
                    .check
                    .misplaced_label(close, "a statement must follow the last label of a `switch`");
            }
            Ok(cases)
        })?;
        self.check.leave_switch();
        self.expect(Punctuator::RightBrace)?;
        Ok(StatementKind::Switch { selector, cases })
    }

    fn for_statement(&mut self) -> Parsed<StatementKind> {
        self.next();
        self.expect(Punctuator::LeftParen)?;
        let mut init = Block::new();
        if !self.eat(Punctuator::Semicolon) {
            self.simple_statement(&mut init)?;
        }
        let condition = if self.is(Punctuator::Semicolon) {
            None
        } else {
            Some(self.loop_condition()?)
        };
        self.expect(Punctuator::Semicolon)?;
        let step = if self.is(Punctuator::RightParen) {
            None
        } else {
            Some(self.expression()?)
        };
        self.expect(Punctuator::RightParen)?;
        let body = self.loop_body(Self::guarded)?;
        Ok(StatementKind::For {
            init,
            condition,
            step,
            body,
        })
    }

    fn while_statement(&mut self) -> Parsed<StatementKind> {
        self.next();
        self.expect(Punctuator::LeftParen)?;
        let condition = self.loop_condition()?;
        self.expect(Punctuator::RightParen)?;
        let body = self.loop_body(Self::guarded)?;
        Ok(StatementKind::While { condition, body })
    }

    fn do_statement(&mut self) -> Parsed<StatementKind> {
        self.next();
        let body = self.loop_body(|parser| parser.scoped(Self::guarded))?;
        if !self.eat_keyword(Keyword::While) {
            return self.unexpected("`while`");
        }
        self.expect(Punctuator::LeftParen)?;
        let condition = self.expression()?;
        let condition = self.check.condition(condition);
        self.expect(Punctuator::RightParen)?;
        self.end(StatementKind::DoWhile { body, condition })
    }

    fn loop_body(&mut self, read: impl FnOnce(&mut Self) -> Parsed<Block>) -> Parsed<Block> {
        self.check.enter_loop();
        let body = read(self);
        self.check.leave_loop();
        body
    }

    /// An expression, or a declaration with initialiser.
    fn loop_condition(&mut self) -> Parsed<Condition> {
        if self.is_declaration() {
            return Ok(Condition::Declare(self.condition_declaration()?));
        }
        let condition = self.expression()?;
        Ok(Condition::Expression(self.check.condition(condition)))
    }
}
