//! Statements that transform a variable: by a matrix, by the perspective division, by a number.

use toyproof_glsl::tree::{BinaryOp, Scalar, Swizzle, Type, VariableId, VariableKind};

use super::super::edit::{Action, Candidate, Change, EditKind};
use super::super::shader::Shape;
use super::super::term::{Op, Term};
use super::writer::{Writer, is_float};
use crate::engine::fit::Fit;
use crate::engine::tournament::Values;

/// The costs: products with matrices, divisions by the last component, and numbers that are added or
/// multiplied, known and fitted.
const MATRIX: u32 = 22;
const PERSPECTIVE: u32 = 20;
const NUMBER: u32 = 24;
const FITTED: u32 = 38;

/// The numbers that are added, and those that are multiplied.
const TERMS: [f64; 6] = [1.0, -1.0, 0.5, -0.5, 2.0, -2.0];
const FACTORS: [f64; 5] = [2.0, 0.5, -1.0, 3.0, 0.25];

/// The largest numbers of variables that are transformed, of matrices, and of the reference's numbers that are
/// added.
const MAX_TRANSFORMED: usize = 4;
const MAX_MATRICES: usize = 4;
const MAX_NUMBERS: usize = 24;

/// An assignment, the numbers that it tries, and its cost.
type Transformation = (Term, Values, u32);

impl Writer<'_> {
    /// Transforms a variable that a statement writes or reads, behind it, and in front of the first of a block
    /// or of one that follows a block: by a matrix, by the perspective division, by a number.
    pub(super) fn transformations(&mut self, at: usize) {
        let tree = self.tree;
        let statement = &self.shader.statements[at];
        let is_simple = matches!(statement.kind, Shape::Expression(_) | Shape::Declaration(_));
        let previous = self.shader.statements[..at]
            .iter()
            .find(|other| other.next == Some(at));
        let block = previous.filter(|other| matches!(other.kind, Shape::If { .. } | Shape::Loop));
        let is_before = previous.is_none() || block.is_some();
        if !is_simple && !is_before {
            return;
        }
        let first = block.map_or(statement.span, |block| block.span);
        let text = self.shader.text(first.to(statement.span));
        let declared = match statement.kind {
            Shape::Declaration(variable) => Some(variable),
            _ => None,
        };
        let is_used = |id: VariableId| {
            let own = &tree[id];
            let is_local = matches!(own.kind, VariableKind::Local | VariableKind::Parameter(_));
            is_local && is_float(own.ty) && mentions(text, &own.name)
        };
        let scope = statement.scope.iter().rev().copied();
        let used: Vec<VariableId> = declared
            .into_iter()
            .chain(scope)
            .filter(|&id| is_used(id))
            .collect();
        for id in used.into_iter().take(MAX_TRANSFORMED) {
            let target = Term::variable(tree, id);
            let mut all = self.products(&target, &statement.scope);
            all.extend(self.of_components(&target));
            all.extend(self.of_numbers(target));
            for (term, values, cost) in all {
                let mut actions = Vec::new();
                if is_simple {
                    actions.push(Action::After(term.clone()));
                }
                // A variable that is declared has no value before.
                if is_before && declared != Some(id) {
                    actions.push(Action::Before(term));
                }
                self.all.extend(actions.into_iter().map(|action| Candidate {
                    change: Change::Statements(vec![(at, action)]),
                    values: values.clone(),
                    cost,
                    kind: EditKind::MissingStatement,
                }));
            }
        }
    }

    /// Products with the matrices in scope.
    fn products(&self, target: &Term, scope: &[VariableId]) -> Vec<Transformation> {
        let tree = self.tree;
        let is_matrix =
            |id: &&VariableId| matches!(tree[**id].ty, Type::Matrix { .. }) && !tree[**id].kind.is_input();
        let matrices = scope.iter().rev().filter(is_matrix).take(MAX_MATRICES);
        let products = matrices.flat_map(|&id| {
            let matrix = Term::variable(tree, id);
            [(matrix.clone(), target.clone()), (target.clone(), matrix)]
        });
        let products = products.filter_map(|(a, b)| Term::binary(BinaryOp::Multiply, a, b));
        let fitting = products.filter(|product| product.ty == target.ty);
        let assigned = fitting.map(|product| Term::assign(None, target.clone(), product));
        assigned.map(|term| (term, Values::Fixed, MATRIX)).collect()
    }

    /// The division of a vector by its last component, and numbers that are added to its components.
    fn of_components(&self, target: &Term) -> Vec<Transformation> {
        let Type::Vector(_, size) = target.ty else {
            return Vec::new();
        };
        let part = |components: &[u8], ty| {
            let components = Swizzle::new(components)?;
            Some(Term::apply(Op::Swizzle(components), vec![target.clone()], ty))
        };
        let mut all = Vec::new();
        let rest: Vec<u8> = (0..size - 1).collect();
        let rest = part(&rest, Type::Vector(Scalar::Float, size - 1)).filter(|_| size > 2);
        if let (Some(rest), Some(last)) = (rest, part(&[size - 1], Type::FLOAT)) {
            let divided = Term::assign(Some(BinaryOp::Divide), rest, last);
            all.push((divided, Values::Fixed, PERSPECTIVE));
        }
        for component in (0..size).filter_map(|component| part(&[component], Type::FLOAT)) {
            let cost = NUMBER + 2;
            let term = Term::assign(Some(BinaryOp::Add), component, Term::fitted());
            all.push((term, self.added(cost), cost));
        }
        all
    }

    /// Numbers by which a variable is multiplied, or which are added.
    fn of_numbers(&self, target: Term) -> [Transformation; 2] {
        let factors = numbers(&FACTORS, NUMBER, Fit::Number(1.0));
        let product = Term::assign(Some(BinaryOp::Multiply), target.clone(), Term::fitted());
        let sum = Term::assign(Some(BinaryOp::Add), target, Term::fitted());
        [(product, factors, NUMBER), (sum, self.added(NUMBER), NUMBER)]
    }

    /// The numbers that are added: well-known ones, and those of the reference with both signs.
    fn added(&self, cost: u32) -> Values {
        let own = self.constants.floats.iter().flat_map(|&number| [number, -number]);
        let all: Vec<f64> = TERMS.into_iter().chain(own.take(MAX_NUMBERS)).collect();
        numbers(&all, cost, Fit::Number(0.0))
    }
}

/// Numbers at a cost, and a fitted one.
fn numbers(all: &[f64], cost: u32, fit: Fit) -> Values {
    Values::Tried {
        values: all.iter().map(|&number| (number, cost)).collect(),
        fit: Some((FITTED, fit)),
    }
}

/// Whether a text has a name as a word.
fn mentions(text: &str, name: &str) -> bool {
    let mut words = text.split(|byte: char| !byte.is_ascii_alphanumeric() && byte != '_');
    !name.is_empty() && words.any(|word| word == name)
}
