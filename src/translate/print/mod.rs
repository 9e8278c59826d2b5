//! Prints a lowered tree as GLSL 450, in the subset that naga's front end reads rightly.
//!
//! What naga reads wrongly at the level of text never leaves here: prototypes, `const in`, precision qualifiers, arrays
//! without a size or sized by a local constant, and several declarators with sizes of their own (`float a[2], b;`).

mod expression;
mod names;
mod order;
mod printer;
mod statement;
mod surroundings;
mod text;
mod word;

pub(super) use names::Numbering;
pub(super) use order::Order;
pub use text::Lowered;
use toyproof_diagnostic::{Deadline, Overdue};

use crate::lower::Draft;

/// Prints what the picture of a draft needs.
pub(super) fn print(draft: &Draft, deadline: &Deadline) -> Result<Lowered, Overdue> {
    let order = order::Order::of(draft);
    let names = names::Names::of(draft, &order);
    let mut printer = printer::Printer::new(draft, &names);
    printer.prelude(&order);
    for &item in &order.items {
        deadline.check()?;
        printer.item(item);
    }
    printer.epilogue();
    printer.out.refuse(draft.too_deep.clone());
    Ok(printer.out)
}
