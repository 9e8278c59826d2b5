//! `for (…; …; f(x), i++)`, `while (f(x), i < 3)`: what a loop's head calls for its effect only runs as a statement.
//!
//! naga refuses calls of `void` functions within sequences, and a head has room for no statement. A condition moves to the
//! beginning of the body; a step, too, where it waits for the second round, so that `continue` does not miss it.

use toyproof_glsl::tree::{
    Arm, Block, Condition, ExprId, ExprKind, Place, Statement, StatementKind, Tree, Type, UnaryOp, Value,
    walk,
};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_statement(|draft, statement, out| {
        let at = statement.at;
        match statement.kind {
            StatementKind::While {
                condition: Condition::Expression(condition),
                body,
            } if has_void(&draft.tree, condition) => {
                let head = vec![leave_unless(draft, condition, at)];
                out.push(endless(Block::new(), head, body, at));
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } if [tested(condition), step]
                .into_iter()
                .flatten()
                .any(|part| has_void(&draft.tree, part)) =>
            {
                let mut head = Block::new();
                if let Some(step) = step {
                    head.push(from_second_round(draft, step, at, out));
                }
                if let Some(condition) = tested(condition) {
                    head.push(leave_unless(draft, condition, at));
                }
                out.push(endless(init, head, body, at));
            }
            kind => out.push(Statement { kind, at }),
        }
    });
}

fn tested(condition: Option<Condition>) -> Option<ExprId> {
    match condition {
        Some(Condition::Expression(condition)) => Some(condition),
        _ => None,
    }
}

/// Whether a sequence calls a `void` function on its way.
fn has_void(tree: &Tree, root: ExprId) -> bool {
    let is_void = |id: ExprId| tree[id].ty == Type::Void;
    walk::any(tree, root, |kind| match *kind {
        ExprKind::Sequence { first, second } => is_void(first) || is_void(second),
        _ => false,
    })
}

/// `for (init; ; ) { head body }`
fn endless(init: Block, mut head: Block, body: Block, at: Place) -> Statement {
    // What the body declares stays its own.
    head.push(Statement {
        kind: StatementKind::Block(body),
        at,
    });
    Statement {
        kind: StatementKind::For {
            init,
            condition: None,
            step: None,
            body: head,
        },
        at,
    }
}

/// `if (!condition) break;`
fn leave_unless(draft: &mut Draft, condition: ExprId, at: Place) -> Statement {
    let condition = draft.build(at).unary(UnaryOp::Not, condition);
    let body = vec![Statement {
        kind: StatementKind::Break,
        at,
    }];
    Statement {
        kind: StatementKind::If {
            arms: vec![Arm { condition, body }],
            otherwise: None,
        },
        at,
    }
}

/// `if (again) step; else again = true;`, with `bool again = false;` before the loop.
fn from_second_round(draft: &mut Draft, step: ExprId, at: Place, out: &mut Block) -> Statement {
    let again = draft.local("again", Type::BOOL, at);
    draft.moved.insert(again);
    let mut build = draft.build(at);
    let [no, yes] = [false, true].map(|value| build.literal(Value::Bool(value)));
    build.tree[again].initialiser = Some(no);
    let condition = build.variable(again);
    let set = build.set(again, yes);
    out.push(Statement {
        kind: StatementKind::Declare(again),
        at,
    });
    let [step, set] = [step, set].map(|expr| {
        vec![Statement {
            kind: StatementKind::Expression(expr),
            at,
        }]
    });
    let arms = vec![Arm {
        condition,
        body: step,
    }];
    Statement {
        kind: StatementKind::If {
            arms,
            otherwise: Some(set),
        },
        at,
    }
}
