//! Sequences of expressions, `a, b`, and what runs for its effect only: statements of their own, so that lowered text reads
//! well. Temporaries are declared where they are first assigned.
//!
//! naga refuses calls of `void` functions within sequences and `?:`.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    Arm, Block, ExprId, ExprKind, Place, Statement, StatementKind, Tree, VariableId, VariableKind, walk,
};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    let mut declared = HashSet::new();
    draft.each_statement(|draft, statement, out| {
        let mut statements = Block::new();
        split(draft, statement, &mut statements);
        declare(draft, statements, &mut declared, out);
    });
}

/// A statement as several, each with one effect.
fn split(draft: &mut Draft, statement: Statement, out: &mut Block) {
    let first = match &statement.kind {
        StatementKind::Expression(expr) => return effects(draft, *expr, out),
        StatementKind::Declare(variable) => draft.tree[*variable].initialiser,
        StatementKind::Return(value) => *value,
        StatementKind::If { arms, .. } => arms.first().map(|arm| arm.condition),
        StatementKind::Switch { selector, .. } => Some(*selector),
        _ => None,
    };
    if let Some(first) = first {
        lead(draft, first, out);
    }
    out.push(statement);
}

/// The statements that an expression comes to whose value nobody asks for.
fn effects(draft: &mut Draft, root: ExprId, out: &mut Block) {
    let mut pending = vec![root];
    while let Some(id) = pending.pop() {
        let at = draft.tree[id].at;
        match draft.tree[id].kind {
            ExprKind::Sequence { first, second } => pending.extend([second, first]),
            ExprKind::Conditional { condition, yes, no } if walk::acts(&draft.tree, id) => {
                lead(draft, condition, out);
                let [body, otherwise] = [yes, no].map(|branch| {
                    let mut body = Block::new();
                    effects(draft, branch, &mut body);
                    body
                });
                let otherwise = (!otherwise.is_empty()).then_some(otherwise);
                let arms = vec![Arm { condition, body }];
                out.push(Statement {
                    kind: StatementKind::If { arms, otherwise },
                    at,
                });
            }
            _ if walk::acts(&draft.tree, id) => {
                lead(draft, id, out);
                out.push(Statement {
                    kind: StatementKind::Expression(id),
                    at,
                });
            }
            _ => {}
        }
    }
}

/// Takes out of an expression what runs before anything else in it.
fn lead(draft: &mut Draft, root: ExprId, out: &mut Block) {
    while let Some((sequence, first, second)) = leading(&draft.tree, root) {
        effects(draft, first, out);
        draft.tree[sequence] = draft.tree[second].clone();
    }
}

/// The first sequence that is certainly evaluated, if nothing before it in the expression minds when it runs.
fn leading(tree: &Tree, root: ExprId) -> Option<(ExprId, ExprId, ExprId)> {
    let mut before = Vec::new();
    let (sequence, first, second) = strict(tree, root).into_iter().find_map(|id| {
        if let ExprKind::Sequence { first, second } = tree[id].kind {
            return Some((id, first, second));
        }
        before.push(id);
        None
    })?;
    let inside: HashSet<ExprId> = tree.postorder(sequence).into_iter().collect();
    let minds = before
        .into_iter()
        .filter(|id| !inside.contains(id))
        .any(|id| minds(tree, id, first));
    (!minds).then_some((sequence, first, second))
}

/// The nodes that are evaluated whatever the others give, operands before users.
fn strict(tree: &Tree, root: ExprId) -> Vec<ExprId> {
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
            // A target that is a variable is not read before it is written.
            &ExprKind::Assign {
                op: None,
                target,
                value,
            } if matches!(tree[target].kind, ExprKind::Variable(_)) => {
                operands.push(value);
            }
            // What a sequence ends with stands where the sequence stood.
            &ExprKind::Sequence { first, .. } => operands.push(first),
            kind => kind.for_each_operand(|operand| operands.push(operand)),
        }
        pending.extend(operands.into_iter().rev().map(|operand| (operand, false)));
    }
    order
}

/// Whether a node, evaluated already, would be another if `effect` had run before it.
fn minds(tree: &Tree, id: ExprId, effect: ExprId) -> bool {
    match tree[id].kind {
        ExprKind::Variable(variable) => {
            let foreign = !matches!(
                tree[variable].kind,
                VariableKind::Local | VariableKind::Parameter(_)
            );
            let fixed = matches!(tree[variable].kind, VariableKind::Const | VariableKind::Input(_));
            !fixed && (foreign || walk::mentions(tree, effect, variable))
        }
        ExprKind::Assign { .. } | ExprKind::Step { .. } | ExprKind::Call { .. } => true,
        ExprKind::Conditional { yes, no, .. } => {
            let branches = [yes, no].into_iter().flat_map(|branch| tree.postorder(branch));
            let leaves = branches.filter(|&id| !matches!(tree[id].kind, ExprKind::Conditional { .. }));
            leaves.into_iter().any(|id| minds(tree, id, effect))
        }
        _ => false,
    }
}

/// Declares the temporaries of those statements, in the block that they stand in.
fn declare(draft: &mut Draft, statements: Block, declared: &mut HashSet<VariableId>, out: &mut Block) {
    if draft.temporaries.is_empty() {
        out.extend(statements);
        return;
    }
    let mut rest = Block::new();
    let mut late = HashSet::new();
    for mut statement in statements {
        if let Some((variable, value)) = first_assignment(draft, &statement, declared, &late) {
            mark(draft, &statement, declared, &mut late, out);
            draft.tree[variable].initialiser = Some(value);
            statement.kind = StatementKind::Declare(variable);
        } else {
            mark(draft, &statement, declared, &mut late, out);
        }
        rest.push(statement);
    }
    out.append(&mut rest);
}

/// `t = value;` of a temporary that nothing has named before.
fn first_assignment(
    draft: &Draft,
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
    } = draft.tree[expr].kind
    else {
        return None;
    };
    let ExprKind::Variable(variable) = draft.tree[target].kind else {
        return None;
    };
    let new =
        draft.temporaries.contains(&variable) && !declared.contains(&variable) && !late.contains(&variable);
    (new && !walk::mentions(&draft.tree, value, variable)).then_some((variable, value))
}

/// Declares the temporaries of a statement that no declaration of their own precedes.
fn mark(
    draft: &Draft,
    statement: &Statement,
    declared: &mut HashSet<VariableId>,
    late: &mut HashSet<VariableId>,
    out: &mut Block,
) {
    let first = first_assignment(draft, statement, declared, late).map(|(variable, _)| variable);
    let mut roots = Vec::new();
    walk::each(std::slice::from_ref(statement), &mut |inner| {
        roots.extend(walk::own_expressions(&draft.tree, inner));
    });
    for root in roots {
        for id in draft.tree.postorder(root) {
            let ExprKind::Variable(variable) = draft.tree[id].kind else {
                continue;
            };
            if draft.temporaries.contains(&variable) && declared.insert(variable) && Some(variable) != first {
                late.insert(variable);
                out.push(declaration(variable, statement.at));
            }
        }
    }
}

fn declaration(variable: VariableId, at: Place) -> Statement {
    Statement {
        kind: StatementKind::Declare(variable),
        at,
    }
}
