use std::collections::HashMap;

use ::spirv::Op;

use super::super::{instructions, opcode, words_of};
use super::narrowed;

const ROUNDING: &str = "
    float toyproof_half(float x) { return unpackHalf2x16(packHalf2x16(vec2(x))).x; }
    vec2 toyproof_half(vec2 x) { return unpackHalf2x16(packHalf2x16(x)); }";

/// The numbers of operations in 16 and in 32 bits in the module of a shader that rounds.
fn operations(text: &str) -> [HashMap<Op, usize>; 2] {
    let narrow = narrowed(&words_of(&format!("{ROUNDING}\n{text}")));
    let mut halves = Vec::new();
    let mut counts = [HashMap::new(), HashMap::new()];
    for (_, instruction) in instructions(&narrow) {
        let op = opcode(instruction).unwrap();
        match (op, &instruction[1..]) {
            (Op::TypeFloat, &[id, 16]) => halves.push(id),
            (Op::TypeVector | Op::TypePointer, &[id, ref of @ ..]) => {
                let is_half = of.iter().any(|of| halves.contains(of));
                halves.extend(is_half.then_some(id));
            }
            (_, &[ty, ..]) => {
                let bits = usize::from(!halves.contains(&ty));
                *counts[bits].entry(op).or_default() += 1;
            }
            _ => {}
        }
    }
    counts
}

#[test]
fn rounded_operations_of_rounded_values_have_sixteen_bits() {
    let [halves, singles] = operations(
        "void mainImage(out vec4 c, in vec2 p) {
            vec2 q = toyproof_half(p);
            float d = toyproof_half(dot(q, q));
            d = toyproof_half(d + toyproof_half(sqrt(q.x)));
            c = vec4(d, d * 2.0, p.y + d, 1.0);
        }",
    );
    let of = |counts: &HashMap<Op, usize>, op| counts.get(&op).copied().unwrap_or(0);
    // `q` and `d` are stored in 16 bits.
    assert_eq!(
        [Op::Dot, Op::FAdd, Op::ExtInst, Op::Variable].map(|op| of(&halves, op)),
        [1, 1, 1, 2]
    );
    // The result of `d * 2.0` is not rounded, and `p` has 32 bits.
    assert_eq!(of(&halves, Op::FMul), 0);
    assert_eq!(of(&singles, Op::FMul), 1);
}

#[test]
fn variables_that_get_other_values_keep_their_bits() {
    let [halves, _] = operations(
        "float twice(float x) { return toyproof_half(x + x); }
        void mainImage(out vec4 c, in vec2 p) {
            float a = toyproof_half(p.x);
            a += 0.1;
            float b = toyproof_half(a * a);
            c = vec4(twice(a), twice(b), a, b);
        }",
    );
    assert_eq!(halves.get(&Op::FMul), None, "a is not rounded");
    assert_eq!(halves.get(&Op::FAdd), None, "one argument is not rounded");
    assert_eq!(halves[&Op::Variable], 1, "b");
}

#[test]
fn modules_that_do_not_round_stay_as_they_are() {
    let words = words_of("void mainImage(out vec4 c, in vec2 p) { c = vec4(sqrt(p), 0.5, 1.0); }");
    assert_eq!(narrowed(&words), words);
}
