//! Loops whose head or step naga or a driver translates wrongly.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    Arm, Block, Condition, ExprId, ExprKind, Place, Statement, StatementKind, Tree, Type, UnaryOp, Value,
    VariableId, walk,
};

use crate::lower::context::LoweringContext;

/// Moves the step of a `for` without `continue` to the end of its body.
///
/// naga puts the step into SPIR-V's continue construct. Mesa 22.3 moves that to the beginning of the loop,
/// behind a test for the first iteration, and peels the test off: a vector initialized by a constant then
/// takes one step too many. With a `continue` in the body Mesa does not peel and is correct. Metal, HLSL and
/// GLSL lack such a construct, so naga writes a flag for it.
pub(super) fn move_steps(cx: &mut LoweringContext) {
    cx.each_statement(|cx, mut statement, out| {
        if let StatementKind::For { step, body, .. } = &mut statement.kind
            && !walk::continues(body)
            && let Some(last) = step.take()
        {
            let at = cx.tree[last].at;
            if shadows_name(cx, body, last) {
                let inner = std::mem::take(body);
                body.push(Statement::new(StatementKind::Block(inner), at));
            }
            body.push(Statement::new(StatementKind::Expression(last), at));
        }
        out.push(statement);
    });
}

/// Whether a block shadows a name that a following expression uses.
fn shadows_name(cx: &LoweringContext, body: &Block, following: ExprId) -> bool {
    let names: HashSet<&str> = body
        .iter()
        .filter_map(walk::declared)
        .map(|variable| cx.tree[variable].name.as_str())
        .collect();
    walk::any(
        &cx.tree,
        following,
        |kind| matches!(kind, ExprKind::Variable(variable) if names.contains(cx.tree[*variable].name.as_str())),
    )
}

/// Moves declarations out of loop heads: `while (bool b = f())`, and a `for` that declares variables of
/// several types or begins with several expressions. They come before the loop, in a block of their own.
///
/// naga does not support a declaration as the condition of a `while`, nor variables of different types in a
/// `for`.
pub(super) fn hoist_loop_heads(cx: &mut LoweringContext) {
    cx.each_statement(|cx, mut statement, out| {
        let at = statement.at;
        let mut before = Block::new();
        match &mut statement.kind {
            StatementKind::While { condition, .. } => assign_condition(cx, condition, &mut before),
            StatementKind::For { init, condition, .. } => {
                if !is_one_statement(cx, init) {
                    cx.moved.extend(init.iter().filter_map(walk::declared));
                    before.append(init);
                }
                if let Some(condition) = condition {
                    assign_condition(cx, condition, &mut before);
                }
            }
            _ => {}
        }
        if before.is_empty() {
            out.push(statement);
        } else {
            before.push(statement);
            out.push(Statement::new(StatementKind::Block(before), at));
        }
    });
}

/// Replaces a condition that declares a variable by an assignment.
fn assign_condition(cx: &mut LoweringContext, condition: &mut Condition, before: &mut Block) {
    let Condition::Declare(variable) = *condition else {
        return;
    };
    let Some(value) = cx.tree[variable].initializer.take() else {
        return;
    };
    cx.moved.insert(variable);
    let at = cx.tree[value].at;
    before.push(Statement::new(StatementKind::Declare(variable), at));
    *condition = Condition::Expression(cx.build(at).set(variable, value));
}

/// Whether one GLSL statement can express it: `float a = 0.0, b = 1.0` or `i = 0`.
fn is_one_statement(cx: &LoweringContext, init: &Block) -> bool {
    let declared: Option<Vec<VariableId>> = init
        .iter()
        .map(|statement| match statement.kind {
            StatementKind::Declare(variable) => Some(variable),
            _ => None,
        })
        .collect();
    match (declared, init.as_slice()) {
        (Some(variables), _) => variables.windows(2).all(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|id| &cx.tree[id]);
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
        ) => !matches!(cx.tree[*only].kind, ExprKind::Sequence { .. }),
        _ => false,
    }
}

/// Rewrites `do … while (c)` with a `continue` as `for (bool again = true; again; again = c) …`.
///
/// naga's `continue` skips the condition.
pub(super) fn lower_do_while(cx: &mut LoweringContext) {
    cx.each_statement(|cx, statement, out| {
        let at = statement.at;
        let kind = match statement.kind {
            StatementKind::DoWhile { body, condition } if walk::continues(&body) => {
                let again = cx.local("again", Type::BOOL, at);
                cx.moved.insert(again);
                let mut build = cx.build(at);
                let begin = build.literal(Value::Bool(true));
                build.tree[again].initializer = Some(begin);
                let tested = build.variable(again);
                let step = build.set(again, condition);
                StatementKind::For {
                    init: vec![Statement::new(StatementKind::Declare(again), at)],
                    condition: Some(Condition::Expression(tested)),
                    step: Some(step),
                    body,
                }
            }
            kind => kind,
        };
        out.push(Statement::new(kind, at));
    });
}

/// Moves `void` calls out of loop heads: `for (…; …; f(x), i++)`, `while (f(x), i < 3)`.
///
/// naga refuses calls of `void` functions in sequences, and a head cannot hold statements. A condition moves
/// to the beginning of the body; so does a step, which is skipped in the first iteration, so that `continue`
/// still reaches it.
pub(super) fn lower_void_calls(cx: &mut LoweringContext) {
    cx.each_statement(|cx, statement, out| {
        let at = statement.at;
        match statement.kind {
            StatementKind::While {
                condition: Condition::Expression(condition),
                body,
            } if has_void_call(&cx.tree, condition) => {
                let head = vec![break_unless(cx, condition, at)];
                out.push(infinite_loop(Block::new(), head, body, at));
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } if [condition_expression(condition), step]
                .into_iter()
                .flatten()
                .any(|part| has_void_call(&cx.tree, part)) =>
            {
                let mut head = Block::new();
                if let Some(step) = step {
                    head.push(skip_first_iteration(cx, step, at, out));
                }
                if let Some(condition) = condition_expression(condition) {
                    head.push(break_unless(cx, condition, at));
                }
                out.push(infinite_loop(init, head, body, at));
            }
            kind => out.push(Statement::new(kind, at)),
        }
    });
}

fn condition_expression(condition: Option<Condition>) -> Option<ExprId> {
    match condition {
        Some(Condition::Expression(condition)) => Some(condition),
        _ => None,
    }
}

/// Whether an expression contains a sequence that calls a `void` function.
fn has_void_call(tree: &Tree, root: ExprId) -> bool {
    let is_void = |id: ExprId| tree[id].ty == Type::Void;
    walk::any(tree, root, |kind| match *kind {
        ExprKind::Sequence { first, second } => is_void(first) || is_void(second),
        _ => false,
    })
}

/// `for (init; ; ) { head body }`
fn infinite_loop(init: Block, mut head: Block, body: Block, at: Place) -> Statement {
    // A block of its own keeps the body's declarations apart.
    head.push(Statement::new(StatementKind::Block(body), at));
    Statement::new(
        StatementKind::For {
            init,
            condition: None,
            step: None,
            body: head,
        },
        at,
    )
}

/// `if (!condition) break;`
fn break_unless(cx: &mut LoweringContext, condition: ExprId, at: Place) -> Statement {
    let condition = cx.build(at).unary(UnaryOp::Not, condition);
    let body = vec![Statement::new(StatementKind::Break, at)];
    Statement::new(StatementKind::when(condition, body), at)
}

/// `if (again) step; else again = true;`, with `bool again = false;` before the loop.
fn skip_first_iteration(cx: &mut LoweringContext, step: ExprId, at: Place, out: &mut Block) -> Statement {
    let again = cx.local("again", Type::BOOL, at);
    cx.moved.insert(again);
    let mut build = cx.build(at);
    let [no, yes] = [false, true].map(|value| build.literal(Value::Bool(value)));
    build.tree[again].initializer = Some(no);
    let condition = build.variable(again);
    let set = build.set(again, yes);
    out.push(Statement::new(StatementKind::Declare(again), at));
    let [step, set] = [step, set].map(|expr| vec![Statement::new(StatementKind::Expression(expr), at)]);
    let arms = vec![Arm {
        condition,
        body: step,
    }];
    Statement::new(
        StatementKind::If {
            arms,
            otherwise: Some(set),
        },
        at,
    )
}
