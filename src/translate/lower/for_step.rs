//! The step of a `for` that is not continued: it is the last statement of the body.
//!
//! naga puts the step into SPIR-V's continue construct. Mesa 22.3 moves that to the beginning of the loop, behind a test for
//! the first round, and peels the test off: a vector that begins as a constant then takes one step too many. With a
//! `continue` in the body the driver does not peel, and is right. Metal, HLSL and GLSL have no such construct either: naga writes a flag for it.

use std::collections::HashSet;

use toyproof_glsl::tree::{Block, ExprId, ExprKind, Statement, StatementKind, walk};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_statement(|draft, mut statement, out| {
        if let StatementKind::For { step, body, .. } = &mut statement.kind
            && !walk::continues(body)
            && let Some(last) = step.take()
        {
            let at = draft.tree[last].at;
            if hides(draft, body, last) {
                let inner = std::mem::take(body);
                body.push(Statement {
                    kind: StatementKind::Block(inner),
                    at,
                });
            }
            body.push(Statement {
                kind: StatementKind::Expression(last),
                at,
            });
        }
        out.push(statement);
    });
}

/// Whether a block declares a name that an expression behind it means otherwise.
fn hides(draft: &Draft, body: &Block, behind: ExprId) -> bool {
    let names: HashSet<&str> = body
        .iter()
        .filter_map(walk::declared)
        .map(|variable| draft.tree[variable].name.as_str())
        .collect();
    walk::any(
        &draft.tree,
        behind,
        |kind| matches!(kind, ExprKind::Variable(variable) if names.contains(draft.tree[*variable].name.as_str())),
    )
}
