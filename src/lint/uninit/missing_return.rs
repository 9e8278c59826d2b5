//! Functions with a result whose end can be reached without a `return`.

use std::collections::HashSet;

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{
    BinaryOp, Block, Constant, ExprId, ExprKind, FunctionId, StatementKind, Value, walk,
};

use crate::Findings;
use crate::program::Program;
use crate::shape::Shape;

/// Reports a function whose end can be reached, unless its author lists the cases of one value.
pub(super) fn report(program: &Program, function: FunctionId, findings: &mut Findings) {
    let tree = program.tree;
    let mut conditions = Vec::new();
    if let Some(body) = &tree[function].body {
        last_conditions(body, &mut conditions);
    }
    if !is_list_of_cases(program, &conditions) {
        let message = format!("`{}` may reach its end without a `return`", tree[function].name);
        findings.add(Code::MissingReturn, tree[function].at, message, |diagnostic| {
            diagnostic
                .note("the result is then undefined; WebGL returns 0")
                .help("add a `return` at the end")
        });
    }
}

/// Collects the conditions of the `if`s that a block ends with. At its end, no condition whose `if` leaves
/// the function holds. Returns whether the whole block consists of such statements.
fn last_conditions(block: &Block, conditions: &mut Vec<ExprId>) -> bool {
    block.iter().rev().all(|statement| match &statement.kind {
        StatementKind::If { arms, otherwise } => {
            let leaving = arms.iter().filter(|arm| arm.body.last().is_some_and(walk::jumps));
            conditions.extend(leaving.map(|arm| arm.condition));
            otherwise
                .as_ref()
                .is_none_or(|body| last_conditions(body, conditions))
        }
        StatementKind::Block(body) => last_conditions(body, conditions),
        StatementKind::Expression(_) | StatementKind::Declare(_) => true,
        _ => false,
    })
}

/// Whether two of the conditions are cases of one value, such as `id == 1` and `id == 2`, or `x > 1.0` and
/// `x <= 1.0`: such lists are most likely complete.
fn is_list_of_cases(program: &Program, conditions: &[ExprId]) -> bool {
    let mut seen = HashSet::new();
    conditions.iter().any(|&condition| {
        let subjects = subjects(program, condition);
        let is_known = subjects.iter().any(|subject| seen.contains(subject));
        seen.extend(subjects);
        is_known
    })
}

/// The operands of a condition's comparisons: a value that is tested for one case, or two values.
fn subjects(program: &Program, condition: ExprId) -> Vec<(Shape, Option<Shape>)> {
    let tree = program.tree;
    let mut found = Vec::new();
    let mut pending = vec![condition];
    while let Some(expr) = pending.pop() {
        match tree[expr].kind {
            ExprKind::Binary {
                op: BinaryOp::Or,
                left,
                right,
            } => pending.extend([left, right]),
            ExprKind::Binary { op, left, right } if op.mirrored() != op || op == BinaryOp::Equal => {
                let Some(subject) = Shape::new(tree, left) else {
                    continue;
                };
                let is_case = match program.constant(right).as_ref().map(Constant::components) {
                    // A number between two integers bounds an ID that is stored as a float.
                    Some(&[Value::Float(bound)]) => {
                        op == BinaryOp::Equal || bound > 1.0 && bound.fract() != 0.0
                    }
                    Some(_) => op == BinaryOp::Equal,
                    None => false,
                };
                if is_case {
                    found.push((subject.clone(), None));
                }
                found.extend(Shape::new(tree, right).map(|right| (subject, Some(right))));
            }
            _ => {}
        }
    }
    found
}
