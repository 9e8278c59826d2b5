//! Statements after a `return`, `break`, `continue` or `discard` of the same block: nothing runs them.
//!
//! naga drops the statements and keeps what they refer to, which its validator refuses.

use super::super::tree::Block;
use super::draft::Draft;
use super::walk;

pub(super) fn run(draft: &mut Draft) {
    draft.each_body(|_, _, body| live(body));
}

fn live(mut block: Block) -> Block {
    if let Some(jump) = block.iter().position(walk::jumps) {
        block.truncate(jump + 1);
    }
    for statement in &mut block {
        for body in walk::inner_mut(statement) {
            *body = live(std::mem::take(body));
        }
    }
    block
}
