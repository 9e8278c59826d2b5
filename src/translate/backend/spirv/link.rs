//! Brings the functions of one module of SPIR-V into another. The first is naga's, of functions of plain values, so that few
//! instructions have to be known; the other may be anybody's.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use ::spirv::Op;

use super::{BOUND, has_type, instructions, opcode};
use crate::naga_ir::library;

/// The id under which GLSL's extended instructions are imported.
pub(super) fn import(spirv: &[u32]) -> Option<u32> {
    let mut all = instructions(spirv).map(|(_, instruction)| instruction);
    let import = all.find(|instruction| {
        opcode(instruction) == Some(Op::ExtInstImport) && text(&instruction[2..]) == "GLSL.std.450"
    })?;
    Some(import[1])
}

/// A string of the module's: bytes in words, up to a zero.
fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    let text: Vec<u8> = bytes.take_while(|&byte| byte != 0).collect();
    String::from_utf8_lossy(&text).into_owned()
}

/// A type or constant without its id: what it is by.
type Meaning = Vec<u32>;

pub(super) struct Linker<'a> {
    library: &'a [u32],
    /// Where the library declares types and constants, by id.
    declared: HashMap<u32, &'a [u32]>,
    /// The ids of what its functions are made of, and of those.
    local: HashSet<u32>,
    /// What the module declares.
    known: HashMap<Meaning, u32>,
    /// What an id of the library is in the module.
    ids: HashMap<u32, u32>,
    bound: u32,
    /// What is to be declared in the module, and the functions.
    globals: Vec<u32>,
    functions: Vec<u32>,
}

impl<'a> Linker<'a> {
    pub(super) fn new(spirv: &[u32], library: &'a [u32]) -> Result<Self, String> {
        let declared =
            instructions(library).filter_map(|(_, instruction)| Some((result(instruction)?, instruction)));
        let code =
            instructions(library).skip_while(|(_, instruction)| opcode(instruction) != Some(Op::Function));
        let local = code.filter_map(|(_, instruction)| match opcode(instruction)? {
            Op::Label => Some(instruction[1]),
            op if has_type(op) => instruction.get(2).copied(),
            _ => None,
        });
        let known = instructions(spirv).filter_map(|(_, instruction)| {
            let id = result(instruction)?;
            Some((meaning(instruction), id))
        });
        let glsl = import(library).map(|theirs| {
            let ours = import(spirv).ok_or("the module imports nothing of GLSL's")?;
            Ok::<_, String>((theirs, ours))
        });
        Ok(Self {
            library,
            declared: declared.collect(),
            local: local.collect(),
            known: known.collect(),
            ids: glsl.transpose()?.into_iter().collect(),
            bound: spirv[BOUND],
            globals: Vec::new(),
            functions: Vec::new(),
        })
    }

    /// Brings all functions but the surroundings; says which stands for which need.
    pub(super) fn link(&mut self, needs: usize) -> Result<Vec<u32>, String> {
        let mut names = HashMap::new();
        let mut calls = vec![None; needs];
        for (_, instruction) in instructions(self.library) {
            match opcode(instruction) {
                Some(Op::Name) => {
                    names.insert(instruction[1], text(&instruction[2..]));
                }
                Some(Op::Function) => {
                    let name = names.get(&instruction[2]).map(String::as_str).unwrap_or_default();
                    // What calls the functions stands behind them.
                    if library::is_surroundings(name) {
                        break;
                    }
                    let call = self.id(instruction[2])?;
                    if let Some(need) = library::need(name).and_then(|need| calls.get_mut(need)) {
                        *need = Some(call);
                    }
                    self.bring(instruction)?;
                }
                _ if self.functions.is_empty() => {}
                _ => self.bring(instruction)?,
            }
        }
        let calls: Option<Vec<_>> = calls.into_iter().collect();
        calls.ok_or_else(|| "a function of the library is missing".to_owned())
    }

    /// The module with what was brought: declarations before its first function, functions behind all.
    pub(super) fn linked(self, spirv: &[u32]) -> Vec<u32> {
        let first = instructions(spirv).find(|(_, instruction)| opcode(instruction) == Some(Op::Function));
        let first = first.map_or(spirv.len(), |(at, _)| at);
        let mut linked = [&spirv[..first], &self.globals, &spirv[first..], &self.functions].concat();
        linked[BOUND] = self.bound;
        linked
    }

    fn bring(&mut self, instruction: &[u32]) -> Result<(), String> {
        let brought = self.translated(instruction)?;
        self.functions.extend(brought);
        Ok(())
    }

    /// The instruction with the module's ids.
    fn translated(&mut self, instruction: &[u32]) -> Result<Vec<u32>, String> {
        let mut words = instruction.to_vec();
        let literals: HashSet<usize> = literals(instruction)?.collect();
        for (at, word) in words.iter_mut().enumerate().skip(1) {
            if !literals.contains(&at) {
                *word = self.id(*word)?;
            }
        }
        Ok(words)
    }

    /// What an id is in the module. Types and constants that are there are not declared twice, as section 2.8 has it.
    fn id(&mut self, theirs: u32) -> Result<u32, String> {
        if let Some(&ours) = self.ids.get(&theirs) {
            return Ok(ours);
        }
        let fresh = |linker: &mut Self| {
            linker.bound += 1;
            linker.bound - 1
        };
        let ours = match self.declared.get(&theirs).copied() {
            None if self.local.contains(&theirs) => fresh(self),
            None => return Err("a function of the library refers to its surroundings".to_owned()),
            Some(declaration) => {
                // Its own id stands for itself while its operands are translated.
                self.ids.insert(theirs, 0);
                let mut declaration = self.translated(declaration)?;
                let meaning = meaning(&declaration);
                if let Some(&known) = self.known.get(&meaning) {
                    known
                } else {
                    let id = fresh(self);
                    let at = result_at(&declaration).ok_or("a declaration of the library has no id")?;
                    declaration[at] = id;
                    self.globals.extend(&declaration);
                    self.known.insert(meaning, id);
                    id
                }
            }
        };
        self.ids.insert(theirs, ours);
        Ok(ours)
    }
}

/// The place of the id of a type or constant.
fn result_at(instruction: &[u32]) -> Option<usize> {
    match opcode(instruction)? {
        Op::TypeVoid
        | Op::TypeBool
        | Op::TypeInt
        | Op::TypeFloat
        | Op::TypeVector
        | Op::TypeMatrix
        | Op::TypePointer
        | Op::TypeFunction => Some(1),
        Op::Constant | Op::ConstantTrue | Op::ConstantFalse | Op::ConstantComposite | Op::ConstantNull => {
            Some(2)
        }
        _ => None,
    }
}

fn result(instruction: &[u32]) -> Option<u32> {
    result_at(instruction).and_then(|at| instruction.get(at).copied())
}

fn meaning(instruction: &[u32]) -> Meaning {
    let mut meaning = instruction.to_vec();
    if let Some(at) = result_at(instruction) {
        meaning.remove(at);
    }
    meaning
}

/// Which words of an instruction are no ids, as the specification's section 3.49 has it.
///
/// # Errors
/// If the instruction is none that functions of plain values are made of.
fn literals(instruction: &[u32]) -> Result<Range<usize>, String> {
    let end = instruction.len();
    let op = opcode(instruction);
    Ok(match op.ok_or("an instruction that is not known")? {
        Op::TypeInt | Op::TypeFloat => 2..end,
        Op::TypeVector | Op::TypeMatrix | Op::Constant => 3..end,
        Op::TypePointer | Op::SelectionMerge => 2..3,
        Op::Function | Op::Variable | Op::LoopMerge => 3..4,
        Op::ExtInst => 4..5,
        Op::CompositeExtract => 4..end,
        Op::CompositeInsert | Op::VectorShuffle => 5..end,
        Op::TypeVoid
        | Op::TypeBool
        | Op::TypeFunction
        | Op::ConstantTrue
        | Op::ConstantFalse
        | Op::ConstantComposite
        | Op::ConstantNull
        | Op::FunctionParameter
        | Op::FunctionEnd
        | Op::FunctionCall
        | Op::Label
        | Op::Branch
        | Op::BranchConditional
        | Op::Return
        | Op::ReturnValue
        | Op::Unreachable
        | Op::Kill
        | Op::Phi
        | Op::Undef
        | Op::Load
        | Op::Store
        | Op::AccessChain => end..end,
        // Of arithmetic, comparison, bits and conversion all operands are ids.
        op if is_arithmetic(op) => end..end,
        op => return Err(format!("{op:?} in the library")),
    })
}

fn is_arithmetic(op: Op) -> bool {
    let op = op as u32;
    [
        Op::VectorExtractDynamic as u32..=Op::VectorInsertDynamic as u32,
        Op::CompositeConstruct as u32..=Op::CompositeConstruct as u32,
        Op::CopyObject as u32..=Op::Transpose as u32,
        Op::ConvertFToU as u32..=Op::Bitcast as u32,
        Op::SNegate as u32..=Op::SMulExtended as u32,
        Op::Any as u32..=Op::FUnordGreaterThanEqual as u32,
        Op::ShiftRightLogical as u32..=Op::BitCount as u32,
    ]
    .iter()
    .any(|range| range.contains(&op))
}
