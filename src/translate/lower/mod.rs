//! From a checked tree to one that naga's GLSL front end reads rightly: a pass for each construct that it refuses or gets
//! wrong, each in a file named for the construct, whose header says what naga does.
//!
//! Most passes rewrite single expressions where they stand; what needs several steps becomes a sequence `a, b`, which naga
//! evaluates in order. The passes after them rewrite statements; `sequence` then makes statements of sequences.

mod boolean;
mod build;
mod compound;
mod constant;
mod dead_code;
mod depth;
mod do_while;
mod draft;
mod elementary;
mod else_if;
mod equality;
mod for_step;
mod geometric;
mod global;
mod helper;
mod index;
mod inequality;
mod is_nan;
mod loop_head;
mod loop_void;
mod lvalue;
mod matrix;
mod member;
mod missing;
mod missing_return;
mod negation;
mod nesting;
mod out_argument;
mod pass;
mod remainder;
mod sampler;
mod sequence;
mod short_circuit;
mod spelled;
mod surroundings;
mod switch;
mod swizzle;
mod texel;
mod uninitialised;
mod zero;

pub(crate) use draft::Draft;
pub use pass::{Pass, Passes};
use toyproof_diagnostic::{Deadline, Overdue};
use toyproof_glsl::Checked;

use crate::print::{Lowered, print};

/// Lowers a shader and prints what naga is fed.
#[must_use]
pub fn lower(checked: &Checked) -> Lowered {
    lower_with(checked, Passes::all())
}

/// The same for a shader whose every operation is to have the same bits on every driver: what drivers differ in is spelled
/// in operations that they agree on ([`toyproof_math`]).
#[must_use]
pub fn lower_strict(checked: &Checked) -> Lowered {
    lower_with(checked, Passes::strict())
}

/// The same by some passes only, to see what naga makes of the rest.
#[must_use]
pub fn lower_with(checked: &Checked, passes: Passes) -> Lowered {
    // Without a deadline there is no failure.
    lower_within(checked, passes, &Deadline::default()).unwrap_or_default()
}

/// The same within a deadline.
///
/// # Errors
/// If it passes.
pub fn lower_within(checked: &Checked, passes: Passes, deadline: &Deadline) -> Result<Lowered, Overdue> {
    let mut draft = Draft::new(checked.tree.clone(), checked.main_image);
    passes.run(&mut draft, deadline)?;
    print(&draft, deadline)
}

#[cfg(test)]
mod tests;
