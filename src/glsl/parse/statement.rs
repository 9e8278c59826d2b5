//! Statements and control flow (§6).

use toyproof_diagnostic::Code;

use super::{ParseResult, Parser};
use crate::check::Labels;
use crate::keywords::{Keyword, Word};
use crate::token::{Punctuator, Token, TokenKind};
use crate::tree::{Arm, Block, Case, Condition, ExprId, Label, Place, Statement, StatementKind};

impl Parser<'_> {
    /// Parses `{ … }` without opening a scope, which the caller has done.
    pub(super) fn block(&mut self) -> ParseResult<Block> {
        self.expect(Punctuator::LeftBrace)?;
        let mut block = Block::new();
        while !self.eat(Punctuator::RightBrace) {
            if self.is_at_end() {
                return self.unexpected("`}`");
            }
            self.recovering(|parser| parser.statement(&mut block));
        }
        self.end_unit();
        Ok(block)
    }

    /// Parses one statement and appends the zero, one or several statements that it is in the tree.
    pub(super) fn statement(&mut self, block: &mut Block) -> ParseResult<()> {
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
            let at = if kind.is_compound() {
                at
            } else {
                parser.place_from(at)
            };
            block.push(Statement { kind, at });
            Ok(())
        })
    }

    /// Parses a statement that begins with a keyword; returns `None` if the keyword begins a declaration.
    fn keyword_statement(&mut self, keyword: Keyword, at: Place) -> ParseResult<Option<StatementKind>> {
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
                self.check.misplaced_label(
                    at,
                    "`case` and `default` labels must be directly inside a `switch`",
                );
                return Err(super::Halt);
            }
            Keyword::Else => {
                let diagnostic = Code::Syntax.at(at, "`else` without a matching `if`");
                let help = "put several statements between `if (…)` and `else` in `{ }`";
                return self.halt_with(diagnostic.help(help));
            }
            _ => return Ok(None),
        }))
    }

    /// Consumes the `;` that ends a statement.
    pub(super) fn end(&mut self, kind: StatementKind) -> ParseResult<StatementKind> {
        self.semicolon("`;` or an operator")?;
        Ok(kind)
    }

    /// Parses a declaration or an expression statement, which differ only after the name of a type.
    fn simple_statement(&mut self, block: &mut Block) -> ParseResult<()> {
        if self.is_declaration() {
            return self.declaration_statement(block);
        }
        let at = self.token().at;
        let expr = self.expression()?;
        let kind = self.end(StatementKind::Expression(expr))?;
        let at = self.place_from(at);
        block.push(Statement { kind, at });
        Ok(())
    }

    /// Whether a declaration begins here: a qualifier, or a type not followed by a constructor's `(`.
    fn is_declaration(&self) -> bool {
        let TokenKind::Word(symbol) = self.kind() else {
            return false;
        };
        let is_type = match self.interner.word(symbol) {
            Word::Keyword(keyword) => return !matches!(keyword, Keyword::True | Keyword::False),
            Word::Type(_) => true,
            Word::Name if self.check.struct_named(symbol).is_some() => true,
            // An unknown type. A declared name is more likely an expression with an error.
            Word::Name if self.check.is_declared(symbol) => false,
            Word::Name | Word::Reserved => {
                return self.names_variable(1) && !self.layout.line_between(self.token(), self.peek(1));
            }
        };
        if !is_type {
            return false;
        }
        // After any `[n]`, a name follows a declaration's type and `(` a constructor's.
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

    /// Whether the token `ahead` positions after the next one is a name that is being declared.
    fn names_variable(&self, ahead: usize) -> bool {
        use Punctuator::{Assign, Comma, LeftBracket, LeftParen, Semicolon};
        let is_name = matches!(self.peek(ahead).kind, TokenKind::Word(symbol) if self.interner.word(symbol) == Word::Name);
        is_name
            && matches!(
                self.peek(ahead + 1).kind,
                TokenKind::Punctuator(Assign | Comma | LeftBracket | LeftParen | Semicolon)
            )
    }

    fn declaration_statement(&mut self, block: &mut Block) -> ParseResult<()> {
        let at = self.token().at;
        let first = self.check.tree.structs.len();
        let variables = self.local_declaration()?;
        let at = self.place_from(at);
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

    fn scoped<T>(&mut self, read: impl FnOnce(&mut Self) -> ParseResult<T>) -> ParseResult<T> {
        self.check.open_scope();
        let result = read(self);
        let end = self.scope_end();
        self.check.close_scope(end);
        result
    }

    /// Parses the body of an `if`, `else` or loop: a block, or one statement. The caller has opened a scope.
    fn statement_body(&mut self) -> ParseResult<Block> {
        if self.is(Punctuator::LeftBrace) {
            return self.nested(Self::block);
        }
        let mut block = Block::new();
        self.statement(&mut block)?;
        Ok(block)
    }
}

// `if`, `switch` and loops (§6.2, §6.3).

impl Parser<'_> {
    /// Parses `if … else if … else …`, the whole chain in one loop.
    fn if_statement(&mut self) -> ParseResult<StatementKind> {
        let mut arms = Vec::new();
        loop {
            self.next();
            let condition = self.parenthesized_condition()?;
            let body = self.scoped(Self::statement_body)?;
            arms.push(Arm { condition, body });
            if self.is_foreign_else_if() {
                self.report_foreign_else_if();
                continue;
            }
            if !self.eat_keyword(Keyword::Else) {
                return Ok(StatementKind::If {
                    arms,
                    otherwise: None,
                });
            }
            if self.keyword() != Some(Keyword::If) {
                let otherwise = Some(self.scoped(Self::statement_body)?);
                return Ok(StatementKind::If { arms, otherwise });
            }
        }
    }

    fn switch_statement(&mut self) -> ParseResult<StatementKind> {
        self.next();
        let at = self.token().at;
        let selector = self.parenthesized(Self::expression)?;
        let selector = selector.unwrap_or_else(|| self.check.error_expr(at));
        let mut labels = self.check.selector(selector);
        self.expect(Punctuator::LeftBrace)?;
        self.check.enter_switch();
        let cases = self.scoped(|parser| parser.cases(&mut labels));
        self.check.leave_switch();
        Ok(StatementKind::Switch {
            selector,
            cases: cases?,
        })
    }

    /// Parses the labels of a `switch`, the statements after them, and the `}`.
    fn cases(&mut self, labels: &mut Labels) -> ParseResult<Vec<Case>> {
        let mut cases: Vec<Case> = Vec::new();
        // Whether no statement followed the last label: the next label then joins it.
        let mut bare = false;
        while !self.eat(Punctuator::RightBrace) {
            if self.is_at_end() {
                return self.unexpected("`}`");
            }
            let at = self.token().at;
            if !matches!(self.keyword(), Some(Keyword::Case | Keyword::Default)) {
                if cases.is_empty() {
                    self.check.misplaced_label(
                        at,
                        "expected a `case` or `default` label at the start of a `switch`",
                    );
                    cases.push(Case {
                        labels: Vec::new(),
                        body: Block::new(),
                        at,
                    });
                }
                if let Some(case) = cases.last_mut() {
                    self.recovering(|parser| parser.statement(&mut case.body));
                }
                bare = false;
                continue;
            }
            let label = self.recovering(|parser| parser.label(labels));
            match (cases.last_mut(), label) {
                (Some(case), Some(label)) if bare => case.labels.push(label),
                (_, label) => cases.push(Case {
                    labels: label.into_iter().collect(),
                    body: Block::new(),
                    at,
                }),
            }
            bare = label.is_some();
        }
        // §6.2: something must follow the last label.
        if bare {
            let close = self.tokens[self.at - 1].at;
            self.check
                .misplaced_label(close, "expected a statement after the last label of a `switch`");
        }
        Ok(cases)
    }

    /// Parses `case 1:` or `default:`.
    fn label(&mut self, labels: &mut Labels) -> ParseResult<Label> {
        let Token { at, .. } = self.token();
        let is_case = self.keyword() == Some(Keyword::Case);
        self.next();
        let label = if is_case {
            let expr = self.expression()?;
            self.check.case(labels, expr)
        } else {
            self.check.default(labels, at)
        };
        self.expect(Punctuator::Colon)?;
        Ok(label)
    }

    fn for_statement(&mut self) -> ParseResult<StatementKind> {
        self.next();
        let head = self.parenthesized(|parser| {
            let mut init = Block::new();
            if !parser.eat(Punctuator::Semicolon) {
                parser.simple_statement(&mut init)?;
            }
            let condition = if parser.is(Punctuator::Semicolon) {
                None
            } else {
                Some(parser.loop_condition()?)
            };
            parser.expect(Punctuator::Semicolon)?;
            let step = if parser.is(Punctuator::RightParen) {
                None
            } else {
                Some(parser.expression()?)
            };
            Ok((init, condition, step))
        })?;
        let (init, condition, step) = head.unwrap_or_default();
        let body = self.loop_body(Self::statement_body)?;
        Ok(StatementKind::For {
            init,
            condition,
            step,
            body,
        })
    }

    fn while_statement(&mut self) -> ParseResult<StatementKind> {
        self.next();
        let at = self.token().at;
        let condition = self.parenthesized(Self::loop_condition)?;
        let condition = condition.unwrap_or_else(|| Condition::Expression(self.check.error_expr(at)));
        let body = self.loop_body(Self::statement_body)?;
        Ok(StatementKind::While { condition, body })
    }

    fn do_statement(&mut self) -> ParseResult<StatementKind> {
        self.next();
        let body = self.loop_body(|parser| parser.scoped(Self::statement_body))?;
        if !self.eat_keyword(Keyword::While) {
            return self.unexpected("`while`");
        }
        let condition = self.parenthesized_condition()?;
        self.end(StatementKind::DoWhile { body, condition })
    }

    fn parenthesized_condition(&mut self) -> ParseResult<ExprId> {
        let at = self.token().at;
        let condition = self.parenthesized(|parser| {
            let condition = parser.expression()?;
            Ok(parser.check.condition(condition))
        })?;
        Ok(condition.unwrap_or_else(|| self.check.error_expr(at)))
    }

    fn loop_body(&mut self, read: impl FnOnce(&mut Self) -> ParseResult<Block>) -> ParseResult<Block> {
        self.check.enter_loop();
        let body = read(self);
        self.check.leave_loop();
        body
    }

    /// An expression, or a declaration with initializer.
    fn loop_condition(&mut self) -> ParseResult<Condition> {
        if self.is_declaration() {
            return Ok(Condition::Declare(self.condition_declaration()?));
        }
        let condition = self.expression()?;
        Ok(Condition::Expression(self.check.condition(condition)))
    }
}
