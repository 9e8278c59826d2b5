//! Uniform blocks as storage buffers.

use std::collections::{HashMap, HashSet};

use ::spirv::{Decoration, Op, StorageClass};

use super::{HEADER_WORDS, instructions, opcode};

/// The same module with its uniform blocks as storage buffers that nobody writes, laid out as before.
///
/// Mesa asks of a number that a loop or a branch hangs on whether it is made of uniforms and constants only, and walks the expression
/// as a tree, though it is none: `sin(iTime)`, spelled out, has some hundred operations and more paths through them than can be walked.
/// What is loaded of a storage buffer is no uniform to it.
#[must_use]
pub fn with_blocks_stored(words: &[u32]) -> Vec<u32> {
    let mut pointees = HashMap::new();
    let mut blocks = HashSet::new();
    let mut variables = Vec::new();
    for (_, instruction) in instructions(words) {
        match (opcode(instruction), &instruction[1..]) {
            (Some(Op::TypePointer), &[id, class, pointee]) if class == StorageClass::Uniform as u32 => {
                pointees.insert(id, pointee);
            }
            (Some(Op::Variable), &[ty, id, ..]) => {
                if let Some(&block) = pointees.get(&ty) {
                    blocks.insert(block);
                    variables.push(id);
                }
            }
            _ => {}
        }
    }
    let mut stored = words[..words.len().min(HEADER_WORDS)].to_vec();
    for (_, instruction) in instructions(words) {
        match (opcode(instruction), &instruction[1..]) {
            (Some(Op::Decorate), &[of, decoration])
                if decoration == Decoration::Block as u32 && blocks.contains(&of) =>
            {
                stored.extend([instruction[0], of, Decoration::BufferBlock as u32]);
                for variable in variables.drain(..) {
                    stored.extend([instruction[0], variable, Decoration::NonWritable as u32]);
                }
            }
            _ => stored.extend(instruction),
        }
    }
    stored
}

/// Whether it asks for derivatives, or samples as far from a texture as they tell. Where a quad of pixels lies half in a triangle, these see
/// what the other half computes, and to that half lavapipe lends no storage buffer: all that it loads is 0.
#[must_use]
pub fn takes_derivatives(words: &[u32]) -> bool {
    instructions(words).any(|(_, instruction)| {
        matches!(
            opcode(instruction),
            Some(
                Op::DPdx
                    | Op::DPdy
                    | Op::Fwidth
                    | Op::DPdxFine
                    | Op::DPdyFine
                    | Op::FwidthFine
                    | Op::DPdxCoarse
                    | Op::DPdyCoarse
                    | Op::FwidthCoarse
                    | Op::ImageSampleImplicitLod
                    | Op::ImageSampleDrefImplicitLod
                    | Op::ImageSampleProjImplicitLod
                    | Op::ImageSampleProjDrefImplicitLod
                    | Op::ImageQueryLod
            )
        )
    })
}

#[cfg(test)]
mod tests {
    use super::super::words;
    use super::*;
    use crate::glsl::{Options as Language, check, lower};
    use crate::module::ValidModule;
    use crate::source::{File, Files};

    fn words_of(shader: &str) -> Vec<u32> {
        let mut files = Files::default();
        let file = files.add(File::new("s", shader));
        let checked = check(&files, file, &Language::default()).unwrap();
        words(&ValidModule::parse(&lower(&checked)).unwrap()).unwrap()
    }

    #[test]
    fn a_block_becomes_one_that_is_stored_and_only_read() {
        let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(iTime); }";
        let uniform = words_of(shader);
        let stored = with_blocks_stored(&uniform);
        let decorated = |words: &[u32], decoration: Decoration| -> Vec<u32> {
            instructions(words)
                .filter(|(_, instruction)| opcode(instruction) == Some(Op::Decorate))
                .filter(|(_, instruction)| instruction[2] == decoration as u32)
                .map(|(_, instruction)| instruction[1])
                .collect()
        };
        let block = decorated(&uniform, Decoration::Block);
        assert_eq!(block.len(), 1);
        assert_eq!(decorated(&stored, Decoration::BufferBlock), block);
        assert!(decorated(&stored, Decoration::Block).is_empty());
        let binding = decorated(&stored, Decoration::Binding);
        assert_eq!(decorated(&stored, Decoration::NonWritable), binding);
        assert_eq!(stored.len(), uniform.len() + 3, "nothing else");
        let plain = words_of("void mainImage(out vec4 c, in vec2 p) { c = vec4(p, p); }");
        assert_eq!(with_blocks_stored(&plain), plain, "a shader that reads no block");
    }

    #[test]
    fn derivatives_are_seen_however_they_are_asked_for() {
        let takes = |body: &str| {
            takes_derivatives(&words_of(&format!(
                "void mainImage(out vec4 c, in vec2 p) {{ {body} }}"
            )))
        };
        assert!(!takes(
            "c = vec4(sin(iTime * p.x)) + texelFetch(iChannel0, ivec2(p), 0);"
        ));
        for body in [
            "c = vec4(dFdx(p.x));",
            "c = vec4(fwidth(p.y));",
            "c = texture(iChannel0, p);",
        ] {
            assert!(takes(body), "{body}");
        }
        let plain = words_of("void mainImage(out vec4 c, in vec2 p) { c = vec4(dFdy(p.x)); }");
        assert!(takes_derivatives(&super::super::strict(&plain)), "fine ones");
    }
}
