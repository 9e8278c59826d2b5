//! Branches: `switch`, long `else if` chains and unreachable statements.

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, Case, ExprId, ExprKind, Label, Place, Statement, StatementKind, Tree, Type,
    UnaryOp, Value, VariableId, VariableKind, walk,
};

use crate::lower::context::LoweringContext;

/// Ends each case of a `switch` in its own `break`.
///
/// naga treats every case whose last statement is not a plain `break` as a fall-through, even `{ …; break; }`
/// and `return x;`, and cannot write a fall-through as WGSL (gfx-rs/wgpu #4415, #9625). Cases that fall into
/// each other become one case, whose parts are guarded by the labels that reach them.
pub(super) fn lower_switches(cx: &mut LoweringContext) {
    cx.each_statement(|cx, statement, out| match statement.kind {
        StatementKind::Switch { selector, cases } => rewrite_switch(cx, selector, cases, statement.at, out),
        _ => out.push(statement),
    });
}

fn rewrite_switch(
    cx: &mut LoweringContext,
    mut selector: ExprId,
    cases: Vec<Case>,
    at: Place,
    out: &mut Block,
) {
    let groups = group_cases(cases);
    if groups.iter().any(|group| group.len() > 1) {
        // The guards read the selector again.
        let variable = cx.local("selector", cx.tree[selector].ty, at);
        cx.moved.insert(variable);
        cx.tree[variable].initializer = Some(selector);
        selector = cx.build(at).variable(variable);
        out.push(Statement::new(StatementKind::Declare(variable), at));
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
            guard_cases(cx, selector, group, &all, out)
        } else {
            group.into_iter().flat_map(|case| case.body).collect()
        };
        end_in_break(cx, &mut body, at);
        cases.push(Case { labels, body, at });
    }
    // naga gives a `switch` no scope of its own.
    let declares = cases
        .iter()
        .flat_map(|case| &case.body)
        .any(|statement| walk::declared(statement).is_some());
    let switch = Statement::new(StatementKind::Switch { selector, cases }, at);
    out.push(if declares {
        Statement::new(StatementKind::Block(vec![switch]), at)
    } else {
        switch
    });
}

/// Groups each case with the case that it falls into.
fn group_cases(cases: Vec<Case>) -> Vec<Vec<Case>> {
    let mut groups: Vec<Vec<Case>> = Vec::new();
    let mut falls = false;
    for case in cases {
        let jumps = always_jumps(&case.body);
        match groups.last_mut() {
            Some(group) if falls => group.push(case),
            _ => groups.push(vec![case]),
        }
        falls = !jumps;
    }
    groups
}

/// Whether control never reaches the end of a block.
fn always_jumps(block: &Block) -> bool {
    block.last().is_some_and(|last| match &last.kind {
        StatementKind::Block(body) => always_jumps(body),
        StatementKind::If {
            arms,
            otherwise: Some(otherwise),
        } => always_jumps(otherwise) && arms.iter().all(|arm| always_jumps(&arm.body)),
        _ => walk::jumps(last),
    })
}

/// Merges cases that fall into each other; each body runs if control has reached its case. A `switch` is a
/// single scope, so declarations move before it.
fn guard_cases(
    cx: &mut LoweringContext,
    selector: ExprId,
    group: Vec<Case>,
    all: &[Label],
    out: &mut Block,
) -> Block {
    let mut body = Block::new();
    let mut reached: Option<VariableId> = None;
    let last = group.len() - 1;
    for (number, case) in group.into_iter().enumerate() {
        let at = case.at;
        let inner: Block = case
            .body
            .into_iter()
            .filter_map(|statement| hoist_declaration(cx, statement, out))
            .collect();
        if number == last {
            body.push(Statement::new(StatementKind::Block(inner), at));
            break;
        }
        let here = selector_matches(cx, selector, &case.labels, all, at);
        let variable = if let Some(variable) = reached {
            let mut build = cx.build(at);
            let before = build.variable(variable);
            let either = build.binary(BinaryOp::Or, before, here, Type::BOOL);
            let set = build.set(variable, either);
            body.push(Statement::new(StatementKind::Expression(set), at));
            variable
        } else {
            let variable = cx.local("reached", Type::BOOL, at);
            cx.moved.insert(variable);
            cx.tree[variable].initializer = Some(here);
            body.push(Statement::new(StatementKind::Declare(variable), at));
            variable
        };
        reached = Some(variable);
        let condition = cx.build(at).variable(variable);
        body.push(Statement::new(StatementKind::when(condition, inner), at));
    }
    body
}

/// Moves a declaration before the `switch`. Returns the assignment that replaces it, if it had an
/// initializer.
fn hoist_declaration(cx: &mut LoweringContext, statement: Statement, out: &mut Block) -> Option<Statement> {
    let StatementKind::Declare(variable) = statement.kind else {
        return Some(statement);
    };
    cx.moved.insert(variable);
    let at = statement.at;
    out.push(Statement::new(StatementKind::Declare(variable), at));
    let value = cx.tree[variable].initializer.take()?;
    cx.tree[variable].kind = VariableKind::Local;
    let set = cx.build(at).set(variable, value);
    Some(Statement::new(StatementKind::Expression(set), at))
}

/// Builds the condition that the selector matches one of the labels; `default` matches if no other label of
/// the whole `switch` does.
pub(super) fn selector_matches(
    cx: &mut LoweringContext,
    selector: ExprId,
    labels: &[Label],
    all: &[Label],
    at: Place,
) -> ExprId {
    let default = labels.contains(&Label::Default);
    let values: Vec<ExprId> = if default {
        let others: Vec<Label> = all
            .iter()
            .copied()
            .filter(|label| !labels.contains(label))
            .collect();
        walk::values(&others).collect()
    } else {
        walk::values(labels).collect()
    };
    let mut build = cx.build(at);
    let tests: Vec<ExprId> = values
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

/// Ends a body in the only form that naga recognizes: a plain `break`.
fn end_in_break(cx: &mut LoweringContext, body: &mut Block, at: Place) {
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
        } else if always_jumps(&inner) {
            rewrite_trailing_jump(cx, inner, at, body);
        } else {
            body.push(Statement::new(StatementKind::Block(inner), at));
            break;
        }
    }
    match body.last().map(|last| &last.kind) {
        Some(StatementKind::Break) => return,
        Some(StatementKind::Return(_) | StatementKind::Continue | StatementKind::Discard) => {
            if let Some(jump) = body.pop() {
                body.push(if_true(cx, vec![jump], at));
            }
        }
        _ => {}
    }
    body.push(Statement::new(StatementKind::Break, at));
}

/// Rewrites a block that ends in a jump, which naga would treat as the end of the case.
fn rewrite_trailing_jump(cx: &mut LoweringContext, mut inner: Block, at: Place, body: &mut Block) {
    if matches!(
        inner.last(),
        Some(Statement {
            kind: StatementKind::Break,
            ..
        })
    ) {
        inner.pop();
        body.push(Statement::new(StatementKind::Block(inner), at));
    } else {
        body.push(if_true(cx, inner, at));
    }
}

/// `if (true) …`
fn if_true(cx: &mut LoweringContext, body: Block, at: Place) -> Statement {
    let condition = cx.build(at).literal(Value::Bool(true));
    Statement::new(StatementKind::when(condition, body), at)
}

/// Removes the `if (true)` around the last jumps of cases, which only naga's reader of GLSL needs.
pub(crate) fn unwrap_case_jumps(cx: &mut LoweringContext) {
    cx.each_statement(|cx, mut statement, out| {
        if let StatementKind::Switch { cases, .. } = &mut statement.kind {
            for case in cases {
                unwrap_jump(&cx.tree, &mut case.body);
            }
        }
        out.push(statement);
    });
}

/// Replaces `if (true) { …; return; } break;` at the end of a case by what is inside, unless its variables could
/// hide those of the case.
pub(crate) fn unwrap_jump(tree: &Tree, body: &mut Block) {
    let [before @ .., last, end] = body.as_slice() else {
        return;
    };
    let declares = |block: &[Statement]| block.iter().any(|statement| walk::declared(statement).is_some());
    let inner = match (&last.kind, &end.kind) {
        (
            StatementKind::If {
                arms,
                otherwise: None,
            },
            StatementKind::Break,
        ) => match arms.as_slice() {
            [arm] if is_true(tree, arm.condition) && !(declares(before) && declares(&arm.body)) => &arm.body,
            _ => return,
        },
        _ => return,
    };
    let (inner, end) = (inner.clone(), end.clone());
    body.truncate(before.len());
    body.extend(inner);
    // In HLSL, execution goes on after `discard`.
    if !matches!(body.last(), Some(last) if matches!(last.kind, StatementKind::Return(_) | StatementKind::Continue))
    {
        body.push(end);
    }
}

fn is_true(tree: &Tree, condition: ExprId) -> bool {
    matches!(&tree[condition].kind, ExprKind::Literal(literal) if literal.value == Value::Bool(true))
}

/// Maximum number of conditions in one `else if` chain.
const MAX_CHAIN_CONDITIONS: usize = 32;

/// Splits chains of hundreds of `else if` into shorter ones; each runs if no earlier condition held.
///
/// naga nests each `else` in the previous one and overflows its stack; WGSL compilers stop at 127 levels.
pub(super) fn split_else_if(cx: &mut LoweringContext) {
    cx.each_statement(|cx, statement, out| match statement.kind {
        StatementKind::If { arms, otherwise } if arms.len() > MAX_CHAIN_CONDITIONS => {
            split_chain(cx, arms, otherwise, statement.at, out);
        }
        kind => out.push(Statement::new(kind, statement.at)),
    });
}

/// `bool open = true; if (open) { open = false; if (a) … else { open = true; } } if (open) { … }`
fn split_chain(
    cx: &mut LoweringContext,
    arms: Vec<Arm>,
    mut otherwise: Option<Block>,
    at: Place,
    out: &mut Block,
) {
    let open = cx.local("open", Type::BOOL, at);
    cx.moved.insert(open);
    let begin = cx.build(at).literal(Value::Bool(true));
    cx.tree[open].initializer = Some(begin);
    out.push(Statement::new(StatementKind::Declare(open), at));
    let mut arms = arms.into_iter().peekable();
    while arms.peek().is_some() {
        let arms_here: Vec<Arm> = arms.by_ref().take(MAX_CHAIN_CONDITIONS).collect();
        let last = if arms.peek().is_some() {
            Some(vec![set_open(cx, open, true, at)])
        } else {
            otherwise.take()
        };
        let chain = StatementKind::If {
            arms: arms_here,
            otherwise: last,
        };
        let body = vec![set_open(cx, open, false, at), Statement::new(chain, at)];
        let condition = cx.build(at).variable(open);
        out.push(Statement::new(StatementKind::when(condition, body), at));
    }
}

fn set_open(cx: &mut LoweringContext, open: VariableId, value: bool, at: Place) -> Statement {
    let mut build = cx.build(at);
    let value = build.literal(Value::Bool(value));
    let set = build.set(open, value);
    Statement::new(StatementKind::Expression(set), at)
}

/// Removes statements after a `return`, `break`, `continue` or `discard` in the same block.
///
/// naga drops such statements but keeps the expressions that they refer to, which its validator refuses.
pub(super) fn remove_dead_code(cx: &mut LoweringContext) {
    cx.each_body(|_, _, body| without_dead_code(body));
}

fn without_dead_code(mut block: Block) -> Block {
    for statement in &mut block {
        for body in walk::statement_blocks_mut(statement) {
            *body = without_dead_code(std::mem::take(body));
        }
    }
    if let Some(jump) = block.iter().position(ends_in_jump) {
        block.truncate(jump + 1);
    }
    block
}

/// Whether a statement always jumps; inner blocks are truncated at their jumps already.
fn ends_in_jump(statement: &Statement) -> bool {
    match &statement.kind {
        StatementKind::Block(body) => body.last().is_some_and(ends_in_jump),
        _ => walk::jumps(statement),
    }
}
