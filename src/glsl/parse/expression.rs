//! Expressions (§5.1): one function for each kind of operator; chains are loops.

use super::{Parsed, Parser};
use crate::check::Specifier;
use crate::codes::Code;
use crate::token::{Punctuator, TokenKind};
use crate::tree::{ExprId, Literal, Place, StepOp, Type, UnaryOp, Value};
use crate::words::{Keyword, Word};

impl Parser<'_> {
    /// `a, b, c`.
    pub(super) fn expression(&mut self) -> Parsed<ExprId> {
        let mut expr = self.assignment()?;
        while self.eat(Punctuator::Comma) {
            let second = self.assignment()?;
            expr = self.check.sequence(expr, second);
        }
        Ok(expr)
    }

    /// `a = b = c`, which groups to the right.
    pub(super) fn assignment(&mut self) -> Parsed<ExprId> {
        self.nested(|parser| {
            let target = parser.conditional()?;
            let TokenKind::Punctuator(punctuator) = parser.kind() else {
                return Ok(target);
            };
            let op = punctuator.assignment_operator();
            if op.is_none() && punctuator != Punctuator::Assign {
                return Ok(target);
            }
            parser.next();
            let value = parser.assignment()?;
            Ok(parser.check.assign(op, target, value))
        })
    }

    /// `a ? b : c`, which groups to the right; also what constant expressions are.
    pub(super) fn conditional(&mut self) -> Parsed<ExprId> {
        let condition = self.binary(1)?;
        if !self.eat(Punctuator::Question) {
            return Ok(condition);
        }
        let yes = self.nested(Self::expression)?;
        self.expect(Punctuator::Colon)?;
        let no = self.assignment()?;
        Ok(self.check.conditional(condition, yes, no))
    }

    /// Operators that bind at least as tightly as `precedence`. A chain of one level is a loop; only a tighter operator nests.
    fn binary(&mut self, precedence: u8) -> Parsed<ExprId> {
        let mut left = self.unary()?;
        while let TokenKind::Punctuator(punctuator) = self.kind()
            && let Some(op) = punctuator.binary_operator()
            && op.precedence() >= precedence
        {
            self.next();
            let right = self.nested(|parser| parser.binary(op.precedence() + 1))?;
            left = self.check.binary(op, left, right);
        }
        Ok(left)
    }

    fn unary(&mut self) -> Parsed<ExprId> {
        enum Prefix {
            Operator(UnaryOp),
            Step(StepOp),
        }
        let at = self.token().at;
        let prefix = match self.kind() {
            TokenKind::Punctuator(Punctuator::Plus) => Prefix::Operator(UnaryOp::Plus),
            TokenKind::Punctuator(Punctuator::Minus) => Prefix::Operator(UnaryOp::Minus),
            TokenKind::Punctuator(Punctuator::Not) => Prefix::Operator(UnaryOp::Not),
            TokenKind::Punctuator(Punctuator::Tilde) => Prefix::Operator(UnaryOp::BitNot),
            TokenKind::Punctuator(Punctuator::Increment) => Prefix::Step(StepOp::Increment),
            TokenKind::Punctuator(Punctuator::Decrement) => Prefix::Step(StepOp::Decrement),
            _ => return self.postfix(),
        };
        self.next();
        let operand = self.nested(Self::unary)?;
        Ok(match prefix {
            Prefix::Operator(op) => self.check.unary(op, operand, at),
            Prefix::Step(op) => self.check.step(op, false, operand, at),
        })
    }

    fn postfix(&mut self) -> Parsed<ExprId> {
        let mut expr = self.primary()?;
        loop {
            let at = self.token().at;
            let TokenKind::Punctuator(punctuator) = self.kind() else {
                return Ok(expr);
            };
            expr = match punctuator {
                Punctuator::LeftBracket => {
                    self.next();
                    let index = self.expression()?;
                    let close = self.expect(Punctuator::RightBracket)?;
                    self.check.index(expr, index, close)
                }
                Punctuator::Dot => {
                    self.next();
                    self.selection(expr)?
                }
                Punctuator::Increment => {
                    self.next();
                    self.check.step(StepOp::Increment, true, expr, at)
                }
                Punctuator::Decrement => {
                    self.next();
                    self.check.step(StepOp::Decrement, true, expr, at)
                }
                _ => return Ok(expr),
            };
        }
    }

    /// What follows a point: a member, a swizzle or `length()`.
    fn selection(&mut self, base: ExprId) -> Parsed<ExprId> {
        let (name, at) = self.name()?;
        if self.is(Punctuator::LeftParen) {
            self.next();
            let close = self.expect(Punctuator::RightParen)?;
            return Ok(self.check.method(base, name, at.to(close)));
        }
        Ok(self.check.field(base, name, at))
    }

    fn primary(&mut self) -> Parsed<ExprId> {
        let token = self.token();
        match token.kind {
            TokenKind::Number(text) => {
                self.next();
                match super::number::literal(self.words.text(text)) {
                    Ok(literal) => Ok(self.check.literal(literal, token.at)),
                    Err((code, message)) => Ok(self.check.refuse(code, token.at, message)),
                }
            }
            TokenKind::Punctuator(Punctuator::LeftParen) => {
                self.next();
                let expr = self.expression()?;
                let close = self.expect(Punctuator::RightParen)?;
                self.check.tree[expr].at = token.at.to(close);
                Ok(expr)
            }
            TokenKind::Word(symbol) => match self.words.word(symbol) {
                Word::Keyword(keyword @ (Keyword::True | Keyword::False)) => {
                    self.next();
                    let literal = Literal {
                        text: keyword.text().into(),
                        value: Value::Bool(keyword == Keyword::True),
                    };
                    Ok(self.check.literal(literal, token.at))
                }
                Word::Type(_) => self.constructor(),
                Word::Name if self.check.struct_named(symbol).is_some() => self.constructor(),
                Word::Reserved if !self.check.is_declared(symbol) => self.unexpected("an expression"),
                Word::Name | Word::Reserved => {
                    self.next();
                    if !self.is(Punctuator::LeftParen) {
                        return Ok(self.check.name(symbol, token.at));
                    }
                    let start = self.at;
                    let (arguments, close) = self.arguments()?;
                    let told = self.check.errors.len();
                    let called = self.check.call(symbol, token.at, arguments, token.at.to(close));
                    self.note_decimal_comma(told, start);
                    Ok(called)
                }
                Word::Keyword(_) => self.unexpected("an expression"),
            },
            _ => self.unexpected("an expression"),
        }
    }

    /// `type(…)` or `type[n](…)`.
    fn constructor(&mut self) -> Parsed<ExprId> {
        let specifier: Specifier = self.named_type()?;
        if !self.is(Punctuator::LeftParen) {
            let name = self.check.tree.type_name(specifier.base);
            if self.is(Punctuator::RightParen) && !self.is_told() {
                let message = format!("GLSL has no casts: write `{name}(…)` around the value");
                return self.halt(Code::Syntax, specifier.at, message);
            }
            return self.unexpected(&format!("`(`, for `{name}` is a type"));
        }
        let start = self.at;
        let (arguments, close) = self.arguments()?;
        let at = specifier.at.to(close);
        let told = self.check.errors.len();
        let constructed = self.check.construct(&specifier, arguments, at);
        self.note_decimal_comma(told, start);
        Ok(constructed)
    }

    /// `(a, b)`, `()` or `(void)`; and the place of the `)`.
    fn arguments(&mut self) -> Parsed<(Vec<ExprId>, Place)> {
        self.expect(Punctuator::LeftParen)?;
        let mut arguments = Vec::new();
        let void = self.word() == Some(Word::Type(Type::Void));
        if void && self.peek(1).kind == TokenKind::Punctuator(Punctuator::RightParen) {
            self.next();
        }
        if !self.is(Punctuator::RightParen) {
            arguments.push(self.assignment()?);
            while self.eat(Punctuator::Comma) {
                arguments.push(self.assignment()?);
            }
        }
        let close = self.expect(Punctuator::RightParen)?;
        Ok((arguments, close))
    }
}
