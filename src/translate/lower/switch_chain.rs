//! `switch` as a chain of `if`, for a language whose `switch` takes no jumps inside the blocks of its cases.

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, Case, Condition, ExprId, ExprKind, Label, Place, Statement, StatementKind, StepOp,
    Type, Value, walk,
};

use super::branch::selector_matches;
use crate::lower::context::LoweringContext;

/// Replaces each `switch` with a jump inside a block of a case. The cases end in jumps already, and do not
/// fall into each other ([`Pass::Switches`](super::Pass::Switches)).
pub(crate) fn chain_switches(cx: &mut LoweringContext) {
    cx.each_statement(|cx, statement, out| {
        let at = statement.at;
        match statement.kind {
            StatementKind::Switch { selector, cases }
                if cases.iter().any(jumps_inside) && !is_continued_and_left(&cases) =>
            {
                let selector = named(cx, selector, at, out);
                out.push(chain(cx, selector, cases, at));
            }
            _ => out.push(statement),
        }
    });
}

/// Whether a case has a jump inside a block of its statements.
pub(crate) fn jumps_inside(case: &Case) -> bool {
    let mut found = false;
    for block in case.body.iter().flat_map(walk::child_blocks) {
        walk::each(block, &mut |inner| found |= walk::jumps(inner));
    }
    found
}

/// Whether cases are left by `break` inside a block, which needs a loop, and by `continue`, which would be that
/// loop's.
fn is_continued_and_left(cases: &[Case]) -> bool {
    let is_left = |case: &Case| {
        let last = case.body.len().saturating_sub(1);
        let is_trailing = |at, kind: &StatementKind| at == last && matches!(kind, StatementKind::Break);
        let mut statements = case.body.iter().enumerate();
        statements.any(|(at, statement)| {
            !is_trailing(at, &statement.kind) && leaves(std::slice::from_ref(statement))
        })
    };
    cases.iter().any(is_left) && cases.iter().any(|case| walk::continues(&case.body))
}

/// The selector as a variable, which is declared before the `switch` if it is an expression.
fn named(cx: &mut LoweringContext, selector: ExprId, at: Place, out: &mut Block) -> ExprId {
    if matches!(cx.tree[selector].kind, ExprKind::Variable(_)) {
        return selector;
    }
    let variable = cx.local("selector", cx.tree[selector].ty, at);
    cx.moved.insert(variable);
    cx.tree[variable].initializer = Some(selector);
    out.push(Statement::new(StatementKind::Declare(variable), at));
    cx.build(at).variable(variable)
}

/// `if (selector == 1) { … } else { … }`; in a loop of one iteration, if a case is left from inside a block.
fn chain(cx: &mut LoweringContext, selector: ExprId, cases: Vec<Case>, at: Place) -> Statement {
    let all: Vec<Label> = cases
        .iter()
        .flat_map(|case| case.labels.iter().copied())
        .collect();
    let mut arms = Vec::new();
    let mut otherwise = None;
    let mut is_left = false;
    for mut case in cases {
        if matches!(case.body.last(), Some(last) if matches!(last.kind, StatementKind::Break)) {
            case.body.pop();
        }
        is_left |= leaves(&case.body);
        if case.labels.contains(&Label::Default) {
            otherwise = Some(case.body);
        } else {
            let condition = selector_matches(cx, selector, &case.labels, &all, case.at);
            arms.push(Arm {
                condition,
                body: case.body,
            });
        }
    }
    let chain = match (arms.is_empty(), otherwise) {
        (true, otherwise) => StatementKind::Block(otherwise.unwrap_or_default()),
        (false, otherwise) => StatementKind::If { arms, otherwise },
    };
    let chain = Statement::new(chain, at);
    if is_left { once(cx, chain, at) } else { chain }
}

/// Whether a block has a `break` that is not of a loop or `switch` inside it.
fn leaves(block: &[Statement]) -> bool {
    block.iter().any(|statement| match statement.kind {
        StatementKind::Break => true,
        StatementKind::For { .. }
        | StatementKind::While { .. }
        | StatementKind::DoWhile { .. }
        | StatementKind::Switch { .. } => false,
        _ => walk::child_blocks(statement)
            .into_iter()
            .any(|block| leaves(block)),
    })
}

/// `for (int once = 0; once < 1; once++) { … }`
fn once(cx: &mut LoweringContext, body: Statement, at: Place) -> Statement {
    let variable = cx.local("once", Type::INT, at);
    cx.moved.insert(variable);
    let mut build = cx.build(at);
    let zero = build.literal(Value::Int(0));
    let one = build.literal(Value::Int(1));
    let left = build.variable(variable);
    let condition = build.binary(BinaryOp::Less, left, one, Type::BOOL);
    let target = build.variable(variable);
    let step = ExprKind::Step {
        op: StepOp::Increment,
        postfix: true,
        target,
    };
    let step = build.push(step, Type::INT);
    cx.tree[variable].initializer = Some(zero);
    let kind = StatementKind::For {
        init: vec![Statement::new(StatementKind::Declare(variable), at)],
        condition: Some(Condition::Expression(condition)),
        step: Some(step),
        body: vec![body],
    };
    Statement::new(kind, at)
}
