//! How plausible an edit is, judged by the shader that renders the scene: an edit that writes its numbers and
//! vectors, or operations of the same shape, is more likely than one that removes them.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{
    Constructor, Direction, ExprId, ExprKind, Literal, Tree, UnaryOp, Value, Variable, VariableId,
    VariableKind,
};

use super::super::edit::{Action, Candidate, Change};
use super::super::shader::Shader;
use super::super::term::{Op, Term, TermKind};
use super::number::{Constants, number};
use crate::engine::tournament::Values;

/// The gain of an edit that writes a vector or a number of the scene, and the loss of one that removes it.
const VECTOR: i32 = 5;
const NUMBER: i32 = 4;

/// The gain of an edit that reads a variable which nothing else reads.
const UNREAD: i32 = 5;

/// The gain or loss for each enclosing operation that has, or had, a shape of the scene's shader; and the
/// largest gain or loss.
const SHAPE: i32 = 2;
const MAX_SHAPES: i32 = 2;

/// The depth to which shapes are compared; deeper operands are described by their types.
const MAX_DEPTH: u32 = 3;

/// The shapes of the operations in a shader.
#[derive(Debug, Default)]
pub(crate) struct Shapes(HashSet<String>);

impl Shapes {
    /// The shapes of all operations of some trees, to every depth.
    pub(crate) fn new(trees: &[&Tree]) -> Self {
        let mut shapes = HashSet::new();
        for tree in trees {
            for (id, expr) in tree.exprs.iter() {
                if is_operation(&expr.kind) {
                    shapes.extend((1..=MAX_DEPTH).map(|depth| shape(tree, id, depth, None)));
                }
            }
        }
        Self(shapes)
    }
}

/// Adjusts the costs of candidates.
pub(super) fn adjust(shader: &Shader, constants: &Constants, candidates: &mut [Candidate]) {
    let places: HashMap<ExprId, usize> = shader
        .sites
        .iter()
        .enumerate()
        .map(|(at, site)| (site.exprs[0], at))
        .collect();
    let parts = places
        .keys()
        .flat_map(|&expr| (1..=MAX_DEPTH).map(move |depth| (expr, depth)));
    let is_known = |&(expr, depth): &(ExprId, u32)| {
        constants
            .shapes
            .0
            .contains(&shape(shader.tree, expr, depth, None))
    };
    let rating = Rating {
        shader,
        constants,
        known: parts.filter(is_known).collect(),
        places,
    };
    let unread = unread(shader.tree);
    for candidate in candidates {
        let adjusted = |cost: u32, gain: i32| u32::try_from(cost as i32 - gain).unwrap_or(0);
        let (site, term) = match &candidate.change {
            Change::Expression { site, term } => (site, term),
            Change::Statements(actions) => {
                let reads = actions.iter().any(|(_, action)| match action {
                    Action::Before(term) | Action::After(term) => reads_any(term, &unread),
                    _ => false,
                });
                candidate.cost = adjusted(candidate.cost, if reads { UNREAD } else { 0 });
                continue;
            }
        };
        let gain = if reads_any(term, &unread) { UNREAD } else { 0 };
        let shape = rating.shape(*site, term) + gain;
        match &mut candidate.values {
            Values::Tried { values, fit } => {
                let mut least = u32::MAX;
                for (value, cost) in values.iter_mut() {
                    let numbers = [*value, 0.0, 0.0];
                    *cost = adjusted(*cost, shape + rating.numbers(*site, &term.with_fitted(&numbers)));
                    least = least.min(*cost);
                }
                if let Some((cost, _)) = fit {
                    *cost = adjusted(*cost, shape + rating.numbers(*site, term));
                }
                candidate.cost = least.min(candidate.cost);
            }
            Values::Fixed => candidate.cost = adjusted(candidate.cost, shape + rating.numbers(*site, term)),
        }
    }
}

/// The variables of a shader that have a value which nothing reads.
fn unread(tree: &Tree) -> HashSet<VariableId> {
    let mut targets: HashSet<ExprId> = HashSet::new();
    for (_, expr) in tree.exprs.iter() {
        if let ExprKind::Assign { op: None, target, .. } = expr.kind {
            targets.insert(target);
        }
    }
    let read = tree.exprs.iter().filter_map(|(id, expr)| match expr.kind {
        ExprKind::Variable(variable) if !targets.contains(&id) => Some(variable),
        _ => None,
    });
    let read: HashSet<VariableId> = read.collect();
    let has_value = |own: &Variable| match own.kind {
        VariableKind::Local | VariableKind::Const | VariableKind::Global => own.initializer.is_some(),
        VariableKind::Parameter(direction) => direction == Direction::In,
        _ => false,
    };
    let variables = tree.variables.iter();
    let unread = variables.filter(|(id, own)| has_value(own) && !own.name.is_empty() && !read.contains(id));
    unread.map(|(id, _)| id).collect()
}

/// Whether a term reads one of some variables, other than as the target of an assignment.
fn reads_any(term: &Term, variables: &HashSet<VariableId>) -> bool {
    let mut reads = false;
    let value = match &term.kind {
        TermKind::Apply(Op::Assign(_), operands) => &operands[1],
        _ => term,
    };
    value.each(&mut |part| {
        reads |= matches!(part.kind, TermKind::Variable(id) if variables.contains(&id));
    });
    reads
}

struct Rating<'a> {
    shader: &'a Shader<'a>,
    constants: &'a Constants,
    /// The site of each expression.
    places: HashMap<ExprId, usize>,
    /// The expressions that have a shape of the scene's shader, and to which depths.
    known: HashSet<(ExprId, u32)>,
}

impl Rating<'_> {
    /// The gain of an edit for the numbers that it writes and removes.
    fn numbers(&self, site: usize, term: &Term) -> i32 {
        let tree = self.shader.tree;
        let expr = self.shader.sites[site].exprs[0];
        // The vector that contains the number, with the signs between them.
        let mut part = expr;
        while let Some(user) = self.user(part)
            && matches!(
                tree[user].kind,
                ExprKind::Unary {
                    op: UnaryOp::Minus,
                    ..
                }
            )
        {
            part = user;
        }
        let is_vector = |&whole: &ExprId| {
            matches!(
                tree[whole].kind,
                ExprKind::Construct {
                    constructor: Constructor::Vector,
                    ..
                }
            )
        };
        let vector = [Some(part), self.user(part)]
            .into_iter()
            .flatten()
            .find(is_vector);
        if let Some(vector) = vector
            && let Some(old) = components(tree, vector, None)
        {
            let new = components(tree, vector, Some((expr, term)));
            let is_scene = |vector: &Vec<f64>| self.constants.has_vector(vector);
            return VECTOR * gained(is_scene(&old), new.as_ref().is_some_and(is_scene));
        }
        let (Some(old), new) = (number(tree, expr), value(term, tree)) else {
            return 0;
        };
        let is_scene = |number: f64| self.constants.has(number);
        NUMBER * gained(is_scene(old), new.is_some_and(is_scene))
    }

    /// The gain of an edit for the shapes of the operations that enclose it.
    fn shape(&self, site: usize, term: &Term) -> i32 {
        let tree = self.shader.tree;
        let expr = self.shader.sites[site].exprs[0];
        let mut gain = 0;
        let mut whole = Some(expr);
        // A shape shows the edit only if it is deep enough.
        for distance in 0..MAX_DEPTH {
            let Some(part) = whole else { break };
            for depth in distance + 1..=MAX_DEPTH {
                let new = shape(tree, part, depth, Some((expr, term)));
                let is_known = self.constants.shapes.0.contains(&new);
                gain += i32::from(is_known) - i32::from(self.known.contains(&(part, depth)));
            }
            whole = self.user(part);
        }
        // The expression that an insertion encloses keeps its shape.
        let least = if term.keeps(expr) { 0 } else { -MAX_SHAPES };
        SHAPE * gain.clamp(least, MAX_SHAPES)
    }

    fn user(&self, expr: ExprId) -> Option<ExprId> {
        let site = self.places.get(&expr)?;
        self.shader.sites[*site].user
    }
}

/// 1 if something is of the scene only after an edit, −1 if only before.
fn gained(before: bool, after: bool) -> i32 {
    i32::from(after) - i32::from(before)
}

/// The components of a vector of literals, perhaps after an edit.
fn components(tree: &Tree, vector: ExprId, edit: Option<(ExprId, &Term)>) -> Option<Vec<f64>> {
    if let Some((expr, term)) = edit
        && expr == vector
    {
        let TermKind::Apply(Op::Construct(_), arguments) = &term.kind else {
            return None;
        };
        return arguments.iter().map(|argument| value(argument, tree)).collect();
    }
    let ExprKind::Construct { arguments, .. } = &tree[vector].kind else {
        return None;
    };
    let component = |&argument: &ExprId| edited_number(tree, argument, edit);
    arguments.iter().map(component).collect()
}

/// The number that an expression is, perhaps after an edit.
fn edited_number(tree: &Tree, expr: ExprId, edit: Option<(ExprId, &Term)>) -> Option<f64> {
    match (&tree[expr].kind, edit) {
        (_, Some((own, term))) if own == expr => value(term, tree),
        (
            &ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            },
            _,
        ) => edited_number(tree, operand, edit).map(|number| -number),
        _ => number(tree, expr),
    }
}

/// The number that a term is.
fn value(term: &Term, tree: &Tree) -> Option<f64> {
    match &term.kind {
        TermKind::Float(value) => Some(*value),
        TermKind::Int(value) => Some(f64::from(*value)),
        TermKind::Keep(expr) => number(tree, *expr),
        TermKind::Apply(Op::Unary(UnaryOp::Minus), operands) => value(&operands[0], tree).map(|value| -value),
        _ => None,
    }
}

/// Whether an expression is an operation, rather than a name or a number.
pub(super) fn is_operation(kind: &ExprKind) -> bool {
    matches!(
        kind,
        ExprKind::Unary { .. }
            | ExprKind::Binary { .. }
            | ExprKind::BuiltIn { .. }
            | ExprKind::Construct { .. }
            | ExprKind::Swizzle { .. }
            | ExprKind::Conditional { .. }
    )
}

/// The shape of an expression to a depth, perhaps after an edit: its operations, and the types of the names.
fn shape(tree: &Tree, expr: ExprId, depth: u32, edit: Option<(ExprId, &Term)>) -> String {
    if let Some((own, term)) = edit
        && own == expr
    {
        return term_shape(tree, term, depth);
    }
    let ty = || tree.type_name(tree[expr].ty);
    match &tree[expr].kind {
        ExprKind::Literal(Literal { value, .. }) => literal(*value),
        _ if depth == 0 => ty(),
        kind => Op::parts(kind).map_or_else(ty, |(op, operands)| {
            let operands = operands
                .iter()
                .map(|&operand| shape(tree, operand, depth - 1, edit));
            shape_of(op, &operands.collect::<Vec<_>>(), ty())
        }),
    }
}

fn term_shape(tree: &Tree, term: &Term, depth: u32) -> String {
    let ty = || tree.type_name(term.ty);
    match &term.kind {
        // The expression that a term keeps is the shader's own.
        TermKind::Keep(expr) => shape(tree, *expr, depth, None),
        TermKind::Float(value) => literal(Value::Float(*value)),
        TermKind::Int(value) => literal(Value::Int(*value)),
        TermKind::Bool(value) => value.to_string(),
        TermKind::Fitted(_) => "?".to_owned(),
        TermKind::Apply(op, operands) if depth > 0 => {
            let operands = operands
                .iter()
                .map(|operand| term_shape(tree, operand, depth - 1));
            shape_of(*op, &operands.collect::<Vec<_>>(), ty())
        }
        _ => ty(),
    }
}

/// The shape of an operation that has this type.
fn shape_of(op: Op, operands: &[String], ty: String) -> String {
    match op {
        Op::Unary(op) => format!("{}{}", op.symbol(), operands[0]),
        Op::Binary(op) => format!("({})", operands.join(op.symbol())),
        Op::Conditional => operands.join(","),
        Op::BuiltIn(function) => format!("{}({})", function.name(), operands.join(",")),
        Op::Construct(_) => format!("{ty}({})", operands.join(",")),
        Op::Swizzle(components) => format!("{}.{}", operands[0], components.name()),
        _ => ty,
    }
}

/// A number of a formula, such as 0, 1 and 2; others belong to the scene, and only their type counts.
fn literal(value: Value) -> String {
    match value {
        Value::Float(value) if [0.0, 1.0, 2.0, 0.5].contains(&value) => value.to_string(),
        Value::Float(_) => "float".to_owned(),
        Value::Int(value) => value.to_string(),
        Value::Uint(value) => value.to_string(),
        Value::Bool(value) => value.to_string(),
    }
}
