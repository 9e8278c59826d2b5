//! Expansion of instructions that drivers compute differently, such as `sin` and matrix products, into
//! operations that they compute in the same way, in SPIR-V of any producer.
//!
//! A module that still contains the author's functions can then be compared bit by bit with the evaluator's
//! image. The expansions come from a library: a generated shader in strict form (`crate::lower_strict`),
//! whose functions are linked into the module. Each expanded instruction becomes a call, and all others
//! remain unchanged.

use std::collections::HashMap;
use std::fmt::Write as _;

use ::spirv::{GlslStd450Op, Op};
use toyproof_diagnostic::{Diagnostics, File, Files};
use toyproof_glsl as glsl;

use super::link::{self, Linker};
use crate::TranslateError;
use crate::backend::spirv::{HEADER_WORDS, has_type, instructions, opcode, words};
use crate::inexact::InexactFunction;
use crate::naga_ir::ValidModule;

/// Expands a module so that every operation has the same bits on all conforming drivers.
///
/// # Errors
/// If the library cannot be linked.
pub fn expanded(spirv: &[u32]) -> Result<Vec<u32>, TranslateError> {
    if spirv.len() < HEADER_WORDS {
        return Err("these are no words of SPIR-V".into());
    }
    let types = Types::new(spirv);
    let mut functions = Vec::new();
    let mut sites = HashMap::new();
    for (at, instruction) in instructions(spirv) {
        if let Some((function, arguments)) = types.library_function(instruction) {
            sites.insert(at, (function.index_in(&mut functions), arguments));
        }
    }
    if functions.is_empty() {
        return Ok(spirv.to_vec());
    }
    let library = words(&library(&functions)?)?;
    let mut linker = Linker::new(spirv, &library)?;
    let linked = linker.link(|name| name != MAIN_IMAGE)?;
    let id = |index| linked.get(&function_name(index)).copied();
    let ids: Option<Vec<u32>> = (0..functions.len()).map(id).collect();
    let ids = ids.ok_or("a function of the library is missing")?;
    let mut expanded = spirv[..HEADER_WORDS].to_vec();
    for (at, instruction) in instructions(spirv) {
        match sites.get(&at) {
            Some((function, arguments)) => {
                // The opcode's word, the result's type and id, and the function's id.
                let length = 4 + arguments.len() as u32;
                expanded.extend([length << 16 | Op::FunctionCall as u32]);
                expanded.extend([instruction[1], instruction[2], ids[*function]]);
                expanded.extend(arguments);
            }
            None => expanded.extend(instruction),
        }
    }
    Ok(linker.linked(&expanded))
}

/// The ids that the expansion needs.
struct Types {
    /// The GLSL names of the types of 32-bit floats and unsigned integers.
    names: HashMap<u32, String>,
    /// The types of values.
    of_values: HashMap<u32, u32>,
    /// The import of GLSL's extended instructions.
    glsl: Option<u32>,
}

impl Types {
    fn new(spirv: &[u32]) -> Self {
        let mut types = Self {
            names: HashMap::new(),
            of_values: HashMap::new(),
            glsl: link::import(spirv),
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
                    types.of_values.insert(id, ty);
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
    fn library_function(&self, instruction: &[u32]) -> Option<(LibraryFunction, Vec<u32>)> {
        let result = self.names.get(instruction.get(1)?)?;
        let (callee, operands) = match (opcode(instruction)?, instruction.get(3..)?) {
            (Op::ExtInst, [set, number, operands @ ..]) if Some(*set) == self.glsl => {
                let function = InexactFunction::from_extended(GlslStd450Op::from_u32(*number)?)?;
                (Some(function.built_in.name()), operands)
            }
            (Op::ConvertUToF, operands) => (Some(result.as_str()), operands),
            (Op::MatrixTimesVector | Op::VectorTimesMatrix | Op::MatrixTimesMatrix, operands) => {
                (None, operands)
            }
            (op, operands) => (Some(InexactFunction::from_core(op)?.built_in.name()), operands),
        };
        let types: Option<Vec<_>> = operands
            .iter()
            .map(|operand| self.names.get(self.of_values.get(operand)?).cloned())
            .collect();
        let value = match callee {
            Some(name) => format!("{name}({})", ["a", "b", "c"].get(..operands.len())?.join(", ")),
            None => "a * b".to_owned(),
        };
        let function = LibraryFunction {
            value,
            types: types?,
            result: result.clone(),
        };
        Some((function, operands.to_vec()))
    }
}

/// A function of the library.
#[derive(Debug, Clone, PartialEq, Eq)]
struct LibraryFunction {
    /// GLSL that computes the value from the parameters `a`, `b` and `c`.
    value: String,
    /// The types of the parameters.
    types: Vec<String>,
    /// The type of the value.
    result: String,
}

impl LibraryFunction {
    /// Returns the index of this function in a list, and appends it if missing.
    fn index_in(self, functions: &mut Vec<Self>) -> usize {
        let index = functions.iter().position(|known| *known == self);
        index.unwrap_or_else(|| {
            functions.push(self);
            functions.len() - 1
        })
    }
}

/// The entry function of the library. It calls the others so that none is removed. It is not linked: naga
/// writes it last, where linking stops.
const MAIN_IMAGE: &str = "mainImage";

/// The name of the library function with this index.
fn function_name(index: usize) -> String {
    format!("toyproof_library_{index}")
}

/// Builds a strict shader with these functions.
///
/// # Errors
/// Its first error message, in one line.
fn library(functions: &[LibraryFunction]) -> Result<ValidModule, TranslateError> {
    let mut text = String::new();
    let mut uses = String::new();
    for (index, function) in functions.iter().enumerate() {
        let parameters: Vec<_> = function
            .types
            .iter()
            .zip(["a", "b", "c"])
            .map(|(ty, name)| format!("{ty} {name}"))
            .collect();
        let arguments: Vec<_> = function.types.iter().map(|ty| format!("{ty}(p.x)")).collect();
        let (LibraryFunction { value, result, .. }, name) = (function, function_name(index));
        let _ = writeln!(
            text,
            "{result} {name}({}) {{ return {value}; }}",
            parameters.join(", ")
        );
        let _ = writeln!(uses, "{result} v{index} = {name}({});", arguments.join(", "));
    }
    let _ = writeln!(text, "void {MAIN_IMAGE}(out vec4 c, in vec2 p) {{\n{uses}}}");
    let mut files = Files::default();
    let file = files.add(File::new("<library>", &text));
    let first = |errors: Diagnostics| {
        let first = errors.first();
        TranslateError(first.map_or_else(String::new, |error| error.message.clone()))
    };
    let checked = glsl::check(&files, file, &glsl::Options::default()).map_err(first)?;
    ValidModule::parse(&crate::lower_strict(&checked)).map_err(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words_of_wgsl(text: &str) -> Vec<u32> {
        words(&ValidModule::of_wgsl(text).unwrap()).unwrap()
    }

    /// The numbers of instructions with these opcodes in the module's own functions, which precede the
    /// library's.
    fn counts<const N: usize>(spirv: &[u32], own: usize, ops: [Op; N]) -> [usize; N] {
        let code = || {
            let mut function = 0;
            instructions(spirv)
                .map(|(_, instruction)| instruction)
                .filter(move |instruction| {
                    function += usize::from(opcode(instruction) == Some(Op::Function));
                    (1..=own).contains(&function)
                })
        };
        ops.map(|op| {
            code()
                .filter(|instruction| opcode(instruction) == Some(op))
                .count()
        })
    }

    #[test]
    fn only_driver_dependent_operations_become_calls() {
        let text = "
            fn twice(x: f32) -> f32 { return sin(x) * 2.0; }
            @fragment fn main(@builtin(position) p: vec4f) -> @location(0) vec4f {
                var sum = vec2f();
                for (var i = 0; i < 3; i++) {
                    if p.x > 4.0 { sum += mat2x2f(p.xy, p.yx) * normalize(p.zw); }
                    sum.x += twice(sum.y) + f32(u32(p.x)) + f32(dot(vec2i(i), vec2i(2)));
                }
                return vec4f(sum, sqrt(dot(p, p)), pow(p.x, 2.0));
            }";
        let plain = words_of_wgsl(text);
        let expanded = expanded(&plain).unwrap();
        let own = counts(&plain, usize::MAX, [Op::Function])[0];
        let ops = [
            Op::FunctionCall,
            Op::ExtInst,
            Op::MatrixTimesVector,
            Op::ConvertUToF,
            Op::ConvertSToF,
            Op::Dot,
        ];
        let [calls, extended, product, from_uint, from_int, dot] = counts(&plain, own, ops);
        assert_eq!([product, from_uint, from_int, dot], [1; 4]);
        // `sin`, `normalize` and `pow`; `sqrt` and the clamping of `u32(p.x)` remain.
        let after = [calls + 6, extended - 3, 0, 0, 1, 0];
        assert_eq!(counts(&expanded, own, ops), after);
    }

    #[test]
    fn other_modules_do_not_change() {
        let text = "@fragment fn main(@builtin(position) p: vec4f) -> @location(0) vec4f { return sqrt(p) + floor(p); }";
        let plain = words_of_wgsl(text);
        assert_eq!(expanded(&plain).unwrap(), plain);
    }

    #[test]
    fn the_library_has_all_functions_of_all_sizes() {
        let text = "
            fn mixed(x: f32) -> f32 { return length(vec2f(atan2(x, 2.0), fract(x))) + mix(x, 1.0, x); }
            @fragment fn main(@builtin(position) p: vec4f) -> @location(0) vec4f {
                let m = mat3x3f(p.xyz, p.yzx, cross(p.xyz, p.zxy));
                return vec4f(transpose(m) * m * refract(p.xyz, p.yzw, 0.5) * determinant(m), mixed(p.x))
                    + smoothstep(p, p.yzwx, p.wzyx) + unpack2x16float(u32(p.x)).xyxy;
            }";
        let expanded = expanded(&words_of_wgsl(text)).unwrap();
        let types = Types::new(&expanded);
        let left =
            instructions(&expanded).filter(|(_, instruction)| types.library_function(instruction).is_some());
        // The library's own `unpackHalf2x16`, whose halves are exact.
        assert_eq!(left.count(), 2);
    }
}
