//! Conditionals whose sides have side effects become branches, for languages that evaluate both sides of
//! `?:`, as HLSL does before 2021. Such languages select no structures, arrays or matrices either.

use toyproof_glsl::tree::{
    Arm, Block, Condition, ExprId, ExprKind, Place, Statement, StatementKind, Tree, Type, UnaryOp, Value,
    walk,
};

use crate::lower::context::LoweringContext;

/// Rewrites `c ? f() : g()` as `(c ? (t = f()) : (t = g()), t)`, whose first part
/// [`Pass::Sequences`](super::Pass::Sequences) turns into an `if`. Conditions that contain one are moved to
/// where a statement can precede them.
pub(crate) fn branch_for_effects(cx: &mut LoweringContext) {
    cx.each_statement(|cx, mut statement, out| {
        move_condition(cx, &mut statement);
        out.push(statement);
    });
    cx.each_expression_postorder(|cx, id| {
        let ExprKind::Conditional { condition, yes, no } = cx.tree[id].kind else {
            return;
        };
        let is_value = matches!(cx.tree[id].ty, Type::Scalar(_) | Type::Vector(..));
        if cx.tree[id].ty == Type::Void || is_value && !has_effect(&cx.tree, yes, no) {
            return;
        }
        let (ty, at) = (cx.tree[id].ty, cx.tree[id].at);
        let value = cx.temporary("value", ty, at);
        let mut build = cx.build(at);
        let yes = build.set(value, yes);
        let no = build.set(value, no);
        let branches = build.push(ExprKind::Conditional { condition, yes, no }, ty);
        let result = build.variable(value);
        cx.tree[id].kind = ExprKind::Sequence {
            first: branches,
            second: result,
        };
    });
}

fn has_effect(tree: &Tree, yes: ExprId, no: ExprId) -> bool {
    walk::has_side_effects(tree, yes) || walk::has_side_effects(tree, no)
}

/// Whether an expression contains a conditional that becomes a branch.
fn branches(tree: &Tree, root: ExprId) -> bool {
    let mut all = tree.postorder(root).into_iter();
    all.any(|id| matches!(tree[id].kind, ExprKind::Conditional { yes, no, .. } if has_effect(tree, yes, no)))
}

/// Maximum number of blocks that one `if` becomes: they nest.
const MAX_SPLITS: usize = 64;

/// Moves the condition of a loop into its body, and those after `else` into a block.
fn move_condition(cx: &mut LoweringContext, statement: &mut Statement) {
    let at = statement.at;
    match &mut statement.kind {
        StatementKind::While { condition, body } => {
            if let Condition::Expression(tested) = *condition
                && branches(&cx.tree, tested)
            {
                let always = cx.build(at).literal(Value::Bool(true));
                *condition = Condition::Expression(always);
                body.insert(0, leave_unless(cx, tested, at));
            }
        }
        StatementKind::For { condition, body, .. } => {
            if let &mut Some(Condition::Expression(tested)) = condition
                && branches(&cx.tree, tested)
            {
                *condition = None;
                body.insert(0, leave_unless(cx, tested, at));
            }
        }
        StatementKind::If { arms, otherwise } => {
            let moved = |arm: &Arm| branches(&cx.tree, arm.condition);
            for _ in 0..MAX_SPLITS {
                let Some(first) = arms.iter().skip(1).rposition(moved) else {
                    break;
                };
                let arms = arms.split_off(first + 1);
                let rest = StatementKind::If {
                    arms,
                    otherwise: otherwise.take(),
                };
                *otherwise = Some(Block::from([Statement::new(rest, at)]));
            }
        }
        _ => {}
    }
}

/// `if (!condition) break;`
fn leave_unless(cx: &mut LoweringContext, condition: ExprId, at: Place) -> Statement {
    let condition = cx.build(at).unary(UnaryOp::Not, condition);
    let leave = Statement::new(StatementKind::Break, at);
    Statement::new(StatementKind::when(condition, Block::from([leave])), at)
}
