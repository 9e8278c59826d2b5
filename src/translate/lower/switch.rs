//! `switch`: each case ends in a `break` of its own.
//!
//! naga makes a fall-through of every case whose last statement is not a plain `break`, also of `{ …; break; }` and
//! `return x;`, and has no WGSL for a fall-through (gfx-rs/wgpu #4415, #9625). Cases that fall into each other become
//! one, whose parts are guarded by the labels that lead to them.

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, Case, ExprId, Label, Place, Statement, StatementKind, Type, UnaryOp, Value,
    VariableId, walk,
};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_statement(|draft, statement, out| match statement.kind {
        StatementKind::Switch { selector, cases } => rewrite(draft, selector, cases, statement.at, out),
        _ => out.push(statement),
    });
}

fn rewrite(draft: &mut Draft, mut selector: ExprId, cases: Vec<Case>, at: Place, out: &mut Block) {
    let groups = group(cases);
    if groups.iter().any(|group| group.len() > 1) {
        // The guards read it again.
        let variable = draft.local("selector", draft.tree[selector].ty, at);
        draft.moved.insert(variable);
        draft.tree[variable].initialiser = Some(selector);
        selector = draft.build(at).variable(variable);
        out.push(Statement {
            kind: StatementKind::Declare(variable),
            at,
        });
    }
    let all: Vec<Label> = groups
        .iter()
        .flatten()
        .flat_map(|case| case.labels.iter().copied())
        .collect();
    let mut cases = Vec::with_capacity(groups.len());
    for group in groups {
        let at = group.first().map_or(at, |case| case.at);
        let labels = group
            .iter()
            .flat_map(|case| case.labels.iter().copied())
            .collect();
        let mut body = if group.len() > 1 {
            guarded(draft, selector, group, &all, out)
        } else {
            group.into_iter().flat_map(|case| case.body).collect()
        };
        end_in_break(draft, &mut body, at);
        cases.push(Case { labels, body, at });
    }
    // naga gives a `switch` no scope of its own.
    let declares = cases
        .iter()
        .flat_map(|case| &case.body)
        .any(|statement| walk::declared(statement).is_some());
    let switch = Statement {
        kind: StatementKind::Switch { selector, cases },
        at,
    };
    out.push(if declares {
        Statement {
            kind: StatementKind::Block(vec![switch]),
            at,
        }
    } else {
        switch
    });
}

/// Puts cases that fall into the next together with it.
fn group(cases: Vec<Case>) -> Vec<Vec<Case>> {
    let mut groups: Vec<Vec<Case>> = Vec::new();
    let mut falls = false;
    for case in cases {
        let ends = ends(&case.body);
        match groups.last_mut() {
            Some(group) if falls => group.push(case),
            _ => groups.push(vec![case]),
        }
        falls = !ends;
    }
    groups
}

/// Whether control cannot run off the end of a block.
fn ends(block: &Block) -> bool {
    block.last().is_some_and(|last| match &last.kind {
        StatementKind::Block(body) => ends(body),
        StatementKind::If {
            arms,
            otherwise: Some(otherwise),
        } => ends(otherwise) && arms.iter().all(|arm| ends(&arm.body)),
        _ => walk::jumps(last),
    })
}

/// The bodies of cases that fall into each other, each under the condition that control has come to it. All of a
/// `switch` is one scope, so what they declare stands before it.
fn guarded(draft: &mut Draft, selector: ExprId, group: Vec<Case>, all: &[Label], out: &mut Block) -> Block {
    let mut body = Block::new();
    let mut reached: Option<VariableId> = None;
    let last = group.len() - 1;
    for (number, case) in group.into_iter().enumerate() {
        let at = case.at;
        let inner: Block = case
            .body
            .into_iter()
            .filter_map(|statement| hoist(draft, statement, out))
            .collect();
        if number == last {
            body.push(Statement {
                kind: StatementKind::Block(inner),
                at,
            });
            break;
        }
        let here = matches(draft, selector, &case.labels, all, at);
        let variable = if let Some(variable) = reached {
            let mut build = draft.build(at);
            let before = build.variable(variable);
            let either = build.binary(BinaryOp::Or, before, here, Type::BOOL);
            let set = build.set(variable, either);
            body.push(Statement {
                kind: StatementKind::Expression(set),
                at,
            });
            variable
        } else {
            let variable = draft.local("reached", Type::BOOL, at);
            draft.moved.insert(variable);
            draft.tree[variable].initialiser = Some(here);
            body.push(Statement {
                kind: StatementKind::Declare(variable),
                at,
            });
            variable
        };
        reached = Some(variable);
        let condition = draft.build(at).variable(variable);
        let arms = vec![Arm {
            condition,
            body: inner,
        }];
        body.push(Statement {
            kind: StatementKind::If {
                arms,
                otherwise: None,
            },
            at,
        });
    }
    body
}

/// Moves a declaration before the `switch`; what is left of it where it stood.
fn hoist(draft: &mut Draft, statement: Statement, out: &mut Block) -> Option<Statement> {
    let StatementKind::Declare(variable) = statement.kind else {
        return Some(statement);
    };
    draft.moved.insert(variable);
    let at = statement.at;
    out.push(Statement {
        kind: StatementKind::Declare(variable),
        at,
    });
    let value = draft.tree[variable].initialiser.take()?;
    draft.tree[variable].kind = toyproof_glsl::tree::VariableKind::Local;
    let set = draft.build(at).set(variable, value);
    Some(Statement {
        kind: StatementKind::Expression(set),
        at,
    })
}

/// Whether the selector leads to one of those labels: to `default`, if it is no other of the whole `switch`.
fn matches(draft: &mut Draft, selector: ExprId, labels: &[Label], all: &[Label], at: Place) -> ExprId {
    let default = labels.contains(&Label::Default);
    let asked: Vec<ExprId> = if default {
        let others: Vec<Label> = all
            .iter()
            .copied()
            .filter(|label| !labels.contains(label))
            .collect();
        walk::values(&others).collect()
    } else {
        walk::values(labels).collect()
    };
    let mut build = draft.build(at);
    let tests: Vec<ExprId> = asked
        .into_iter()
        .map(|value| {
            let [left, right] = [selector, value].map(|expr| build.copy(expr));
            build.binary(BinaryOp::Equal, left, right, Type::BOOL)
        })
        .collect();
    let any = tests
        .into_iter()
        .reduce(|a, b| build.binary(BinaryOp::Or, a, b, Type::BOOL));
    match any {
        Some(any) if default => build.unary(UnaryOp::Not, any),
        Some(any) => any,
        None => build.literal(Value::Bool(default)),
    }
}

/// Gives a body the one end that naga understands.
fn end_in_break(draft: &mut Draft, body: &mut Block, at: Place) {
    while let Some(Statement {
        kind: StatementKind::Block(_),
        ..
    }) = body.last()
    {
        let Some(Statement {
            kind: StatementKind::Block(inner),
            at,
        }) = body.pop()
        else {
            return;
        };
        if !inner.iter().any(|statement| walk::declared(statement).is_some()) {
            body.extend(inner);
        } else if ends(&inner) {
            unnest(draft, inner, at, body);
        } else {
            body.push(Statement {
                kind: StatementKind::Block(inner),
                at,
            });
            break;
        }
    }
    match body.last().map(|last| &last.kind) {
        Some(StatementKind::Break) => return,
        Some(StatementKind::Return(_) | StatementKind::Continue | StatementKind::Discard) => {
            if let Some(jump) = body.pop() {
                body.push(always(draft, vec![jump], at));
            }
        }
        _ => {}
    }
    body.push(Statement {
        kind: StatementKind::Break,
        at,
    });
}

/// A block that ends in a jump: naga would take the jump for the end of the case.
fn unnest(draft: &mut Draft, mut inner: Block, at: Place, body: &mut Block) {
    if matches!(
        inner.last(),
        Some(Statement {
            kind: StatementKind::Break,
            ..
        })
    ) {
        inner.pop();
        body.push(Statement {
            kind: StatementKind::Block(inner),
            at,
        });
    } else {
        body.push(always(draft, inner, at));
    }
}

/// `if (true) …`
fn always(draft: &mut Draft, body: Block, at: Place) -> Statement {
    let condition = draft.build(at).literal(Value::Bool(true));
    let arms = vec![Arm { condition, body }];
    Statement {
        kind: StatementKind::If {
            arms,
            otherwise: None,
        },
        at,
    }
}
