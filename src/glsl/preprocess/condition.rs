//! Conditional directives: `#if` groups, and the integer expressions that control them.

use toyproof_diagnostic::{Code, Diagnostic};

use super::macros::expect_end_of_directive;
use super::{PpToken, Preprocessor};
use crate::token::{Punctuator, TokenKind};
use crate::tree::{BinaryOp, Place, UnaryOp};

/// An open `#if` group.
pub(super) struct Group {
    /// Whether the enclosing lines are active.
    outer: bool,
    branch: Branch,
    /// Whether the group's `#else` has been read, so that the last branch is open.
    last: bool,
    pub(super) at: Place,
}

/// The state of a group's current branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Branch {
    /// The branch is active.
    Read,
    /// Skipped until a branch whose condition holds.
    Waiting,
    /// Skipped up to `#endif`: an earlier branch was active, or the enclosing lines are not.
    Over,
}

impl Preprocessor<'_> {
    pub(super) fn is_active(&self) -> bool {
        self.groups
            .last()
            .is_none_or(|group| group.branch == Branch::Read)
    }

    pub(super) fn on_if(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let outer = self.is_active();
        let value = if outer { self.evaluate(line, at) } else { Ok(false) };
        // An invalid condition counts as false; the group is still opened, so that directives stay balanced.
        self.open(outer, matches!(value, Ok(true)), at);
        value.map(|_| ())
    }

    pub(super) fn on_ifdef(
        &mut self,
        line: &[PpToken],
        at: Place,
        wanted: bool,
    ) -> Result<(), Box<Diagnostic>> {
        let outer = self.is_active();
        let name = match line {
            [
                PpToken {
                    kind: TokenKind::Word(name),
                    ..
                },
                ..,
            ] => Some(*name),
            _ => None,
        };
        let active = name.is_some_and(|name| self.macros.contains_key(&name) == wanted);
        self.open(outer, active, at);
        match name {
            _ if !outer => Ok(()),
            None => Code::MalformedDirective.refuse(at, "expected the name of a macro"),
            Some(_) => expect_end_of_directive(&line[1..]),
        }
    }

    pub(super) fn on_elif(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let group = self.branch(at, "#elif")?;
        let is_evaluated = group.branch == Branch::Waiting;
        group.branch = Branch::Over;
        // The condition is evaluated only if no earlier branch was active.
        let value = if is_evaluated {
            self.evaluate(line, at)
        } else {
            Ok(false)
        };
        if is_evaluated && let Some(group) = self.groups.last_mut() {
            group.branch = if matches!(value, Ok(true)) {
                Branch::Read
            } else {
                Branch::Waiting
            };
        }
        value.map(|_| ())
    }

    pub(super) fn on_else(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let group = self.branch(at, "#else")?;
        group.branch = if group.branch == Branch::Waiting {
            Branch::Read
        } else {
            Branch::Over
        };
        group.last = true;
        if group.outer {
            expect_end_of_directive(line)
        } else {
            Ok(())
        }
    }

    pub(super) fn on_endif(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        match self.groups.pop() {
            None => Code::UnbalancedCondition.refuse(at, "`#endif` without `#if`"),
            Some(group) if group.outer => expect_end_of_directive(line),
            Some(_) => Ok(()),
        }
    }

    fn open(&mut self, outer: bool, active: bool, at: Place) {
        let branch = match (outer, active) {
            (true, true) => Branch::Read,
            (true, false) => Branch::Waiting,
            (false, _) => Branch::Over,
        };
        self.groups.push(Group {
            outer,
            branch,
            last: false,
            at,
        });
    }

    /// The innermost group, which starts its next branch.
    fn branch(&mut self, at: Place, name: &str) -> Result<&mut Group, Box<Diagnostic>> {
        match self.groups.last_mut() {
            None => Code::UnbalancedCondition.refuse(at, format!("`{name}` without `#if`")),
            Some(group) if group.last => Err(Box::new(
                Code::UnbalancedCondition
                    .at(at, format!("`{name}` after `#else`"))
                    .related(group.at.span, "this `#if` already has an `#else`"),
            )),
            Some(group) => Ok(group),
        }
    }

    fn evaluate(&mut self, line: &[PpToken], at: Place) -> Result<bool, Box<Diagnostic>> {
        // `defined` is evaluated before macros are expanded (§3.4).
        let replaced = self.replace_defined(line)?;
        let errors = self.diagnostics.len();
        let tokens = self.expand_list(replaced);
        if self.diagnostics.len() > errors {
            return Ok(false);
        }
        let (value, rest) = self.constant(&tokens, at)?;
        match rest {
            [] => Ok(value != 0),
            [first, ..] => Code::BadCondition.refuse(first.at, "expected an operator"),
        }
    }

    fn replace_defined(&mut self, line: &[PpToken]) -> Result<Vec<PpToken>, Box<Diagnostic>> {
        let mut replaced = Vec::with_capacity(line.len());
        let mut rest = line;
        while let [token, tail @ ..] = rest {
            rest = tail;
            let TokenKind::Word(word) = token.kind else {
                replaced.push(*token);
                continue;
            };
            if self.interner.text(word) != "defined" {
                replaced.push(*token);
                continue;
            }
            let paren = |token: &PpToken, wanted| token.kind == TokenKind::Punctuator(wanted);
            let (name, after) = match rest {
                [open, name, close, after @ ..]
                    if paren(open, Punctuator::LeftParen) && paren(close, Punctuator::RightParen) =>
                {
                    (name, after)
                }
                [name, after @ ..] => (name, after),
                [] => {
                    return Code::BadCondition
                        .refuse(token.at, "expected the name of a macro after `defined`");
                }
            };
            let TokenKind::Word(name) = name.kind else {
                return Code::BadCondition.refuse(token.at, "expected the name of a macro after `defined`");
            };
            rest = after;
            let value = self
                .interner
                .symbol(if self.macros.contains_key(&name) { "1" } else { "0" });
            replaced.push(PpToken {
                kind: TokenKind::Number(value),
                ..*token
            });
        }
        Ok(replaced)
    }
}

// Integer constant expressions (§3.4).

impl Preprocessor<'_> {
    /// Evaluates the integer constant expression at the beginning of a list; also returns the tokens after
    /// it.
    pub(super) fn constant<'t>(
        &self,
        tokens: &'t [PpToken],
        at: Place,
    ) -> Result<(i64, &'t [PpToken]), Box<Diagnostic>> {
        let mut evaluator = Evaluator {
            preprocessor: self,
            rest: tokens,
            at,
            depth: 0,
        };
        let value = evaluator.binary(1, true)?;
        Ok((value, evaluator.rest))
    }
}

/// Maximum nesting depth of parentheses and unary operators in a condition.
const MAX_CONDITION_NESTING: usize = 256;

/// Parses and evaluates an expression in one pass.
struct Evaluator<'p, 't> {
    preprocessor: &'p Preprocessor<'p>,
    rest: &'t [PpToken],
    at: Place,
    depth: usize,
}

impl Evaluator<'_, '_> {
    /// Evaluates a chain of operators of at least `precedence`. If `is_evaluated` is false, the value is
    /// ignored, and `1 / 0` or an unknown name is not an error (§3.4: `&&` and `||` short-circuit).
    fn binary(&mut self, precedence: u8, is_evaluated: bool) -> Result<i64, Box<Diagnostic>> {
        let mut left = self.unary(is_evaluated)?;
        while let Some(op) = self.peek_operator().filter(|op| op.precedence() >= precedence) {
            let at = self.rest.first().map_or(self.at, |token| token.at);
            self.rest = &self.rest[1..];
            let evaluates_right = match op {
                BinaryOp::And => is_evaluated && left != 0,
                BinaryOp::Or => is_evaluated && left == 0,
                _ => is_evaluated,
            };
            let right = self.binary(op.precedence() + 1, evaluates_right)?;
            left = match compute(op, left, right) {
                Some(value) => value,
                None if is_evaluated => {
                    return Code::BadCondition.refuse(at, "division by zero in a preprocessor condition");
                }
                None => 0,
            };
        }
        Ok(left)
    }

    fn unary(&mut self, is_evaluated: bool) -> Result<i64, Box<Diagnostic>> {
        let Some((&token, rest)) = self.rest.split_first() else {
            return Code::BadCondition.refuse(self.at, "expected an integer expression");
        };
        self.rest = rest;
        let op = match token.kind {
            TokenKind::Number(number) => return integer(self.preprocessor.interner.text(number), token.at),
            TokenKind::Word(_) if !is_evaluated => return Ok(0),
            TokenKind::Word(name) => {
                let name = self.preprocessor.interner.text(name);
                let message = format!("`{name}` is not a macro");
                let diagnostic = Code::BadCondition.at(token.at, message);
                return Err(Box::new(
                    diagnostic.help(format!("define it, or test `defined({name})` first")),
                ));
            }
            TokenKind::Punctuator(Punctuator::LeftParen) => None,
            TokenKind::Punctuator(Punctuator::Plus) => Some(UnaryOp::Plus),
            TokenKind::Punctuator(Punctuator::Minus) => Some(UnaryOp::Minus),
            TokenKind::Punctuator(Punctuator::Not) => Some(UnaryOp::Not),
            TokenKind::Punctuator(Punctuator::Tilde) => Some(UnaryOp::BitNot),
            _ => return Code::BadCondition.refuse(token.at, "expected an integer"),
        };
        if self.depth == MAX_CONDITION_NESTING {
            return Code::TooDeep.refuse(
                token.at,
                format!("condition nested more than {MAX_CONDITION_NESTING} levels deep"),
            );
        }
        self.depth += 1;
        let value = if let Some(op) = op {
            let value = self.unary(is_evaluated)?;
            match op {
                UnaryOp::Plus => value,
                UnaryOp::Minus => value.wrapping_neg(),
                UnaryOp::Not => i64::from(value == 0),
                UnaryOp::BitNot => !value,
            }
        } else {
            let value = self.binary(1, is_evaluated)?;
            match self.rest.split_first() {
                Some((close, rest)) if close.kind == TokenKind::Punctuator(Punctuator::RightParen) => {
                    self.rest = rest;
                }
                _ => return Code::BadCondition.refuse(token.at, "unclosed `(`"),
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
    value.or_else(|_| Code::BadCondition.refuse(at, format!("`{text}` is not an integer")))
}

/// Computes one operation; `None` for a division by zero.
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
