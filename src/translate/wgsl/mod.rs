//! Prints a shader as WGSL that its author recognizes: with the original names, comments, loops and
//! expressions.
//!
//! naga's writer prints its intermediate representation, in which every expression has a number and every
//! variable is declared at the head of its function. This writer prints the syntax tree, after the few
//! lowering passes that WGSL also requires. Shaders that it does not support ([`Unprintable`]) are left to
//! naga's writer. Section numbers are those of the WGSL specification.

mod builtin;
mod construct;
mod effect;
mod expression;
mod item;
mod literal;
mod loops;
mod names;
mod statement;
mod style;
mod writer;

pub use style::{HostedShader, Style};
use toyproof_diagnostic::{Deadline, Files};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::BuiltIn;

use crate::lower::context::LoweringContext;
use crate::lower::{Pass, Passes, call_macros, fold_except};
use crate::print::{CaseLabels, Order};
pub use crate::unprintable::{Unprintable, WriteFailure};

/// Prints a checked shader as WGSL for a kind of host; the author's comments are read from `files`.
///
/// # Errors
/// If a construct is not supported or the deadline passes.
pub fn wgsl(
    checked: &Checked,
    files: &Files,
    style: Style,
    deadline: &Deadline,
) -> Result<String, WriteFailure> {
    let mut cx = LoweringContext::new(checked);
    call_macros(&mut cx, checked, files, deadline)?;
    fold_except(&mut cx, is_computed_alike);
    passes().run(&mut cx, deadline)?;
    let order = Order::new(&cx, CaseLabels::AsWritten);
    deadline.check()?;
    let names = names::Names::new(&cx, &order, style);
    deadline.check()?;
    let facts = writer::Facts::new(&cx);
    let writer = writer::Writer::new(&cx, &names, &facts, &order, style, files, deadline);
    let written = writer.write(&order);
    // An expired deadline also makes the writer fail.
    deadline.check()?;
    Ok(written?)
}

/// Whether compilers evaluate a function of constants in the same way, or leave it to the driver:
/// `normalize(vec3f(1.0, 2.0, 3.0))` stays readable. naga, which proofs read WGSL with, computes the last
/// bits of all others in its own way.
fn is_computed_alike(function: BuiltIn) -> bool {
    use BuiltIn as B;
    matches!(
        function,
        B::InverseSqrt
            | B::Fract
            | B::Mod
            | B::Mix
            | B::Step
            | B::Smoothstep
            | B::Length
            | B::Distance
            | B::Dot
            | B::Cross
            | B::Normalize
            | B::Faceforward
            | B::Reflect
            | B::Refract
            | B::Determinant
    )
}

/// The lowering passes for constructs that WGSL lacks too. This writer handles loops, `?:`, assignments and
/// missing returns itself; WGSL zero-initializes locals anyway.
fn passes() -> Passes {
    [
        Pass::Folding,
        Pass::ShortCircuit,
        Pass::Matrices,
        Pass::Compounds,
        Pass::Inequality,
        Pass::Members,
        Pass::Uninitialized,
        Pass::Steps,
        Pass::DoWhile,
        Pass::Nesting,
        Pass::MissingReturns,
    ]
    .into_iter()
    .fold(Passes::required(), Passes::without)
}

#[cfg(test)]
mod tests;
