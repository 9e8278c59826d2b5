//! What WebGL 1 refuses of GLSL ES 1.00: loops and indices beyond its Appendix A, and derivatives without
//! their extension.

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{
    BinaryOp, Condition, ExprId, ExprKind, Place, Statement, StatementKind, Tree, UnaryOp, VariableId,
    VariableKind, walk,
};
use toyproof_glsl::{Checked, Version};

use super::Findings;
use super::program::Program;

pub(super) fn run(program: &Program, checked: &Checked, findings: &mut Findings) {
    if checked.version != Version::Es100 {
        return;
    }
    let tree = program.tree;
    for &function in &program.functions {
        for &expr in program.exprs(function) {
            if let ExprKind::BuiltIn { function, .. } = tree[expr].kind
                && function.is_derivative()
                && !checked.enables_derivatives
            {
                let message = format!("WebGL 1 refuses `{}` without its extension", function.name());
                findings.add(Code::BeyondAppendixA, tree[expr].at, message, |diagnostic| {
                    diagnostic.help("begin with `#extension GL_OES_standard_derivatives : enable`")
                });
            }
        }
        let mut counters = Vec::new();
        walk::each(
            tree[function].body.as_deref().unwrap_or_default(),
            &mut |statement| {
                if let Some(problem) = loop_problem(tree, statement) {
                    add(findings, statement.at, problem, "A.4");
                }
                counters.extend(counter(tree, statement));
            },
        );
        for &expr in program.exprs(function) {
            if let ExprKind::Index { index, .. } = tree[expr].kind
                && !is_constant_index(tree, index, &counters)
            {
                add(
                    findings,
                    tree[index].at,
                    "an index that is not a constant or the counter of a `for` loop",
                    "A.5",
                );
            }
        }
    }
}

fn add(findings: &mut Findings, at: Place, problem: &str, section: &str) {
    let message = format!("WebGL 1 refuses {problem}");
    findings.add(Code::BeyondAppendixA, at, message, |diagnostic| {
        diagnostic
            .note(format!("GLSL ES 1.00, Appendix {section}"))
            .help("use a `for` loop with a constant number of iterations, and `break`; or begin with `#version 300 es`")
    });
}

/// What Appendix A.4 does not allow of a loop.
fn loop_problem(tree: &Tree, statement: &Statement) -> Option<&'static str> {
    match &statement.kind {
        StatementKind::While { .. } => Some("a `while` loop"),
        StatementKind::DoWhile { .. } => Some("a `do` loop"),
        StatementKind::For { condition, step, .. } => {
            let Some(counter) = counter(tree, statement) else {
                return Some("a `for` loop that does not begin with a counter and its constant value");
            };
            if !condition.is_some_and(|condition| compares(tree, condition, counter)) {
                return Some("a `for` loop whose condition does not compare its counter with a constant");
            }
            if !step.is_some_and(|step| counts(tree, step, counter)) {
                return Some("a `for` loop that does not change its counter by a constant");
            }
            None
        }
        _ => None,
    }
}

/// The counter of a `for` loop that begins with its constant value.
fn counter(tree: &Tree, statement: &Statement) -> Option<VariableId> {
    let StatementKind::For { init, .. } = &statement.kind else {
        return None;
    };
    let [
        Statement {
            kind: StatementKind::Declare(variable),
            ..
        },
    ] = init[..]
    else {
        return None;
    };
    let value = tree[variable].initializer?;
    tree[value].constant.then_some(variable)
}

fn compares(tree: &Tree, condition: Condition, counter: VariableId) -> bool {
    let Condition::Expression(expr) = condition else {
        return false;
    };
    let ExprKind::Binary { op, left, right } = tree[expr].kind else {
        return false;
    };
    let is_comparison = matches!(
        op,
        BinaryOp::Less
            | BinaryOp::LessEqual
            | BinaryOp::Greater
            | BinaryOp::GreaterEqual
            | BinaryOp::Equal
            | BinaryOp::NotEqual
    );
    is_comparison && is_variable(tree, left, counter) && tree[right].constant
}

fn counts(tree: &Tree, step: ExprId, counter: VariableId) -> bool {
    match tree[step].kind {
        ExprKind::Step { target, .. } => is_variable(tree, target, counter),
        ExprKind::Assign {
            op: Some(BinaryOp::Add | BinaryOp::Subtract),
            target,
            value,
        } => is_variable(tree, target, counter) && tree[value].constant,
        _ => false,
    }
}

fn is_variable(tree: &Tree, expr: ExprId, variable: VariableId) -> bool {
    matches!(tree[expr].kind, ExprKind::Variable(own) if own == variable)
}

/// Whether an expression is composed of constants and counters of loops.
fn is_constant_index(tree: &Tree, index: ExprId, counters: &[VariableId]) -> bool {
    tree.postorder(index)
        .into_iter()
        .all(|expr| match tree[expr].kind {
            ExprKind::Variable(variable) => {
                counters.contains(&variable) || tree[variable].kind == VariableKind::Const
            }
            ExprKind::Call { .. } | ExprKind::Assign { .. } | ExprKind::Step { .. } => false,
            ExprKind::Unary { op, .. } => matches!(op, UnaryOp::Minus | UnaryOp::Plus),
            _ => true,
        })
}
