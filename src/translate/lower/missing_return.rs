//! Functions that may end without a `return`: they give zero, as good a value as any (§6.1 leaves it undefined).
//!
//! naga looks at the last statement only and returns nothing there, which its validator refuses.

use toyproof_glsl::tree::{Block, Statement, StatementKind, Type};

use super::draft::Draft;
use super::zero;

pub(super) fn run(draft: &mut Draft) {
    draft.each_body(|draft, function, mut body| {
        let (ty, at) = (draft.tree[function].return_type, draft.tree[function].at);
        if ty != Type::Void && !returns(&body) {
            let value = zero::value(draft, ty, at);
            body.push(Statement {
                kind: StatementKind::Return(Some(value)),
                at,
            });
        }
        body
    });
}

/// Whether naga, too, sees that no end of the block is left open.
fn returns(block: &Block) -> bool {
    block.last().is_some_and(|last| match &last.kind {
        StatementKind::Return(_) | StatementKind::Discard => true,
        StatementKind::Block(body) => returns(body),
        StatementKind::If {
            arms,
            otherwise: Some(otherwise),
        } => returns(otherwise) && arms.iter().all(|arm| returns(&arm.body)),
        _ => false,
    })
}
