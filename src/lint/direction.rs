//! Ray–sphere formulas that take a = 1, given directions that are never normalised.
//!
//! Only where all that a direction may be is seen, and none of it can have length 1 but by chance: vectors of pixel coordinates and sums of
//! vectors, without a `normalize`, a division, a sine or a dot product anywhere on the way.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::Code;
use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, StructId, Type, UnaryOp, Value, VariableId,
};

use super::Found;
use super::program::{Definition, Program};
use super::quadratic::Quadratic;

/// How many expressions are looked at for one formula; of what has more, nothing is told.
const BUDGET: usize = 1_000;

pub(super) fn run(program: &Program, quadratics: &[Quadratic], found: &mut Found) {
    let tree = program.tree;
    let mut members = None;
    for quadratic in quadratics.iter().filter(|quadratic| quadratic.for_unit) {
        let members = members.get_or_insert_with(|| self::members(program));
        let Some(origin) = never_unit(program, members, quadratic.direction) else {
            continue;
        };
        let message =
            "this discriminant is right for directions of length 1, and the ray's is never normalised";
        found.tell(Code::UnnormalisedDirection, tree[quadratic.expr].at, message, |diagnostic| {
            diagnostic
                .related(tree[origin].at.span, "the direction is made here")
                .note("write `normalize(…)` there, or keep a = dot(d, d): `b*b - a*c`, and divide the roots by a")
        });
    }
}

/// All values that a member of a structure is ever given; none where one cannot be told.
type Members = HashMap<(StructId, usize), Option<Vec<ExprId>>>;

fn members(program: &Program) -> Members {
    let tree = program.tree;
    let mut members = Members::new();
    for expr in program.all_exprs() {
        if let ExprKind::Construct {
            constructor: Constructor::Struct,
            arguments,
        } = &tree[expr].kind
            && let Type::Struct(id) = tree[expr].ty
        {
            for (member, &argument) in arguments.iter().enumerate() {
                if let Some(values) = members.entry((id, member)).or_insert_with(|| Some(Vec::new())) {
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
            let values = members.entry((id, member)).or_insert_with(|| Some(Vec::new()));
            match (value, values.as_mut()) {
                (Some(value), Some(values)) => values.push(value),
                _ => *values = None,
            }
        });
    }
    members
}

/// Where a direction comes from, if it is never of length 1 but by chance.
fn never_unit(program: &Program, members: &Members, direction: ExprId) -> Option<ExprId> {
    let tree = program.tree;
    let mut origin = None;
    let mut pending = vec![direction];
    let mut seen: HashSet<VariableId> = HashSet::new();
    let mut seen_members = HashSet::new();
    for _ in 0..BUDGET {
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
                            Definition::Change(_) | Definition::Outside => return None,
                        }
                    }
                }
            }
            ExprKind::Member { structure, member } => {
                let Type::Struct(id) = tree[*structure].ty else {
                    return None;
                };
                if seen_members.insert((id, *member)) {
                    pending.extend(members.get(&(id, *member))?.as_ref()?);
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

/// Whether a change leaves it as unlikely to be of length 1 as it was: a turn, or a component.
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

/// Whether a sum or a vector of components is made of anything that vectors of length 1 are made of.
fn may_be_unit(program: &Program, expr: ExprId) -> bool {
    let tree = program.tree;
    let mut pending = vec![expr];
    let mut seen: HashSet<VariableId> = HashSet::new();
    for _ in 0..BUDGET {
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
            // Of vectors only the scalars are followed that stretch them.
            ExprKind::Variable(variable) if tree[expr].ty == Type::FLOAT && seen.insert(*variable) => {
                for definition in program.definitions(*variable) {
                    match definition {
                        Definition::Value(value) | Definition::Change(value) => pending.push(*value),
                        Definition::Outside => {}
                    }
                }
            }
            // `d.yzx * n.x + d.zxy * n.y + …` may be a turn.
            ExprKind::Swizzle { components, .. } if components.size() > 2 => return true,
            ExprKind::Swizzle { .. } | ExprKind::Member { .. } | ExprKind::Index { .. } => {}
            _ => tree[expr].kind.for_each_operand(|operand| pending.push(operand)),
        }
    }
    true
}
