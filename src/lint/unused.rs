//! Statements that compute a value and drop it: `normalize(d);`, `x == 1.0;`.

use std::collections::HashSet;

use toyproof_glsl::Code;
use toyproof_glsl::tree::{
    BinaryOp, Direction, ExprId, ExprKind, StatementKind, Tree, Type, VariableKind, walk,
};

use super::Found;
use super::program::{Program, direction};

pub(super) fn run(program: &Program, found: &mut Found) {
    let tree = program.tree;
    let pure = pure_functions(program);
    for &function in &program.functions {
        let Some(body) = &tree[function].body else {
            continue;
        };
        // `for (i; i < 3; i++)` is how some begin with a variable as it is.
        let mut idle = HashSet::new();
        walk::each(body, &mut |statement| match &statement.kind {
            StatementKind::Expression(expr) if !idle.contains(expr) => judge(tree, &pure, *expr, found),
            StatementKind::For { init, step, .. } => {
                for first in init {
                    if let StatementKind::Expression(expr) = first.kind
                        && matches!(tree[expr].kind, ExprKind::Variable(_))
                    {
                        idle.insert(expr);
                    }
                }
                if let Some(step) = step {
                    judge(tree, &pure, *step, found);
                }
            }
            _ => {}
        });
    }
}

/// By the index of the function: whether a call does nothing but give its result.
fn pure_functions(program: &Program) -> Vec<bool> {
    let tree = program.tree;
    let mut pure = vec![false; tree.functions.len()];
    for &function in &program.functions {
        let gives = tree[function]
            .parameters
            .iter()
            .all(|&parameter| matches!(direction(tree, parameter), Direction::In | Direction::ConstIn));
        let mut quiet = true;
        for &expr in program.exprs(function) {
            tree.each_write(expr, |target, _| {
                quiet &= tree.root_variable(target).is_some_and(|root| {
                    matches!(tree[root].kind, VariableKind::Local | VariableKind::Parameter(_))
                });
            });
            if let ExprKind::Call { function, .. } = tree[expr].kind {
                // A callee that only writes to our own variables is none of our caller's business; but few such are.
                quiet &= pure[function.index()];
            }
        }
        if let Some(body) = &tree[function].body {
            walk::each(body, &mut |statement| {
                quiet &= !matches!(statement.kind, StatementKind::Discard);
            });
        }
        pure[function.index()] = gives && quiet;
    }
    pure
}

fn judge(tree: &Tree, pure: &[bool], expr: ExprId, found: &mut Found) {
    let at = tree[expr].at;
    // A macro may well stand for nothing.
    if at.is_expanded() || tree[expr].ty == Type::Void || walk::any(tree, expr, |kind| acts(kind, pure)) {
        return;
    }
    let message = match &tree[expr].kind {
        ExprKind::Binary {
            op: BinaryOp::Equal, ..
        } => "this compares, and drops the answer; one `=` assigns".to_owned(),
        ExprKind::BuiltIn { function, .. } => dropped(function.name()),
        ExprKind::Call { function, .. } => dropped(&tree[*function].name),
        _ => "this does nothing: its value is computed and dropped".to_owned(),
    };
    let assigned = match &tree[expr].kind {
        ExprKind::BuiltIn { arguments, .. } | ExprKind::Call { arguments, .. } => match arguments.first() {
            Some(&first) if tree[first].ty == tree[expr].ty => match tree[first].kind {
                ExprKind::Variable(variable) => Some(&tree[variable].name),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    found.tell(Code::UnusedResult, at, message, |diagnostic| match assigned {
        Some(name) => diagnostic.note(format!(
            "a function leaves its argument as it is; assign what it gives: `{name} = …`"
        )),
        None => diagnostic,
    });
}

fn dropped(name: &str) -> String {
    format!("the result of `{name}` is dropped, and it does nothing else")
}

fn acts(kind: &ExprKind, pure: &[bool]) -> bool {
    match kind {
        ExprKind::Assign { .. } | ExprKind::Step { .. } => true,
        ExprKind::Call { function, .. } => !pure[function.index()],
        ExprKind::BuiltIn { function, .. } => function.out_parameter().is_some(),
        _ => false,
    }
}
