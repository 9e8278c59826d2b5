//! Replaces expressions by constants of their types, or by their operands.

use std::collections::HashSet;
use std::ops::Range;

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Scalar, Tree, Type, Value, walk};

use super::functions::plain;
use super::{Source, constant};
use crate::rewrite::Rewrite;

/// The expressions at a depth below those of statements, whose values may be replaced; `None` if nothing is
/// so deep.
fn values_at(tree: &Tree, depth: usize) -> Option<Vec<ExprId>> {
    let mut level: Vec<ExprId> = tree
        .global_variables()
        .filter_map(|variable| tree[variable].initializer)
        .collect();
    for (_, function) in tree.functions.iter() {
        level.extend(walk::roots(tree, &function.body.clone().unwrap_or_default()));
    }
    let mut lvalues: HashSet<ExprId> = HashSet::new();
    for expr in tree.exprs.ids() {
        tree.each_write(expr, |target, _| lvalues.extend(tree.path(target)));
    }
    for _ in 0..depth {
        let mut next = Vec::new();
        for expr in level {
            tree[expr].kind.for_each_operand(|operand| next.push(operand));
        }
        level = next;
    }
    if level.is_empty() {
        return None;
    }
    level.retain(|expr| {
        let has_value = !matches!(tree[*expr].ty, Type::Void | Type::Sampler(_) | Type::Error);
        has_value && !lvalues.contains(expr) && plain(tree, *expr).is_some()
    });
    Some(level)
}

/// Values replaced by 0, and divisors by 1: a division by 0 is another fault.
pub(super) fn zero(source: &Source, depth: usize) -> Option<Vec<Rewrite>> {
    let tree = source.tree()?;
    let divisors: HashSet<ExprId> = tree
        .exprs
        .iter()
        .filter_map(|(_, expr)| match expr.kind {
            ExprKind::Binary {
                op: BinaryOp::Divide | BinaryOp::Remainder,
                right,
                ..
            } => Some(right),
            _ => None,
        })
        .collect();
    let constant = |expr: ExprId| {
        let ty = tree[expr].ty;
        if divisors.contains(&expr) {
            constant::one(tree, ty)
        } else {
            constant::zero(tree, ty)
        }
    };
    constants(tree, depth, constant)
}

/// Values replaced by 1, which do not make products and quotients vanish.
pub(super) fn one(source: &Source, depth: usize) -> Option<Vec<Rewrite>> {
    let tree = source.tree()?;
    constants(tree, depth, |expr| constant::one(tree, tree[expr].ty))
}

fn constants(tree: &Tree, depth: usize, constant: impl Fn(ExprId) -> Option<String>) -> Option<Vec<Rewrite>> {
    let replaced = |expr: ExprId| Some(Rewrite::replace(plain(tree, expr)?, constant(expr)?));
    let values = values_at(tree, depth)?;
    Some(values.into_iter().rev().filter_map(replaced).collect())
}

/// Values replaced by one of their operands, which is converted where that takes no more than a swizzle or a
/// constructor.
pub(super) fn operands(source: &Source, depth: usize) -> Option<Vec<Rewrite>> {
    let tree = source.tree()?;
    let mut rewrites = Vec::new();
    for expr in values_at(tree, depth)? {
        let Some(whole) = plain(tree, expr) else { continue };
        tree[expr].kind.for_each_operand(|operand| {
            let Some(part) = plain(tree, operand) else { return };
            if let Some((before, after)) = conversion(tree, tree[operand].ty, tree[expr].ty) {
                let is_kept_apart =
                    before.is_empty() && after.is_empty() && !needs_parentheses(tree, expr, operand);
                let text = &source.outline.text[part.clone()];
                let has_parentheses = text.starts_with('(') && text.ends_with(')');
                let (before, after) = if is_kept_apart || before.ends_with('(') || has_parentheses {
                    (before, after)
                } else {
                    (format!("{before}("), format!("){after}"))
                };
                rewrites.push(around(&part, &whole, &before, &after));
            }
        });
    }
    Some(rewrites)
}

/// Keeps a part of a range between two texts.
fn around(part: &Range<usize>, whole: &Range<usize>, before: &str, after: &str) -> Rewrite {
    Rewrite::replace(whole.start..part.start, before).and(part.end..whole.end, after)
}

/// What is written before and after a value to convert it; `None` if a conversion takes more.
fn conversion(tree: &Tree, from: Type, to: Type) -> Option<(String, String)> {
    let plain = |before: String, after: &str| Some((before, after.to_owned()));
    match (from, to) {
        _ if from == to => plain(String::new(), ""),
        (Type::Vector(a, size), Type::Scalar(b)) if a == b && size > 1 => plain(String::new(), ".x"),
        (Type::Vector(a, larger), Type::Vector(b, size)) if a == b && larger > size => {
            plain(String::new(), &format!(".{}", &"xyz"[..usize::from(size)]))
        }
        (Type::Scalar(a), Type::Vector(b, _)) if a == b && a != Scalar::Bool => {
            plain(format!("{}(", tree.type_name(to)), ")")
        }
        _ => None,
    }
}

/// Whether an operand may need parentheses in place of the whole: not where both are operators, since an
/// operand binds at least as tightly.
fn needs_parentheses(tree: &Tree, whole: ExprId, operand: ExprId) -> bool {
    let is_operator = |expr: ExprId| {
        matches!(
            tree[expr].kind,
            ExprKind::Unary { .. }
                | ExprKind::Binary { .. }
                | ExprKind::Conditional { .. }
                | ExprKind::Assign { .. }
                | ExprKind::Sequence { .. }
        )
    };
    is_operator(operand) && !is_operator(whole)
}

/// Numbers with fewer digits, and counts of loops of 2.
pub(super) fn short_numbers(source: &Source) -> Vec<Rewrite> {
    let Some(tree) = source.tree() else {
        return Vec::new();
    };
    let mut rewrites = Vec::new();
    for (id, expr) in tree.exprs.iter() {
        let (ExprKind::Literal(literal), Some(range)) = (&expr.kind, plain(tree, id)) else {
            continue;
        };
        let shorter = match literal.value {
            Value::Float(value) if value.is_finite() && value != 0.0 => {
                let rounded = |digits: usize| -> Option<String> {
                    let rounded: f64 = format!("{value:.digits$e}").parse().ok()?;
                    Some(written(rounded))
                };
                (0..3).filter_map(rounded).collect()
            }
            Value::Int(value) if value > 2 => vec!["2".to_owned()],
            Value::Uint(value) if value > 2 => vec!["2u".to_owned()],
            _ => Vec::new(),
        };
        let shorter = shorter.into_iter().filter(|text| text.len() < literal.text.len());
        rewrites.extend(shorter.map(|text| Rewrite::replace(range.clone(), text)));
    }
    rewrites
}

/// The shortest text of a float.
fn written(value: f64) -> String {
    let text = format!("{value:?}");
    if let Some(integer) = text.strip_suffix(".0") {
        return format!("{integer}.");
    }
    text.strip_prefix('0')
        .map(str::to_owned)
        .filter(|rest| rest.starts_with('.'))
        .unwrap_or(text)
}
