//! Rewrites a checked tree into one that naga's GLSL front end translates correctly.
//!
//! There is one pass for each construct that naga refuses or translates wrongly; its comment states what naga
//! does. Most passes rewrite expressions in place; where several steps are needed they become a sequence `a,
//! b`, which naga evaluates in order. Later passes rewrite statements; finally `sequence` turns sequences
//! into statements.

mod array_value;
mod branch;
mod builtin;
mod call_order;
mod conditional;
mod constant;
pub(crate) mod context;
mod effect;
#[cfg(test)]
mod expression_tests;
mod flatten;
mod float32;
mod folding;
mod generated;
mod global_parameter;
mod helper_tree;
mod initializer;
mod lookup;
mod lookup_text;
mod loops;
mod lvalue;
mod macro_function;
mod member;
mod nesting;
mod operator;
mod polyfill;
mod sequence;
mod stage_io;
mod switch_chain;
#[cfg(test)]
mod tests;
mod uniform_block;

pub(crate) use array_value::name_array_values;
pub(crate) use branch::{unwrap_case_jumps, unwrap_jump};
pub(crate) use conditional::branch_for_effects;
pub(crate) use effect::{impure_functions, is_pure};
pub(crate) use folding::{fold_by_precision, fold_except};
pub(crate) use global_parameter::{GlobalConflict, UPWARD, orient_derivatives, pass_globals};
pub(crate) use helper_tree::helper_tree;
pub(crate) use initializer::is_written_first;
pub(crate) use macro_function::call_macros;
pub(crate) use switch_chain::{chain_switches, jumps_inside as has_inner_jump};
use toyproof_diagnostic::{Deadline, Diagnostic, Overdue};
use toyproof_glsl::{Checked, overdue};

use self::context::LoweringContext;
use crate::print::{Lowered, print};

/// Lowers a shader and prints it as GLSL for naga.
pub fn lower(checked: &Checked) -> Lowered {
    lower_with(checked, Passes::required())
}

/// Lowers a shader whose operations must have the same bits on every driver: operations that drivers compute
/// differently are expanded into ones that they compute in the same way ([`toyproof_math`]).
pub fn lower_strict(checked: &Checked) -> Lowered {
    lower_with(checked, Passes::strict())
}

/// Lowers a shader by a subset of the passes, to see how naga translates it without the others.
pub fn lower_with(checked: &Checked, passes: Passes) -> Lowered {
    // This cannot fail without a deadline.
    lower_within(checked, passes, &Deadline::default()).unwrap_or_default()
}

/// Lowers a shader by a subset of the passes, within a deadline.
///
/// # Errors
/// If the deadline passes.
pub fn lower_within(checked: &Checked, passes: Passes, deadline: &Deadline) -> Result<Lowered, Overdue> {
    let mut cx = LoweringContext::new(checked);
    passes.run(&mut cx, deadline)?;
    print(&cx, deadline)
}

/// Lowers a shader for a host of the author's: its uniforms are members of a block, whose names are returned,
/// and the alpha of a host that runs `main` is the shader's.
///
/// # Errors
/// If the deadline passes, or the shader reads what no such module has.
pub(crate) fn lower_module(
    checked: &Checked,
    passes: Passes,
    deadline: &Deadline,
) -> Result<(Lowered, Vec<String>), Vec<Diagnostic>> {
    let too_slow = |late| vec![overdue(late)];
    let mut cx = LoweringContext::new(checked);
    cx.is_opaque &= checked.dialect.calls_main_image();
    uniform_block::run(&mut cx, checked)?;
    passes.run(&mut cx, deadline).map_err(too_slow)?;
    let lowered = print(&cx, deadline).map_err(too_slow)?;
    let members = cx
        .uniform_block
        .iter()
        .map(|&member| cx.tree[member].name.clone());
    Ok((lowered, members.collect()))
}

macro_rules! passes {
    ($($(#[$doc:meta])* $variant:ident = $run:path,)*) => {
        /// A construct that naga's GLSL front end translates wrongly; in the order in which they are lowered.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Pass {
            $($(#[$doc])* $variant,)*
        }

        impl Pass {
            /// Every pass, in order.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            fn run(self, cx: &mut LoweringContext) {
                match self {
                    $(Self::$variant => $run(cx),)*
                }
            }
        }
    };
}

passes! {
    /// Sampler parameters.
    Samplers = stage_io::specialize_samplers,
    /// Built-in variables and uniforms that naga lacks or that are not set.
    StageIo = stage_io::lower_stage_io,
    /// `&&` and `||` with an effect on the right.
    ShortCircuit = operator::lower_short_circuit,
    /// Built-in functions of constants whose last bits naga computes differently.
    Folding = folding::run,
    /// Filtered texture lookups, which drivers compute with few bits; for strict shaders only.
    Lookups = lookup::expand_lookups,
    /// Built-in functions whose last bits depend on the driver; for strict shaders only.
    InexactFunctions = polyfill::expand_inexact_functions,
    /// `modf`, `matrixCompMult`, `outerProduct`, `inverse`.
    MissingBuiltIns = builtin::lower_missing,
    /// `dot` and other geometric functions of scalars.
    Geometric = builtin::lower_geometric,
    /// `isnan` and `isinf`.
    IsNan = builtin::lower_is_nan,
    /// Offsets of texture lookups.
    Texels = stage_io::lower_texel_offsets,
    /// Matrix constructors.
    Matrices = operator::lower_matrix_constructors,
    /// Conversions of `bool` to vectors and numbers.
    Booleans = operator::lower_boolean_conversions,
    /// Swizzles of swizzles and of matrix columns as targets.
    Swizzles = lvalue::lower_swizzles,
    /// Indices with side effects, evaluated once.
    Indices = lvalue::lower_indices,
    /// Compound assignments whose right side changes their target.
    Compounds = lvalue::lower_compound_assignments,
    /// Matrix products, whose sums are ordered by the driver; for strict shaders only.
    Products = polyfill::expand_matrix_products,
    /// `-x` of unsigned integers.
    Negations = operator::lower_negation,
    /// `%`.
    Remainders = operator::lower_remainder,
    /// `out` and `inout` arguments that are parts of variables.
    OutArguments = lvalue::lower_out_arguments,
    /// `==` of structures and arrays.
    Equality = operator::lower_equality,
    /// `!=` of floats.
    Inequality = operator::lower_inequality,
    /// Members of structures whose layout naga changes.
    Members = member::run,
    /// Infinities and other constants that naga cannot evaluate.
    Constants = constant::run,
    /// Chains of thousands of operators.
    Depth = operator::split_operator_chains,
    /// Global initializers and constant arrays.
    Globals = initializer::lower_globals,
    /// Variables without an initializer.
    Uninitialized = initializer::zero_uninitialized,
    /// Steps of `for` that Mesa executes once too often.
    Steps = loops::move_steps,
    /// Declarations in loop heads.
    LoopHeads = loops::hoist_loop_heads,
    /// `continue` in `do … while`.
    DoWhile = loops::lower_do_while,
    /// Calls of `void` functions in loop heads.
    LoopVoids = loops::lower_void_calls,
    /// Chains of hundreds of `else if`.
    ElseIfs = branch::split_else_if,
    /// Unreachable statements.
    DeadCode = branch::remove_dead_code,
    /// Fall-through in `switch`.
    Switches = branch::lower_switches,
    /// Statements nested deeper than lavapipe supports.
    Nesting = nesting::run,
    /// Sequences as statements.
    Sequences = sequence::run,
    /// Functions that may end without a `return`.
    MissingReturns = initializer::add_missing_returns,
}

/// A set of passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Passes(u64);

impl Passes {
    /// The passes that naga and the drivers need.
    pub fn required() -> Self {
        Self::strict()
            .without(Pass::Lookups)
            .without(Pass::InexactFunctions)
            .without(Pass::Products)
    }

    /// All passes, including those that make a shader's bits the same on every driver.
    pub fn strict() -> Self {
        Self(u64::MAX)
    }

    /// No pass.
    pub(crate) fn none() -> Self {
        Self(0)
    }

    /// This set with one pass.
    pub(crate) fn with(self, pass: Pass) -> Self {
        Self(self.0 | 1 << pass as u32)
    }

    /// This set without one pass.
    #[must_use]
    pub fn without(self, pass: Pass) -> Self {
        Self(self.0 & !(1 << pass as u32))
    }

    /// Whether the set contains a pass.
    pub fn contains(self, pass: Pass) -> bool {
        self.0 & (1 << pass as u32) != 0
    }

    pub(crate) fn run(self, cx: &mut LoweringContext, deadline: &Deadline) -> Result<(), Overdue> {
        for pass in Pass::ALL.iter().filter(|pass| self.contains(**pass)) {
            deadline.check()?;
            pass.run(cx);
        }
        Ok(())
    }
}
