//! `==` and `!=` of floats that were computed: rounding decides the answer.
//!
//! Not told of what is exact: whole numbers and halves under `+ - *`, what `floor` and its kin give, and values that are only
//! handed on: sentinels, and what `min` or `?:` chose among others.

mod grid;
mod origin;

use std::collections::HashSet;

use origin::{Origin, Origins};
use toyproof_glsl::Code;
use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, FunctionId, Value};

use super::Found;
use super::program::{Program, is_float};
use super::shape::Shape;

pub(super) fn run(program: &Program, found: &mut Found) {
    let tree = program.tree;
    let mut origins = Origins::new(program);
    for &function in &program.functions {
        let mut divisors = None;
        let lengths = lengths(program, function);
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
            if !is_float(tree[left].ty) || lengths.contains(&expr) {
                continue;
            }
            let divisors = divisors.get_or_insert_with(|| self::divisors(program, function));
            if is_left_to_rounding(program, &mut origins, left, right, divisors) {
                let message = format!(
                    "whether these are equal is left to rounding: `{sign}` of a float that was computed"
                );
                found.tell(Code::FloatEquality, tree[expr].at, message, |diagnostic| {
                    diagnostic.note("compare with a tolerance that fits their size: `abs(a - b) < 1e-4`")
                });
            }
        }
    }
}

/// `x == 0.0 && y == 0.0` asks whether a vector has no length: its components are not asked one by one.
fn lengths(program: &Program, function: FunctionId) -> HashSet<ExprId> {
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
    let pairs = program
        .exprs(function)
        .iter()
        .filter_map(|expr| match tree[*expr].kind {
            ExprKind::Binary {
                op: BinaryOp::And,
                left,
                right,
            } if is_zero(left) && is_zero(right) => Some([left, right]),
            _ => None,
        });
    pairs.flatten().collect()
}

/// What a function divides by: who asks whether that is zero asks for no more than not to divide by it.
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
        .filter_map(|expr| Shape::of(tree, expr))
        .collect()
}

fn is_left_to_rounding(
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
            let (a, b) = (origins.of(left), origins.of(right));
            return a.is_rounded()
                && b.is_rounded()
                && !a.feeds(program, left, right)
                && !b.feeds(program, right, left);
        }
    };
    let guards = Shape::of(program.tree, computed).is_some_and(|shape| divisors.contains(&shape));
    !guards && misses(&origins.of(computed), constant.components())
}

/// Whether a computed value may miss a constant by rounding alone.
fn misses(origin: &Origin, constant: &[Value]) -> bool {
    let floats = constant.iter().filter_map(|scalar| match scalar {
        Value::Float(value) => Some(*value),
        _ => None,
    });
    let floats: Vec<_> = floats.collect();
    let at_zero = floats.iter().all(|&value| value == 0.0);
    origin.is_rounded()
        && !floats.iter().any(|&value| origin.is_given(value))
        // Products, roots and lengths are zero where they should be; differences are not.
        && (!at_zero || origin.is_cancelled())
}
