//! What holds a driver to the arithmetic as written: `NoContraction`, and derivatives of one kind.

use std::collections::HashSet;

use ::spirv::{Capability, Decoration, GlslStd450Op, Op};

use super::{HEADER_WORDS, instructions, is_product, is_type, opcode};

/// The same module with `NoContraction` on every float operation that a driver could fuse, rearrange or round otherwise,
/// and with fine derivatives where the module leaves it to the driver how near a derivative must be: Mesa takes that of a pixel's own
/// row or column, `SwiftShader` that of the quad's first. Nothing else changes.
#[must_use]
pub fn strict(words: &[u32]) -> Vec<u32> {
    let mut floats = HashSet::new();
    let mut decorations = Vec::new();
    let mut first_type = words.len();
    let mut derives = false;
    for (at, instruction) in instructions(words) {
        let Some(op) = opcode(instruction) else { continue };
        // Decorations stand before the first type or constant.
        if is_type(op) || op == Op::ConstantTrue || op == Op::Constant {
            first_type = first_type.min(at);
        }
        match op {
            Op::TypeFloat => {
                floats.insert(instruction[1]);
            }
            Op::TypeVector | Op::TypeMatrix if floats.contains(&instruction[2]) => {
                floats.insert(instruction[1]);
            }
            _ if is_arithmetic(op, instruction, &floats) => decorations.extend([
                3 << 16 | Op::Decorate as u32,
                instruction[2],
                Decoration::NoContraction as u32,
            ]),
            _ => derives |= fine(op).is_some(),
        }
    }
    let mut strict = words[..HEADER_WORDS.min(words.len())].to_vec();
    if derives {
        strict.extend([
            2 << 16 | Op::Capability as u32,
            Capability::DerivativeControl as u32,
        ]);
    }
    for (at, instruction) in instructions(words) {
        if at == first_type {
            strict.append(&mut decorations);
        }
        let length = instruction[0] & 0xffff_0000;
        let op = opcode(instruction).and_then(fine);
        strict.push(op.map_or(instruction[0], |op| length | op as u32));
        strict.extend(&instruction[1..]);
    }
    strict
}

/// Whether an instruction computes floats that depend on how.
///
/// `sqrt`, `min`, `max` and `clamp` do not: each is one step, exact or correctly rounded. And the first three must not be decorated: SPIRV-Tools,
/// which `SwiftShader` runs, takes what comes of them for a value that is still to be known, if all operands are constants after some
/// propagation, and so `c ? 0.25 : f(m)` for 0.25.
fn is_arithmetic(op: Op, instruction: &[u32], floats: &HashSet<u32>) -> bool {
    use GlslStd450Op as G;
    match op {
        Op::ExtInst => {
            let exact = matches!(
                instruction.get(4).and_then(|&number| G::from_u32(number)),
                Some(G::Sqrt | G::FMin | G::FMax | G::FClamp)
            );
            floats.contains(&instruction[1]) && !exact
        }
        Op::FNegate | Op::FAdd | Op::FSub | Op::FDiv | Op::FRem | Op::FMod => true,
        _ => is_product(op),
    }
}

/// The derivative of a pixel's own row or column, for one that leaves it to the driver.
fn fine(op: Op) -> Option<Op> {
    Some(match op {
        Op::DPdx => Op::DPdxFine,
        Op::DPdy => Op::DPdyFine,
        Op::Fwidth => Op::FwidthFine,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::words_of;
    use super::*;

    const SHADER: &str = "void mainImage(out vec4 c, in vec2 p) {
        int i = int(p.x) * 3;
        mat2 m = mat2(p, p);
        c = vec4(m * p, dot(p, p) - 0.5, sin(p.x) / float(i));
    }";

    fn is_no_contraction(instruction: &[u32]) -> bool {
        instruction.len() == 3
            && opcode(instruction) == Some(Op::Decorate)
            && instruction[2] == Decoration::NoContraction as u32
    }

    #[test]
    fn only_decorations_are_added() {
        let plain = words_of(SHADER);
        let strict = strict(&plain);
        let kept: Vec<u32> = instructions(&strict)
            .filter(|(_, instruction)| !is_no_contraction(instruction))
            .flat_map(|(_, instruction)| instruction.to_vec())
            .collect();
        assert_eq!(kept, plain[HEADER_WORDS..]);
        assert_eq!(strict[..HEADER_WORDS], plain[..HEADER_WORDS]);
    }

    #[test]
    fn every_float_operation_is_decorated_and_no_integer_one() {
        let strict = strict(&words_of(SHADER));
        let decorated: HashSet<u32> = instructions(&strict)
            .filter(|(_, instruction)| is_no_contraction(instruction))
            .map(|(_, instruction)| instruction[1])
            .collect();
        let results = |op: Op| -> Vec<u32> {
            instructions(&strict)
                .filter(|(_, instruction)| opcode(instruction) == Some(op))
                // The conversion to `int` has a `clamp`.
                .filter(|(_, instruction)| op != Op::ExtInst || instruction[4] == GlslStd450Op::Sin as u32)
                .map(|(_, instruction)| instruction[2])
                .collect()
        };
        // m · p, the dot product, the subtraction, sin and the quotient.
        for op in [Op::MatrixTimesVector, Op::Dot, Op::FSub, Op::ExtInst, Op::FDiv] {
            let results = results(op);
            assert!(
                !results.is_empty() && results.iter().all(|id| decorated.contains(id)),
                "{op:?}"
            );
        }
        assert!(results(Op::IMul).iter().all(|id| !decorated.contains(id)) && !results(Op::IMul).is_empty());
    }

    #[test]
    fn exact_steps_are_not_decorated() {
        let shader = "void mainImage(out vec4 c, in vec2 p) {
            c = vec4(sqrt(p), min(p.x, max(p.y, 2.0)), clamp(p.x, 0.0, 1.0));
        }";
        let strict = strict(&words_of(shader));
        assert!(instructions(&strict).all(|(_, instruction)| !is_no_contraction(instruction)));
    }

    #[test]
    fn derivatives_are_fine() {
        let shader = "void mainImage(out vec4 c, in vec2 p) { c = vec4(dFdx(p), dFdy(p.x), fwidth(p.y)); }";
        let (plain, strict) = (words_of(shader), strict(&words_of(shader)));
        let of = |words: &[u32]| -> Vec<Op> {
            let all = instructions(words).filter_map(|(_, instruction)| opcode(instruction));
            all.filter(|op| (Op::DPdx..=Op::FwidthCoarse).contains(op))
                .collect()
        };
        assert_eq!(of(&plain), [Op::DPdx, Op::DPdy, Op::Fwidth]);
        assert_eq!(of(&strict), [Op::DPdxFine, Op::DPdyFine, Op::FwidthFine]);
        let capability = [
            2 << 16 | Op::Capability as u32,
            Capability::DerivativeControl as u32,
        ];
        assert_eq!(strict[HEADER_WORDS..][..2], capability);
        assert_eq!(strict.len(), plain.len() + 2, "nothing else is added");
    }
}
