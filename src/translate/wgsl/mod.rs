//! Prints a shader as WGSL that its author would know again: names, comments, loops and expressions as they were written.
//!
//! naga's own writer goes by way of its intermediate form, in which every expression has a number and every variable stands at
//! the head of its function. What is printed here is the tree, after the few passes of lowering that WGSL needs as naga does. What cannot
//! be said so ([`Unprintable`]) is left to naga's writer. Sections are those of the WGSL specification.

mod assign;
mod builtin;
mod call;
mod comment;
mod conditional;
mod construct;
mod expression;
mod facts;
mod host;
mod item;
mod later;
mod literal;
mod loops;
mod names;
mod statement;
mod style;
mod text;
mod texture;
mod word;
mod wrap;
mod writer;

pub use host::Hosted;
pub use style::Style;
use thiserror::Error;
use toyproof_diagnostic::{Deadline, Files, Overdue};
use toyproof_glsl::Checked;

use crate::lower::{Draft, Pass, Passes};
use crate::print::Order;

/// What this writer has no words for.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct Unprintable(pub &'static str);

/// Why there is no text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Failure {
    /// This writer has no words for it.
    #[error(transparent)]
    Unprintable(#[from] Unprintable),
    /// The deadline passed.
    #[error(transparent)]
    Overdue(#[from] Overdue),
}

/// A checked shader as WGSL for a kind of host; the author's comments are read from `files`.
///
/// # Errors
/// What cannot be said, or that the deadline passed.
pub fn wgsl(checked: &Checked, files: &Files, style: Style, deadline: &Deadline) -> Result<String, Failure> {
    let mut draft = Draft::new(checked.tree.clone(), checked.main_image);
    passes().run(&mut draft, deadline)?;
    let order = Order::with_labels(&draft);
    deadline.check()?;
    let names = names::Names::of(&draft, &order, style);
    deadline.check()?;
    let facts = facts::Facts::of(&draft);
    let writer = writer::Writer::new(&draft, &names, &facts, style, files, deadline);
    let written = writer.write(&order);
    // A writer that runs out of time gives up wherever it is.
    deadline.check()?;
    Ok(written?)
}

/// What WGSL, as GLSL in naga's reading, does not have. Loops, `?:` and assignments are printed here instead, locals begin
/// with zero in any case, and functions return where they must.
fn passes() -> Passes {
    [
        Pass::ShortCircuit,
        Pass::Matrices,
        Pass::Compounds,
        Pass::Inequality,
        Pass::Members,
        Pass::Uninitialised,
        Pass::Steps,
        Pass::DoWhile,
        Pass::Nesting,
        Pass::MissingReturns,
    ]
    .into_iter()
    .fold(Passes::all(), Passes::without)
}

#[cfg(test)]
mod tests;
