//! Turns sequences of expressions, `a, b`, and conditionals with side effects into statements, for
//! readability. Temporaries are declared at their first assignment.
//!
//! naga refuses calls of `void` functions within sequences and `?:`.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, ExprId, ExprKind, Place, Statement, StatementKind, Tree, VariableId, VariableKind,
    walk,
};

use crate::lower::context::LoweringContext;

pub(super) fn run(cx: &mut LoweringContext) {
    let mut declared = HashSet::new();
    cx.each_statement(|cx, statement, out| {
        let mut statements = Block::new();
        split(cx, statement, &mut statements);
        declare(cx, statements, &mut declared, out);
    });
}

/// Splits a statement into several, each with one effect.
fn split(cx: &mut LoweringContext, statement: Statement, out: &mut Block) {
    let first = match &statement.kind {
        StatementKind::Expression(expr) => return emit_effects(cx, *expr, out),
        StatementKind::Declare(variable) => cx.tree[*variable].initializer,
        StatementKind::Return(value) => *value,
        StatementKind::If { arms, .. } => arms.first().map(|arm| arm.condition),
        StatementKind::Switch { selector, .. } => Some(*selector),
        _ => None,
    };
    if let Some(first) = first {
        hoist_leading(cx, first, out);
    }
    out.push(statement);
}

/// Emits the statements for an expression whose value is not used.
fn emit_effects(cx: &mut LoweringContext, root: ExprId, out: &mut Block) {
    let mut pending = vec![root];
    while let Some(id) = pending.pop() {
        let at = cx.tree[id].at;
        match cx.tree[id].kind {
            ExprKind::Sequence { first, second } => pending.extend([second, first]),
            ExprKind::Conditional { condition, yes, no } if walk::has_side_effects(&cx.tree, id) => {
                hoist_leading(cx, condition, out);
                let [body, otherwise] = [yes, no].map(|branch| {
                    let mut body = Block::new();
                    emit_effects(cx, branch, &mut body);
                    body
                });
                let otherwise = (!otherwise.is_empty()).then_some(otherwise);
                let arms = vec![Arm { condition, body }];
                out.push(Statement::new(StatementKind::If { arms, otherwise }, at));
            }
            _ if walk::has_side_effects(&cx.tree, id) => {
                hoist_leading(cx, id, out);
                out.push(Statement::new(StatementKind::Expression(id), at));
            }
            _ => {}
        }
    }
}

/// Moves leading sequences of an expression to statements before it.
fn hoist_leading(cx: &mut LoweringContext, root: ExprId, out: &mut Block) {
    while let Some((sequence, first, second)) = leading_sequence(&cx.tree, root) {
        emit_effects(cx, first, out);
        cx.tree[sequence] = cx.tree[second].clone();
    }
}

/// The first sequence that is always evaluated, unless it affects an expression evaluated before it.
fn leading_sequence(tree: &Tree, root: ExprId) -> Option<(ExprId, ExprId, ExprId)> {
    let mut before = Vec::new();
    let (sequence, first, second) = always_evaluated(tree, root).into_iter().find_map(|id| {
        if let ExprKind::Sequence { first, second } = tree[id].kind {
            return Some((id, first, second));
        }
        before.push(id);
        None
    })?;
    let inside: HashSet<ExprId> = tree.postorder(sequence).into_iter().collect();
    let affected = before
        .into_iter()
        .filter(|id| !inside.contains(id))
        .any(|id| is_affected(tree, id, first));
    (!affected).then_some((sequence, first, second))
}

/// The nodes that are always evaluated, operands before users.
fn always_evaluated(tree: &Tree, root: ExprId) -> Vec<ExprId> {
    let mut order = Vec::new();
    let mut pending = vec![(root, false)];
    while let Some((id, done)) = pending.pop() {
        if done {
            order.push(id);
            continue;
        }
        pending.push((id, true));
        let mut operands = Vec::new();
        match &tree[id].kind {
            ExprKind::Conditional { condition, .. } => operands.push(*condition),
            ExprKind::Binary {
                op: BinaryOp::And | BinaryOp::Or,
                left,
                ..
            } => operands.push(*left),
            // A target is not read before it is written; only its indices are evaluated.
            &ExprKind::Assign {
                op: None,
                target,
                value,
            } => {
                operands.push(value);
                let indices = tree.path(target).filter_map(|node| match tree[node].kind {
                    ExprKind::Index { index, .. } => Some(index),
                    _ => None,
                });
                operands.extend(indices);
                operands.reverse();
            }
            // The last operand of a sequence takes the sequence's place.
            &ExprKind::Sequence { first, .. } => operands.push(first),
            kind => kind.for_each_operand(|operand| operands.push(operand)),
        }
        pending.extend(operands.into_iter().rev().map(|operand| (operand, false)));
    }
    order
}

/// Whether a node's value could differ if `effect` ran before it.
fn is_affected(tree: &Tree, id: ExprId, effect: ExprId) -> bool {
    match tree[id].kind {
        ExprKind::Variable(variable) => {
            let foreign = !matches!(
                tree[variable].kind,
                VariableKind::Local | VariableKind::Parameter(_)
            );
            let fixed = tree[variable].kind == VariableKind::Const || tree[variable].kind.is_input();
            !fixed && (foreign && walk::calls(tree, effect) || walk::writes(tree, effect, variable))
        }
        ExprKind::Assign { .. } | ExprKind::Step { .. } | ExprKind::Call { .. } => true,
        ExprKind::Binary {
            op: BinaryOp::And | BinaryOp::Or,
            right,
            ..
        } => tree.postorder(right).into_iter().any(|id| match tree[id].kind {
            // Its operands follow.
            ExprKind::Binary { .. } | ExprKind::Conditional { .. } => false,
            _ => is_affected(tree, id, effect),
        }),
        ExprKind::Conditional { yes, no, .. } => {
            let branches = [yes, no].into_iter().flat_map(|branch| tree.postorder(branch));
            let leaves = branches.filter(|&id| !matches!(tree[id].kind, ExprKind::Conditional { .. }));
            leaves.into_iter().any(|id| is_affected(tree, id, effect))
        }
        _ => false,
    }
}

/// Declares the temporaries of the statements in their block.
fn declare(cx: &mut LoweringContext, statements: Block, declared: &mut HashSet<VariableId>, out: &mut Block) {
    if cx.temporaries.is_empty() {
        out.extend(statements);
        return;
    }
    let mut rest = Block::new();
    let mut late = HashSet::new();
    for mut statement in statements {
        if let Some((variable, value)) = first_assignment(cx, &statement, declared, &late) {
            declare_temporaries(cx, &statement, declared, &mut late, out);
            cx.tree[variable].initializer = Some(value);
            statement.kind = StatementKind::Declare(variable);
        } else {
            declare_temporaries(cx, &statement, declared, &mut late, out);
        }
        rest.push(statement);
    }
    out.append(&mut rest);
}

/// `t = value;` of a temporary that no earlier statement names.
fn first_assignment(
    cx: &LoweringContext,
    statement: &Statement,
    declared: &HashSet<VariableId>,
    late: &HashSet<VariableId>,
) -> Option<(VariableId, ExprId)> {
    let StatementKind::Expression(expr) = statement.kind else {
        return None;
    };
    let ExprKind::Assign {
        op: None,
        target,
        value,
    } = cx.tree[expr].kind
    else {
        return None;
    };
    let ExprKind::Variable(variable) = cx.tree[target].kind else {
        return None;
    };
    let new =
        cx.temporaries.contains(&variable) && !declared.contains(&variable) && !late.contains(&variable);
    (new && !walk::mentions(&cx.tree, value, variable)).then_some((variable, value))
}

/// Declares those temporaries of a statement that are not declared by their first assignment.
fn declare_temporaries(
    cx: &LoweringContext,
    statement: &Statement,
    declared: &mut HashSet<VariableId>,
    late: &mut HashSet<VariableId>,
    out: &mut Block,
) {
    let first = first_assignment(cx, statement, declared, late).map(|(variable, _)| variable);
    let mut roots = Vec::new();
    walk::each(std::slice::from_ref(statement), &mut |inner| {
        roots.extend(walk::own_expressions(&cx.tree, inner));
    });
    for root in roots {
        for id in cx.tree.postorder(root) {
            let ExprKind::Variable(variable) = cx.tree[id].kind else {
                continue;
            };
            if cx.temporaries.contains(&variable) && declared.insert(variable) && Some(variable) != first {
                late.insert(variable);
                out.push(declaration(variable, statement.at));
            }
        }
    }
}

fn declaration(variable: VariableId, at: Place) -> Statement {
    Statement::new(StatementKind::Declare(variable), at)
}
