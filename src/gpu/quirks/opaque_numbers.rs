//! Optimization barriers: values that a driver's compiler cannot recognize as uniform or constant.

use std::collections::{HashMap, HashSet};

use spirv::{GlslStd450Op, Op, StorageClass};
use toyproof_translate::backend::spirv::{has_type, instructions, is_product, opcode, push};

use super::foldable::{Foldable, Known, Operands};
use super::opaque::{Opaque, functions_start};

/// Combines some numbers by or with the bits of `gl_FragCoord.z`, which are 0 if an image is
/// rendered with triangles at depth 0. Their values do not change; neither does a module without
/// `gl_FragCoord`. An exclusive or would be undone where a number is hidden twice, as a column and in a
/// matrix. The numbers are:
///
/// - Numbers and vectors loaded from a uniform block. If a loop or a branch depends on a number, Mesa checks
///   whether it is computed from uniforms and constants only, and traverses the expression as a tree although
///   it is a graph: the expanded `sin(iTime)` has some hundred operations and more paths than can be
///   traversed. The traversal ends at the first operand that depends on the pixel.
/// - Zeros that are multiplied, divided or stored, and other operands of products that Mesa may find to be
///   zero by folding constants. Mesa's llvmpipe treats the product of a constant zero and any value, and its
///   quotient, as zero even if it is NaN, and a quotient by it as anything, regardless of decorations.
/// - Constants whose operations Mesa folds differently from the processor: it does not flush
///   denormal products and bit patterns, and it treats all derivatives of constants as 0.
/// - Denormal constants, which Mesa and `SwiftShader` do not treat as zeros when they fold them.
/// - −2³¹ where it is compared or stored. To count a loop's iterations, Mesa divides what a variable runs
///   through by its step, and −2³¹ / −1 terminates the process.
pub(crate) fn with_opaque_numbers(words: &[u32]) -> Vec<u32> {
    let Some(mut rewriter) = Rewriter::new(words) else {
        return words.to_vec();
    };
    let foldable = Foldable::new(words, |instruction, known| {
        rewriter.hidden_operands(instruction, known)
    });
    let mut code = Vec::new();
    let start = functions_start(words);
    for (_, instruction) in instructions(words).filter(|(at, _)| *at >= start) {
        match (opcode(instruction), instruction) {
            (Some(Op::Load), &[_, ty, result, pointer, ..]) if rewriter.is_in_block(pointer) => {
                match rewriter.shapes.get(&ty).copied() {
                    Some(shape) => {
                        let loaded = rewriter.opaque.value(&mut code, Op::Load, ty, &instruction[3..]);
                        rewriter.hide(&mut code, shape, result, loaded);
                    }
                    None => code.extend(instruction),
                }
            }
            _ => {
                let mut changed = instruction.to_vec();
                for operand in rewriter.hidden_operands(instruction, &|id| foldable.known(id)) {
                    changed[operand] = rewriter.hide_operand(&mut code, instruction[operand]);
                }
                code.extend(changed);
            }
        }
    }
    rewriter.opaque.finish(&words[..start], &code)
}

/// Whether an instruction compares integers.
fn is_comparison(op: Op) -> bool {
    (Op::IEqual as u32..=Op::SLessThanEqual as u32).contains(&(op as u32))
}

/// The indices of an instruction's operands that are values, and in whose place another value may be.
fn values(op: Op, instruction: &[u32]) -> std::ops::Range<usize> {
    let end = instruction.len();
    match op {
        Op::Phi | Op::Variable => 0..0,
        Op::ReturnValue => 1..end,
        Op::Store => 2..3,
        Op::FunctionCall => 4..end,
        Op::ExtInst => 5..end,
        Op::CompositeExtract => 3..4,
        Op::CompositeInsert | Op::VectorShuffle => 3..5,
        _ if has_type(op) => end.min(3)..end,
        _ => 0..0,
    }
}

/// The type of a number or a vector.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Shape {
    ty: u32,
    is_float: bool,
    components: u32,
}

struct Rewriter {
    opaque: Opaque,
    /// The types of 32-bit numbers and vectors that can be hidden, of either sign.
    shapes: HashMap<u32, Shape>,
    /// The pointer types into uniform blocks.
    into_blocks: Vec<u32>,
    /// The type of each value.
    types: HashMap<u32, u32>,
    /// The constants −2³¹.
    least: Vec<u32>,
    /// Denormal constants, composites of them, variables that are initialized with them, and values that are
    /// loaded from these.
    denormals: HashSet<u32>,
    /// The type of the columns and their number, for each type of matrices.
    matrices: HashMap<u32, (u32, u32)>,
}

impl Rewriter {
    /// Collects the facts about a module; `None` if it has no `gl_FragCoord`.
    fn new(words: &[u32]) -> Option<Self> {
        let mut rewriter = Self {
            opaque: Opaque::new(words)?,
            shapes: HashMap::new(),
            into_blocks: Vec::new(),
            types: HashMap::new(),
            least: Vec::new(),
            denormals: HashSet::new(),
            matrices: HashMap::new(),
        };
        for (_, instruction) in instructions(words) {
            let Some(op) = opcode(instruction) else { continue };
            let shape = match (op, &instruction[1..]) {
                (Op::TypeFloat, &[id, 32]) => Some((id, true, 1)),
                (Op::TypeInt, &[id, 32, _]) => Some((id, false, 1)),
                (Op::TypeVector, &[id, of, components]) => {
                    let of = rewriter.shapes.get(&of);
                    of.map(|of| (id, of.is_float, components))
                }
                (Op::TypePointer, &[id, class, _]) => {
                    if class == StorageClass::Uniform as u32 {
                        rewriter.into_blocks.push(id);
                    }
                    None
                }
                (Op::TypeMatrix, &[id, column, columns]) => {
                    rewriter.matrices.insert(id, (column, columns));
                    None
                }
                (_, &[ty, id, ..]) if has_type(op) => {
                    rewriter.types.insert(id, ty);
                    let is_float = rewriter.shapes.get(&ty).map(|shape| shape.is_float);
                    match (op, is_float, &instruction[3..]) {
                        (Op::Constant, Some(false), &[0x8000_0000]) => rewriter.least.push(id),
                        (Op::Constant, Some(true), &[bits]) if f32::from_bits(bits).is_subnormal() => {
                            rewriter.denormals.insert(id);
                        }
                        // A variable may be initialized with one, and is then loaded.
                        (
                            Op::ConstantComposite
                            | Op::Variable
                            | Op::AccessChain
                            | Op::Load
                            | Op::CompositeExtract,
                            _,
                            parts,
                        ) if parts.iter().any(|part| rewriter.denormals.contains(part)) => {
                            rewriter.denormals.insert(id);
                        }
                        _ => {}
                    }
                    None
                }
                _ => None,
            };
            if let Some((ty, is_float, components)) = shape {
                let shape = Shape {
                    ty,
                    is_float,
                    components,
                };
                rewriter.shapes.insert(ty, shape);
            }
        }
        Some(rewriter)
    }

    /// Whether a pointer points into a uniform block.
    fn is_in_block(&self, pointer: u32) -> bool {
        let ty = self.types.get(&pointer);
        ty.is_some_and(|ty| self.into_blocks.contains(ty))
    }

    /// Whether a value consists of floats and can be hidden.
    fn is_float(&self, value: u32) -> bool {
        self.types.get(&value).is_some_and(|ty| {
            self.matrices.contains_key(ty) || self.shapes.get(ty).is_some_and(|shape| shape.is_float)
        })
    }

    /// The indices of an instruction's operands that are hidden, by the facts about their values.
    fn hidden_operands(&self, instruction: &[u32], known: &Operands) -> Vec<usize> {
        let Some(op) = opcode(instruction) else {
            return Vec::new();
        };
        let mut hidden = self.hidden_by_operation(op, instruction, known);
        for at in values(op, instruction) {
            if self.denormals.contains(&instruction[at]) && !hidden.contains(&at) {
                hidden.push(at);
            }
        }
        hidden
    }

    /// The indices of the operands that are hidden because of what Mesa does with the results of an
    /// operation.
    fn hidden_by_operation(&self, op: Op, instruction: &[u32], known: &Operands) -> Vec<usize> {
        use GlslStd450Op as G;
        let from = |first: usize, is_hidden: &dyn Fn(Known) -> bool| -> Vec<usize> {
            let operands = first..instruction.len();
            operands
                .filter(|&at| known(instruction[at]).is_some_and(is_hidden))
                .filter(|&at| self.is_float(instruction[at]))
                .collect()
        };
        let any = |_| true;
        let zero = |known| known != Known::NonZero;
        let literal_zero = |known| known == Known::Zero;
        match op {
            _ if is_product(op) || matches!(op, Op::FDiv | Op::FRem | Op::FMod) => {
                let all = from(3, &any);
                // The result may be denormal.
                let is_constant = all.len() == instruction.len() - 3;
                if is_constant { all } else { from(3, &zero) }
            }
            Op::CompositeConstruct => from(3, &literal_zero),
            Op::Store if self.least.contains(&instruction[2]) => vec![2],
            Op::Store => from(2, &literal_zero),
            _ if is_comparison(op) => {
                let is_least = |at: &usize| self.least.contains(&instruction[*at]);
                [3, 4].into_iter().filter(is_least).collect()
            }
            Op::ReturnValue => from(1, &literal_zero),
            // Otherwise, operations of the function would have to be hidden for one of its calls.
            Op::FunctionCall => from(4, &any),
            Op::DPdx | Op::DPdy | Op::Fwidth | Op::DPdxFine | Op::DPdyFine | Op::FwidthFine => from(3, &any),
            Op::ExtInst => match G::from_u32(instruction[4]) {
                Some(G::FMix | G::Fma) => from(5, &any),
                Some(G::UnpackHalf2x16) if known(instruction[5]).is_some() => vec![5],
                _ => Vec::new(),
            },
            Op::Bitcast => {
                let is_float = self
                    .shapes
                    .get(&instruction[1])
                    .is_some_and(|shape| shape.is_float);
                if is_float && known(instruction[3]).is_some() {
                    vec![3]
                } else {
                    Vec::new()
                }
            }
            _ => Vec::new(),
        }
    }

    /// Hides a number, a vector or a matrix.
    fn hide_operand(&mut self, code: &mut Vec<u32>, operand: u32) -> u32 {
        let Some(&ty) = self.types.get(&operand) else {
            return operand;
        };
        if let Some(&(column_type, columns)) = self.matrices.get(&ty) {
            let columns: Vec<u32> = (0..columns)
                .map(|at| {
                    let column = self
                        .opaque
                        .value(code, Op::CompositeExtract, column_type, &[operand, at]);
                    self.types.insert(column, column_type);
                    self.hide_operand(code, column)
                })
                .collect();
            return self.opaque.value(code, Op::CompositeConstruct, ty, &columns);
        }
        let Some(&shape) = self.shapes.get(&ty) else {
            return operand;
        };
        let hidden = self.opaque.fresh();
        self.hide(code, shape, hidden, operand);
        hidden
    }

    /// Appends instructions that compute the id `hidden` with the value of `known`.
    fn hide(&mut self, code: &mut Vec<u32>, shape: Shape, hidden: u32, known: u32) {
        let Shape {
            ty,
            is_float,
            components,
        } = shape;
        let whole = self.opaque.int_type(components);
        let mut zero = self.opaque.zero(code);
        if components > 1 {
            let zeros = vec![zero; components as usize];
            zero = self.opaque.value(code, Op::CompositeConstruct, whole, &zeros);
        }
        if is_float {
            let bits = self.opaque.value(code, Op::Bitcast, whole, &[known]);
            let bits = self.opaque.value(code, Op::BitwiseOr, whole, &[bits, zero]);
            push(code, Op::Bitcast, &[ty, hidden, bits]);
        } else {
            push(code, Op::BitwiseOr, &[ty, hidden, known, zero]);
        }
    }
}

#[cfg(test)]
mod tests {
    use spirv::{BuiltIn, Decoration};
    use toyproof_translate::backend::spirv::BOUND;

    use super::super::opaque::words_of;
    use super::*;

    fn all(words: &[u32], op: Op) -> Vec<&[u32]> {
        let found = instructions(words).filter(|(_, instruction)| opcode(instruction) == Some(op));
        found.map(|(_, instruction)| instruction).collect()
    }

    /// The number of hidden numbers of a shader with these statements, without those around `mainImage`.
    fn hidden_by(statements: &str) -> usize {
        let count = |statements: &str| {
            let shader = format!(
                "void mainImage(out vec4 c, in vec2 p) {{ vec4 v = vec4(p, p); {statements} c = v; }}"
            );
            all(&with_opaque_numbers(&words_of(&shader)), Op::BitwiseOr).len()
        };
        count(statements) - count("")
    }

    #[test]
    fn only_numbers_loaded_from_blocks_are_hidden() {
        let plain = words_of(
            "float late() { return iTime; }
            void mainImage(out vec4 c, in vec2 p) { c = vec4(late(), p / iResolution.xy, iMouse.x + float(iFrame)); }",
        );
        let opaque = with_opaque_numbers(&plain);
        let hidden = all(&opaque, Op::BitwiseOr).len();
        assert_eq!(all(&plain, Op::BitwiseOr).len(), 0);
        let statements = "v += vec4(iTime, p / iResolution.xy, iMouse.x + float(iFrame));";
        assert_eq!(
            hidden_by(statements),
            4,
            "the time, the resolution, the mouse and the frame"
        );
        let loads =
            |words| -> Vec<Vec<u32>> { all(words, Op::Load).iter().map(|load| load.to_vec()).collect() };
        assert_eq!(
            loads(&opaque).len(),
            loads(&plain).len() + hidden,
            "the coordinate beside each"
        );
        // Each hidden number keeps its id, and ids are unique.
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
    fn multiplied_zeros_are_hidden() {
        assert_eq!(hidden_by("v *= vec4(1, 0.5, 2, 1);"), 0);
        assert_eq!(hidden_by("v = max(v, 0.0) - vec4(0, 1, 2, 3);"), 0);
        for body in [
            "v.x *= 0.0;",
            "v *= vec4(1, 0.5, 0, 1);",
            "v *= -0.0;",
            "v.x = 0.0 / v.y;",
            "v.x = dot(v, vec4(1, 0, 1, 1));",
            "v = vec4(p.x, 1, 0, 1);",
        ] {
            assert!(hidden_by(body) >= 1, "{body}");
        }
        assert!(hidden_by("v.xy = mat2(1, 0, 2, 3) * v.xy;") >= 2, "both columns");
        for body in [
            "float z = 0.0; v.x *= z;",
            "float z = 1.0; z -= 1.0; v.x *= z;",
            "bool b = false; v.x *= float(b);",
            "v.x *= float(iFrame > 3) * p.x; float z = floor(0.5); v.x /= z;",
            "vec2 d = vec2(0.0, 1.0); v.xy = d * v.x;",
            "v.x = dFdx(1.0);",
            "uint u = 5u; v.x = uintBitsToFloat(u);",
            "int k = int(p.x); if (-2147483647 - 1 == k--) v.x = float(k);",
            "float tiny = 1e-40; v.x = float(tiny > 0.0);",
            "v.xy = p.x > 1.0 ? vec2(1e-40, 2.0) : p;",
        ] {
            let uniforms = usize::from(body.contains("iFrame"));
            assert!(hidden_by(body) > uniforms, "{body}");
        }
    }

    #[test]
    fn a_module_without_frag_coord_does_not_change() {
        let mut words = words_of("void mainImage(out vec4 c, in vec2 p) { c = vec4(iTime); }");
        let built_in = instructions(&words).find(|(_, instruction)| {
            opcode(instruction) == Some(Op::Decorate) && instruction[2] == Decoration::BuiltIn as u32
        });
        let at = built_in.unwrap().0;
        assert_ne!(with_opaque_numbers(&words), words);
        words[at + 3] = BuiltIn::FrontFacing as u32;
        assert_eq!(with_opaque_numbers(&words), words);
        assert!(with_opaque_numbers(&[]).is_empty());
    }
}
