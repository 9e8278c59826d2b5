//! Lowering of structured code to instructions: jumps and masks, registers, and the function that executes
//! each instruction.

pub(crate) mod isel;
pub(crate) mod linearize;
pub(crate) mod regalloc;
