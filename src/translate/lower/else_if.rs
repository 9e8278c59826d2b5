//! Chains of hundreds of `else if`: cut into shorter ones, each entered if those before it chose nothing.
//!
//! naga nests each `else` in the one before and ends the process where its stack ends; WGSL compilers stop at 127.

use toyproof_glsl::tree::{Arm, Block, Place, Statement, StatementKind, Type, Value, VariableId};

use super::draft::Draft;

/// How many conditions a chain keeps.
const LONGEST: usize = 32;

pub(super) fn run(draft: &mut Draft) {
    draft.each_statement(|draft, statement, out| match statement.kind {
        StatementKind::If { arms, otherwise } if arms.len() > LONGEST => {
            cut(draft, arms, otherwise, statement.at, out);
        }
        kind => out.push(Statement {
            kind,
            at: statement.at,
        }),
    });
}

/// `bool open = true; if (open) { open = false; if (a) … else { open = true; } } if (open) { … }`
fn cut(draft: &mut Draft, arms: Vec<Arm>, mut otherwise: Option<Block>, at: Place, out: &mut Block) {
    let open = draft.local("open", Type::BOOL, at);
    draft.moved.insert(open);
    let begin = draft.build(at).literal(Value::Bool(true));
    draft.tree[open].initialiser = Some(begin);
    out.push(Statement {
        kind: StatementKind::Declare(open),
        at,
    });
    let mut arms = arms.into_iter().peekable();
    while arms.peek().is_some() {
        let arms_here: Vec<Arm> = arms.by_ref().take(LONGEST).collect();
        let last = if arms.peek().is_some() {
            Some(vec![set(draft, open, true, at)])
        } else {
            otherwise.take()
        };
        let chain = StatementKind::If {
            arms: arms_here,
            otherwise: last,
        };
        let body = vec![set(draft, open, false, at), Statement { kind: chain, at }];
        let condition = draft.build(at).variable(open);
        let arms = vec![Arm { condition, body }];
        out.push(Statement {
            kind: StatementKind::If {
                arms,
                otherwise: None,
            },
            at,
        });
    }
}

fn set(draft: &mut Draft, open: VariableId, value: bool, at: Place) -> Statement {
    let mut build = draft.build(at);
    let value = build.literal(Value::Bool(value));
    let set = build.set(open, value);
    Statement {
        kind: StatementKind::Expression(set),
        at,
    }
}
