//! `#if` and its kin: which groups of lines are read, and the integers that decide it.

use toyproof_diagnostic::Diagnostic;

use super::define::nothing_left;
use super::{PpToken, Preprocessor};
use crate::codes::Code;
use crate::token::{Punctuator, TokenKind};
use crate::tree::Place;

/// An `#if` that waits for its `#endif`.
pub(super) struct Group {
    /// Whether the lines around it are read.
    outer: bool,
    branch: Branch,
    /// Whether its `#else` came already.
    last: bool,
    pub(super) at: Place,
}

/// What becomes of the lines of a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Branch {
    /// They are read now.
    Read,
    /// They are passed over until a branch comes whose condition holds.
    Waiting,
    /// They are passed over up to `#endif`: a branch was read already, or the lines around are not read.
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
        // A condition that cannot be told counts as false: what follows is still balanced.
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
            None => Code::MalformedDirective.refuse(at, "the name of a macro is missing here"),
            Some(_) => nothing_left(&line[1..]),
        }
    }

    pub(super) fn on_elif(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let group = self.branch(at, "#elif")?;
        let asked = group.branch == Branch::Waiting;
        group.branch = Branch::Over;
        // The condition is looked at only if no branch was read before.
        let value = if asked { self.evaluate(line, at) } else { Ok(false) };
        if asked && let Some(group) = self.groups.last_mut() {
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
        if group.outer { nothing_left(line) } else { Ok(()) }
    }

    pub(super) fn on_endif(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        match self.groups.pop() {
            None => Code::UnbalancedCondition.refuse(at, "this `#endif` has no `#if`"),
            Some(group) if group.outer => nothing_left(line),
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

    /// The group whose next branch begins.
    fn branch(&mut self, at: Place, name: &str) -> Result<&mut Group, Box<Diagnostic>> {
        match self.groups.last_mut() {
            None => Code::UnbalancedCondition.refuse(at, format!("this `{name}` has no `#if`")),
            Some(group) if group.last => Err(Box::new(
                Code::UnbalancedCondition
                    .at(at, format!("this `{name}` follows an `#else`"))
                    .related(group.at.span, "of this"),
            )),
            Some(group) => Ok(group),
        }
    }

    fn evaluate(&mut self, line: &[PpToken], at: Place) -> Result<bool, Box<Diagnostic>> {
        // `defined` is answered before macros are expanded (§3.4).
        let answered = self.answer_defined(line)?;
        let errors = self.diagnostics.len();
        let tokens = self.expand_list(answered);
        if self.diagnostics.len() > errors {
            return Ok(false);
        }
        let (value, rest) = self.constant(&tokens, at)?;
        match rest {
            [] => Ok(value != 0),
            [first, ..] => Code::BadCondition.refuse(first.at, "an operator is missing here"),
        }
    }

    fn answer_defined(&mut self, line: &[PpToken]) -> Result<Vec<PpToken>, Box<Diagnostic>> {
        let mut answered = Vec::with_capacity(line.len());
        let mut rest = line;
        while let [token, tail @ ..] = rest {
            rest = tail;
            let TokenKind::Word(word) = token.kind else {
                answered.push(*token);
                continue;
            };
            if self.words.text(word) != "defined" {
                answered.push(*token);
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
                [] => return Code::BadCondition.refuse(token.at, "`defined` needs the name of a macro"),
            };
            let TokenKind::Word(name) = name.kind else {
                return Code::BadCondition.refuse(token.at, "`defined` needs the name of a macro");
            };
            rest = after;
            let value = self
                .words
                .symbol(if self.macros.contains_key(&name) { "1" } else { "0" });
            answered.push(PpToken {
                kind: TokenKind::Number(value),
                ..*token
            });
        }
        Ok(answered)
    }
}
