//! Zeros that a driver's compiler does not know: the bits of `gl_FragCoord.z`, which are 0 because images are
//! rendered with triangles at depth 0.

use std::collections::HashMap;

use spirv::{BuiltIn, Decoration, Op};
use toyproof_translate::backend::spirv::{BOUND, instructions, opcode, push};

/// The ids of a module that are needed to compute such zeros, and the types that are added for it.
pub(super) struct Opaque {
    /// `gl_FragCoord` and its type.
    coordinate: (u32, u32),
    float: u32,
    boolean: Option<u32>,
    /// An integer type for each number of components.
    int_types: HashMap<u32, u32>,
    bound: u32,
    /// Types and constants to add to the module.
    declared: Vec<u32>,
}

impl Opaque {
    /// Finds the ids in a module; `None` if it has no `gl_FragCoord`.
    pub(super) fn new(words: &[u32]) -> Option<Self> {
        let mut coordinates = Vec::new();
        let mut found = None;
        let mut pointees = HashMap::new();
        let mut opaque = Self {
            coordinate: (0, 0),
            float: 0,
            boolean: None,
            int_types: HashMap::new(),
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
                (Op::TypeFloat, &[id, 32]) => opaque.float = id,
                (Op::TypeBool, &[id]) => opaque.boolean = Some(id),
                (Op::TypeInt, &[id, 32, _]) => {
                    opaque.int_types.entry(1).or_insert(id);
                }
                (Op::TypeVector, &[id, of, components]) if opaque.int_types.get(&1) == Some(&of) => {
                    opaque.int_types.insert(components, id);
                }
                (Op::TypePointer, &[id, _, pointee]) => {
                    pointees.insert(id, pointee);
                }
                (Op::Variable, &[ty, id, ..]) if coordinates.contains(&id) => {
                    found = Some((id, *pointees.get(&ty)?));
                }
                (Op::Function, _) => break,
                _ => {}
            }
        }
        opaque.coordinate = found?;
        Some(opaque)
    }

    /// Appends instructions that compute the unknown zero as an integer.
    pub(super) fn zero(&mut self, code: &mut Vec<u32>) -> u32 {
        let one = self.int_type(1);
        let (coordinate, at) = self.coordinate;
        let at = self.value(code, Op::Load, at, &[coordinate]);
        let depth = self.value(code, Op::CompositeExtract, self.float, &[at, 2]);
        self.value(code, Op::Bitcast, one, &[depth])
    }

    /// Appends instructions that compute an unknown `false`: whether the zero is 1. If they compared it with
    /// 0, Mesa would know that it is 0 wherever this is `false`.
    pub(super) fn never(&mut self, code: &mut Vec<u32>) -> u32 {
        let int = self.int_type(1);
        let boolean = self.boolean.unwrap_or_else(|| {
            let id = self.fresh();
            push(&mut self.declared, Op::TypeBool, &[id]);
            self.boolean = Some(id);
            id
        });
        let known = self.fresh();
        push(&mut self.declared, Op::Constant, &[int, known, 1]);
        let zero = self.zero(code);
        self.value(code, Op::IEqual, boolean, &[zero, known])
    }

    /// Appends an operation with a new result id.
    pub(super) fn value(&mut self, code: &mut Vec<u32>, op: Op, ty: u32, operands: &[u32]) -> u32 {
        let id = self.fresh();
        push(code, op, &[&[ty, id], operands].concat());
        id
    }

    /// The integer type with a number of components.
    pub(super) fn int_type(&mut self, components: u32) -> u32 {
        if let Some(&id) = self.int_types.get(&components) {
            return id;
        }
        let (op, operands) = match components {
            1 => (Op::TypeInt, vec![32, 0]),
            _ => (Op::TypeVector, vec![self.int_type(1), components]),
        };
        let id = self.fresh();
        push(&mut self.declared, op, &[&[id], &operands[..]].concat());
        self.int_types.insert(components, id);
        id
    }

    /// A new id.
    pub(super) fn fresh(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }

    /// The part of the module before its functions, and the code of the functions.
    pub(super) fn finish(&self, head: &[u32], code: &[u32]) -> Vec<u32> {
        let mut whole = [head, &self.declared, code].concat();
        whole[BOUND] = self.bound;
        whole
    }
}

/// The index of the word at which the functions of a module begin.
pub(super) fn functions_start(words: &[u32]) -> usize {
    let mut all = instructions(words);
    let first = all.find(|(_, instruction)| opcode(instruction) == Some(Op::Function));
    first.map_or(words.len(), |(at, _)| at)
}

/// The words of a valid shader.
#[cfg(test)]
pub(super) fn words_of(shader: &str) -> Vec<u32> {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::{Options, check};
    use toyproof_translate::backend::spirv::words;
    use toyproof_translate::naga_ir::ValidModule;

    let mut files = Files::default();
    let file = files.add(File::new("s", shader));
    let checked = check(&files, file, &Options::default()).unwrap();
    words(&ValidModule::parse(&toyproof_translate::lower(&checked)).unwrap()).unwrap()
}
