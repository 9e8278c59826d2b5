//! Visitors of statements and of what expressions write. Blocks nest at most `MAX_NESTING` deep, so these recurse.

use std::collections::HashSet;

use crate::tree::{
    Block, Condition, Direction, ExprId, ExprKind, Label, Statement, StatementKind, Tree, VariableId,
    VariableKind,
};

/// The blocks directly inside of a statement, in order; the `init` of a `for` is one.
#[must_use]
pub fn inner(statement: &Statement) -> Vec<&Block> {
    match &statement.kind {
        StatementKind::Block(body)
        | StatementKind::While { body, .. }
        | StatementKind::DoWhile { body, .. } => vec![body],
        StatementKind::If { arms, otherwise } => arms.iter().map(|arm| &arm.body).chain(otherwise).collect(),
        StatementKind::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        StatementKind::For { init, body, .. } => vec![init, body],
        _ => Vec::new(),
    }
}

/// The blocks directly inside of a statement that hold statements of any kind: not the `init` of a `for`.
pub fn inner_mut(statement: &mut Statement) -> Vec<&mut Block> {
    match &mut statement.kind {
        StatementKind::Block(body)
        | StatementKind::While { body, .. }
        | StatementKind::DoWhile { body, .. }
        | StatementKind::For { body, .. } => vec![body],
        StatementKind::If { arms, otherwise } => arms
            .iter_mut()
            .map(|arm| &mut arm.body)
            .chain(otherwise)
            .collect(),
        StatementKind::Switch { cases, .. } => cases.iter_mut().map(|case| &mut case.body).collect(),
        _ => Vec::new(),
    }
}

/// Calls `visit` with every statement, outer ones before those inside of them.
pub fn each<'a>(block: &'a [Statement], visit: &mut dyn FnMut(&'a Statement)) {
    for statement in block {
        visit(statement);
        for body in inner(statement) {
            each(body, visit);
        }
    }
}

/// Rebuilds a block from the inside out: `change` is given each statement, those inside of it done, and puts what
/// becomes of it into the new block. The `init` of a `for` stays as it is.
pub fn rebuild(block: Block, change: &mut dyn FnMut(Statement, &mut Block)) -> Block {
    let mut out = Block::with_capacity(block.len());
    for mut statement in block {
        for body in inner_mut(&mut statement) {
            *body = rebuild(std::mem::take(body), change);
        }
        change(statement, &mut out);
    }
    out
}

/// The expressions that a statement evaluates itself, in the order of its text.
#[must_use]
pub fn own_expressions(tree: &Tree, statement: &Statement) -> Vec<ExprId> {
    let initialiser = |variable: VariableId| tree[variable].initialiser;
    let tested = |condition: &Condition| match *condition {
        Condition::Expression(expr) => Some(expr),
        Condition::Declare(variable) => initialiser(variable),
    };
    match &statement.kind {
        StatementKind::Expression(expr) => vec![*expr],
        StatementKind::Declare(variable) => initialiser(*variable).into_iter().collect(),
        StatementKind::If { arms, .. } => arms.iter().map(|arm| arm.condition).collect(),
        StatementKind::Switch { selector, .. } => vec![*selector],
        StatementKind::For { condition, step, .. } => {
            condition.iter().filter_map(tested).chain(*step).collect()
        }
        StatementKind::While { condition, .. } => tested(condition).into_iter().collect(),
        StatementKind::DoWhile { condition, .. } => vec![*condition],
        StatementKind::Return(value) => value.iter().copied().collect(),
        StatementKind::Struct(_)
        | StatementKind::Block(_)
        | StatementKind::Break
        | StatementKind::Continue
        | StatementKind::Discard => Vec::new(),
    }
}

/// The variables that a statement declares itself.
#[must_use]
pub fn declared(statement: &Statement) -> Option<VariableId> {
    match statement.kind {
        StatementKind::Declare(variable)
        | StatementKind::While {
            condition: Condition::Declare(variable),
            ..
        }
        | StatementKind::For {
            condition: Some(Condition::Declare(variable)),
            ..
        } => Some(variable),
        _ => None,
    }
}

/// Every expression that a block evaluates: whole trees, by their roots.
#[must_use]
pub fn roots(tree: &Tree, block: &Block) -> Vec<ExprId> {
    let mut roots = Vec::new();
    each(block, &mut |statement| {
        roots.extend(own_expressions(tree, statement));
    });
    roots
}

/// Whether running an expression does more than give a value, or may take long: an assignment or a call of an
/// author's function stands in it.
#[must_use]
pub fn acts(tree: &Tree, root: ExprId) -> bool {
    any(tree, root, |kind| match kind {
        ExprKind::Assign { .. } | ExprKind::Step { .. } | ExprKind::Call { .. } => true,
        ExprKind::BuiltIn { function, .. } => function.out_parameter().is_some(),
        _ => false,
    })
}

/// Whether one is found at or below an expression.
pub fn any(tree: &Tree, root: ExprId, mut is_one: impl FnMut(&ExprKind) -> bool) -> bool {
    let mut pending = vec![root];
    while let Some(id) = pending.pop() {
        if is_one(&tree[id].kind) {
            return true;
        }
        tree[id].kind.for_each_operand(|operand| pending.push(operand));
    }
    false
}

/// Whether control can leave a loop's body by a `continue` of that loop.
#[must_use]
pub fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match &statement.kind {
        StatementKind::Continue => true,
        StatementKind::For { .. } | StatementKind::While { .. } | StatementKind::DoWhile { .. } => false,
        _ => inner(statement).into_iter().any(continues),
    })
}

/// Whether nothing that follows the statement in its block is ever run.
#[must_use]
pub fn jumps(statement: &Statement) -> bool {
    matches!(
        statement.kind,
        StatementKind::Break | StatementKind::Continue | StatementKind::Return(_) | StatementKind::Discard
    )
}

/// The labels of a `case` that are values, with their texts.
pub fn values(labels: &[Label]) -> impl Iterator<Item = ExprId> + '_ {
    labels.iter().filter_map(|label| match label {
        Label::Case { expr, .. } => Some(*expr),
        Label::Default => None,
    })
}

/// Whether a variable stands in an expression.
#[must_use]
pub fn mentions(tree: &Tree, root: ExprId, variable: VariableId) -> bool {
    any(
        tree,
        root,
        |kind| matches!(kind, ExprKind::Variable(v) if *v == variable),
    )
}

/// Whether evaluating `value` may change what a path reads, its variable or what its indices are made of:
/// that stands in `value` where something acts, or a function that is called may know it.
#[must_use]
pub fn may_change(tree: &Tree, value: ExprId, path: ExprId) -> bool {
    if !acts(tree, value) {
        return false;
    }
    let nodes = tree.postorder(path).into_iter();
    let read: HashSet<VariableId> = nodes
        .filter_map(|id| match tree[id].kind {
            ExprKind::Variable(variable) => Some(variable),
            _ => None,
        })
        .collect();
    let has_global = read
        .iter()
        .any(|&variable| tree[variable].kind == VariableKind::Global);
    any(tree, value, |kind| match kind {
        ExprKind::Variable(other) => read.contains(other),
        ExprKind::Call { .. } => has_global,
        _ => false,
    })
}

impl Tree {
    /// Calls `visit` with each lvalue that the expression itself writes, not its operands, and with the value where `=` gives one.
    pub fn each_write(&self, expr: ExprId, mut visit: impl FnMut(ExprId, Option<ExprId>)) {
        match &self[expr].kind {
            ExprKind::Assign { op, target, value } => visit(*target, op.is_none().then_some(*value)),
            ExprKind::Step { target, .. } => visit(*target, None),
            ExprKind::Call { function, arguments } => {
                for (&parameter, &argument) in self[*function].parameters.iter().zip(arguments) {
                    if matches!(direction(self, parameter), Direction::Out | Direction::InOut) {
                        visit(argument, None);
                    }
                }
            }
            ExprKind::BuiltIn { function, arguments } => {
                if let Some(written) = function.out_parameter() {
                    visit(arguments[written], None);
                }
            }
            _ => {}
        }
    }
}

/// How a parameter is passed.
#[must_use]
pub fn direction(tree: &Tree, parameter: VariableId) -> Direction {
    match tree[parameter].kind {
        VariableKind::Parameter(direction) => direction,
        _ => Direction::In,
    }
}
