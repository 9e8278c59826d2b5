//! Narrows to floats of 16 bits what a shader rounds to 16 bits, for drivers that have them.
//!
//! The shader calls [`ROUNDING_FUNCTION`] wherever a value has 16 bits. Here a value is *exact* if it always
//! is a number of 16 bits: the result of such a call, some constants, what is loaded from a variable that
//! gets nothing else, and what is composed of such values. An exact value gets a copy of 16 bits, exact
//! variables store 16 bits, and an operation of exact values whose result is rounded is one of 16 bits.
//! Drivers remove the values that nothing uses any more.

mod exact;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use ::half::f16;
use ::spirv::{Capability, Op, StorageClass};

use self::exact::Module;
use super::{BOUND, HEADER_WORDS, instructions, is_type, opcode, push};

/// The start of the names of the functions that round a float, or the components of a vector, to 16 bits.
pub const ROUNDING_FUNCTION: &str = "toyproof_half";

/// Computes in 16 bits what is rounded to 16 bits. A module without [`ROUNDING_FUNCTION`] remains as it is.
pub fn narrowed(words: &[u32]) -> Vec<u32> {
    let module = Module::new(words);
    if !module.has_roundings() {
        return words.to_vec();
    }
    let mut narrowing = Narrowing {
        module,
        bound: words[BOUND],
        halves: HashMap::new(),
        declarations: Vec::new(),
        types: HashMap::new(),
        pointers: HashMap::new(),
        parameters: Vec::new(),
    };
    narrowing.declare(words);
    narrowing.rewrite(words)
}

/// A module in which exact values get copies of 16 bits.
struct Narrowing<'a> {
    module: Module<'a>,
    bound: u32,
    /// The copies of values.
    halves: HashMap<u32, u32>,
    /// The types and constants of 16 bits.
    declarations: Vec<u32>,
    /// The types of 16 bits by their numbers of components.
    types: HashMap<u32, u32>,
    /// The types of pointers to these, by storage class and number of components.
    pointers: HashMap<(u32, u32), u32>,
    /// Parameters whose copies follow the variables of the function.
    parameters: Vec<u32>,
}

impl Narrowing<'_> {
    fn fresh(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }

    fn half(&mut self, value: u32) -> u32 {
        if let Some(&half) = self.halves.get(&value) {
            return half;
        }
        let half = self.fresh();
        self.halves.insert(value, half);
        half
    }

    /// Declares the types, and the copies of constants.
    fn declare(&mut self, words: &[u32]) {
        for size in 1..=4 {
            let id = self.fresh();
            match size {
                1 => push(&mut self.declarations, Op::TypeFloat, &[id, 16]),
                _ => push(
                    &mut self.declarations,
                    Op::TypeVector,
                    &[id, self.types[&1], size],
                ),
            }
            self.types.insert(size, id);
            for storage in [StorageClass::Function as u32, StorageClass::Private as u32] {
                let pointer = self.fresh();
                push(&mut self.declarations, Op::TypePointer, &[pointer, storage, id]);
                self.pointers.insert((storage, size), pointer);
            }
        }
        for (_, instruction) in instructions(words) {
            match opcode(instruction) {
                Some(Op::Function) => break,
                Some(Op::Constant) if self.module.is_exact(instruction[2]) => {
                    let bits = f16::from_f32(f32::from_bits(instruction[3])).to_bits();
                    let operands = [self.types[&1], self.half(instruction[2]), u32::from(bits)];
                    push(&mut self.declarations, Op::Constant, &operands);
                }
                Some(Op::ConstantComposite | Op::ConstantNull) => {
                    let half = self.half_instruction(instruction);
                    self.declarations.extend(half);
                }
                _ => {}
            }
        }
    }

    /// An instruction of 16 bits in place of one whose operands and result are exact; empty if it has none.
    fn half_instruction(&mut self, instruction: &[u32]) -> Vec<u32> {
        let kept = self
            .module
            .kept(instruction)
            .filter(|_| self.module.is_exact(instruction[2]));
        match kept {
            Some(operands) => self.of_halves(instruction, &operands, instruction[2]),
            None => Vec::new(),
        }
    }

    /// An instruction of the copies of its operands, which computes the copy of a value.
    fn of_halves(&mut self, instruction: &[u32], operands: &[usize], value: u32) -> Vec<u32> {
        let mut half = instruction.to_vec();
        half[1] = self.narrow_type(value);
        half[2] = self.half(value);
        for &at in operands {
            half[at] = self.half(half[at]);
        }
        half
    }

    /// The type of the copy of a value.
    fn narrow_type(&self, value: u32) -> u32 {
        let size = self.module.floats(value).map_or(1, |(_, size)| size);
        self.types[&size]
    }

    fn rewrite(&mut self, words: &[u32]) -> Vec<u32> {
        let mut code = words[..HEADER_WORDS].to_vec();
        push(&mut code, Op::Capability, &[Capability::Float16 as u32]);
        for (_, instruction) in instructions(words) {
            let Some(op) = opcode(instruction) else {
                code.extend(instruction);
                continue;
            };
            if is_type(op) {
                code.append(&mut self.declarations);
            }
            let precedes_code = matches!(op, Op::FunctionParameter | Op::Label | Op::Variable | Op::Line);
            if !precedes_code {
                for parameter in std::mem::take(&mut self.parameters) {
                    self.convert_to_half(&mut code, parameter);
                }
            }
            self.rewrite_instruction(&mut code, op, instruction);
        }
        code[BOUND] = self.bound;
        code
    }

    fn rewrite_instruction(&mut self, code: &mut Vec<u32>, op: Op, instruction: &[u32]) {
        let is_exact = |narrowing: &Self, at: usize| {
            instruction
                .get(at)
                .is_some_and(|&id| narrowing.module.is_exact(id))
        };
        match op {
            Op::Variable | Op::AccessChain if is_exact(self, 2) => {
                let mut narrow = instruction.to_vec();
                if let Some(pointee) = self.module.pointee(instruction[2]) {
                    narrow[1] = self.pointers[&pointee];
                }
                if let (Op::Variable, Some(initializer)) = (op, narrow.get(4).copied()) {
                    narrow[4] = self.half(initializer);
                }
                code.extend(narrow);
            }
            Op::Store if is_exact(self, 1) => {
                let value = self.half(instruction[2]);
                push(code, op, &[instruction[1], value]);
            }
            Op::Load if is_exact(self, 2) => {
                let narrow = [
                    self.narrow_type(instruction[2]),
                    self.half(instruction[2]),
                    instruction[3],
                ];
                push(code, op, &narrow);
                self.convert_from_half(code, instruction);
            }
            Op::FunctionCall if self.module.is_rounding(instruction[3]) => {
                let [value, argument] = [instruction[2], instruction[4]];
                if let Some((operation, operands)) = self.module.narrow_operation(argument) {
                    let narrow = self.of_halves(operation, &operands, value);
                    code.extend(narrow);
                } else {
                    let narrow = [self.narrow_type(value), self.half(value), argument];
                    push(code, Op::FConvert, &narrow);
                }
                self.convert_from_half(code, instruction);
            }
            Op::FunctionCall if is_exact(self, 2) => {
                code.extend(instruction);
                self.convert_to_half(code, instruction[2]);
            }
            Op::FunctionParameter => {
                code.extend(instruction);
                if is_exact(self, 2) && self.module.floats(instruction[2]).is_some() {
                    self.parameters.push(instruction[2]);
                }
            }
            Op::ConstantComposite | Op::ConstantNull => code.extend(instruction),
            _ => {
                code.extend(instruction);
                let half = self.half_instruction(instruction);
                code.extend(half);
            }
        }
    }

    /// Appends the conversion of a value to 16 bits, which changes nothing.
    fn convert_to_half(&mut self, code: &mut Vec<u32>, value: u32) {
        let operands = [self.narrow_type(value), self.half(value), value];
        push(code, Op::FConvert, &operands);
    }

    /// Appends the conversion of the copy to the value of an instruction.
    fn convert_from_half(&mut self, code: &mut Vec<u32>, instruction: &[u32]) {
        let half = self.half(instruction[2]);
        push(code, Op::FConvert, &[instruction[1], instruction[2], half]);
    }
}
