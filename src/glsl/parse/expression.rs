//! Expressions (§5.1): one function for each kind of operator; chains are loops. Also numeric literals.

use toyproof_diagnostic::Code;

use super::{ParseResult, Parser};
use crate::check::Specifier;
use crate::keywords::{Keyword, Word};
use crate::token::{Punctuator, TokenKind};
use crate::tree::{ExprId, Literal, Place, StepOp, Type, UnaryOp, Value};

impl Parser<'_> {
    /// Parses `a, b, c`.
    pub(super) fn expression(&mut self) -> ParseResult<ExprId> {
        let mut expr = self.assignment()?;
        while self.eat(Punctuator::Comma) {
            let second = self.assignment()?;
            expr = self.check.sequence(expr, second);
        }
        Ok(expr)
    }

    /// Parses `a = b = c`, which is right-associative.
    pub(super) fn assignment(&mut self) -> ParseResult<ExprId> {
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

    /// Parses `a ? b : c`, which is right-associative. Constant expressions also have this form.
    pub(super) fn conditional(&mut self) -> ParseResult<ExprId> {
        let condition = self.binary(1)?;
        if !self.eat(Punctuator::Question) {
            return Ok(condition);
        }
        let yes = self.nested(Self::expression)?;
        self.expect(Punctuator::Colon)?;
        let no = self.assignment()?;
        Ok(self.check.conditional(condition, yes, no))
    }

    /// Parses binary operators of at least `precedence`. A chain of one precedence is a loop; only operators
    /// of higher precedence recurse.
    fn binary(&mut self, precedence: u8) -> ParseResult<ExprId> {
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

    fn unary(&mut self) -> ParseResult<ExprId> {
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

    fn postfix(&mut self) -> ParseResult<ExprId> {
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

    /// Parses the text after a `.`: a member, a swizzle or `length()`.
    fn selection(&mut self, base: ExprId) -> ParseResult<ExprId> {
        let (name, at) = self.name()?;
        if self.is(Punctuator::LeftParen) {
            self.next();
            let close = self.expect(Punctuator::RightParen)?;
            return Ok(self.check.method(base, name, at.to(close)));
        }
        Ok(self.check.field(base, name, at))
    }

    /// Parses `.size` after `iCh0`.
    fn channel_member(&mut self, channel: u8, input: Place) -> ParseResult<ExprId> {
        if !self.is(Punctuator::Dot) {
            return Ok(self.check.unselected_channel_input(channel, input));
        }
        self.next();
        let (member, at) = self.name()?;
        Ok(self.check.channel_member(channel, member, input.to(at)))
    }

    fn primary(&mut self) -> ParseResult<ExprId> {
        let token = self.token();
        match token.kind {
            TokenKind::Number(text) => {
                self.next();
                let text = self.interner.text(text);
                self.check.check_suffix(text, token.at);
                match super::expression::literal(text) {
                    Ok(literal) => Ok(self.check.literal(literal, token.at)),
                    Err(error) => Ok(self.check.malformed_literal(error, token.at)),
                }
            }
            TokenKind::Punctuator(Punctuator::LeftParen) => {
                self.next();
                let expr = self.expression()?;
                let close = self.expect(Punctuator::RightParen)?;
                self.check.tree[expr].at = token.at.to(close);
                Ok(expr)
            }
            TokenKind::Word(symbol) => match self.interner.word(symbol) {
                Word::Keyword(keyword @ (Keyword::True | Keyword::False)) => {
                    self.next();
                    let literal = Literal::new(keyword.text(), Value::Bool(keyword == Keyword::True));
                    Ok(self.check.literal(literal, token.at))
                }
                Word::Type(_) => self.constructor(),
                Word::Name if self.check.struct_named(symbol).is_some() => self.constructor(),
                Word::Reserved if !self.check.is_declared(symbol) => self.unexpected("an expression"),
                Word::Name | Word::Reserved => {
                    self.next();
                    if let Some(channel) = self.check.channel_input(symbol) {
                        return self.channel_member(channel, token.at);
                    }
                    if !self.is(Punctuator::LeftParen) {
                        return Ok(self.check.name(symbol, token.at));
                    }
                    let start = self.at;
                    let (arguments, close) = self.arguments()?;
                    let reported = self.check.errors.len();
                    let called = self.check.call(symbol, token.at, arguments, token.at.to(close));
                    self.note_decimal_comma(reported, start);
                    Ok(called)
                }
                Word::Keyword(_) => self.unexpected("an expression"),
            },
            _ => self.unexpected("an expression"),
        }
    }

    /// Parses `type(…)` or `type[n](…)`.
    fn constructor(&mut self) -> ParseResult<ExprId> {
        let specifier: Specifier = self.named_type()?;
        if !self.is(Punctuator::LeftParen) {
            let name = self.check.tree.type_name(specifier.base);
            if self.is(Punctuator::RightParen) && !self.is_reported() {
                let diagnostic = Code::Syntax.at(specifier.at, "C-style casts are not supported");
                return self.halt_with(diagnostic.help(format!("write `{name}(…)` around the value")));
            }
            return self.unexpected(&format!("`(` after the type `{name}`"));
        }
        let start = self.at;
        let (arguments, close) = self.arguments()?;
        let at = specifier.at.to(close);
        let reported = self.check.errors.len();
        let push_constructor = self.check.construct(&specifier, arguments, at);
        self.note_decimal_comma(reported, start);
        Ok(push_constructor)
    }

    /// Parses `(a, b)`, `()` or `(void)`; also returns the place of the `)`.
    fn arguments(&mut self) -> ParseResult<(Vec<ExprId>, Place)> {
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

// Numeric literals (§4.1.3, §4.1.4).

/// The error in a numeric literal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LiteralError {
    pub(crate) code: Code,
    pub(crate) message: String,
    /// The literal that was probably intended.
    pub(crate) replacement: Option<String>,
}

impl LiteralError {
    fn malformed(text: &str) -> Self {
        Self {
            code: Code::BadNumber,
            message: format!("malformed number `{text}`"),
            replacement: None,
        }
    }
}

/// The value of a numeric literal, or the error in it.
pub(super) fn literal(text: &str) -> Result<Literal, LiteralError> {
    let value = if is_float(text) {
        float(text)
    } else {
        integer(text)
    };
    Ok(Literal::new(text, value?))
}

fn is_float(text: &str) -> bool {
    let hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    !hexadecimal && text.contains(['.', 'e', 'E'])
}

fn float(text: &str) -> Result<Value, LiteralError> {
    let digits = text.strip_suffix(['f', 'F']).unwrap_or(text);
    // Forms that Rust accepts but GLSL does not (`inf`, `1`) do not reach this. As in WebGL, a number that is
    // too large is infinity.
    match digits.parse() {
        Ok(value) => Ok(Value::Float(value)),
        Err(_) => Err(LiteralError::malformed(text)),
    }
}

fn integer(text: &str) -> Result<Value, LiteralError> {
    let (digits, unsigned) = match text.strip_suffix(['u', 'U']) {
        Some(digits) => (digits, true),
        None => (text, false),
    };
    let (digits, radix) = match digits.strip_prefix("0x").or(digits.strip_prefix("0X")) {
        Some(digits) => (digits, 16),
        None if digits.len() > 1 && digits.starts_with('0') => (&digits[1..], 8),
        None => (digits, 10),
    };
    if digits.is_empty() || !digits.chars().all(|c| c.is_digit(radix)) {
        let is_float = digits
            .strip_suffix(['f', 'F'])
            .is_some_and(|rest| rest.parse::<u64>().is_ok());
        let (message, replacement) = if is_float {
            let number = text.trim_end_matches(['f', 'F']);
            let message = format!("`float` literal `{text}` has no decimal point");
            (message, Some(format!("{number}.0")))
        } else if radix == 8 && digits.chars().all(|c| c.is_ascii_digit()) {
            let number = text.trim_start_matches('0');
            let message = format!("invalid digit in `{text}`: a leading 0 makes it octal");
            (message, Some(number.to_owned()))
        } else {
            return Err(LiteralError::malformed(text));
        };
        return Err(LiteralError {
            code: Code::BadNumber,
            message,
            replacement,
        });
    }
    match u32::from_str_radix(digits, radix) {
        // An `int` takes the bit pattern: 0xFFFFFFFF is −1 (§4.1.3).
        Ok(bits) if unsigned => Ok(Value::Uint(bits)),
        Ok(bits) => Ok(Value::Int(bits.cast_signed())),
        Err(_) => Err(LiteralError {
            code: Code::NumberRange,
            message: format!("integer literal `{text}` does not fit in 32 bits"),
            replacement: None,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers() {
        let cases = [
            ("0", Some(Value::Int(0))),
            ("010", Some(Value::Int(8))),
            ("0x1F", Some(Value::Int(31))),
            ("0XfU", Some(Value::Uint(15))),
            ("4294967295", Some(Value::Int(-1))),
            ("2147483648u", Some(Value::Uint(1 << 31))),
            (".5", Some(Value::Float(0.5))),
            ("1.", Some(Value::Float(1.0))),
            ("1e3", Some(Value::Float(1000.0))),
            ("1.5E-1f", Some(Value::Float(0.15))),
            ("1e999", Some(Value::Float(f64::INFINITY))),
            ("4294967296", None),
            ("08", None),
            ("0x", None),
            ("1f", None),
            ("1.xx", None),
            ("1..", None),
            ("1e", None),
            ("1.0u", None),
        ];
        for (text, value) in cases {
            assert_eq!(literal(text).ok().map(|literal| literal.value), value, "{text}");
        }
    }
}
