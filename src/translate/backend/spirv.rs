//! SPIR-V, and what holds a driver to the arithmetic as written.

mod link;
mod opaque;
mod spell;
mod strict;

use ::spirv::Op;
use naga::ShaderStage;
use naga::back::spv::{BindingInfo, Options, PipelineOptions, WriterFlags, write_vec};
pub use opaque::with_opaque_numbers;
pub use spell::spelled;
pub use strict::strict;

use super::{BOUNDS, ENTRY_POINT, bindings};
use crate::naga_ir::ValidModule;

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

const HEADER_WORDS: usize = 5;

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

/// The same module with a text in it that nothing refers to: `OpString`, before all names.
#[must_use]
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

/// The index of the header's word that all ids are below.
const BOUND: usize = 3;

/// A string as an instruction holds it: bytes up to a zero, filled up with zeros; nothing if it is too long for one.
fn literal(text: &str) -> Option<Vec<u32>> {
    let mut bytes: Vec<u8> = text.bytes().filter(|&byte| byte != 0).collect();
    bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
    let words = bytes
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    (bytes.len() / 4 + 2 < 1 << 16).then(|| words.collect())
}

/// The words of a `.spv` file; nothing if they are not whole.
#[must_use]
pub fn of_bytes(bytes: &[u8]) -> Option<Vec<u32>> {
    let words = bytes.chunks_exact(4);
    let whole = words.remainder().is_empty();
    whole.then(|| {
        words
            .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect()
    })
}

/// What an instruction is, if that is known.
fn opcode(instruction: &[u32]) -> Option<Op> {
    Op::from_u32(instruction[0] & 0xffff)
}

/// Whether the first two operands of an instruction are its type and itself: so it is for all that have a value, and no others begin
/// with an id of a type.
fn has_type(op: Op) -> bool {
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

/// Whether it multiplies floats, and perhaps adds up what comes of it.
fn is_product(op: Op) -> bool {
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

/// The words of a shader that is right.
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
