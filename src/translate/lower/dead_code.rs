//! Statements after a `return`, `break`, `continue` or `discard` of the same block: nothing runs them.
//!
//! naga drops the statements and keeps what they refer to, which its validator refuses.

use toyproof_glsl::tree::{Block, Statement, StatementKind, walk};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_body(|_, _, body| live(body));
}

fn live(mut block: Block) -> Block {
    for statement in &mut block {
        for body in walk::inner_mut(statement) {
            *body = live(std::mem::take(body));
        }
    }
    if let Some(jump) = block.iter().position(jumps) {
        block.truncate(jump + 1);
    }
    block
}

/// Whether nothing that follows is run, in a block whose inner blocks end where they jump.
fn jumps(statement: &Statement) -> bool {
    match &statement.kind {
        StatementKind::Block(body) => body.last().is_some_and(jumps),
        _ => walk::jumps(statement),
    }
}
