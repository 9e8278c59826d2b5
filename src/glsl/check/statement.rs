//! Jumps and `switch` labels (§6.2, §6.4).

use std::collections::HashSet;

use toyproof_diagnostic::{Code, grouped};

use super::Checker;
use crate::tree::{ExprId, Label, Place, Type};

/// Maximum number of labels of a `switch`: lavapipe loses the device at 50,000.
const MAX_LABELS: usize = 20_000;

/// The labels of a `switch` parsed so far.
#[derive(Debug)]
pub(crate) struct Labels {
    selector: Type,
    values: HashSet<u32>,
    has_default: bool,
}

impl Checker<'_> {
    /// Checks the selector of a `switch`: an `int` or `uint`.
    pub(crate) fn selector(&mut self, selector: ExprId) -> Labels {
        let (ty, at) = (self.ty(selector), self.tree[selector].at);
        if !matches!(ty, Type::INT | Type::UINT | Type::Error) {
            let message = format!(
                "the value of a `switch` must be `int` or `uint`, not {}",
                self.quoted_type(ty)
            );
            self.error(Code::BadSwitch, at, message);
        }
        Labels {
            selector: ty,
            values: HashSet::new(),
            has_default: false,
        }
    }

    /// Checks `case expr:`.
    pub(crate) fn case(&mut self, labels: &mut Labels, expr: ExprId) -> Label {
        let at = self.tree[expr].at;
        let expr = self.expect(expr, labels.selector, "the label");
        let value = self.integer(expr).filter(|_| self.tree[expr].constant);
        // All labels of one `switch` have one type, so bit patterns identify values.
        let bits = value.unwrap_or_default() as u32;
        if self.ty(expr) != Type::Error {
            if value.is_none() {
                self.error(
                    Code::NotConstant,
                    at,
                    "a `case` label must be an integer constant expression",
                );
            } else if !labels.values.insert(bits) {
                self.error(Code::BadSwitch, at, "duplicate `case` label");
            } else if labels.values.len() == MAX_LABELS + 1 {
                let message = format!(
                    "this `switch` has more than {} labels, the limit of drivers",
                    grouped(MAX_LABELS as u64)
                );
                self.error(Code::BadSwitch, at, message);
            }
        }
        Label::Case { expr, value: bits }
    }

    /// Checks `default:`.
    pub(crate) fn default(&mut self, labels: &mut Labels, at: Place) -> Label {
        if std::mem::replace(&mut labels.has_default, true) {
            self.error(Code::BadSwitch, at, "duplicate `default` label");
        }
        Label::Default
    }

    pub(crate) fn misplaced_label(&mut self, at: Place, message: &str) {
        self.error(Code::BadSwitch, at, message);
    }

    /// Enters a loop, in which `break` and `continue` are allowed.
    pub(crate) fn enter_loop(&mut self) {
        if let Some(context) = &mut self.function {
            context.loops += 1;
            context.breakable += 1;
        }
    }

    pub(crate) fn leave_loop(&mut self) {
        if let Some(context) = &mut self.function {
            context.loops -= 1;
            context.breakable -= 1;
        }
    }

    /// Enters a `switch`, in which `break` is allowed.
    pub(crate) fn enter_switch(&mut self) {
        if let Some(context) = &mut self.function {
            context.breakable += 1;
        }
    }

    pub(crate) fn leave_switch(&mut self) {
        if let Some(context) = &mut self.function {
            context.breakable -= 1;
        }
    }

    pub(crate) fn break_statement(&mut self, at: Place) {
        if self
            .function
            .as_ref()
            .is_none_or(|context| context.breakable == 0)
        {
            self.error(Code::MisplacedJump, at, "`break` outside a loop or `switch`");
        }
    }

    pub(crate) fn continue_statement(&mut self, at: Place) {
        if self.function.as_ref().is_none_or(|context| context.loops == 0) {
            self.error(Code::MisplacedJump, at, "`continue` outside a loop");
        }
    }

    /// Records that unparsable text may contain a `return`.
    pub(crate) fn assume_returns(&mut self) {
        if let Some(context) = &mut self.function {
            context.returns = true;
        }
    }

    pub(crate) fn return_statement(&mut self, value: Option<ExprId>, at: Place) -> Option<ExprId> {
        let Some(context) = &mut self.function else {
            return value;
        };
        context.returns = true;
        let wanted = context.return_type;
        let name = self.tree[context.function].name.clone();
        match value {
            None if !matches!(wanted, Type::Void | Type::Error) => {
                let message = format!(
                    "missing return value: `{name}` returns {}",
                    self.quoted_type(wanted)
                );
                self.error(Code::BadReturn, at, message);
                None
            }
            None => None,
            Some(_) if wanted == Type::Void => {
                let given = value.map_or(Type::Error, |value| self.ty(value));
                let message = format!("`{name}` is `void` and cannot return a value");
                let mut diagnostic = Code::BadReturn.at(at, message);
                if given != Type::Error {
                    let help = format!(
                        "write `return;`, or make the return type {}",
                        self.quoted_type(given)
                    );
                    diagnostic = diagnostic.help(help);
                }
                self.report(diagnostic);
                None
            }
            Some(value) => {
                if let Some(fits) = self.convert(value, wanted) {
                    return Some(fits);
                }
                let given = self.ty(value);
                let message = format!(
                    "the return value of `{name}` must be {}, not {}",
                    self.quoted_type(wanted),
                    self.quoted_type(given)
                );
                let diagnostic = Code::BadReturn.at(self.tree[value].at, message);
                let diagnostic = self.with_fixit(diagnostic, value, wanted);
                self.report(diagnostic);
                if let Some(context) = &mut self.function {
                    context.contradicted = true;
                }
                None
            }
        }
    }
}
