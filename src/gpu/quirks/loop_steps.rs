//! Steps of loops that Mesa executes once too often, in shaders that come from WGSL.
//! `lower::loops::move_steps` of `toyproof_translate` does the same for GLSL.

use naga::{Block, Statement};
use toyproof_translate::TranslateError;
use toyproof_translate::naga_ir::ValidModule;

use super::loop_probe::inner_blocks;

/// Returns the same module with the steps of its loops at the end of their bodies.
///
/// Mesa 22.3 executes the step in SPIR-V's continue construct once too often if nothing continues the loop
/// and the stepped variable is initialized with a constant vector. The move changes nothing else.
///
/// # Errors
/// naga's message, if it refuses the result.
pub(crate) fn with_steps_last(module: &ValidModule) -> Result<ValidModule, TranslateError> {
    let mut module = module.module().clone();
    for (_, function) in module.functions.iter_mut() {
        move_steps(&mut function.body);
    }
    for entry in &mut module.entry_points {
        move_steps(&mut entry.function.body);
    }
    ValidModule::new(module)
}

fn move_steps(block: &mut Block) {
    for statement in block.iter_mut() {
        match statement {
            Statement::Loop {
                body,
                continuing,
                break_if: None,
            } => {
                move_steps(body);
                if !continues(body) && !always_jumps(body) {
                    for (step, span) in std::mem::take(continuing).span_into_iter() {
                        body.push(step, span);
                    }
                }
            }
            Statement::Loop { body, .. } => move_steps(body),
            other => inner_blocks(other).into_iter().for_each(move_steps),
        }
    }
}

/// Whether the loop's body contains a `continue` of this loop.
fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Continue => true,
        Statement::Block(block) => continues(block),
        Statement::If { accept, reject, .. } => continues(accept) || continues(reject),
        Statement::Switch { cases, .. } => cases.iter().any(|case| continues(&case.body)),
        _ => false,
    })
}

/// Whether the end of a block is never reached.
fn always_jumps(block: &Block) -> bool {
    block.last().is_some_and(|last| match last {
        Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue => true,
        Statement::Block(block) => always_jumps(block),
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_move_to_the_end_of_bodies_without_continue() {
        let text = |more: &str| {
            format!(
                "@fragment fn main() -> @location(0) vec4f {{
                    var sum = 0.0;
                    for (var i = 0; i < 3; i++) {{ {more} sum += 1.0; }}
                    return vec4f(sum);
                }}"
            )
        };
        let steps = |more: &str| {
            let module = with_steps_last(&ValidModule::of_wgsl(&text(more)).unwrap()).unwrap();
            let body = &module.module().entry_points[0].function.body;
            let find = |statement: &Statement| match statement {
                Statement::Loop { continuing, .. } => Some(continuing.len()),
                _ => None,
            };
            let nested = body.iter().find_map(|statement| match statement {
                Statement::Block(block) => block.iter().find_map(find),
                other => find(other),
            });
            nested.unwrap()
        };
        assert_eq!(steps(""), 0);
        assert!(steps("if i == 1 { continue; }") > 0);
        assert!(steps("if i == 1 { return vec4f(); }") == 0);
        assert!(steps("for (var j = 0; j < 3; j++) { if j == 1 { continue; } }") == 0);
    }
}
