//! Links functions of one SPIR-V module into another.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use ::spirv::Op;

use crate::TranslateError;
use crate::backend::spirv::{BOUND, has_type, instructions, opcode};

/// The id of the import of GLSL's extended instructions.
pub(super) fn import(spirv: &[u32]) -> Option<u32> {
    let mut all = instructions(spirv).map(|(_, instruction)| instruction);
    let import = all.find(|instruction| {
        opcode(instruction) == Some(Op::ExtInstImport) && text(&instruction[2..]) == "GLSL.std.450"
    })?;
    Some(import[1])
}

/// Decodes a string literal: bytes in words, up to a zero.
pub(super) fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    let text: Vec<u8> = bytes.take_while(|&byte| byte != 0).collect();
    String::from_utf8_lossy(&text).into_owned()
}

/// A type or constant without its id, to find equal declarations.
type Declaration = Vec<u32>;

/// Links library functions into a module. The library is written by naga and only has functions of plain
/// values, so that few instructions need support; the module may come from any compiler.
pub(super) struct Linker<'a> {
    library: &'a [u32],
    /// The library's declarations of types and constants, by id.
    declared: HashMap<u32, &'a [u32]>,
    /// The ids of the library's functions and of the values in them.
    local: HashSet<u32>,
    /// The module's declarations.
    known: HashMap<Declaration, u32>,
    /// The module's ids, by the library's.
    ids: HashMap<u32, u32>,
    bound: u32,
    /// Declarations to add to the module. The functions to add follow.
    globals: Vec<u32>,
    functions: Vec<u32>,
}

impl<'a> Linker<'a> {
    pub(super) fn new(spirv: &[u32], library: &'a [u32]) -> Result<Self, TranslateError> {
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
            Some((without_id(instruction), id))
        });
        let glsl = import(library).map(|library_id| {
            let module_id = import(spirv).ok_or("the module imports nothing of GLSL's")?;
            Ok::<_, TranslateError>((library_id, module_id))
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

    /// Translates the library's functions up to the first that is not wanted. Returns their ids by name.
    pub(super) fn link(
        &mut self,
        is_wanted: impl Fn(&str) -> bool,
    ) -> Result<HashMap<String, u32>, TranslateError> {
        let mut names = HashMap::new();
        let mut linked = HashMap::new();
        for (_, instruction) in instructions(self.library) {
            match opcode(instruction) {
                Some(Op::Name) => {
                    names.insert(instruction[1], text(&instruction[2..]));
                }
                Some(Op::Function) => {
                    let name = names.remove(&instruction[2]).unwrap_or_default();
                    if !is_wanted(&name) {
                        break;
                    }
                    linked.insert(name, self.id(instruction[2])?);
                    self.append(instruction)?;
                }
                _ if self.functions.is_empty() => {}
                _ => self.append(instruction)?,
            }
        }
        Ok(linked)
    }

    /// Inserts the new declarations before the module's first function and appends the new functions.
    pub(super) fn linked(self, spirv: &[u32]) -> Vec<u32> {
        let first = instructions(spirv).find(|(_, instruction)| opcode(instruction) == Some(Op::Function));
        let first = first.map_or(spirv.len(), |(at, _)| at);
        let mut linked = [&spirv[..first], &self.globals, &spirv[first..], &self.functions].concat();
        linked[BOUND] = self.bound;
        linked
    }

    fn append(&mut self, instruction: &[u32]) -> Result<(), TranslateError> {
        let translated = self.translate(instruction)?;
        self.functions.extend(translated);
        Ok(())
    }

    /// Translates an instruction to the module's ids.
    fn translate(&mut self, instruction: &[u32]) -> Result<Vec<u32>, TranslateError> {
        let mut words = instruction.to_vec();
        let literals: HashSet<usize> = literal_words(instruction)?.collect();
        for (at, word) in words.iter_mut().enumerate().skip(1) {
            if !literals.contains(&at) {
                *word = self.id(*word)?;
            }
        }
        Ok(words)
    }

    /// Translates an id. Types and constants that the module has are not declared twice (section 2.8).
    fn id(&mut self, library_id: u32) -> Result<u32, TranslateError> {
        if let Some(&module_id) = self.ids.get(&library_id) {
            return Ok(module_id);
        }
        let fresh = |linker: &mut Self| {
            linker.bound += 1;
            linker.bound - 1
        };
        let module_id = match self.declared.get(&library_id).copied() {
            None if self.local.contains(&library_id) => fresh(self),
            None => return Err("a function of the library refers to its surroundings".into()),
            Some(declaration) => {
                // A placeholder for its own id while its operands are translated.
                self.ids.insert(library_id, 0);
                let mut declaration = self.translate(declaration)?;
                let key = without_id(&declaration);
                if let Some(&known) = self.known.get(&key) {
                    known
                } else {
                    let id = fresh(self);
                    let at = result_at(&declaration).ok_or("a declaration of the library has no id")?;
                    declaration[at] = id;
                    self.globals.extend(&declaration);
                    self.known.insert(key, id);
                    id
                }
            }
        };
        self.ids.insert(library_id, module_id);
        Ok(module_id)
    }
}

/// The position of the id in a type or constant declaration.
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

fn without_id(instruction: &[u32]) -> Declaration {
    let mut key = instruction.to_vec();
    if let Some(at) = result_at(instruction) {
        key.remove(at);
    }
    key
}

/// The words of an instruction that are not ids (section 3.49 of the specification).
///
/// # Errors
/// If the instruction is not one that functions of plain values consist of.
fn literal_words(instruction: &[u32]) -> Result<Range<usize>, TranslateError> {
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
        // All operands of arithmetic, comparisons, bit operations and conversions are ids.
        op if is_arithmetic(op) => end..end,
        op => return Err(TranslateError(format!("{op:?} in the library"))),
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
