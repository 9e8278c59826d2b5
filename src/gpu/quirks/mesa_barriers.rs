//! Optimization barriers for Mesa: values that its compiler cannot recognize as uniform or constant.

use std::collections::HashMap;

use spirv::{BuiltIn, Decoration, Op, StorageClass};

use toyproof_translate::backend::spirv::{BOUND, has_type, instructions, is_product, opcode};

/// Combines some numbers by exclusive or with the bits of `gl_FragCoord.z`, which are 0 if an image is
/// rendered with triangles at depth 0. Their values do not change, nor does a module without `gl_FragCoord`.
/// The numbers are:
///
/// - Numbers and vectors loaded from a uniform block. If a loop or a branch depends on a number, Mesa checks
///   whether it is computed from uniforms and constants only, and traverses the expression as a tree although
///   it is a graph: the expanded `sin(iTime)` has some hundred operations and more paths than can be
///   traversed. The traversal ends at the first operand that depends on the pixel.
/// - Zeros that are multiplied, divided or passed to where they may be. Mesa's llvmpipe takes the product of
///   a constant zero and any value, and its quotient, for zero even if it is NaN, regardless of decorations.
#[must_use]
pub(crate) fn with_opaque_numbers(words: &[u32]) -> Vec<u32> {
    let Some(mut rewriter) = Rewriter::of(words) else {
        return words.to_vec();
    };
    let mut code = Vec::new();
    let mut first_function = words.len();
    for (at, instruction) in instructions(words) {
        let op = opcode(instruction);
        if op == Some(Op::Function) {
            first_function = first_function.min(at);
        }
        if at < first_function {
            continue;
        }
        match (op, instruction) {
            (Some(Op::Load), &[_, ty, result, pointer, ..]) if rewriter.is_in_block(pointer) => {
                match rewriter.shapes.get(&ty).copied() {
                    Some(shape) => {
                        let loaded = rewriter.value(&mut code, Op::Load, ty, &instruction[3..]);
                        rewriter.hide(&mut code, shape, result, loaded);
                    }
                    None => code.extend(instruction),
                }
            }
            (Some(op), _) => {
                let mut instruction = instruction.to_vec();
                for operand in instruction.iter_mut().skip(first_hidden_operand(op)) {
                    *operand = rewriter.hide_zero(&mut code, *operand);
                }
                code.extend(instruction);
            }
            _ => code.extend(instruction),
        }
    }
    let mut whole = [&words[..first_function], &rewriter.declared, &code].concat();
    whole[BOUND] = rewriter.bound;
    whole
}

/// The index of an instruction's first operand that is multiplied, divided or passed on; all operands from
/// there are values. Beyond the end for other instructions.
fn first_hidden_operand(op: Op) -> usize {
    match op {
        Op::FDiv | Op::CompositeConstruct => 3,
        op if is_product(op) => 3,
        Op::FunctionCall => 4,
        Op::ReturnValue => 1,
        _ => usize::MAX,
    }
}

/// The type of a number or a vector.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Shape {
    ty: u32,
    is_float: bool,
    components: u32,
}

#[derive(Clone)]
enum Zero {
    Number(Shape),
    /// The type and the columns of a matrix.
    Matrix(u32, Vec<u32>),
}

struct Rewriter {
    /// `gl_FragCoord` and its type.
    coordinate: (u32, u32),
    float: u32,
    /// The types of 32-bit numbers and vectors that can be hidden, of either sign.
    shapes: HashMap<u32, Shape>,
    /// An integer type for each number of components.
    int_types: HashMap<u32, u32>,
    /// The pointer types into uniform blocks.
    into_blocks: Vec<u32>,
    /// The type of each value.
    types: HashMap<u32, u32>,
    /// Constants that contain a zero.
    zeros: HashMap<u32, Zero>,
    bound: u32,
    /// Types to add to the module.
    declared: Vec<u32>,
}

impl Rewriter {
    /// Collects the facts about a module; `None` if it has no `gl_FragCoord`.
    fn of(words: &[u32]) -> Option<Self> {
        let mut coordinates = Vec::new();
        let mut found = None;
        let mut pointees = HashMap::new();
        let mut matrices = Vec::new();
        let mut rewriter = Self {
            coordinate: (0, 0),
            float: 0,
            shapes: HashMap::new(),
            int_types: HashMap::new(),
            into_blocks: Vec::new(),
            types: HashMap::new(),
            zeros: HashMap::new(),
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
                (Op::TypeFloat, &[id, 32]) => {
                    rewriter.float = id;
                    let shape = Shape {
                        ty: id,
                        is_float: true,
                        components: 1,
                    };
                    rewriter.shapes.insert(id, shape);
                }
                (Op::TypeInt, &[id, 32, _]) => {
                    rewriter.int_types.entry(1).or_insert(id);
                    let shape = Shape {
                        ty: id,
                        is_float: false,
                        components: 1,
                    };
                    rewriter.shapes.insert(id, shape);
                }
                (Op::TypeVector, &[id, of, components]) => {
                    if let Some(&Shape { is_float, .. }) = rewriter.shapes.get(&of) {
                        if rewriter.int_types.get(&1) == Some(&of) {
                            rewriter.int_types.insert(components, id);
                        }
                        rewriter.shapes.insert(
                            id,
                            Shape {
                                ty: id,
                                is_float,
                                components,
                            },
                        );
                    }
                }
                (Op::TypePointer, &[id, class, pointee]) => {
                    pointees.insert(id, pointee);
                    if class == StorageClass::Uniform as u32 {
                        rewriter.into_blocks.push(id);
                    }
                }
                (Op::Variable, &[ty, id, ..]) if coordinates.contains(&id) => {
                    found = Some((id, *pointees.get(&ty)?));
                }
                (Op::TypeMatrix, &[id, ..]) => matrices.push(id),
                (Op::Constant, &[ty, id, bits]) if bits << 1 == 0 => rewriter.record_zero(id, ty),
                (Op::ConstantNull, &[ty, id]) => rewriter.record_zero(id, ty),
                (Op::ConstantComposite, [ty, id, parts @ ..])
                    if parts.iter().any(|part| rewriter.zeros.contains_key(part)) =>
                {
                    rewriter.record_zero(*id, *ty);
                    if matrices.contains(ty) {
                        rewriter.zeros.insert(*id, Zero::Matrix(*ty, parts.to_vec()));
                    }
                }
                (_, &[ty, id, ..]) if has_type(op) => {
                    rewriter.types.insert(id, ty);
                }
                _ => {}
            }
        }
        rewriter.coordinate = found?;
        Some(rewriter)
    }

    /// Records a constant that contains a zero, if its type is of floats.
    fn record_zero(&mut self, constant: u32, ty: u32) {
        if let Some(&shape) = self.shapes.get(&ty).filter(|shape| shape.is_float) {
            self.zeros.insert(constant, Zero::Number(shape));
        }
    }

    /// Whether a pointer points into a uniform block.
    fn is_in_block(&self, pointer: u32) -> bool {
        let ty = self.types.get(&pointer);
        ty.is_some_and(|ty| self.into_blocks.contains(ty))
    }

    /// Hides an operand that is a known zero.
    fn hide_zero(&mut self, code: &mut Vec<u32>, operand: u32) -> u32 {
        match self.zeros.get(&operand).cloned() {
            None => operand,
            Some(Zero::Number(shape)) => {
                let hidden = self.fresh();
                self.hide(code, shape, hidden, operand);
                hidden
            }
            Some(Zero::Matrix(ty, columns)) => {
                let columns = columns.iter().map(|&column| self.hide_zero(code, column));
                let columns: Vec<u32> = columns.collect();
                self.value(code, Op::CompositeConstruct, ty, &columns)
            }
        }
    }

    /// Appends instructions that compute the id `hidden` with the value of `known`.
    fn hide(&mut self, code: &mut Vec<u32>, shape: Shape, hidden: u32, known: u32) {
        let Shape {
            ty,
            is_float,
            components,
        } = shape;
        let one = self.int_type(1);
        let whole = self.int_type(components);
        let (coordinate, at) = self.coordinate;
        let at = self.value(code, Op::Load, at, &[coordinate]);
        let depth = self.value(code, Op::CompositeExtract, self.float, &[at, 2]);
        let mut zero = self.value(code, Op::Bitcast, one, &[depth]);
        if components > 1 {
            zero = self.value(
                code,
                Op::CompositeConstruct,
                whole,
                &vec![zero; components as usize],
            );
        }
        if is_float {
            let bits = self.value(code, Op::Bitcast, whole, &[known]);
            let bits = self.value(code, Op::BitwiseXor, whole, &[bits, zero]);
            push(code, Op::Bitcast, &[ty, hidden, bits]);
        } else {
            push(code, Op::BitwiseXor, &[ty, hidden, known, zero]);
        }
    }

    /// Appends an operation with a new result id.
    fn value(&mut self, code: &mut Vec<u32>, op: Op, ty: u32, operands: &[u32]) -> u32 {
        let id = self.fresh();
        push(code, op, &[&[ty, id], operands].concat());
        id
    }

    /// The integer type with a number of components.
    fn int_type(&mut self, components: u32) -> u32 {
        if let Some(&id) = self.int_types.get(&components) {
            return id;
        }
        let operands = match components {
            1 => vec![32, 0],
            _ => vec![self.int_type(1), components],
        };
        let op = if components == 1 {
            Op::TypeInt
        } else {
            Op::TypeVector
        };
        let id = self.fresh();
        push(&mut self.declared, op, &[&[id], &operands[..]].concat());
        self.int_types.insert(components, id);
        id
    }

    fn fresh(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }
}

fn push(code: &mut Vec<u32>, op: Op, operands: &[u32]) {
    code.push((operands.len() as u32 + 1) << 16 | op as u32);
    code.extend(operands);
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::{Options, check};
    use toyproof_translate::backend::spirv::words;
    use toyproof_translate::naga_ir::ValidModule;

    use super::*;

    /// The words of a valid shader.
    fn words_of(shader: &str) -> Vec<u32> {
        let mut files = Files::default();
        let file = files.add(File::new("s", shader));
        let checked = check(&files, file, &Options::default()).unwrap();
        words(&ValidModule::parse(&toyproof_translate::lower(&checked)).unwrap()).unwrap()
    }

    fn all(words: &[u32], op: Op) -> Vec<&[u32]> {
        let found = instructions(words).filter(|(_, instruction)| opcode(instruction) == Some(op));
        found.map(|(_, instruction)| instruction).collect()
    }

    #[test]
    fn only_numbers_loaded_from_blocks_are_hidden() {
        let plain = words_of(
            "float late() { return iTime; }
            void mainImage(out vec4 c, in vec2 p) { c = vec4(late(), p / iResolution.xy, iMouse.x + float(iFrame)); }",
        );
        let opaque = with_opaque_numbers(&plain);
        // The time, the resolution, the mouse and the frame.
        let hidden = all(&opaque, Op::BitwiseXor);
        assert_eq!((all(&plain, Op::BitwiseXor).len(), hidden.len()), (0, 4));
        let loads =
            |words| -> Vec<Vec<u32>> { all(words, Op::Load).iter().map(|load| load.to_vec()).collect() };
        assert_eq!(
            loads(&opaque).len(),
            loads(&plain).len() + 4,
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
    fn only_multiplied_zeros_are_hidden() {
        let hidden = |body: &str| {
            let shader = format!("void mainImage(out vec4 c, in vec2 p) {{ c = vec4(p, p); {body} }}");
            all(&with_opaque_numbers(&words_of(&shader)), Op::BitwiseXor).len()
        };
        assert_eq!(hidden("c *= vec4(1, 0.5, 2, 1);"), 0);
        assert_eq!(hidden("c = max(c, 0.0) - vec4(0, 1, 2, 3);"), 0);
        for body in [
            "c.x *= 0.0;",
            "c *= vec4(1, 0.5, 0, 1);",
            "c *= -0.0;",
            "c.x = 0.0 / c.y;",
            "c.x = dot(c, vec4(1, 0, 1, 1));",
            "c = vec4(p.x, 1, 0, 1);",
        ] {
            assert_eq!(hidden(body), 1, "{body}");
        }
        assert_eq!(hidden("c.xy = mat2(1, 0, 2, 3) * c.xy;"), 1, "one of the columns");
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
