//! Expansion of instructions that drivers compute differently, in SPIR-V of any producer.
//!
//! Each instruction such as `sin` or a matrix product becomes a call of a linked library function. All others
//! remain unchanged.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use ::spirv::{GlslStd450Op, Op};

use super::BOUND;
use crate::TranslateError;
use crate::backend::spirv::{HEADER_WORDS, has_type, instructions, opcode, words};
use crate::naga_ir::expand::{self as library, Need, library};

/// Expands a module so that every operation has the same bits on all conforming drivers.
///
/// # Errors
/// If the library cannot be linked.
pub fn spelled(spirv: &[u32]) -> Result<Vec<u32>, TranslateError> {
    if spirv.len() < HEADER_WORDS {
        return Err("these are no words of SPIR-V".into());
    }
    let types = Types::of(spirv);
    let mut needs = Vec::new();
    let mut sites = HashMap::new();
    for (at, instruction) in instructions(spirv) {
        if let Some((need, arguments)) = types.need(instruction) {
            sites.insert(at, (need.index_in(&mut needs), arguments));
        }
    }
    if needs.is_empty() {
        return Ok(spirv.to_vec());
    }
    let library = words(&library(&needs)?)?;
    let mut linker = Linker::new(spirv, &library)?;
    let calls = linker.link(needs.len())?;
    let mut expanded = spirv[..HEADER_WORDS].to_vec();
    for (at, instruction) in instructions(spirv) {
        match sites.get(&at) {
            Some((need, arguments)) => {
                let length = 4 + arguments.len() as u32;
                expanded.extend([length << 16 | Op::FunctionCall as u32]);
                expanded.extend([instruction[1], instruction[2], calls[*need]]);
                expanded.extend(arguments);
            }
            None => expanded.extend(instruction),
        }
    }
    Ok(linker.linked(&expanded))
}

/// The ids that matter for the expansion.
struct Types {
    /// The GLSL names of the types of 32-bit floats and unsigned integers.
    names: HashMap<u32, String>,
    /// The types of values.
    of: HashMap<u32, u32>,
    /// The import of GLSL's extended instructions.
    glsl: Option<u32>,
}

impl Types {
    fn of(spirv: &[u32]) -> Self {
        let mut types = Self {
            names: HashMap::new(),
            of: HashMap::new(),
            glsl: import(spirv),
        };
        for (_, instruction) in instructions(spirv) {
            let of = |names: &HashMap<u32, String>, id, kinds: [(&str, &str); 2]| {
                let name: &String = names.get(&id)?;
                let kind = kinds.iter().find(|kind| kind.0 == name)?;
                Some(kind.1.to_owned())
            };
            let name = match (opcode(instruction), &instruction[1..]) {
                (Some(Op::TypeFloat), [_, 32, ..]) => Some("float".to_owned()),
                (Some(Op::TypeInt), [_, 32, 0]) => Some("uint".to_owned()),
                (Some(Op::TypeVector), [_, scalar, size]) => {
                    let kind = of(&types.names, *scalar, [("float", "vec"), ("uint", "uvec")]);
                    kind.map(|kind| format!("{kind}{size}"))
                }
                (Some(Op::TypeMatrix), [_, column, columns]) => {
                    let column = types.names.get(column).and_then(|name| name.strip_prefix("vec"));
                    column.map(|rows| format!("mat{columns}x{rows}"))
                }
                (Some(op), &[ty, id, ..]) if has_type(op) => {
                    types.of.insert(id, ty);
                    None
                }
                _ => None,
            };
            if let Some(name) = name {
                types.names.insert(instruction[1], name);
            }
        }
        types
    }

    /// The library function for an instruction whose result depends on the driver, and its operands.
    fn need(&self, instruction: &[u32]) -> Option<(Need, Vec<u32>)> {
        let result = self.names.get(instruction.get(1)?)?;
        let (value, operands) = match (opcode(instruction)?, instruction.get(3..)?) {
            (Op::ExtInst, [set, number, operands @ ..]) if Some(*set) == self.glsl => {
                (glsl_name(GlslStd450Op::from_u32(*number)?)?, operands)
            }
            (Op::Dot, operands) => ("dot", operands),
            (Op::FMod, operands) => ("mod", operands),
            (Op::ConvertUToF, operands) => (result.as_str(), operands),
            (Op::MatrixTimesVector | Op::VectorTimesMatrix | Op::MatrixTimesMatrix, operands) => {
                ("*", operands)
            }
            _ => return None,
        };
        let types: Option<Vec<_>> = operands
            .iter()
            .map(|operand| self.names.get(self.of.get(operand)?).cloned())
            .collect();
        let value = match value {
            "*" => "a * b".to_owned(),
            name => format!("{name}({})", ["a", "b", "c"].get(..operands.len())?.join(", ")),
        };
        let need = Need {
            value,
            types: types?,
            result: result.clone(),
        };
        Some((need, operands.to_vec()))
    }
}

/// The GLSL name of a function whose last bits depend on the driver.
fn glsl_name(function: GlslStd450Op) -> Option<&'static str> {
    use GlslStd450Op as G;
    Some(match function {
        G::Radians => "radians",
        G::Degrees => "degrees",
        G::Sin => "sin",
        G::Cos => "cos",
        G::Tan => "tan",
        G::Asin => "asin",
        G::Acos => "acos",
        G::Atan | G::Atan2 => "atan",
        G::Sinh => "sinh",
        G::Cosh => "cosh",
        G::Tanh => "tanh",
        G::Asinh => "asinh",
        G::Acosh => "acosh",
        G::Atanh => "atanh",
        G::Pow => "pow",
        G::Exp => "exp",
        G::Log => "log",
        G::Exp2 => "exp2",
        G::Log2 => "log2",
        G::InverseSqrt => "inversesqrt",
        G::Fract => "fract",
        G::FMix => "mix",
        G::Step => "step",
        G::SmoothStep => "smoothstep",
        G::Length => "length",
        G::Distance => "distance",
        G::Cross => "cross",
        G::Normalize => "normalize",
        G::FaceForward => "faceforward",
        G::Reflect => "reflect",
        G::Refract => "refract",
        G::Determinant => "determinant",
        G::MatrixInverse => "inverse",
        G::UnpackSnorm2x16 => "unpackSnorm2x16",
        G::UnpackUnorm2x16 => "unpackUnorm2x16",
        G::UnpackHalf2x16 => "unpackHalf2x16",
        _ => return None,
    })
}

/// The id of the import of GLSL's extended instructions.
fn import(spirv: &[u32]) -> Option<u32> {
    let mut all = instructions(spirv).map(|(_, instruction)| instruction);
    let import = all.find(|instruction| {
        opcode(instruction) == Some(Op::ExtInstImport) && text(&instruction[2..]) == "GLSL.std.450"
    })?;
    Some(import[1])
}

/// Decodes a string literal: bytes in words, up to a zero.
fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    let text: Vec<u8> = bytes.take_while(|&byte| byte != 0).collect();
    String::from_utf8_lossy(&text).into_owned()
}

/// A type or constant without its id, to find equal declarations.
type Declaration = Vec<u32>;

/// Links library functions into a module. The library is written by naga and only has functions of plain
/// values, so that few instructions need support; the module may come from any compiler.
struct Linker<'a> {
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
    fn new(spirv: &[u32], library: &'a [u32]) -> Result<Self, TranslateError> {
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

    /// Translates all library functions. Returns the id of the function for each need.
    fn link(&mut self, needs: usize) -> Result<Vec<u32>, TranslateError> {
        let mut names = HashMap::new();
        let mut calls = vec![None; needs];
        for (_, instruction) in instructions(self.library) {
            match opcode(instruction) {
                Some(Op::Name) => {
                    names.insert(instruction[1], text(&instruction[2..]));
                }
                Some(Op::Function) => {
                    let name = names.get(&instruction[2]).map(String::as_str).unwrap_or_default();
                    // The functions that only call the others come last.
                    if library::is_library_caller(name) {
                        break;
                    }
                    let call = self.id(instruction[2])?;
                    if let Some(need) = library::need_index(name).and_then(|need| calls.get_mut(need)) {
                        *need = Some(call);
                    }
                    self.append(instruction)?;
                }
                _ if self.functions.is_empty() => {}
                _ => self.append(instruction)?,
            }
        }
        let calls: Option<Vec<_>> = calls.into_iter().collect();
        calls.ok_or_else(|| "a function of the library is missing".into())
    }

    /// Inserts the new declarations before the module's first function and appends the new functions.
    fn linked(self, spirv: &[u32]) -> Vec<u32> {
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
