//! Variables that Mesa 22.3 overwrites in pixels that have left a loop: see
//! [`LOOP_EXITS`](super::LOOP_EXITS).

use spirv::Op;
use toyproof_translate::backend::spirv::{instructions, opcode, push};

use super::opaque::{Opaque, functions_start};

/// Adds an exit that is never taken to the head of each loop that may assign a variable before its first
/// exit.
///
/// Mesa promotes variables to values. A value of a loop's body that is also used after the loop must be kept
/// for a pixel that leaves while others, computed together with it, continue. Mesa 22.3 keeps it only if the
/// exits of the loop disagree about the value, and so need a separate variable; if all exits come after the
/// assignment, the next iteration overwrites it. At the added exit, every variable has its value from before
/// the assignment.
///
/// A module without `gl_FragCoord` does not change; neither do loops whose first exit comes before
/// assignments, as in most `for` loops.
pub(crate) fn with_early_exits(words: &[u32]) -> Vec<u32> {
    let exits = late_exits(words);
    let Some(mut opaque) = Opaque::new(words).filter(|_| !exits.is_empty()) else {
        return words.to_vec();
    };
    let mut code = Vec::new();
    let start = functions_start(words);
    // The exit to add, and its condition, between a loop's head and the branch that ends it.
    let mut added = None;
    for (_, instruction) in instructions(words).filter(|(at, _)| *at >= start) {
        match (opcode(instruction), instruction, added.take()) {
            (Some(Op::LoopMerge), &[_, exit, ..], _) if exits.contains(&exit) => {
                added = Some((opaque.never(&mut code), exit));
                code.extend(instruction);
            }
            (Some(Op::Branch), &[_, body], Some((never, exit))) => {
                push(&mut code, Op::BranchConditional, &[never, exit, body]);
            }
            _ => code.extend(instruction),
        }
    }
    opaque.finish(&words[..start], &code)
}

/// The blocks after loops that may assign a variable before their first exit, or that never end.
fn late_exits(words: &[u32]) -> Vec<u32> {
    let mut late = Vec::new();
    // The blocks after the loops that no exit was found for yet, innermost last.
    let mut open: Vec<u32> = Vec::new();
    let mut block = 0;
    for (_, instruction) in instructions(words) {
        match (opcode(instruction), instruction) {
            (Some(Op::Label), &[_, label]) => block = label,
            (Some(Op::LoopMerge), &[_, exit, ..]) => open.push(exit),
            (Some(Op::Store | Op::CopyMemory | Op::FunctionCall), _) => late.append(&mut open),
            (Some(Op::Branch | Op::BranchConditional), targets) => {
                open.retain(|exit| !targets[1..].contains(exit));
            }
            // It would have to know the added exit.
            (Some(Op::Phi), _) => late.retain(|&exit| exit != block),
            _ => {}
        }
    }
    late
}

#[cfg(test)]
mod tests {
    use toyproof_translate::backend::spirv::BOUND;

    use super::super::opaque::words_of;
    use super::*;

    /// The number of loops that get another exit.
    fn added(body: &str) -> usize {
        let words = words_of(&format!(
            "float f(float x) {{ return x * 0.5; }}
            void mainImage(out vec4 c, in vec2 p) {{ float r = p.x; int i = 0; {body} c = vec4(r); }}"
        ));
        let changed = with_early_exits(&words);
        let count = |words: &[u32]| -> usize {
            let all = instructions(words).filter_map(|(_, instruction)| opcode(instruction));
            all.filter(|&op| op == Op::BranchConditional).count()
        };
        assert!(changed[BOUND] >= words[BOUND]);
        count(&changed) - count(&words)
    }

    #[test]
    fn loops_that_end_after_an_assignment_get_an_exit() {
        for body in [
            "do { r *= 0.5; } while (r > 0.1);",
            "do { r *= 0.5; if (r < 0.2) break; i++; } while (i < 9);",
            "for (;;) { r *= 0.5; if (r < 0.1) break; }",
            "while ((r = f(r)) > 0.1) {}",
            "while (f(r) > 0.1) { r -= 0.1; }",
        ] {
            assert_eq!(added(body), 1, "{body}");
        }
        assert_eq!(
            added("do { do { r *= 0.5; } while (r > 0.1); i++; } while (i < 3);"),
            2
        );
    }

    #[test]
    fn other_loops_do_not_change() {
        for body in [
            "for (int j = 0; j < 9; j++) { r *= 0.5; if (r < 0.1) break; }",
            "while (r > 0.1) r *= 0.5;",
            "for (;;) { if (r < 0.1) break; r *= 0.5; }",
            "if (r > 1.0) r = 1.0;",
        ] {
            assert_eq!(added(body), 0, "{body}");
        }
    }
}
