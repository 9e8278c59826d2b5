//! Names for expressions, the same for those that are written alike.

use std::collections::HashMap;

use toyproof_glsl::tree::{ExprId, Tree, VariableId};

use super::super::shape::Shape;
use super::known::Term;

/// The expressions of a function that were named.
#[derive(Default)]
pub(super) struct Terms {
    /// Of those asked for; none for what is not compared.
    named: HashMap<ExprId, Option<Term>>,
    shapes: HashMap<Shape, Term>,
    /// By term: whose values it depends on.
    depends: Vec<Vec<VariableId>>,
}

impl Terms {
    /// The name of an expression; none for what does more than give a value, and for the very large.
    pub(super) fn of(&mut self, tree: &Tree, expr: ExprId) -> Option<Term> {
        if let Some(term) = self.named.get(&expr) {
            return *term;
        }
        let term = Shape::of(tree, expr).map(|shape| self.of_shape(shape));
        self.named.insert(expr, term);
        term
    }

    /// The name of a variable.
    pub(super) fn of_variable(&mut self, variable: VariableId) -> Term {
        self.of_shape(Shape::of_variable(variable))
    }

    /// Whether a term's value depends on a variable's.
    pub(super) fn depends(&self, term: Term, variable: VariableId) -> bool {
        self.depends[term as usize].contains(&variable)
    }

    fn of_shape(&mut self, shape: Shape) -> Term {
        let next = self.depends.len() as Term;
        let variables = shape.variables.clone();
        let term = *self.shapes.entry(shape).or_insert(next);
        if term == next {
            self.depends.push(variables);
        }
        term
    }
}
