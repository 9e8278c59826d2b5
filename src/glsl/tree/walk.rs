//! Traversals of statements and expressions. Blocks nest at most `MAX_NESTING` deep, so these recurse.

use std::collections::HashSet;

use crate::tree::{
    Block, Condition, Direction, ExprId, ExprKind, Label, Statement, StatementKind, Tree, VariableId,
    VariableKind,
};

/// The blocks directly inside a statement, in order; the `init` of a `for` is one.
pub fn child_blocks(statement: &Statement) -> Vec<&Block> {
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

/// The blocks directly inside a statement that can contain any statement: not the `init` of a `for`.
pub fn statement_blocks_mut(statement: &mut Statement) -> Vec<&mut Block> {
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

/// Calls `visit` with every statement, outer statements before inner ones.
pub fn each<'a>(block: &'a [Statement], visit: &mut dyn FnMut(&'a Statement)) {
    for statement in block {
        visit(statement);
        for body in child_blocks(statement) {
            each(body, visit);
        }
    }
}

/// Rebuilds a block bottom-up: `change` gets each statement, whose inner statements are done, and appends its
/// replacement to the new block. The `init` of a `for` is unchanged.
pub fn rebuild(block: Block, change: &mut dyn FnMut(Statement, &mut Block)) -> Block {
    let mut out = Block::with_capacity(block.len());
    for mut statement in block {
        for body in statement_blocks_mut(&mut statement) {
            *body = rebuild(std::mem::take(body), change);
        }
        change(statement, &mut out);
    }
    out
}

/// The expressions that a statement evaluates itself, in source order.
pub fn own_expressions(tree: &Tree, statement: &Statement) -> Vec<ExprId> {
    let initializer = |variable: VariableId| tree[variable].initializer;
    let tested = |condition: &Condition| match *condition {
        Condition::Expression(expr) => Some(expr),
        Condition::Declare(variable) => initializer(variable),
    };
    match &statement.kind {
        StatementKind::Expression(expr) => vec![*expr],
        StatementKind::Declare(variable) => initializer(*variable).into_iter().collect(),
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

/// The variable that a statement itself declares, if any.
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

/// The roots of all expressions that a block evaluates.
pub fn roots(tree: &Tree, block: &Block) -> Vec<ExprId> {
    let mut roots = Vec::new();
    each(block, &mut |statement| {
        roots.extend(own_expressions(tree, statement));
    });
    roots
}

/// Whether evaluating an expression has side effects or may take long: it contains an assignment, a call of a
/// user function, or a built-in function with an `out` parameter.
pub fn has_side_effects(tree: &Tree, root: ExprId) -> bool {
    any(tree, root, |kind| match kind {
        ExprKind::Assign { .. } | ExprKind::Step { .. } | ExprKind::Call { .. } => true,
        ExprKind::BuiltIn { function, .. } => function.out_parameter().is_some(),
        _ => false,
    })
}

/// Whether `is_one` holds for any expression at or below `root`.
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

/// Whether a loop's body contains a `continue` of that loop.
pub fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match &statement.kind {
        StatementKind::Continue => true,
        StatementKind::For { .. } | StatementKind::While { .. } | StatementKind::DoWhile { .. } => false,
        _ => child_blocks(statement).into_iter().any(continues),
    })
}

/// Whether the statement is a jump, after which nothing in its block runs.
pub fn jumps(statement: &Statement) -> bool {
    matches!(
        statement.kind,
        StatementKind::Break | StatementKind::Continue | StatementKind::Return(_) | StatementKind::Discard
    )
}

/// The expressions of the `case` labels, without `default`.
pub fn values(labels: &[Label]) -> impl Iterator<Item = ExprId> + '_ {
    labels.iter().filter_map(|label| match label {
        Label::Case { expr, .. } => Some(*expr),
        Label::Default => None,
    })
}

/// Whether an expression contains a variable.
pub fn mentions(tree: &Tree, root: ExprId, variable: VariableId) -> bool {
    any(
        tree,
        root,
        |kind| matches!(kind, ExprKind::Variable(v) if *v == variable),
    )
}

/// Whether an expression itself assigns to a variable or a part of it: by an operator, or as an `out` argument.
pub fn writes(tree: &Tree, root: ExprId, variable: VariableId) -> bool {
    tree.postorder(root).into_iter().any(|id| {
        let mut is_written = false;
        tree.each_write(id, |target, _| {
            is_written |= tree.root_variable(target) == Some(variable);
        });
        is_written
    })
}

/// Whether an expression calls a function of the shader.
pub fn calls(tree: &Tree, root: ExprId) -> bool {
    any(tree, root, |kind| matches!(kind, ExprKind::Call { .. }))
}

/// Whether evaluating `value` may change what the lvalue `path` reads (its variable or variables in its
/// indices): `value` has side effects and contains such a variable, or calls a function that may access a
/// global one.
pub fn may_change(tree: &Tree, value: ExprId, path: ExprId) -> bool {
    if !has_side_effects(tree, value) {
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
    /// Calls `visit` with each lvalue that the expression itself (not its operands) writes, and with the
    /// assigned value for `=`.
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

/// The direction of a parameter.
pub fn direction(tree: &Tree, parameter: VariableId) -> Direction {
    match tree[parameter].kind {
        VariableKind::Parameter(direction) => direction,
        _ => Direction::In,
    }
}
