//! `==` and `!=` of computed floats, whose result depends on rounding.
//!
//! Exact values are not reported: integers and halves under `+ - *`, results of `floor` and similar
//! functions, and values that are only copied, such as sentinels and the results of `min` or `?:`.

mod grid;
mod origin;

use std::collections::HashSet;

use origin::{Origin, Origins};
use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, FunctionId, Value};

use super::Findings;
use super::program::{Program, is_float};
use super::shape::Shape;

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    let mut origins = Origins::new(program);
    for &function in &program.functions {
        let mut divisors = None;
        let zero_vector_tests = zero_vector_tests(program, function);
        for &expr in program.exprs(function) {
            if program.deadline.is_over() {
                return;
            }
            let (sign, left, right) = match &tree[expr].kind {
                ExprKind::Binary {
                    op: op @ (BinaryOp::Equal | BinaryOp::NotEqual),
                    left,
                    right,
                } => (op.symbol(), *left, *right),
                ExprKind::BuiltIn {
                    function: function @ (BuiltIn::Equal | BuiltIn::NotEqual),
                    arguments,
                } => (function.name(), arguments[0], arguments[1]),
                _ => continue,
            };
            if !is_float(tree[left].ty) || zero_vector_tests.contains(&expr) {
                continue;
            }
            let divisors = divisors.get_or_insert_with(|| self::divisors(program, function));
            if depends_on_rounding(program, &mut origins, left, right, divisors) {
                let message = format!("`{sign}` of computed floats depends on rounding");
                findings.add(Code::FloatEquality, tree[expr].at, message, |diagnostic| {
                    diagnostic.help(
                        "compare with a tolerance relative to their magnitude, such as `abs(a - b) < 1e-4`",
                    )
                });
            }
        }
    }
}

/// The comparisons in `x == 0.0 && y == 0.0` and longer conjunctions: together they test a vector for zero
/// length, and are not reported one by one.
fn zero_vector_tests(program: &Program, function: FunctionId) -> HashSet<ExprId> {
    let tree = program.tree;
    let is_zero = |expr: ExprId| match tree[expr].kind {
        ExprKind::Binary {
            op: BinaryOp::Equal,
            right,
            ..
        } => program.constant(right).is_some_and(|constant| {
            constant
                .components()
                .iter()
                .all(|scalar| matches!(scalar, Value::Float(0.0)))
        }),
        _ => false,
    };
    // The comparisons and their conjunctions. Operands come before the expressions that have them.
    let mut tests = HashSet::new();
    for &expr in program.exprs(function) {
        if let ExprKind::Binary {
            op: BinaryOp::And,
            left,
            right,
        } = tree[expr].kind
            && [left, right]
                .iter()
                .all(|&side| is_zero(side) || tests.contains(&side))
        {
            tests.extend([left, right, expr]);
        }
    }
    tests
}

/// The divisors in a function: a test for zero that guards a division is not reported.
fn divisors(program: &Program, function: FunctionId) -> HashSet<Shape> {
    let tree = program.tree;
    let by = |expr: &ExprId| match &tree[*expr].kind {
        ExprKind::Binary {
            op: BinaryOp::Divide,
            right,
            ..
        }
        | ExprKind::Assign {
            op: Some(BinaryOp::Divide),
            value: right,
            ..
        } => Some(*right),
        ExprKind::BuiltIn {
            function: BuiltIn::Log | BuiltIn::Log2 | BuiltIn::Atan | BuiltIn::Normalize,
            arguments,
        } => arguments.last().copied(),
        _ => None,
    };
    program
        .exprs(function)
        .iter()
        .filter_map(by)
        .filter_map(|expr| Shape::new(tree, expr))
        .collect()
}

fn depends_on_rounding(
    program: &Program,
    origins: &mut Origins,
    left: ExprId,
    right: ExprId,
    divisors: &HashSet<Shape>,
) -> bool {
    let constants = (program.constant(left), program.constant(right));
    let (computed, constant) = match constants {
        (Some(_), Some(_)) => return false,
        (Some(constant), None) => (right, constant),
        (None, Some(constant)) => (left, constant),
        (None, None) => {
            let (a, b) = (origins.origin(left), origins.origin(right));
            return a.is_rounded()
                && b.is_rounded()
                && !a.feeds(program, left, right)
                && !b.feeds(program, right, left);
        }
    };
    let guards_division = Shape::new(program.tree, computed).is_some_and(|shape| divisors.contains(&shape));
    !guards_division && may_miss(&origins.origin(computed), constant.components())
}

/// Whether rounding alone may make a computed value differ from a constant.
fn may_miss(origin: &Origin, constant: &[Value]) -> bool {
    let floats = constant.iter().filter_map(|scalar| match scalar {
        Value::Float(value) => Some(*value),
        _ => None,
    });
    let floats: Vec<_> = floats.collect();
    let at_zero = floats.iter().all(|&value| value == 0.0);
    origin.is_rounded()
        && !floats.iter().any(|&value| origin.may_be_exactly(value))
        // Products, roots and lengths that should be zero are exactly zero; differences may not be.
        && (!at_zero || origin.is_cancelled())
}
