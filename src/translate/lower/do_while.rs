//! `do … while (c)` with a `continue` in it: `for (bool again = true; again; again = c) …`.
//!
//! naga's `continue` skips the condition.

use toyproof_glsl::tree::{Condition, Statement, StatementKind, Type, Value, walk};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_statement(|draft, statement, out| {
        let at = statement.at;
        let kind = match statement.kind {
            StatementKind::DoWhile { body, condition } if walk::continues(&body) => {
                let again = draft.local("again", Type::BOOL, at);
                draft.moved.insert(again);
                let mut build = draft.build(at);
                let begin = build.literal(Value::Bool(true));
                build.tree[again].initialiser = Some(begin);
                let tested = build.variable(again);
                let step = build.set(again, condition);
                StatementKind::For {
                    init: vec![Statement {
                        kind: StatementKind::Declare(again),
                        at,
                    }],
                    condition: Some(Condition::Expression(tested)),
                    step: Some(step),
                    body,
                }
            }
            kind => kind,
        };
        out.push(Statement { kind, at });
    });
}
