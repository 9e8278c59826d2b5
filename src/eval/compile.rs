//! The pipeline from the typed tree to lowered code.

use toyproof_diagnostic::Deadline;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::VariableId;

use crate::build::{BuildOptions, InstrumentedFunction, Refusal, build_function, with_stack};
use crate::exec::ops::fold;
use crate::ir::{AliasGroups, Cell};
use crate::lower::LoweredCode;
use crate::lower::linearize::linearize;
use crate::lower::regalloc::allocate_registers;
use crate::opt::dce::eliminate_dead_code;
use crate::opt::denormals::flush_operands;
use crate::opt::divergence::Divergence;
use crate::opt::fuse::fuse;
use crate::opt::gvn::number_values;
use crate::opt::pair::pair;

/// Compiles a shader. Uniforms that are among the `parameters` get their values for each point; all others
/// are zero.
///
/// # Errors
/// If it is too large once its calls are inlined, or takes longer than the deadline.
pub(crate) fn compile(
    checked: &Checked,
    parameters: &[VariableId],
    options: BuildOptions,
    deadline: &Deadline,
) -> Result<LoweredCode, Refusal> {
    with_stack(|| {
        let InstrumentedFunction {
            mut function,
            sites,
            schema,
            profile,
        } = build_function(checked, parameters, options, deadline)?;
        deadline.check()?;
        flush_operands(&mut function);
        number_values(&mut function, fold, options.trace.is_traced());
        deadline.check()?;
        eliminate_dead_code(&mut function);
        let groups = AliasGroups::new(&function);
        deadline.check()?;
        let divergence = Divergence::new(&function, &groups);
        fuse(&mut function, &divergence);
        pair(&mut function);
        deadline.check()?;
        let linear = linearize(&function, &divergence, options.trace.is_traced());
        deadline.check()?;
        let locations = allocate_registers(&function, &linear, &divergence, &groups);
        let cells = (0..function.cells.len() as u32).map(Cell);
        let shared = cells.map(|cell| divergence.is_shared(cell)).collect();
        function.body.clear();
        Ok(LoweredCode {
            function,
            linear,
            locations,
            shared,
            shapes: checked.channels,
            sites,
            schema,
            profile,
        })
    })?
}
