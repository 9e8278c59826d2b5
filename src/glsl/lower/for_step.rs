//! The step of a `for` that is not continued: it is the last statement of the body.
//!
//! naga puts the step into SPIR-V's continue construct. Mesa 22.3 moves that to the beginning of the loop, behind a test for
//! the first round, and peels the test off: a vector that begins as a constant then takes one step too many. With a
//! `continue` in the body the driver does not peel, and is right. Metal, HLSL and GLSL have no such construct either: naga writes a flag for it.

use super::super::tree::{Statement, StatementKind};
use super::draft::Draft;
use super::walk;

pub(super) fn run(draft: &mut Draft) {
    draft.each_statement(|draft, mut statement, out| {
        if let StatementKind::For { step, body, .. } = &mut statement.kind
            && !walk::continues(body)
            && let Some(last) = step.take()
        {
            body.push(Statement {
                kind: StatementKind::Expression(last),
                at: draft.tree[last].at,
            });
        }
        out.push(statement);
    });
}
