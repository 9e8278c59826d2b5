//! Statements that compute a value and discard it: `normalize(d);`, `x == 1.0;`.

use std::collections::HashSet;

use toyproof_diagnostic::{Code, Fix, Span};
use toyproof_glsl::tree::{
    BinaryOp, Direction, ExprId, ExprKind, StatementKind, Tree, Type, VariableKind, walk,
};

use super::Findings;
use super::program::{Program, direction};

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    let pure = pure_functions(program);
    for &function in &program.functions {
        let Some(body) = &tree[function].body else {
            continue;
        };
        // Some authors write `for (i; i < 3; i++)` to keep the variable's value.
        let mut idle_inits = HashSet::new();
        walk::each(body, &mut |statement| match &statement.kind {
            StatementKind::Expression(expr) if !idle_inits.contains(expr) => {
                check_expression(tree, &pure, *expr, findings);
            }
            StatementKind::For { init, step, .. } => {
                for first in init {
                    if let StatementKind::Expression(expr) = first.kind
                        && matches!(tree[expr].kind, ExprKind::Variable(_))
                    {
                        idle_inits.insert(expr);
                    }
                }
                if let Some(step) = step {
                    check_expression(tree, &pure, *step, findings);
                }
            }
            _ => {}
        });
    }
}

/// By function index: whether its calls have no effect besides the result.
fn pure_functions(program: &Program) -> Vec<bool> {
    let tree = program.tree;
    let mut pure = vec![false; tree.functions.len()];
    for &function in &program.functions {
        let only_inputs = tree[function]
            .parameters
            .iter()
            .all(|&parameter| matches!(direction(tree, parameter), Direction::In | Direction::ConstIn));
        let mut has_no_effect = true;
        for &expr in program.exprs(function) {
            tree.each_write(expr, |target, _| {
                has_no_effect &= tree.root_variable(target).is_some_and(|root| {
                    matches!(tree[root].kind, VariableKind::Local | VariableKind::Parameter(_))
                });
            });
            if let ExprKind::Call { function, .. } = tree[expr].kind {
                // A callee that writes only to the caller's locals has no effect outside it, but is rare
                // enough to count as impure.
                has_no_effect &= pure[function.index()];
            }
        }
        if let Some(body) = &tree[function].body {
            walk::each(body, &mut |statement| {
                has_no_effect &= !matches!(statement.kind, StatementKind::Discard);
            });
        }
        pure[function.index()] = only_inputs && has_no_effect;
    }
    pure
}

fn check_expression(tree: &Tree, pure: &[bool], expr: ExprId, findings: &mut Findings) {
    let at = tree[expr].at;
    // A macro may legitimately expand to a statement without effect.
    if at.is_expanded() || tree[expr].ty == Type::Void || walk::any(tree, expr, |kind| has_effect(kind, pure))
    {
        return;
    }
    let message = match &tree[expr].kind {
        ExprKind::Binary {
            op: BinaryOp::Equal, ..
        } => "the result of this comparison is unused; `=` assigns".to_owned(),
        ExprKind::BuiltIn { function, .. } => dropped_message(function.name()),
        ExprKind::Call { function, .. } => dropped_message(&tree[*function].name),
        _ => "this expression has no effect: its value is unused".to_owned(),
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
    findings.add(Code::UnusedResult, at, message, |diagnostic| match assigned {
        Some(name) => {
            let start = Span::new(at.span.file, at.span.start, at.span.start);
            let fix = Fix::new(
                format!("assign the result: `{name} = …`"),
                start,
                format!("{name} = "),
            );
            diagnostic
                .note("a function does not change its argument")
                .fix(fix)
        }
        None => diagnostic,
    });
}

fn dropped_message(name: &str) -> String {
    format!("the result of `{name}` is unused, and the call has no other effect")
}

fn has_effect(kind: &ExprKind, pure: &[bool]) -> bool {
    match kind {
        ExprKind::Assign { .. } | ExprKind::Step { .. } => true,
        ExprKind::Call { function, .. } => !pure[function.index()],
        ExprKind::BuiltIn { function, .. } => function.out_parameter().is_some(),
        _ => false,
    }
}
