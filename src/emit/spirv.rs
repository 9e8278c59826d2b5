//! SPIR-V, and the decorations that hold a driver to the arithmetic as written.

use std::collections::HashSet;

use naga::ShaderStage;
use naga::back::spv::{BindingInfo, Options, PipelineOptions, WriterFlags, write_vec};

use super::{BOUNDS, ENTRY_POINT, bindings};
use crate::module::ValidModule;

/// naga's words: names kept, no flipping of coordinates, indices clamped, loops as they are.
///
/// # Errors
/// naga's words, where it cannot write the module.
pub fn words(module: &ValidModule) -> Result<Vec<u32>, String> {
    let options = Options {
        flags: WriterFlags::DEBUG | WriterFlags::LABEL_VARYINGS,
        binding_map: bindings(module)
            .map(|(binding, _)| {
                let same = BindingInfo {
                    descriptor_set: binding.group,
                    binding: binding.binding,
                    binding_array_size: None,
                };
                (binding, same)
            })
            .collect(),
        fake_missing_bindings: false,
        bounds_check_policies: BOUNDS,
        force_loop_bounding: false,
        ..Options::default()
    };
    let pipeline = PipelineOptions {
        shader_stage: ShaderStage::Fragment,
        entry_point: ENTRY_POINT.to_owned(),
    };
    write_vec(module.module(), module.info(), &options, Some(&pipeline)).map_err(|error| error.to_string())
}

/// Words as the bytes of a `.spv` file, little-endian.
#[must_use]
pub fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Opcodes and operands of the SPIR-V specification, section 3.
mod op {
    pub(super) const EXT_INST: u32 = 12;
    pub(super) const TYPE_FLOAT: u32 = 22;
    pub(super) const TYPE_VECTOR: u32 = 23;
    pub(super) const TYPE_MATRIX: u32 = 24;
    /// `OpTypeVoid` to `OpConstantNull`.
    pub(super) const TYPES_AND_CONSTANTS: std::ops::RangeInclusive<u32> = 19..=46;
    pub(super) const DECORATE: u32 = 71;
    pub(super) const F_NEGATE: u32 = 127;
    pub(super) const F_ADD: u32 = 129;
    pub(super) const F_SUB: u32 = 131;
    pub(super) const F_MUL: u32 = 133;
    pub(super) const F_DIV: u32 = 136;
    pub(super) const F_REM: u32 = 140;
    pub(super) const F_MOD: u32 = 141;
    /// `OpVectorTimesScalar` to `OpDot`: products of vectors and matrices.
    pub(super) const PRODUCTS: std::ops::RangeInclusive<u32> = 142..=148;
    pub(super) const NO_CONTRACTION: u32 = 42;
}

const HEADER_WORDS: usize = 5;

/// The same module with `NoContraction` on every float arithmetic result and on every extended instruction
/// with a float result, so that the driver neither fuses nor rearranges them. Only decorations are added.
#[must_use]
pub fn strict(words: &[u32]) -> Vec<u32> {
    let mut floats = HashSet::new();
    let mut arithmetic = Vec::new();
    let mut first_type = words.len();
    for (at, instruction) in instructions(words) {
        let opcode = instruction[0] & 0xffff;
        // Decorations stand before the first type or constant.
        if op::TYPES_AND_CONSTANTS.contains(&opcode) {
            first_type = first_type.min(at);
        }
        match opcode {
            op::TYPE_FLOAT => {
                floats.insert(instruction[1]);
            }
            op::TYPE_VECTOR | op::TYPE_MATRIX if floats.contains(&instruction[2]) => {
                floats.insert(instruction[1]);
            }
            op::F_NEGATE | op::F_ADD | op::F_SUB | op::F_MUL | op::F_DIV | op::F_REM | op::F_MOD => {
                arithmetic.push(instruction[2]);
            }
            op::EXT_INST if floats.contains(&instruction[1]) => arithmetic.push(instruction[2]),
            opcode if op::PRODUCTS.contains(&opcode) => arithmetic.push(instruction[2]),
            _ => {}
        }
    }
    let decorations = arithmetic
        .into_iter()
        .flat_map(|result| [3 << 16 | op::DECORATE, result, op::NO_CONTRACTION]);
    let (head, tail) = words.split_at(first_type);
    head.iter()
        .copied()
        .chain(decorations)
        .chain(tail.iter().copied())
        .collect()
}

/// Each instruction with the index of its first word.
fn instructions(words: &[u32]) -> impl Iterator<Item = (usize, &[u32])> {
    let mut at = HEADER_WORDS;
    std::iter::from_fn(move || {
        let start = at;
        let count = (*words.get(start)? >> 16) as usize;
        at += count.max(1);
        Some((start, words.get(start..at)?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glsl::{Options as Language, check, lower};
    use crate::source::{File, Files};

    const SHADER: &str = "void mainImage(out vec4 c, in vec2 p) {
        int i = int(p.x) * 3;
        mat2 m = mat2(p, p);
        c = vec4(m * p, dot(p, p) - 0.5, sin(p.x) / float(i));
    }";

    fn plain() -> Vec<u32> {
        let mut files = Files::default();
        let file = files.add(File::new("s", SHADER));
        let checked = check(&files, file, &Language::default()).unwrap();
        words(&ValidModule::parse(&lower(&checked)).unwrap()).unwrap()
    }

    fn is_no_contraction(instruction: &[u32]) -> bool {
        instruction.len() == 3
            && instruction[0] & 0xffff == op::DECORATE
            && instruction[2] == op::NO_CONTRACTION
    }

    #[test]
    fn only_decorations_are_added() {
        let plain = plain();
        let strict = strict(&plain);
        let kept: Vec<u32> = instructions(&strict)
            .filter(|(_, instruction)| !is_no_contraction(instruction))
            .flat_map(|(_, instruction)| instruction.to_vec())
            .collect();
        assert_eq!(kept, plain[HEADER_WORDS..]);
        assert_eq!(strict[..HEADER_WORDS], plain[..HEADER_WORDS]);
    }

    #[test]
    fn every_float_operation_is_decorated_and_no_integer_one() {
        const I_MUL: u32 = 132;
        let strict = strict(&plain());
        let decorated: HashSet<u32> = instructions(&strict)
            .filter(|(_, instruction)| is_no_contraction(instruction))
            .map(|(_, instruction)| instruction[1])
            .collect();
        let results = |opcode: u32| -> Vec<u32> {
            instructions(&strict)
                .filter(|(_, instruction)| instruction[0] & 0xffff == opcode)
                .map(|(_, instruction)| instruction[2])
                .collect()
        };
        // m · p, the dot product, the subtraction, sin and the quotient.
        for opcode in [145, 148, op::F_SUB, op::EXT_INST, op::F_DIV] {
            let results = results(opcode);
            assert!(
                !results.is_empty() && results.iter().all(|id| decorated.contains(id)),
                "{opcode}"
            );
        }
        assert!(results(I_MUL).iter().all(|id| !decorated.contains(id)) && !results(I_MUL).is_empty());
    }
}
