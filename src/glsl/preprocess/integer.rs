//! The integers that decide conditions (§3.4).

use toyproof_diagnostic::Diagnostic;

use super::{PpToken, Preprocessor};
use crate::codes::Code;
use crate::token::{Punctuator, TokenKind};
use crate::tree::{BinaryOp, Place, UnaryOp};

impl Preprocessor<'_> {
    /// The integer constant expression that a list begins with, and what follows it.
    pub(super) fn constant<'t>(
        &self,
        tokens: &'t [PpToken],
        at: Place,
    ) -> Result<(i64, &'t [PpToken]), Box<Diagnostic>> {
        let mut reader = Reader {
            preprocessor: self,
            rest: tokens,
            at,
            depth: 0,
        };
        let value = reader.binary(1, true)?;
        Ok((value, reader.rest))
    }
}

/// How deep parentheses and unary operators may nest in a condition.
const MAX_DEPTH: usize = 256;

/// Reads an expression and computes it on the way.
struct Reader<'p, 't> {
    preprocessor: &'p Preprocessor<'p>,
    rest: &'t [PpToken],
    at: Place,
    depth: usize,
}

impl Reader<'_, '_> {
    /// A chain of operators that bind at least as tightly as `precedence`. Where `asked` is false the value does not count, and
    /// nothing is wrong with `1 / 0` or an unknown name (§3.4: `&&` and `||` decide by their left side).
    fn binary(&mut self, precedence: u8, asked: bool) -> Result<i64, Box<Diagnostic>> {
        let mut left = self.unary(asked)?;
        while let Some(op) = self.peek_operator().filter(|op| op.precedence() >= precedence) {
            let at = self.rest.first().map_or(self.at, |token| token.at);
            self.rest = &self.rest[1..];
            let right_asked = match op {
                BinaryOp::And => asked && left != 0,
                BinaryOp::Or => asked && left == 0,
                _ => asked,
            };
            let right = self.binary(op.precedence() + 1, right_asked)?;
            left = match compute(op, left, right) {
                Some(value) => value,
                None if asked => return Code::BadCondition.refuse(at, "division by zero"),
                None => 0,
            };
        }
        Ok(left)
    }

    fn unary(&mut self, asked: bool) -> Result<i64, Box<Diagnostic>> {
        let Some((&token, rest)) = self.rest.split_first() else {
            return Code::BadCondition.refuse(self.at, "the condition ends too early");
        };
        self.rest = rest;
        let op = match token.kind {
            TokenKind::Number(number) => return integer(self.preprocessor.words.text(number), token.at),
            TokenKind::Word(_) if !asked => return Ok(0),
            TokenKind::Word(name) => {
                let message = format!("`{}` is no macro", self.preprocessor.words.text(name));
                return Code::BadCondition.refuse(token.at, message);
            }
            TokenKind::Punctuator(Punctuator::LeftParen) => None,
            TokenKind::Punctuator(Punctuator::Plus) => Some(UnaryOp::Plus),
            TokenKind::Punctuator(Punctuator::Minus) => Some(UnaryOp::Minus),
            TokenKind::Punctuator(Punctuator::Not) => Some(UnaryOp::Not),
            TokenKind::Punctuator(Punctuator::Tilde) => Some(UnaryOp::BitNot),
            _ => return Code::BadCondition.refuse(token.at, "an integer is missing here"),
        };
        if self.depth == MAX_DEPTH {
            return Code::TooDeep.refuse(token.at, "this condition is nested too deep");
        }
        self.depth += 1;
        let value = if let Some(op) = op {
            let value = self.unary(asked)?;
            match op {
                UnaryOp::Plus => value,
                UnaryOp::Minus => value.wrapping_neg(),
                UnaryOp::Not => i64::from(value == 0),
                UnaryOp::BitNot => !value,
            }
        } else {
            let value = self.binary(1, asked)?;
            match self.rest.split_first() {
                Some((close, rest)) if close.kind == TokenKind::Punctuator(Punctuator::RightParen) => {
                    self.rest = rest;
                }
                _ => return Code::BadCondition.refuse(token.at, "this `(` has no `)`"),
            }
            value
        };
        self.depth -= 1;
        Ok(value)
    }

    fn peek_operator(&self) -> Option<BinaryOp> {
        match self.rest.first()?.kind {
            TokenKind::Punctuator(punctuator) => {
                punctuator.binary_operator().filter(|&op| op != BinaryOp::Xor)
            }
            _ => None,
        }
    }
}

fn integer(text: &str, at: Place) -> Result<i64, Box<Diagnostic>> {
    let digits = text.strip_suffix(['u', 'U']).unwrap_or(text);
    let value = match digits.strip_prefix("0x").or(digits.strip_prefix("0X")) {
        Some(hex) => i64::from_str_radix(hex, 16),
        None if digits.starts_with('0') => i64::from_str_radix(digits, 8),
        None => digits.parse(),
    };
    value.or_else(|_| Code::BadCondition.refuse(at, format!("`{text}` is no integer")))
}

/// None for a division by zero.
fn compute(op: BinaryOp, a: i64, b: i64) -> Option<i64> {
    Some(match op {
        BinaryOp::Multiply => a.wrapping_mul(b),
        BinaryOp::Divide => a.checked_div(b)?,
        BinaryOp::Remainder => a.checked_rem(b)?,
        BinaryOp::Add => a.wrapping_add(b),
        BinaryOp::Subtract => a.wrapping_sub(b),
        BinaryOp::ShiftLeft => a.wrapping_shl(b as u32),
        BinaryOp::ShiftRight => a.wrapping_shr(b as u32),
        BinaryOp::Less => i64::from(a < b),
        BinaryOp::Greater => i64::from(a > b),
        BinaryOp::LessEqual => i64::from(a <= b),
        BinaryOp::GreaterEqual => i64::from(a >= b),
        BinaryOp::Equal => i64::from(a == b),
        BinaryOp::NotEqual => i64::from(a != b),
        BinaryOp::BitAnd => a & b,
        BinaryOp::BitXor => a ^ b,
        BinaryOp::BitOr => a | b,
        BinaryOp::And => i64::from(a != 0 && b != 0),
        BinaryOp::Xor => i64::from((a != 0) != (b != 0)),
        BinaryOp::Or => i64::from(a != 0 || b != 0),
    })
}
