//! `if`, `switch` and loops (§6.2, §6.3).

use super::{Parsed, Parser};
use crate::check::Labels;
use crate::token::{Punctuator, Token};
use crate::tree::{Arm, Block, Case, Condition, Label, StatementKind};
use crate::words::Keyword;

impl Parser<'_> {
    /// `if … else if … else …`, the whole chain in one loop.
    pub(super) fn if_statement(&mut self) -> Parsed<StatementKind> {
        let mut arms = Vec::new();
        loop {
            self.next();
            let at = self.token().at;
            let condition = self.parenthesised(|parser| {
                let condition = parser.expression()?;
                Ok(parser.check.condition(condition))
            })?;
            let condition = condition.unwrap_or_else(|| self.check.broken(at));
            let body = self.scoped(Self::guarded)?;
            arms.push(Arm { condition, body });
            if self.is_others_else_if() {
                self.tell_else_if();
                continue;
            }
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
        let at = self.token().at;
        let selector = self.parenthesised(Self::expression)?;
        let selector = selector.unwrap_or_else(|| self.check.broken(at));
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

    /// The labels of a `switch` with what follows them, and the `}`.
    fn cases(&mut self, labels: &mut Labels) -> Parsed<Vec<Case>> {
        let mut cases: Vec<Case> = Vec::new();
        // Whether no statement came since the last label: a label that comes now stands beside it.
        let mut bare = false;
        while !self.eat(Punctuator::RightBrace) {
            if self.is_at_end() {
                return self.unexpected("`}`");
            }
            let at = self.token().at;
            if !matches!(self.keyword(), Some(Keyword::Case | Keyword::Default)) {
                if cases.is_empty() {
                    self.check.misplaced_label(at, "a `switch` begins with a label");
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
                .misplaced_label(close, "a statement must follow the last label of a `switch`");
        }
        Ok(cases)
    }

    /// `case 1:` or `default:`.
    fn label(&mut self, labels: &mut Labels) -> Parsed<Label> {
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

    pub(super) fn for_statement(&mut self) -> Parsed<StatementKind> {
        self.next();
        let head = self.parenthesised(|parser| {
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
        let at = self.token().at;
        let condition = self.parenthesised(Self::loop_condition)?;
        let condition = condition.unwrap_or_else(|| Condition::Expression(self.check.broken(at)));
        let body = self.loop_body(Self::guarded)?;
        Ok(StatementKind::While { condition, body })
    }

    pub(super) fn do_statement(&mut self) -> Parsed<StatementKind> {
        self.next();
        let body = self.loop_body(|parser| parser.scoped(Self::guarded))?;
        if !self.eat_keyword(Keyword::While) {
            return self.unexpected("`while`");
        }
        let at = self.token().at;
        let condition = self.parenthesised(|parser| {
            let condition = parser.expression()?;
            Ok(parser.check.condition(condition))
        })?;
        let condition = condition.unwrap_or_else(|| self.check.broken(at));
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
