//! Values that a compiler may find to be constants.

use std::collections::{HashMap, HashSet};

use spirv::Op;
use toyproof_translate::backend::spirv::{has_type, instructions, opcode};

/// A fact that a compiler may know about a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Known {
    /// A literal without zeros.
    NonZero,
    /// A literal with a zero.
    Zero,
    /// Any number.
    Folded,
}

/// Returns the fact about the value of an id; `None` if it depends on the pixel.
pub(super) type Operands<'a> = dyn Fn(u32) -> Option<Known> + 'a;

/// The values of a module that may be constants after variables are replaced by their values, calls by the
/// called functions and loops by their iterations. A variable may be constant if a constant is stored to it.
#[derive(Debug, Default)]
pub(super) struct Foldable {
    /// The facts about values, variables (about the stored values) and functions (about the returned values).
    known: HashMap<u32, Known>,
    /// The variables that pointers point into.
    roots: HashMap<u32, u32>,
    /// Parameters that are pointers.
    references: HashSet<u32>,
    /// The constants with which variables without an initializer are initialized.
    nulls: HashSet<u32>,
    /// The parameters of functions.
    parameters: HashMap<u32, Vec<u32>>,
}

impl Foldable {
    /// Finds them, if the operands with the indices that `hidden_operands` returns are hidden.
    pub(super) fn new(words: &[u32], hidden_operands: impl Fn(&[u32], &Operands) -> Vec<usize>) -> Self {
        let mut foldable = Self::default();
        foldable.collect_parameters(words);
        loop {
            let mut changes = false;
            let mut function = 0;
            for (_, instruction) in instructions(words) {
                let Some(op) = opcode(instruction) else { continue };
                if op == Op::Function {
                    function = instruction[2];
                }
                let hidden = hidden_operands(instruction, &|id| foldable.known(id));
                for (id, known) in foldable.effects(op, instruction, function, &hidden) {
                    changes |= foldable.join(id, known);
                }
            }
            if !changes {
                return foldable;
            }
        }
    }

    /// Returns the fact that a compiler may know about a value.
    pub(super) fn known(&self, id: u32) -> Option<Known> {
        self.known.get(&id).copied()
    }

    fn collect_parameters(&mut self, words: &[u32]) {
        let mut function = 0;
        let mut pointers = HashSet::new();
        for (_, instruction) in instructions(words) {
            match (opcode(instruction), instruction) {
                (Some(Op::TypePointer), &[_, id, ..]) => {
                    pointers.insert(id);
                }
                (Some(Op::ConstantNull), &[_, _, id]) => {
                    self.nulls.insert(id);
                }
                (Some(Op::Function), &[_, _, id, ..]) => function = id,
                (Some(Op::FunctionParameter), &[_, ty, id]) => {
                    self.parameters.entry(function).or_default().push(id);
                    if pointers.contains(&ty) {
                        self.references.insert(id);
                    }
                }
                (Some(Op::AccessChain | Op::InBoundsAccessChain), &[_, _, id, base, ..]) => {
                    let root = self.root(base);
                    self.roots.insert(id, root);
                }
                _ => {}
            }
        }
    }

    fn root(&self, pointer: u32) -> u32 {
        self.roots.get(&pointer).copied().unwrap_or(pointer)
    }

    /// Adds what may be known of an id; returns whether it is new.
    fn join(&mut self, id: u32, known: Known) -> bool {
        let joined = match self.known(id) {
            None => known,
            Some(before) if before == known => return false,
            Some(_) => Known::Folded,
        };
        self.known.insert(id, joined) != Some(joined)
    }

    /// The values that become known by an instruction.
    fn effects(&self, op: Op, instruction: &[u32], function: u32, hidden: &[usize]) -> Vec<(u32, Known)> {
        let operand = |at: usize| {
            let id = *instruction.get(at)?;
            if hidden.contains(&at) {
                None
            } else {
                self.known(id)
            }
        };
        let either = |operands: &[usize]| operands.iter().filter_map(|&at| operand(at)).max();
        let all = |first: usize| {
            let operands = first..instruction.len();
            let is_known = operands.clone().all(|at| operand(at).is_some());
            (is_known && !operands.is_empty()).then_some(Known::Folded)
        };
        let result = |known: Option<Known>| -> Vec<(u32, Known)> {
            known.map(|known| (instruction[2], known)).into_iter().collect()
        };
        match op {
            Op::Constant if instruction[3..].iter().all(|word| word << 1 == 0) => result(Some(Known::Zero)),
            Op::Constant | Op::ConstantTrue => result(Some(Known::NonZero)),
            Op::ConstantFalse | Op::ConstantNull => result(Some(Known::Zero)),
            Op::ConstantComposite => {
                let parts = instruction[3..].iter();
                result(parts.filter_map(|&part| self.known(part)).max())
            }
            // A value that is read before it is written is rarely multiplied.
            Op::Variable if instruction.get(4).is_some_and(|id| self.nulls.contains(id)) => Vec::new(),
            Op::Variable => result(operand(4)),
            Op::Load => result(self.known(self.root(instruction[3]))),
            Op::Store => {
                let value = operand(2).map(|known| (self.root(instruction[1]), known));
                value.into_iter().collect()
            }
            Op::ReturnValue => operand(1).map(|known| (function, known)).into_iter().collect(),
            Op::FunctionCall => {
                let mut effects = result(self.known(instruction[3]));
                let parameters = self.parameters.get(&instruction[3]);
                for (at, &parameter) in (4..instruction.len()).zip(parameters.into_iter().flatten()) {
                    if self.references.contains(&parameter) {
                        // A value that either function stores is known in both.
                        let root = self.root(instruction[at]);
                        effects.extend(self.known(parameter).map(|known| (root, known)));
                        effects.extend(self.known(root).map(|known| (parameter, known)));
                    } else {
                        effects.extend(operand(at).map(|known| (parameter, known)));
                    }
                }
                effects
            }
            Op::Phi => {
                let values: Vec<usize> = (3..instruction.len()).step_by(2).collect();
                result(either(&values))
            }
            Op::CompositeConstruct => {
                let parts: Vec<usize> = (3..instruction.len()).collect();
                result(either(&parts))
            }
            Op::CompositeExtract | Op::VectorExtractDynamic | Op::CopyObject => result(either(&[3])),
            Op::VectorShuffle | Op::CompositeInsert => result(either(&[3, 4])),
            Op::Select => result(operand(3).and_then(|_| either(&[4, 5])).map(|_| Known::Folded)),
            Op::ExtInst => result(all(5)),
            Op::Function | Op::FunctionParameter | Op::AccessChain | Op::InBoundsAccessChain | Op::Undef => {
                Vec::new()
            }
            _ if has_type(op) && instruction.len() > 3 => result(all(3)),
            _ => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::opaque::words_of;
    use super::*;

    /// Returns the fact about the operand of `exp`, instruction 27 of GLSL's extended instructions.
    fn known(body: &str) -> Option<Known> {
        let words = words_of(&format!(
            "void set(out float x) {{ x = 2.0; }}
            float twice(float x) {{ return x + x; }}
            void mainImage(out vec4 c, in vec2 p) {{ {body} c = vec4(y); }}"
        ));
        let foldable = Foldable::new(&words, |_, _| Vec::new());
        let exp = instructions(&words)
            .find(|(_, instruction)| opcode(instruction) == Some(Op::ExtInst) && instruction[4] == 27)
            .unwrap();
        foldable.known(exp.1[5])
    }

    #[test]
    fn values_are_traced_to_constants() {
        for body in [
            "float x = 2.0; float y = exp(x);",
            "float x = p.x; if (p.y > 1.0) x = 2.0; float y = exp(x);",
            "float x; set(x); float y = exp(x);",
        ] {
            assert!(known(body).is_some(), "{body}");
        }
        for body in [
            "float x = 2.0; float y = exp(x - 1.0);",
            "bool b = false; float y = exp(float(b));",
            "float y = 0.0; for (int i = 0; i < 3; i++) y = exp(float(i));",
            "float x = 2.0; float y = exp(twice(x));",
        ] {
            assert_eq!(known(body), Some(Known::Folded), "{body}");
        }
    }

    #[test]
    fn values_of_pixels_and_uniforms_are_not_known() {
        for body in [
            "float x = p.x; float y = exp(x);",
            "float x = 2.0; float y = exp(x * p.x);",
            "float y = exp(iTime - 1.0);",
            "float y = exp(twice(p.x));",
        ] {
            assert_eq!(known(body), None, "{body}");
        }
    }
}
