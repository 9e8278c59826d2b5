//! Uniforms that a driver's compiler cannot tell from what differs from pixel to pixel.

use std::collections::HashMap;

use ::spirv::{BuiltIn, Decoration, Op, StorageClass};

use super::{BOUND, has_type, instructions, opcode};

/// The same module with each number that is loaded of a uniform block put through an exclusive or with the bits of `gl_FragCoord.z`,
/// which are 0 where a picture is painted by triangles at depth 0. Its values are the same. A module that has no
/// `gl_FragCoord` stays as it is, and so does what is loaded as an array or a structure.
///
/// Mesa asks of a number that a loop or a branch hangs on whether it is made of uniforms and constants only, and walks the expression
/// as a tree, though it is none: `sin(iTime)`, spelled out, has some hundred operations and more paths through them than can be walked.
/// Where the first operand that it meets hangs on the pixel, the walk has ended.
#[must_use]
pub fn with_opaque_uniforms(words: &[u32]) -> Vec<u32> {
    let Some(mut opaque) = Opaque::of(words) else {
        return words.to_vec();
    };
    let mut code = Vec::new();
    let mut first_function = words.len();
    for (at, instruction) in instructions(words) {
        if opcode(instruction) == Some(Op::Function) {
            first_function = first_function.min(at);
        }
        if first_function <= at && !opaque.hide(instruction, &mut code) {
            code.extend(instruction);
        }
    }
    let mut whole = [&words[..first_function], &opaque.declared, &code].concat();
    whole[BOUND] = opaque.bound;
    whole
}

/// A number, or a vector of them.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Shape {
    is_float: bool,
    components: u32,
}

struct Opaque {
    /// `gl_FragCoord`, and the type of what it points to.
    coordinate: (u32, u32),
    float: u32,
    /// The types of 32-bit numbers that can be hidden, of either sign.
    shapes: HashMap<u32, Shape>,
    /// A type of whole numbers for each count of components.
    whole: HashMap<u32, u32>,
    /// Types that point into uniform blocks.
    into_blocks: Vec<u32>,
    /// The type of each value.
    types: HashMap<u32, u32>,
    bound: u32,
    /// Types that the module did not have.
    declared: Vec<u32>,
}

impl Opaque {
    /// What has to be known of a module; nothing if it cannot be done in it.
    fn of(words: &[u32]) -> Option<Self> {
        let mut coordinates = Vec::new();
        let mut found = None;
        let mut pointees = HashMap::new();
        let mut opaque = Self {
            coordinate: (0, 0),
            float: 0,
            shapes: HashMap::new(),
            whole: HashMap::new(),
            into_blocks: Vec::new(),
            types: HashMap::new(),
            bound: *words.get(BOUND)?,
            declared: Vec::new(),
        };
        for (_, instruction) in instructions(words) {
            let Some(op) = opcode(instruction) else { continue };
            match (op, &instruction[1..]) {
                (Op::Decorate, &[variable, decoration, built_in])
                    if decoration == Decoration::BuiltIn as u32 && built_in == BuiltIn::FragCoord as u32 =>
                {
                    coordinates.push(variable);
                }
                (Op::TypeFloat, &[id, 32]) => {
                    opaque.float = id;
                    let shape = Shape {
                        is_float: true,
                        components: 1,
                    };
                    opaque.shapes.insert(id, shape);
                }
                (Op::TypeInt, &[id, 32, _]) => {
                    opaque.whole.entry(1).or_insert(id);
                    let shape = Shape {
                        is_float: false,
                        components: 1,
                    };
                    opaque.shapes.insert(id, shape);
                }
                (Op::TypeVector, &[id, of, components]) => {
                    if let Some(&Shape { is_float, .. }) = opaque.shapes.get(&of) {
                        if opaque.whole.get(&1) == Some(&of) {
                            opaque.whole.insert(components, id);
                        }
                        opaque.shapes.insert(id, Shape { is_float, components });
                    }
                }
                (Op::TypePointer, &[id, class, pointee]) => {
                    pointees.insert(id, pointee);
                    if class == StorageClass::Uniform as u32 {
                        opaque.into_blocks.push(id);
                    }
                }
                (Op::Variable, &[ty, id, ..]) if coordinates.contains(&id) => {
                    found = Some((id, *pointees.get(&ty)?));
                }
                (_, &[ty, id, ..]) if has_type(op) => {
                    opaque.types.insert(id, ty);
                }
                _ => {}
            }
        }
        opaque.coordinate = found?;
        Some(opaque)
    }

    /// Loads what the instruction loads and hides it, if that is a number of a block.
    fn hide(&mut self, load: &[u32], code: &mut Vec<u32>) -> bool {
        let (Some(Op::Load), &[_, ty, result, pointer, ..]) = (opcode(load), load) else {
            return false;
        };
        let Some(&Shape { is_float, components }) = self.shapes.get(&ty) else {
            return false;
        };
        if !self
            .types
            .get(&pointer)
            .is_some_and(|ty| self.into_blocks.contains(ty))
        {
            return false;
        }
        let one = self.whole_type(1);
        let whole = self.whole_type(components);
        let (coordinate, at) = self.coordinate;
        let at = self.value(code, Op::Load, at, &[coordinate]);
        let depth = self.value(code, Op::CompositeExtract, self.float, &[at, 2]);
        let mut zero = self.value(code, Op::Bitcast, one, &[depth]);
        if components > 1 {
            zero = self.value(
                code,
                Op::CompositeConstruct,
                whole,
                &vec![zero; components as usize],
            );
        }
        let loaded = self.value(code, Op::Load, ty, &load[3..]);
        if is_float {
            let bits = self.value(code, Op::Bitcast, whole, &[loaded]);
            let hidden = self.value(code, Op::BitwiseXor, whole, &[bits, zero]);
            push(code, Op::Bitcast, &[ty, result, hidden]);
        } else {
            push(code, Op::BitwiseXor, &[ty, result, loaded, zero]);
        }
        true
    }

    /// Appends an operation with a value of its own.
    fn value(&mut self, code: &mut Vec<u32>, op: Op, ty: u32, operands: &[u32]) -> u32 {
        let id = self.fresh();
        push(code, op, &[&[ty, id], operands].concat());
        id
    }

    /// The type of so many whole numbers.
    fn whole_type(&mut self, components: u32) -> u32 {
        if let Some(&id) = self.whole.get(&components) {
            return id;
        }
        let operands = match components {
            1 => vec![32, 0],
            _ => vec![self.whole_type(1), components],
        };
        let op = if components == 1 {
            Op::TypeInt
        } else {
            Op::TypeVector
        };
        let id = self.fresh();
        push(&mut self.declared, op, &[&[id], &operands[..]].concat());
        self.whole.insert(components, id);
        id
    }

    fn fresh(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }
}

fn push(code: &mut Vec<u32>, op: Op, operands: &[u32]) {
    code.push((operands.len() as u32 + 1) << 16 | op as u32);
    code.extend(operands);
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

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

    fn all(words: &[u32], op: Op) -> Vec<&[u32]> {
        let found = instructions(words).filter(|(_, instruction)| opcode(instruction) == Some(op));
        found.map(|(_, instruction)| instruction).collect()
    }

    #[test]
    fn each_number_of_a_block_is_hidden_and_nothing_else_changes() {
        let plain = words_of(
            "float late() { return iTime; }
            void mainImage(out vec4 c, in vec2 p) { c = vec4(late(), p / iResolution.xy, iMouse.x + float(iFrame)); }",
        );
        let opaque = with_opaque_uniforms(&plain);
        // The time, the resolution, the mouse and the frame.
        let hidden = all(&opaque, Op::BitwiseXor);
        assert_eq!((all(&plain, Op::BitwiseXor).len(), hidden.len()), (0, 4));
        let loads =
            |words| -> Vec<Vec<u32>> { all(words, Op::Load).iter().map(|load| load.to_vec()).collect() };
        assert_eq!(
            loads(&opaque).len(),
            loads(&plain).len() + 4,
            "the coordinate beside each"
        );
        // Each number has its old id when it has been hidden, and no two have one.
        let results = |words| -> Vec<u32> {
            let typed =
                instructions(words).filter(|(_, instruction)| opcode(instruction).is_some_and(has_type));
            typed
                .filter_map(|(_, instruction)| instruction.get(2).copied())
                .collect()
        };
        let now = results(&opaque);
        let distinct: HashSet<_> = now.iter().collect();
        assert_eq!(distinct.len(), now.len());
        assert!(now.iter().all(|&id| id < opaque[BOUND]));
        assert!(results(&plain).iter().all(|id| distinct.contains(id)));
    }

    #[test]
    fn a_module_that_does_not_know_where_it_paints_stays_as_it_is() {
        let mut words = words_of("void mainImage(out vec4 c, in vec2 p) { c = vec4(iTime); }");
        let built_in = instructions(&words).find(|(_, instruction)| {
            opcode(instruction) == Some(Op::Decorate) && instruction[2] == Decoration::BuiltIn as u32
        });
        let at = built_in.unwrap().0;
        assert_ne!(with_opaque_uniforms(&words), words);
        words[at + 3] = BuiltIn::FrontFacing as u32;
        assert_eq!(with_opaque_uniforms(&words), words);
        assert!(with_opaque_uniforms(&[]).is_empty());
    }
}
