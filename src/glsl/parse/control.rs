//! `if`, `switch` and loops (§6.2, §6.3).

use super::{Halt, Parsed, Parser};
use crate::glsl::token::Punctuator;
use crate::glsl::tree::{Arm, Block, Case, Condition, StatementKind};
use crate::glsl::words::Keyword;

impl Parser<'_> {
    /// `if … else if … else …`, the whole chain in one loop.
    pub(super) fn if_statement(&mut self) -> Parsed<StatementKind> {
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

    pub(super) fn switch_statement(&mut self) -> Parsed<StatementKind> {
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
                            return Err(Halt);
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

    pub(super) fn for_statement(&mut self) -> Parsed<StatementKind> {
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

    pub(super) fn while_statement(&mut self) -> Parsed<StatementKind> {
        self.next();
        self.expect(Punctuator::LeftParen)?;
        let condition = self.loop_condition()?;
        self.expect(Punctuator::RightParen)?;
        let body = self.loop_body(Self::guarded)?;
        Ok(StatementKind::While { condition, body })
    }

    pub(super) fn do_statement(&mut self) -> Parsed<StatementKind> {
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
