//! The same words with what drivers differ in spelled in operations that they agree on, whoever wrote them: each instruction that
//! stands for `sin` and the like, or for a product of matrices, becomes a call of a function that is linked to them. All others stay.

use std::collections::HashMap;

use ::spirv::{GlslStd450Op, Op};

use super::link::Linker;
use super::{HEADER_WORDS, has_type, instructions, opcode, words};
use crate::naga_ir::library::{Need, library};

/// Words every operation of which has the same bits on all drivers that keep to their arithmetic.
///
/// # Errors
/// What cannot be linked.
pub fn spelled(spirv: &[u32]) -> Result<Vec<u32>, String> {
    if spirv.len() < HEADER_WORDS {
        return Err("these are no words of SPIR-V".to_owned());
    }
    let types = Types::of(spirv);
    let mut needs = Vec::new();
    let mut sites = HashMap::new();
    for (at, instruction) in instructions(spirv) {
        if let Some((need, arguments)) = types.need(instruction) {
            sites.insert(at, (need.among(&mut needs), arguments));
        }
    }
    if needs.is_empty() {
        return Ok(spirv.to_vec());
    }
    let library = words(&library(&needs)?)?;
    let mut linker = Linker::new(spirv, &library)?;
    let calls = linker.link(needs.len())?;
    let mut spelled = spirv[..HEADER_WORDS].to_vec();
    for (at, instruction) in instructions(spirv) {
        match sites.get(&at) {
            Some((need, arguments)) => {
                let length = 4 + arguments.len() as u32;
                spelled.extend([length << 16 | Op::FunctionCall as u32]);
                spelled.extend([instruction[1], instruction[2], calls[*need]]);
                spelled.extend(arguments);
            }
            None => spelled.extend(instruction),
        }
    }
    Ok(linker.linked(&spelled))
}

/// What ids stand for, as far as it matters here.
struct Types {
    /// GLSL's names of types of 32-bit floats and unsigned integers.
    names: HashMap<u32, String>,
    /// The types of values.
    of: HashMap<u32, u32>,
    /// The import of GLSL's instructions.
    glsl: Option<u32>,
}

impl Types {
    fn of(spirv: &[u32]) -> Self {
        let mut types = Self {
            names: HashMap::new(),
            of: HashMap::new(),
            glsl: super::link::import(spirv),
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

    /// What stands for an instruction, if drivers differ in it, and its operands.
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

/// The GLSL name of a function whose last bits drivers choose.
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
