//! Which values of a module always are numbers of 16 bits.

use std::collections::{HashMap, HashSet};

use ::half::f16;
use ::spirv::{GlslStd450Op, Op, StorageClass};

use super::ROUNDING_FUNCTION;
use crate::backend::spirv::link::{import, text};
use crate::backend::spirv::{has_type, instructions, opcode};

/// What is known of a module.
pub(super) struct Module<'a> {
    words: &'a [u32],
    /// The functions that round.
    rounding: HashSet<u32>,
    /// The numbers of components of the types of floats and their vectors.
    sizes: HashMap<u32, u32>,
    /// The storage class and the pointee of each type of pointers to these.
    pointers: HashMap<u32, (u32, u32)>,
    /// The types of values; of functions, those of their results.
    types: HashMap<u32, u32>,
    /// The instructions that define values.
    definitions: HashMap<u32, &'a [u32]>,
    parameters: HashMap<u32, Vec<u32>>,
    glsl: Option<u32>,
    /// What is not exact: values, functions by their results, and variables by their contents.
    inexact: HashSet<u32>,
}

impl<'a> Module<'a> {
    pub(super) fn new(words: &'a [u32]) -> Self {
        let mut module = Self {
            words,
            rounding: HashSet::new(),
            sizes: HashMap::new(),
            pointers: HashMap::new(),
            types: HashMap::new(),
            definitions: HashMap::new(),
            parameters: HashMap::new(),
            glsl: import(words),
            inexact: HashSet::new(),
        };
        let mut names = HashMap::new();
        let mut function = 0;
        for (_, instruction) in instructions(words) {
            match (opcode(instruction), &instruction[1..]) {
                (Some(Op::Name), [id, name @ ..]) => {
                    names.insert(*id, text(name));
                }
                (Some(Op::TypeFloat), &[id, 32, ..]) => {
                    module.sizes.insert(id, 1);
                }
                (Some(Op::TypeVector), &[id, of, size]) if module.sizes.contains_key(&of) => {
                    module.sizes.insert(id, size);
                }
                (Some(Op::TypePointer), &[id, storage, of]) if module.sizes.contains_key(&of) => {
                    module.pointers.insert(id, (storage, of));
                }
                (Some(op), &[ty, id, ..]) if has_type(op) => {
                    module.types.insert(id, ty);
                    module.definitions.insert(id, instruction);
                    match op {
                        Op::Function => function = id,
                        Op::FunctionParameter => module.parameters.entry(function).or_default().push(id),
                        _ => {}
                    }
                }
                _ => {}
            }
        }
        let rounds = |id: &u32| {
            names
                .get(id)
                .is_some_and(|name| name.starts_with(ROUNDING_FUNCTION))
        };
        let functions = module.definitions.iter();
        let functions = functions.filter(|(_, known)| opcode(known) == Some(Op::Function));
        module.rounding = functions.map(|(id, _)| *id).filter(rounds).collect();
        if module.has_roundings() {
            while module.refute() {}
        }
        module
    }

    pub(super) fn has_roundings(&self) -> bool {
        !self.rounding.is_empty()
    }

    /// The type and the number of components of a value of floats.
    pub(super) fn floats(&self, id: u32) -> Option<(u32, u32)> {
        let ty = *self.types.get(&id)?;
        Some((ty, *self.sizes.get(&ty)?))
    }

    /// The storage class and the number of components of a variable of floats, or of a part of one, in the
    /// shader's own memory.
    pub(super) fn pointee(&self, id: u32) -> Option<(u32, u32)> {
        let &(storage, pointee) = self.pointers.get(self.types.get(&id)?)?;
        let is_own = [StorageClass::Function as u32, StorageClass::Private as u32].contains(&storage);
        is_own.then(|| Some((storage, *self.sizes.get(&pointee)?)))?
    }

    /// Whether a value, a variable or the result of a function always is a number of 16 bits.
    pub(super) fn is_exact(&self, id: u32) -> bool {
        (self.floats(id).is_some() || self.pointee(id).is_some()) && !self.inexact.contains(&id)
    }

    pub(super) fn is_rounding(&self, function: u32) -> bool {
        self.rounding.contains(&function)
    }

    /// The operation of exact values whose result is this value, and the positions of its operands.
    pub(super) fn narrow_operation(&self, value: u32) -> Option<(&'a [u32], Vec<usize>)> {
        let operation = *self.definitions.get(&value)?;
        let operands = self.operands(operation)?;
        let is_exact = |id| self.is_exact(id) && self.floats(id).is_some();
        let are_exact = operands.iter().all(|&at| is_exact(operation[at]));
        are_exact.then_some((operation, operands))
    }

    /// Marks what one pass over the module finds not to be exact; whether anything was found.
    fn refute(&mut self) -> bool {
        let known = self.inexact.len();
        let mut function = 0;
        for (_, instruction) in instructions(self.words) {
            let Some(op) = opcode(instruction) else { continue };
            match (op, &instruction[1..]) {
                (Op::Function, &[_, id, ..]) => function = id,
                (Op::Store, &[pointer, value, ..]) => self.require(value, self.root(pointer)),
                (Op::ReturnValue, &[value]) => self.require(value, function),
                (Op::FunctionCall, &[_, id, callee, ref arguments @ ..]) => {
                    if !self.is_rounding(callee) {
                        self.require(callee, id);
                    }
                    let parameters = self.parameters.get(&callee).cloned().unwrap_or_default();
                    for (parameter, &argument) in parameters.into_iter().zip(arguments) {
                        self.require(argument, parameter);
                        if self.pointee(argument).is_some() {
                            self.inexact.extend([self.root(argument), parameter]);
                        }
                    }
                }
                (Op::Variable, &[_, id, _, initializer]) => self.require(initializer, id),
                (Op::FunctionParameter | Op::Variable, _) => {}
                (Op::AccessChain | Op::Load, &[_, id, pointer, ..]) => self.require(pointer, id),
                (Op::Constant, &[_, id, bits, ..]) => {
                    let value = f32::from_bits(bits);
                    if f16::from_f32(value).to_f32().to_bits() != bits {
                        self.inexact.insert(id);
                    }
                }
                (_, &[_, id, ..]) if has_type(op) => {
                    let is_exact = self.kept(instruction);
                    let is_exact =
                        is_exact.is_some_and(|kept| kept.iter().all(|&at| self.is_exact(instruction[at])));
                    if !is_exact {
                        self.inexact.insert(id);
                    }
                }
                _ => {}
            }
        }
        self.inexact.len() > known
    }

    /// Marks what depends on a value that is not exact.
    fn require(&mut self, value: u32, dependent: u32) {
        if !self.is_exact(value) {
            self.inexact.insert(dependent);
        }
    }

    /// The variable that a pointer points into.
    fn root(&self, mut pointer: u32) -> u32 {
        while let Some(chain) = self.definitions.get(&pointer)
            && opcode(chain) == Some(Op::AccessChain)
        {
            pointer = chain[3];
        }
        pointer
    }

    /// The positions of the operands of an instruction whose results are components of its operands, or exact
    /// if they are.
    pub(super) fn kept(&self, instruction: &[u32]) -> Option<Vec<usize>> {
        use GlslStd450Op as G;
        let end = instruction.len();
        Some(match opcode(instruction)? {
            Op::CopyObject | Op::FNegate | Op::CompositeConstruct | Op::ConstantComposite => {
                (3..end).collect()
            }
            Op::ConstantNull => Vec::new(),
            Op::CompositeExtract | Op::VectorExtractDynamic => vec![3],
            Op::CompositeInsert | Op::VectorShuffle | Op::VectorInsertDynamic => vec![3, 4],
            Op::Select => vec![4, 5],
            Op::Phi => (3..end).step_by(2).collect(),
            Op::ExtInst if Some(instruction[3]) == self.glsl => match G::from_u32(instruction[4])? {
                G::FAbs
                | G::FSign
                | G::Floor
                | G::Ceil
                | G::Trunc
                | G::RoundEven
                | G::FMin
                | G::FMax
                | G::FClamp
                | G::Step => (5..end).collect(),
                _ => return None,
            },
            _ => return None,
        })
    }

    /// The positions of the operands of an operation that exists for 16 bits, too: among the extended
    /// instructions, these are all whose operands and results are floats.
    fn operands(&self, instruction: &[u32]) -> Option<Vec<usize>> {
        let end = instruction.len();
        match opcode(instruction)? {
            Op::FAdd | Op::FSub | Op::FMul | Op::FDiv | Op::FNegate | Op::VectorTimesScalar | Op::Dot => {
                Some((3..end).collect())
            }
            Op::ExtInst if Some(instruction[3]) == self.glsl => Some((5..end).collect()),
            _ => None,
        }
    }
}
