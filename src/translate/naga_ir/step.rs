//! The step of a loop that nothing continues, as the last statement of its body: what strict shaders have from
//! `glsl/lower/for_step.rs`, for modules that come of a text which says `for`.
//!
//! Mesa 22.3 takes the step of SPIR-V's continue construct once too often, where nothing continues the loop and what it steps began as a
//! constant vector. Moving it changes nothing but that.

use naga::{Block, Statement};

use super::ValidModule;

impl ValidModule {
    /// The same module with its steps where that driver takes them as often as they are taken.
    ///
    /// # Errors
    /// naga's words, should it refuse the result.
    pub fn with_steps_last(&self) -> Result<Self, String> {
        let mut module = self.module.clone();
        for (_, function) in module.functions.iter_mut() {
            settle(&mut function.body);
        }
        for entry in &mut module.entry_points {
            settle(&mut entry.function.body);
        }
        Self::validate(module).map_err(|error| super::chain(error.as_inner()))
    }
}

fn settle(block: &mut Block) {
    for statement in block.iter_mut() {
        match statement {
            Statement::Block(block) => settle(block),
            Statement::If { accept, reject, .. } => {
                settle(accept);
                settle(reject);
            }
            Statement::Switch { cases, .. } => cases.iter_mut().for_each(|case| settle(&mut case.body)),
            Statement::Loop {
                body,
                continuing,
                break_if: None,
            } => {
                settle(body);
                if !continues(body) && !ends(body) {
                    for (step, span) in std::mem::take(continuing).span_into_iter() {
                        body.push(step, span);
                    }
                }
            }
            Statement::Loop { body, .. } => settle(body),
            _ => {}
        }
    }
}

/// Whether a `continue` of the loop's own stands in its body.
fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Continue => true,
        Statement::Block(block) => continues(block),
        Statement::If { accept, reject, .. } => continues(accept) || continues(reject),
        Statement::Switch { cases, .. } => cases.iter().any(|case| continues(&case.body)),
        _ => false,
    })
}

/// Whether nothing may stand behind a block: its end is never reached.
fn ends(block: &Block) -> bool {
    block.last().is_some_and(|last| match last {
        Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue => true,
        Statement::Block(block) => ends(block),
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_goes_to_the_end_of_a_body_that_nothing_continues() {
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
            let module = ValidModule::of_wgsl(&text(more))
                .unwrap()
                .with_steps_last()
                .unwrap();
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
