//! Ray–sphere formulas that assume a = 1, applied to directions that are never normalized: `b*b - c` or
//! `b*b - 4.0*c` with `b = dot(f, d)` or twice that, and `c = dot(f, f) - r*r`.
//!
//! Reports only where all definitions of a direction are known, and none of them can have length 1 except by
//! chance: vectors of pixel coordinates and sums of vectors, without a division, sine or dot product in any
//! definition.

use std::collections::{HashMap, HashSet};

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, StructId, Type, UnaryOp, Value};

use super::Findings;
use super::program::{Definition, Program};
use super::shape::Shape;

/// The maximum number of terms of a discriminant, and of factors of a term.
const MAX_TERMS: usize = 8;
/// The maximum number of nested operators and names that a discriminant is expanded through.
const MAX_DEPTH: u32 = 24;
/// The maximum number of expressions examined for one formula; nothing is reported beyond it.
const MAX_EXPRS: usize = 1_000;

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    let mut members = None;
    for (discriminant, direction) in discriminants(program) {
        let members = members.get_or_insert_with(|| Members::new(program));
        let Some(origin) = members.never_unit(direction) else {
            continue;
        };
        let message =
            "this discriminant requires a unit direction, but the ray direction is never normalized";
        findings.add(Code::UnnormalizedDirection, tree[discriminant].at, message, |diagnostic| {
            diagnostic
                .related(tree[origin].at.span, "the direction is computed here")
                .help("normalize the direction, or use the general form: `b*b - a*c` with `a = dot(d, d)`, and divide the roots by `a`")
        });
    }
}

/// All reachable discriminants that assume a = 1, with the ray's direction; of nested ones, only the largest.
fn discriminants(program: &Program) -> Vec<(ExprId, ExprId)> {
    let mut found = Vec::new();
    for &function in &program.functions {
        let mut operands: HashSet<ExprId> = HashSet::new();
        for &expr in program.exprs(function).iter().rev() {
            if program.deadline.is_over() {
                break;
            }
            if let Some((_, left, right)) = sum(program, expr) {
                operands.extend([left, right]);
                if !operands.contains(&expr) {
                    found.extend(direction_of(program, expr).map(|direction| (expr, direction)));
                }
            }
        }
    }
    found
}

/// The sign of the second operand of a sum or difference of floats, and both operands.
fn sum(program: &Program, expr: ExprId) -> Option<(f64, ExprId, ExprId)> {
    match program.tree[expr].kind {
        _ if program.tree[expr].ty != Type::FLOAT => None,
        ExprKind::Binary {
            op: BinaryOp::Add,
            left,
            right,
        } => Some((1.0, left, right)),
        ExprKind::Binary {
            op: BinaryOp::Subtract,
            left,
            right,
        } => Some((-1.0, left, right)),
        _ => None,
    }
}

/// The vector d if a sum has the terms k·dot(f, d)² and −k·dot(f, f) with k > 0.
fn direction_of(program: &Program, expr: ExprId) -> Option<ExprId> {
    let tree = program.tree;
    let terms = terms(program, expr, MAX_DEPTH)?;
    let dot = |factor: ExprId| match &tree[factor].kind {
        ExprKind::BuiltIn {
            function: BuiltIn::Dot,
            arguments,
        } => Some((arguments[0], arguments[1])),
        _ => None,
    };
    let equal = |a, b| Shape::new(tree, a).is_some_and(|shape| Some(shape) == Shape::new(tree, b));
    let (k, (u, v)) = terms.iter().find_map(|(k, factors)| match factors[..] {
        [a, b] if *k > 0.0 && equal(a, b) => Some((k, dot(a)?)),
        _ => None,
    })?;
    terms.iter().find_map(|(constant, factors)| match factors[..] {
        [only] if *constant == -k => {
            let (a, b) = dot(only).filter(|&(a, b)| equal(a, b))?;
            (equal(a, u).then_some(v)).or(equal(b, v).then_some(u))
        }
        _ => None,
    })
}

/// The terms of a float that is expanded, each a constant and other factors. Variables that are set once are
/// replaced by their values.
fn terms(program: &Program, expr: ExprId, depth: u32) -> Option<Vec<(f64, Vec<ExprId>)>> {
    let expr = program.resolve(expr);
    if let Some(number) = program.number(expr) {
        return Some(vec![(number, Vec::new())]);
    }
    let terms = |expr| terms(program, expr, depth.checked_sub(1)?);
    let expanded: Vec<_> = match program.tree[expr].kind {
        ExprKind::Unary {
            op: UnaryOp::Minus,
            operand,
        } => terms(operand)?
            .into_iter()
            .map(|(k, factors)| (-k, factors))
            .collect(),
        ExprKind::Binary {
            op: BinaryOp::Multiply,
            left,
            right,
        } => {
            let (left, right) = (terms(left)?, terms(right)?);
            let products = left
                .iter()
                .flat_map(|(k, a)| right.iter().map(move |(l, b)| (k * l, [&a[..], b].concat())));
            products.take(MAX_TERMS + 1).collect()
        }
        _ => match sum(program, expr) {
            Some((sign, left, right)) => {
                let right = terms(right)?.into_iter().map(|(k, factors)| (sign * k, factors));
                terms(left)?.into_iter().chain(right).collect()
            }
            None => vec![(1.0, vec![expr])],
        },
    };
    let fits = expanded.len() <= MAX_TERMS && expanded.iter().all(|(_, factors)| factors.len() <= MAX_TERMS);
    fits.then_some(expanded)
}

/// All values assigned to each member of a structure; `None` for an unknown one.
struct Members<'a> {
    program: &'a Program<'a>,
    values: HashMap<(StructId, usize), Vec<Option<ExprId>>>,
}

impl<'a> Members<'a> {
    fn new(program: &'a Program<'a>) -> Self {
        let tree = program.tree;
        let mut values: HashMap<_, Vec<_>> = HashMap::new();
        for expr in program.all_exprs() {
            if let ExprKind::Construct {
                constructor: Constructor::Struct,
                arguments,
            } = &tree[expr].kind
                && let Type::Struct(id) = tree[expr].ty
            {
                for (member, &argument) in arguments.iter().enumerate() {
                    values.entry((id, member)).or_default().push(Some(argument));
                }
            }
            tree.each_write(expr, |target, value| {
                if let ExprKind::Member { structure, member } = tree[target].kind
                    && let Type::Struct(id) = tree[structure].ty
                {
                    values.entry((id, member)).or_default().push(value);
                }
            });
        }
        Self { program, values }
    }

    /// The expression that makes a direction, if its length is 1 only by chance.
    fn never_unit(&self, direction: ExprId) -> Option<ExprId> {
        let (program, tree) = (self.program, self.program.tree);
        let mut origin = None;
        let mut pending = vec![direction];
        let mut seen = HashSet::new();
        for _ in 0..MAX_EXPRS {
            let Some(expr) = pending.pop() else {
                return origin;
            };
            if !seen.insert(expr) {
                continue;
            }
            if let Some(constant) = tree.value(expr) {
                let squares = constant.components().iter().map(|scalar| match scalar {
                    Value::Float(value) => value * value,
                    _ => 0.0,
                });
                if (squares.sum::<f64>() - 1.0).abs() < 1e-3 {
                    return None;
                }
                origin = origin.or(Some(expr));
                continue;
            }
            match &tree[expr].kind {
                ExprKind::Variable(variable) => {
                    let definitions = program.definitions(*variable);
                    if definitions.is_empty() {
                        return None;
                    }
                    for definition in definitions {
                        match *definition {
                            Definition::Value(value) => pending.push(value),
                            Definition::Change(change) if keeps_length(program, change) => {}
                            Definition::Change(_) | Definition::External => return None,
                        }
                    }
                }
                ExprKind::Member { structure, member } => {
                    let Type::Struct(id) = tree[*structure].ty else {
                        return None;
                    };
                    let values = self.values.get(&(id, *member))?.iter().copied();
                    pending.extend(values.collect::<Option<Vec<_>>>()?);
                }
                ExprKind::Unary { operand, .. } => pending.push(*operand),
                ExprKind::Conditional { yes, no, .. } => pending.extend([*yes, *no]),
                ExprKind::Binary {
                    op: BinaryOp::Multiply,
                    left,
                    right,
                } => match (tree[*left].ty, tree[*right].ty) {
                    (Type::Matrix { .. }, _) => pending.push(*right),
                    (_, Type::Matrix { .. }) => pending.push(*left),
                    _ => return None,
                },
                ExprKind::Binary {
                    op: BinaryOp::Add | BinaryOp::Subtract,
                    ..
                }
                | ExprKind::Construct {
                    constructor: Constructor::Vector,
                    ..
                } => {
                    if may_be_unit(program, expr) {
                        return None;
                    }
                    origin = Some(expr);
                }
                ExprKind::BuiltIn {
                    function: BuiltIn::Reflect,
                    arguments,
                } => pending.push(arguments[0]),
                ExprKind::Call { function, .. } => pending.extend(program.returned(*function)),
                _ => return None,
            }
        }
        None
    }
}

/// Whether a change keeps a vector as unlikely to have length 1: a rotation, or a component assignment.
fn keeps_length(program: &Program, change: ExprId) -> bool {
    let tree = program.tree;
    match tree[change].kind {
        ExprKind::Assign {
            op: Some(BinaryOp::Multiply),
            value,
            ..
        } => {
            matches!(tree[value].ty, Type::Matrix { .. })
        }
        ExprKind::Assign {
            op: None | Some(BinaryOp::Add | BinaryOp::Subtract),
            target,
            value,
        } => !matches!(tree[target].kind, ExprKind::Variable(_)) && !may_be_unit(program, value),
        _ => false,
    }
}

/// Whether a sum or vector constructor contains any operation that produces unit vectors.
fn may_be_unit(program: &Program, expr: ExprId) -> bool {
    use BuiltIn::{Abs, Cross, Floor, Fract, Max, Min, Mod, Normalize, Radians, Tan};
    let tree = program.tree;
    let mut pending = vec![expr];
    let mut seen = HashSet::new();
    for _ in 0..MAX_EXPRS {
        let Some(expr) = pending.pop() else {
            return false;
        };
        match &tree[expr].kind {
            ExprKind::BuiltIn {
                function: Abs | Cross | Floor | Fract | Max | Min | Mod | Normalize | Radians | Tan,
                ..
            } => {}
            ExprKind::Call { .. } | ExprKind::BuiltIn { .. } => return true,
            // Only scalars are followed: they scale the vectors.
            ExprKind::Variable(variable) if tree[expr].ty == Type::FLOAT && seen.insert(*variable) => {
                pending.extend(program.definitions(*variable).iter().filter_map(
                    |definition| match *definition {
                        Definition::Value(value) | Definition::Change(value) => Some(value),
                        Definition::External => None,
                    },
                ));
            }
            // `d.yzx * n.x + d.zxy * n.y + …` may be a rotation.
            ExprKind::Swizzle { components, .. } if components.size() > 2 => return true,
            ExprKind::Swizzle { .. } | ExprKind::Member { .. } | ExprKind::Index { .. } => {}
            _ => tree[expr].kind.for_each_operand(|operand| pending.push(operand)),
        }
    }
    true
}
