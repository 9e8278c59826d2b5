//! Heads of loops: `while (bool b = f())`, and a `for` that declares variables of several types or begins with several
//! expressions. They are declared, or run, before the loop, in a block of their own.
//!
//! naga knows no declaration as the condition of a `while`, and one type for all variables of a `for`.

use toyproof_glsl::tree::{Block, Condition, ExprKind, Statement, StatementKind, VariableId, walk};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_statement(|draft, mut statement, out| {
        let at = statement.at;
        let mut before = Block::new();
        match &mut statement.kind {
            StatementKind::While { condition, .. } => tested(draft, condition, &mut before),
            StatementKind::For { init, condition, .. } => {
                if !is_one_statement(draft, init) {
                    draft.moved.extend(init.iter().filter_map(walk::declared));
                    before.append(init);
                }
                if let Some(condition) = condition {
                    tested(draft, condition, &mut before);
                }
            }
            _ => {}
        }
        if before.is_empty() {
            out.push(statement);
        } else {
            before.push(statement);
            out.push(Statement {
                kind: StatementKind::Block(before),
                at,
            });
        }
    });
}

/// Lets a declared condition be assigned instead.
fn tested(draft: &mut Draft, condition: &mut Condition, before: &mut Block) {
    let Condition::Declare(variable) = *condition else {
        return;
    };
    let Some(value) = draft.tree[variable].initialiser.take() else {
        return;
    };
    draft.moved.insert(variable);
    let at = draft.tree[value].at;
    before.push(Statement {
        kind: StatementKind::Declare(variable),
        at,
    });
    *condition = Condition::Expression(draft.build(at).set(variable, value));
}

/// Whether one statement of GLSL says it: `float a = 0.0, b = 1.0` or `i = 0`.
fn is_one_statement(draft: &Draft, init: &Block) -> bool {
    let declared: Option<Vec<VariableId>> = init
        .iter()
        .map(|statement| match statement.kind {
            StatementKind::Declare(variable) => Some(variable),
            _ => None,
        })
        .collect();
    match (declared, init.as_slice()) {
        (Some(variables), _) => variables.windows(2).all(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|id| &draft.tree[id]);
            a.ty == b.ty && a.kind == b.kind
        }),
        (
            None,
            [
                Statement {
                    kind: StatementKind::Expression(only),
                    ..
                },
            ],
        ) => !matches!(draft.tree[*only].kind, ExprKind::Sequence { .. }),
        _ => false,
    }
}
