//! The textbook ray–sphere discriminant: `b*b - c` or `b*b - 4.0*a*c` with `b = dot(f, d)` or twice that, and
//! `c = dot(f, f) - r*r`.

use std::collections::HashSet;

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, Type, UnaryOp, Value};

use super::program::{Program, Shape};

/// The maximum number of terms in a discriminant.
const MAX_TERMS: usize = 8;

/// A recognized discriminant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quadratic {
    /// The whole discriminant.
    pub(super) expr: ExprId,
    /// The ray's direction.
    pub(super) direction: ExprId,
    /// Whether the formula assumes a = 1, which is right for unit directions only.
    pub(super) for_unit: bool,
}

/// A product of a constant and other factors.
#[derive(Debug, Clone)]
struct Term {
    constant: f64,
    factors: Vec<ExprId>,
}

/// All reachable discriminants; of nested ones, only the largest.
pub(super) fn quadratics(program: &Program) -> Vec<Quadratic> {
    let tree = program.tree;
    let mut all: Vec<Quadratic> = Vec::new();
    for &function in &program.functions {
        // Operands of larger sums.
        let mut parts: HashSet<ExprId> = HashSet::new();
        for &expr in program.exprs(function).iter().rev() {
            if program.deadline.is_over() {
                break;
            }
            let ExprKind::Binary {
                op: BinaryOp::Add | BinaryOp::Subtract,
                left,
                right,
            } = tree[expr].kind
            else {
                continue;
            };
            if tree[expr].ty != Type::FLOAT {
                continue;
            }
            parts.extend([left, right]);
            if !parts.contains(&expr)
                && let Some(quadratic) = recognize(program, expr)
            {
                all.push(quadratic);
            }
        }
    }
    all
}

fn recognize(program: &Program, expr: ExprId) -> Option<Quadratic> {
    let terms = terms(program, expr)?;
    let dot = |factor: ExprId| match &program.tree[factor].kind {
        ExprKind::BuiltIn {
            function: BuiltIn::Dot,
            arguments,
        } => Some((arguments[0], arguments[1])),
        _ => None,
    };
    let alike = |a: ExprId, b: ExprId| {
        let (a, b) = (Shape::of(program.tree, a), Shape::of(program.tree, b));
        a.is_some() && a == b
    };
    // (d·f)² with a positive factor.
    let (square, (u, v)) = terms.iter().find_map(|term| match term.factors[..] {
        [a, b] if term.constant > 0.0 && alike(a, b) => Some((term, dot(a)?)),
        _ => None,
    })?;
    // −f·f, alone or times d·d.
    terms.iter().find_map(|term| {
        let with = |from: ExprId, direction: ExprId| {
            let length =
                |factor: ExprId, of: ExprId| dot(factor).is_some_and(|(a, b)| alike(a, b) && alike(a, of));
            let for_unit = match term.factors[..] {
                [only] if length(only, from) => true,
                [a, b]
                    if length(a, from) && length(b, direction) || length(b, from) && length(a, direction) =>
                {
                    false
                }
                _ => return None,
            };
            Some(Quadratic {
                expr,
                direction,
                for_unit,
            })
        };
        if term.constant != -square.constant {
            return None;
        }
        with(u, v).or_else(|| with(v, u))
    })
}

/// The terms of a sum; variables that are set once are replaced by their values.
fn terms(program: &Program, expr: ExprId) -> Option<Vec<Term>> {
    let tree = program.tree;
    let mut terms = Vec::new();
    let mut pending = vec![(expr, 1.0, Vec::new())];
    // Each step splits a sum or a product, or resolves a name.
    for _ in 0..10 * MAX_TERMS {
        let Some((expr, constant, factors)) = pending.pop() else {
            return Some(terms);
        };
        let expr = program.resolve(expr);
        let only_sum = factors.is_empty();
        match tree[expr].kind {
            ExprKind::Binary {
                op: op @ (BinaryOp::Add | BinaryOp::Subtract),
                left,
                right,
            } if only_sum => {
                let sign = if op == BinaryOp::Add { 1.0 } else { -1.0 };
                pending.push((right, constant * sign, Vec::new()));
                pending.push((left, constant, Vec::new()));
            }
            ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => pending.push((operand, -constant, factors)),
            ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            } => {
                let (left, right) = (program.resolve(left), program.resolve(right));
                match (number(program, left), number(program, right)) {
                    (Some(number), _) => pending.push((right, constant * number, factors)),
                    (_, Some(number)) => pending.push((left, constant * number, factors)),
                    _ => {
                        let (left, right) = (product(program, left)?, product(program, right)?);
                        let constant = constant * left.constant * right.constant;
                        let factors = [factors, left.factors, right.factors].concat();
                        // `4.0 * c` with a sum `c` is handled above; here a sum is an opaque factor.
                        terms.push(Term { constant, factors });
                    }
                }
            }
            _ => terms.push(Term {
                constant,
                factors: [factors, vec![expr]].concat(),
            }),
        }
        if terms.len() + pending.len() > MAX_TERMS {
            return None;
        }
    }
    None
}

/// Splits a product into its factors; any other expression is a single factor.
fn product(program: &Program, expr: ExprId) -> Option<Term> {
    let tree = program.tree;
    let mut term = Term {
        constant: 1.0,
        factors: Vec::new(),
    };
    let mut pending = vec![expr];
    for _ in 0..4 * MAX_TERMS {
        let Some(expr) = pending.pop() else {
            return Some(term);
        };
        let expr = program.resolve(expr);
        match tree[expr].kind {
            ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            } if tree[expr].ty == Type::FLOAT => {
                pending.extend([left, right]);
            }
            ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => {
                term.constant = -term.constant;
                pending.push(operand);
            }
            _ => match number(program, expr) {
                Some(number) => term.constant *= number,
                None => term.factors.push(expr),
            },
        }
    }
    None
}

fn number(program: &Program, expr: ExprId) -> Option<f64> {
    match *program.constant(expr)?.components() {
        [Value::Float(value)] => Some(value),
        _ => None,
    }
}
