//! SPIR-V, and the decorations that make drivers evaluate arithmetic as written.

mod expand;
mod link;
mod narrow;

use std::collections::HashSet;

use ::spirv::{Capability, Decoration, GlslStd450Op, Op};
pub use expand::expanded;
use naga::ShaderStage;
use naga::back::spv::{BindingInfo, Options, PipelineOptions, WriterFlags, write_vec};
pub use narrow::{ROUNDING_FUNCTION, narrowed};

use super::{ENTRY_POINT, bindings, bounds};
use crate::TranslateError;
use crate::naga_ir::ValidModule;

/// Writes a module by naga: with names, without flipped coordinates, with clamped indices and unbounded
/// loops.
///
/// # Errors
/// naga's message, if it cannot write the module.
pub fn words(module: &ValidModule) -> Result<Vec<u32>, TranslateError> {
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
        bounds_check_policies: bounds(module),
        force_loop_bounding: false,
        ..Options::default()
    };
    let pipeline = PipelineOptions {
        shader_stage: ShaderStage::Fragment,
        entry_point: ENTRY_POINT.to_owned(),
    };
    write_vec(module.module(), module.info(), &options, Some(&pipeline)).map_err(TranslateError::new)
}

/// Encodes words as the little-endian bytes of a `.spv` file.
pub fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

const HEADER_WORDS: usize = 5;

/// The instructions with the indices of their first words.
pub fn instructions(words: &[u32]) -> impl Iterator<Item = (usize, &[u32])> {
    let mut at = HEADER_WORDS;
    std::iter::from_fn(move || {
        let start = at;
        let count = (*words.get(start)? >> 16) as usize;
        at += count.max(1);
        Some((start, words.get(start..at)?))
    })
}

/// Adds an unreferenced `OpString` before all names.
pub fn with_note(words: &[u32], note: &str) -> Vec<u32> {
    let Some((&bound, text)) = words.get(BOUND).zip(literal(note)) else {
        return words.to_vec();
    };
    let is_before = |instruction: &[u32]| {
        matches!(
            opcode(instruction),
            Some(
                Op::Capability
                    | Op::Extension
                    | Op::ExtInstImport
                    | Op::MemoryModel
                    | Op::EntryPoint
                    | Op::ExecutionMode
            )
        )
    };
    let first = instructions(words).find(|(_, instruction)| !is_before(instruction));
    let (head, tail) = words.split_at(first.map_or(words.len(), |(at, _)| at));
    let string = [(2 + text.len() as u32) << 16 | Op::String as u32, bound];
    let mut noted = [head, &string, &text, tail].concat();
    noted[BOUND] = bound + 1;
    noted
}

/// The index of the header word with the bound of all ids.
pub const BOUND: usize = 3;

/// Encodes a string literal: its bytes and zero padding; `None` if it is too long for an instruction.
fn literal(text: &str) -> Option<Vec<u32>> {
    let mut bytes: Vec<u8> = text.bytes().filter(|&byte| byte != 0).collect();
    bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
    let words = bytes
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    (bytes.len() / 4 + 2 < 1 << 16).then(|| words.collect())
}

/// Decodes the words of a `.spv` file; `None` if the length is not a multiple of 4.
pub fn of_bytes(bytes: &[u8]) -> Option<Vec<u32>> {
    let words = bytes.chunks_exact(4);
    let whole = words.remainder().is_empty();
    whole.then(|| {
        words
            .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect()
    })
}

/// Appends an instruction.
pub fn push(code: &mut Vec<u32>, op: Op, operands: &[u32]) {
    code.push((1 + operands.len() as u32) << 16 | op as u32);
    code.extend(operands);
}

/// The opcode of an instruction, if known.
pub fn opcode(instruction: &[u32]) -> Option<Op> {
    Op::from_u32(instruction[0] & 0xffff)
}

/// Whether the first two operands are the result's type and id, as in all instructions with a typed result.
pub fn has_type(op: Op) -> bool {
    let names_and_decorations = matches!(
        op,
        Op::Source | Op::Name | Op::MemberName | Op::Line | Op::Decorate | Op::MemberDecorate
    );
    let structure = matches!(
        op,
        Op::EntryPoint | Op::ExecutionMode | Op::MemoryModel | Op::ExtInstImport
    );
    let flow = matches!(
        op,
        Op::Store
            | Op::CopyMemory
            | Op::LoopMerge
            | Op::SelectionMerge
            | Op::Label
            | Op::Branch
            | Op::BranchConditional
            | Op::Switch
            | Op::ReturnValue
    );
    !(names_and_decorations || structure || flow || is_type(op))
}

/// Whether an instruction multiplies floats, possibly adding the products.
pub fn is_product(op: Op) -> bool {
    matches!(
        op,
        Op::FMul
            | Op::VectorTimesScalar
            | Op::MatrixTimesScalar
            | Op::VectorTimesMatrix
            | Op::MatrixTimesVector
            | Op::MatrixTimesMatrix
            | Op::OuterProduct
            | Op::Dot
    )
}

fn is_type(op: Op) -> bool {
    (Op::TypeVoid as u32..=Op::TypeForwardPointer as u32).contains(&(op as u32))
}

/// The words of a valid shader.
#[cfg(test)]
fn words_of(shader: &str) -> Vec<u32> {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::{Options as Language, check};

    use crate::lower;

    let mut files = Files::default();
    let file = files.add(File::new("s", shader));
    let checked = check(&files, file, &Language::default()).unwrap();
    words(&ValidModule::parse(&lower(&checked)).unwrap()).unwrap()
}

/// Decorates every float operation that a driver could fuse, rearrange or round differently with
/// `NoContraction`, and makes derivatives fine where their precision is left to the driver: Mesa uses a
/// pixel's own row or column, `SwiftShader` the quad's first. Nothing else changes.
pub fn strict(words: &[u32]) -> Vec<u32> {
    let mut floats = HashSet::new();
    let mut decorations = Vec::new();
    let mut first_type = words.len();
    let mut derives = false;
    for (at, instruction) in instructions(words) {
        let Some(op) = opcode(instruction) else { continue };
        // Decorations precede the first type or constant.
        if is_type(op) || op == Op::ConstantTrue || op == Op::Constant {
            first_type = first_type.min(at);
        }
        match op {
            Op::TypeFloat => {
                floats.insert(instruction[1]);
            }
            Op::TypeVector | Op::TypeMatrix if floats.contains(&instruction[2]) => {
                floats.insert(instruction[1]);
            }
            _ if is_arithmetic(op, instruction, &floats) => decorations.extend([
                3 << 16 | Op::Decorate as u32,
                instruction[2],
                Decoration::NoContraction as u32,
            ]),
            _ => derives |= fine(op).is_some(),
        }
    }
    let mut strict = words[..HEADER_WORDS.min(words.len())].to_vec();
    if derives {
        strict.extend([
            2 << 16 | Op::Capability as u32,
            Capability::DerivativeControl as u32,
        ]);
    }
    for (at, instruction) in instructions(words) {
        if at == first_type {
            strict.append(&mut decorations);
        }
        let length = instruction[0] & 0xffff_0000;
        let op = opcode(instruction).and_then(fine);
        strict.push(op.map_or(instruction[0], |op| length | op as u32));
        strict.extend(&instruction[1..]);
    }
    strict
}

/// Whether an instruction computes floats with a result that may depend on the driver.
///
/// `sqrt`, `min`, `max` and `clamp` do not: each is one operation, exact or correctly rounded. The first
/// three must not be decorated: if all operands become constant after some propagation, SPIRV-Tools, which
/// `SwiftShader` runs, treats their decorated results as still unknown, and so takes `c ? 0.25 : f(m)` for
/// 0.25.
fn is_arithmetic(op: Op, instruction: &[u32], floats: &HashSet<u32>) -> bool {
    use GlslStd450Op as G;
    match op {
        Op::ExtInst => {
            let exact = matches!(
                instruction.get(4).and_then(|&number| G::from_u32(number)),
                Some(G::Sqrt | G::FMin | G::FMax | G::FClamp)
            );
            floats.contains(&instruction[1]) && !exact
        }
        Op::FNegate | Op::FAdd | Op::FSub | Op::FDiv | Op::FRem | Op::FMod => true,
        _ => is_product(op),
    }
}

/// The fine version of a derivative whose precision is left to the driver.
fn fine(op: Op) -> Option<Op> {
    Some(match op {
        Op::DPdx => Op::DPdxFine,
        Op::DPdy => Op::DPdyFine,
        Op::Fwidth => Op::FwidthFine,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHADER: &str = "void mainImage(out vec4 c, in vec2 p) {
        int i = int(p.x) * 3;
        mat2 m = mat2(p, p);
        c = vec4(m * p, dot(p, p) - 0.5, sin(p.x) / float(i));
    }";

    fn is_no_contraction(instruction: &[u32]) -> bool {
        instruction.len() == 3
            && opcode(instruction) == Some(Op::Decorate)
            && instruction[2] == Decoration::NoContraction as u32
    }

    #[test]
    fn only_decorations_are_added() {
        let plain = words_of(SHADER);
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
        let strict = strict(&words_of(SHADER));
        let decorated: HashSet<u32> = instructions(&strict)
            .filter(|(_, instruction)| is_no_contraction(instruction))
            .map(|(_, instruction)| instruction[1])
            .collect();
        let results = |op: Op| -> Vec<u32> {
            instructions(&strict)
                .filter(|(_, instruction)| opcode(instruction) == Some(op))
                // The conversion to `int` uses `clamp`.
                .filter(|(_, instruction)| op != Op::ExtInst || instruction[4] == GlslStd450Op::Sin as u32)
                .map(|(_, instruction)| instruction[2])
                .collect()
        };
        // m · p, the dot product, the subtraction, `sin` and the quotient.
        for op in [Op::MatrixTimesVector, Op::Dot, Op::FSub, Op::ExtInst, Op::FDiv] {
            let results = results(op);
            assert!(
                !results.is_empty() && results.iter().all(|id| decorated.contains(id)),
                "{op:?}"
            );
        }
        assert!(results(Op::IMul).iter().all(|id| !decorated.contains(id)) && !results(Op::IMul).is_empty());
    }

    #[test]
    fn exact_steps_are_not_decorated() {
        let shader = "void mainImage(out vec4 c, in vec2 p) {
            c = vec4(sqrt(p), min(p.x, max(p.y, 2.0)), clamp(p.x, 0.0, 1.0));
        }";
        let strict = strict(&words_of(shader));
        assert!(instructions(&strict).all(|(_, instruction)| !is_no_contraction(instruction)));
    }

    #[test]
    fn derivatives_are_fine() {
        let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(dFdx(p), dFdy(p.x), fwidth(p.y)); }";
        let (plain, strict) = (words_of(shader), strict(&words_of(shader)));
        let of = |words: &[u32]| -> Vec<Op> {
            let all = instructions(words).filter_map(|(_, instruction)| opcode(instruction));
            all.filter(|op| (Op::DPdx..=Op::FwidthCoarse).contains(op))
                .collect()
        };
        assert_eq!(of(&plain), [Op::DPdx, Op::DPdy, Op::Fwidth]);
        assert_eq!(of(&strict), [Op::DPdxFine, Op::DPdyFine, Op::FwidthFine]);
        let capability = [
            2 << 16 | Op::Capability as u32,
            Capability::DerivativeControl as u32,
        ];
        assert_eq!(strict[HEADER_WORDS..][..2], capability);
        assert_eq!(strict.len(), plain.len() + 2, "nothing else is added");
    }
}
