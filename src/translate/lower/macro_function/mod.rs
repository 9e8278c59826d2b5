//! Function-like macros as functions, for conversions that people read.
//!
//! The tree has the macros expanded. A use becomes a call only if what it expands to is a whole expression,
//! which a function of the arguments computes with the same bits wherever it is called:
//!
//! - The expansion has all tokens of the macro's replacement, and each argument is a whole expression in it.
//!   `#define SQ(x) x*x` of `a + b` is `a + b*a + b`, in which there is no product of two equal sides.
//! - Nothing that it evaluates has side effects, so that arguments may be evaluated once and first. Arguments
//!   that it evaluates under a condition must also be cheap and defined without it.
//! - Apart from the arguments it names only what is global, and it is neither written nor required to be
//!   constant. Only the values of numbers and structures are passed.
//!
//! Uses with arguments of other types get functions of their own. A use that expands to other operations than
//! the first one of its types, because another macro was redefined in between, stays expanded.

mod expansion;
mod finder;
#[cfg(test)]
mod tests;
mod uses;

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::{Deadline, Files, Overdue};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::Item;

use self::expansion::Expansion;
use self::finder::find;
use self::uses::Source;
use super::effect::{impure_functions, is_pure};
use crate::lower::context::LoweringContext;

/// Replaces expanded uses of function-like macros by calls of functions.
///
/// # Errors
/// If the deadline passes.
pub(crate) fn call_macros(
    cx: &mut LoweringContext,
    checked: &Checked,
    files: &Files,
    deadline: &Deadline,
) -> Result<(), Overdue> {
    let source = Source::new(files, checked.tree[checked.main_image].at.span.file);
    let uses = source.uses(&checked.expansions);
    if uses.is_empty() {
        return Ok(());
    }
    let (mut found, parents) = find(&cx.tree, &source, &uses);
    // In the order of the text, uses in arguments first: their calls are then parts of the arguments.
    found.sort_by_key(|&(_, at)| uses[at].span.end);
    let impure = impure_functions(&cx.tree);
    let globals: HashSet<Item> = cx.tree.items.iter().copied().collect();
    let mut functions = HashMap::new();
    for (root, at) in found {
        deadline.check()?;
        if is_pure(&cx.tree, &impure, root)
            && let Some(expansion) = Expansion::new(&cx.tree, &source, &uses[at], root)
            && expansion.is_global(&cx.tree, &globals)
        {
            expansion.call(cx, &parents, &mut functions);
        }
    }
    Ok(())
}
