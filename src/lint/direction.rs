//! Ray–sphere formulas that assume a = 1, applied to directions that are never normalized.
//!
//! Reports only where all definitions of a direction are known, and none of them can have length 1 except by
//! chance: vectors of pixel coordinates and sums of vectors, without a `normalize`, division, sine or dot
//! product in any definition.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::Code;
use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, StructId, Type, UnaryOp, Value, VariableId,
};

use super::Findings;
use super::program::{Definition, Program};
use super::quadratic::Quadratic;

/// The maximum number of expressions examined for one formula; nothing is reported beyond it.
const MAX_EXPRS: usize = 1_000;

pub(super) fn run(program: &Program, quadratics: &[Quadratic], findings: &mut Findings) {
    let tree = program.tree;
    let mut member_values = None;
    for quadratic in quadratics.iter().filter(|quadratic| quadratic.for_unit) {
        let member_values = member_values.get_or_insert_with(|| self::member_values(program));
        let Some(origin) = never_unit(program, member_values, quadratic.direction) else {
            continue;
        };
        let message =
            "this discriminant requires a unit direction, but the ray direction is never normalized";
        findings.add(Code::UnnormalizedDirection, tree[quadratic.expr].at, message, |diagnostic| {
            diagnostic
                .related(tree[origin].at.span, "the direction is computed here")
                .help("normalize the direction, or use the general form: `b*b - a*c` with `a = dot(d, d)`, and divide the roots by `a`")
        });
    }
}

/// All values assigned to each member of a structure; `None` where one is unknown.
type Members = HashMap<(StructId, usize), Option<Vec<ExprId>>>;

fn member_values(program: &Program) -> Members {
    let tree = program.tree;
    let mut member_values = Members::new();
    for expr in program.all_exprs() {
        if let ExprKind::Construct {
            constructor: Constructor::Struct,
            arguments,
        } = &tree[expr].kind
            && let Type::Struct(id) = tree[expr].ty
        {
            for (member, &argument) in arguments.iter().enumerate() {
                if let Some(values) = member_values
                    .entry((id, member))
                    .or_insert_with(|| Some(Vec::new()))
                {
                    values.push(argument);
                }
            }
        }
        tree.each_write(expr, |target, value| {
            let ExprKind::Member { structure, member } = tree[target].kind else {
                return;
            };
            let Type::Struct(id) = tree[structure].ty else {
                return;
            };
            let values = member_values
                .entry((id, member))
                .or_insert_with(|| Some(Vec::new()));
            match (value, values.as_mut()) {
                (Some(value), Some(values)) => values.push(value),
                _ => *values = None,
            }
        });
    }
    member_values
}

/// The expression that makes a direction, if its length is 1 only by chance.
fn never_unit(program: &Program, member_values: &Members, direction: ExprId) -> Option<ExprId> {
    let tree = program.tree;
    let mut origin = None;
    let mut pending = vec![direction];
    let mut seen: HashSet<VariableId> = HashSet::new();
    let mut seen_members = HashSet::new();
    for _ in 0..MAX_EXPRS {
        let Some(expr) = pending.pop() else {
            return origin;
        };
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
                if seen.insert(*variable) {
                    let definitions = program.definitions(*variable);
                    if definitions.is_empty() {
                        return None;
                    }
                    for definition in definitions {
                        match definition {
                            Definition::Value(value) => pending.push(*value),
                            Definition::Change(change) if keeps_length(program, *change) => {}
                            Definition::Change(_) | Definition::External => return None,
                        }
                    }
                }
            }
            ExprKind::Member { structure, member } => {
                let Type::Struct(id) = tree[*structure].ty else {
                    return None;
                };
                if seen_members.insert((id, *member)) {
                    pending.extend(member_values.get(&(id, *member))?.as_ref()?);
                }
            }
            ExprKind::Unary {
                op: UnaryOp::Minus | UnaryOp::Plus,
                operand: only,
            }
            | ExprKind::Assign {
                op: None,
                value: only,
                ..
            }
            | ExprKind::Sequence { second: only, .. } => pending.push(*only),
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

/// Whether a change keeps a vector as unlikely to have length 1: a rotation, or a component assignment.
fn keeps_length(program: &Program, change: ExprId) -> bool {
    let tree = program.tree;
    match tree[change].kind {
        ExprKind::Assign {
            op: Some(BinaryOp::Multiply),
            value,
            ..
        } => matches!(tree[value].ty, Type::Matrix { .. }),
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
    let tree = program.tree;
    let mut pending = vec![expr];
    let mut seen: HashSet<VariableId> = HashSet::new();
    for _ in 0..MAX_EXPRS {
        let Some(expr) = pending.pop() else {
            return false;
        };
        match &tree[expr].kind {
            ExprKind::Call { .. } => return true,
            ExprKind::BuiltIn { function, .. } => match function {
                BuiltIn::Abs
                | BuiltIn::Min
                | BuiltIn::Max
                | BuiltIn::Floor
                | BuiltIn::Fract
                | BuiltIn::Mod
                | BuiltIn::Tan
                | BuiltIn::Radians
                | BuiltIn::Cross
                | BuiltIn::Normalize => {}
                _ => return true,
            },
            // Only scalars are followed: they scale the vectors.
            ExprKind::Variable(variable) if tree[expr].ty == Type::FLOAT && seen.insert(*variable) => {
                for definition in program.definitions(*variable) {
                    match definition {
                        Definition::Value(value) | Definition::Change(value) => pending.push(*value),
                        Definition::External => {}
                    }
                }
            }
            // `d.yzx * n.x + d.zxy * n.y + …` may be a rotation.
            ExprKind::Swizzle { components, .. } if components.size() > 2 => return true,
            ExprKind::Swizzle { .. } | ExprKind::Member { .. } | ExprKind::Index { .. } => {}
            _ => tree[expr].kind.for_each_operand(|operand| pending.push(operand)),
        }
    }
    true
}
