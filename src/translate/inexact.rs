//! The functions whose last bits are implementation-defined, found by the built-in function or by the SPIR-V
//! instruction. Both expansions use this list: that of the tree (`lower::polyfill`) and that of SPIR-V
//! (`backend::spirv`).

use std::sync::LazyLock;

use ::spirv::{GlslStd450Op as Ext, Op};
use toyproof_glsl::tree::{BuiltIn, Definition, Instruction};

/// A function whose last bits are implementation-defined.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InexactFunction {
    pub(crate) built_in: BuiltIn,
    pub(crate) definition: Definition,
}

/// The instructions that compute such functions.
#[derive(Default)]
struct Instructions {
    extended: Vec<(Ext, InexactFunction)>,
    core: Vec<(Op, InexactFunction)>,
}

/// The largest number of an instruction among which that of a name is searched for; those of all inexact
/// functions are smaller.
const LAST_INSTRUCTION: u32 = 255;

static INSTRUCTIONS: LazyLock<Instructions> = LazyLock::new(|| {
    let mut all = Instructions::default();
    for &built_in in BuiltIn::ALL {
        for exact in built_in.exact_definitions() {
            let definition = exact.definition;
            let function = InexactFunction { built_in, definition };
            let numbers = 0..=LAST_INSTRUCTION;
            match exact.instruction {
                Instruction::Extended(name) => {
                    let mut known = numbers.filter_map(Ext::from_u32);
                    let instruction = known.find(|instruction| format!("{instruction:?}") == name);
                    all.extended.extend(instruction.zip(Some(function)));
                }
                Instruction::Core(name) => {
                    let mut known = numbers.filter_map(Op::from_u32);
                    let instruction = known.find(|instruction| format!("{instruction:?}") == name);
                    all.core.extend(instruction.zip(Some(function)));
                }
            }
        }
    }
    all
});

impl InexactFunction {
    /// The function of that name with that number of arguments, if its last bits are implementation-defined.
    pub(crate) fn from_built_in(built_in: BuiltIn, arguments: usize) -> Option<Self> {
        let mut definitions = built_in.exact_definitions().iter().map(|exact| exact.definition);
        let fits =
            |definition: &Definition| definition.argument_count().is_none_or(|count| count == arguments);
        let definition = definitions.find(fits)?;
        Some(Self { built_in, definition })
    }

    /// The function that an instruction of `GLSL.std.450` computes.
    pub(crate) fn from_extended(instruction: Ext) -> Option<Self> {
        let mut extended = INSTRUCTIONS.extended.iter();
        extended
            .find(|(known, _)| *known == instruction)
            .map(|(_, function)| *function)
    }

    /// The function that a core instruction of SPIR-V computes.
    pub(crate) fn from_core(instruction: Op) -> Option<Self> {
        let mut core = INSTRUCTIONS.core.iter();
        core.find(|(known, _)| *known == instruction)
            .map(|(_, function)| *function)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_instruction_exists() {
        let definitions = BuiltIn::ALL
            .iter()
            .map(|function| function.exact_definitions().len());
        assert_eq!(
            INSTRUCTIONS.extended.len() + INSTRUCTIONS.core.len(),
            definitions.sum()
        );
    }
}
