//! Collects candidates: what the edits of all kinds share.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    ExprId, ExprKind, Input, Member, Scalar, Swizzle, Tree, Type, Variable, VariableId, VariableKind,
};

use super::super::edit::{Candidate, Change, EditKind};
use super::super::shader::{Shader, Site, written};
use super::super::term::{Op, Term, TermKind};
use super::number::{self, Constants};
use crate::engine::tournament::Values;

/// The largest number of values of a type in scope that are tried, and of variables that index an array.
const MAX_VALUES: usize = 24;
const MAX_INDICES: usize = 2;

/// The place of an expression that is edited.
#[derive(Debug, Clone, Copy)]
pub(super) struct At {
    pub(super) site: usize,
    pub(super) expr: ExprId,
    pub(super) ty: Type,
    /// The expression that uses its value.
    pub(super) user: Option<ExprId>,
    pub(super) statement: usize,
}

/// Collects candidates.
pub(super) struct Writer<'a> {
    pub(super) shader: &'a Shader<'a>,
    pub(super) tree: &'a Tree,
    pub(super) constants: &'a Constants,
    /// The bits of the numbers that the shader has; the scene's other numbers are missing in it.
    pub(super) own_numbers: HashSet<u64>,
    /// The variables that an assignment writes.
    pub(super) written: HashSet<VariableId>,
    pub(super) all: Vec<Candidate>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(shader: &'a Shader<'a>, constants: &'a Constants) -> Self {
        let numbers = shader
            .tree
            .exprs
            .iter()
            .filter_map(|(id, _)| number::number(shader.tree, id));
        Self {
            shader,
            tree: shader.tree,
            constants,
            own_numbers: numbers.map(f64::to_bits).collect(),
            written: written_variables(shader.tree),
            all: Vec::new(),
        }
    }

    pub(super) fn site(&mut self, site: usize) {
        let Site {
            exprs,
            user,
            statement,
            ..
        } = &self.shader.sites[site];
        let (expr, user, statement) = (exprs[0], *user, *statement);
        let at = At {
            site,
            expr,
            ty: self.tree[expr].ty,
            user,
            statement,
        };
        self.number(at);
        if exprs.len() > 1 {
            // The text of a macro's body: only its numbers change.
            return;
        }
        if let ExprKind::Assign { op, target, value } = self.tree[expr].kind {
            self.assignment(at, op, target, value);
            return;
        }
        self.expression(at);
        self.name(at);
        self.insertion(at);
    }

    pub(super) fn keep(&self, expr: ExprId) -> Term {
        Term::keep(self.tree, expr)
    }

    /// Adds the replacement of a site's expression, if there is one.
    pub(super) fn replace(&mut self, at: At, kind: EditKind, cost: u32, term: impl Into<Option<Term>>) {
        self.replace_with(at, kind, cost, term, Values::Fixed);
    }

    pub(super) fn replace_with(
        &mut self,
        at: At,
        kind: EditKind,
        cost: u32,
        term: impl Into<Option<Term>>,
        values: Values,
    ) {
        let term = term
            .into()
            .filter(|term| term.ty == at.ty && term.kind != TermKind::Keep(at.expr));
        self.all.extend(term.map(|term| Candidate {
            change: Change::Expression { site: at.site, term },
            values,
            cost,
            kind,
        }));
    }

    /// The values of a type that the variables in scope at a statement have.
    pub(super) fn values(&self, statement: usize, ty: Type) -> Vec<Term> {
        let scope = &self.shader.statements[statement].scope;
        let reads_pixels = self.reads_pixels(statement);
        let mut values = Vec::new();
        // The innermost of equal names hides the others.
        let mut names: HashSet<&str> = HashSet::new();
        for &variable in scope.iter().rev() {
            if values.len() >= MAX_VALUES {
                break;
            }
            let Variable { name, kind, .. } = &self.tree[variable];
            let name = name.as_str();
            let is_resolution = *kind == VariableKind::Input(Input::Resolution);
            // A uniform of the host is the input of its name.
            if *kind == VariableKind::Uniform {
                continue;
            }
            if !name.is_empty() && names.insert(name) && (reads_pixels || !is_resolution) {
                self.values_of(variable, ty, &mut values);
                self.elements(variable, scope, ty, &mut values);
            }
        }
        values
    }

    /// Whether a statement computes with pixels: with the resolution, or with the position in `mainImage`. In
    /// others, which compute with lengths of the scene, a resolution has no meaning.
    fn reads_pixels(&self, statement: usize) -> bool {
        let text = self.shader.text(self.shader.statements[statement].span);
        let position = self.tree[self.shader.checked.main_image].parameters.get(1);
        let position = position.map(|&position| self.tree[position].name.as_str());
        let mut variables = self.tree.variables.iter();
        let resolution =
            variables.find(|(_, variable)| variable.kind == VariableKind::Input(Input::Resolution));
        let resolution = resolution.map(|(_, resolution)| resolution.name.as_str());
        let names = [resolution, position, Some("gl_FragCoord")];
        let mut words = text.split(|byte: char| !byte.is_ascii_alphanumeric() && byte != '_');
        words.any(|word| names.contains(&Some(word)))
    }

    /// The elements of an array at the indices that the shader uses, and their members.
    fn elements(&self, array: VariableId, scope: &[VariableId], ty: Type, values: &mut Vec<Term>) {
        let Type::Array(id) = self.tree[array].ty else {
            return;
        };
        if self.tree[array].kind.is_input() {
            return;
        }
        let element = self.tree.array(id).element;
        let indices = scope
            .iter()
            .rev()
            .filter(|&&index| self.tree[index].ty == Type::INT);
        for &index in indices
            .filter(|&&index| self.tree[index].kind == VariableKind::Local)
            .take(MAX_INDICES)
        {
            let operands = [array, index].map(|id| Term::variable(self.tree, id));
            let element = Term::apply(Op::Index, operands.into(), element);
            self.parts(&element, ty, values, 1);
        }
    }

    fn values_of(&self, variable: VariableId, ty: Type, values: &mut Vec<Term>) {
        let own = &self.tree[variable];
        match own.kind {
            _ if ty == Type::FLOAT && self.is_resolution(variable) => {
                let whole = Term::variable(self.tree, variable);
                let components = [[0], [1]].iter().filter_map(|at| Swizzle::new(at));
                let component = |components| Term::apply(Op::Swizzle(components), vec![whole.clone()], ty);
                values.extend(components.map(component));
            }
            VariableKind::Input(Input::Time) | VariableKind::Global | VariableKind::Const if own.ty == ty => {
                values.push(Term::variable(self.tree, variable));
            }
            VariableKind::Local | VariableKind::Parameter(_) => {
                self.parts(&Term::variable(self.tree, variable), ty, values, 2);
            }
            _ => {}
        }
    }

    /// Whether a variable is `iResolution`, or a vector with that value.
    fn is_resolution(&self, variable: VariableId) -> bool {
        let own = &self.tree[variable];
        let initializer = own
            .initializer
            .map(|initializer| match self.tree[initializer].kind {
                ExprKind::Swizzle { vector, .. } => &self.tree[vector].kind,
                _ => &self.tree[initializer].kind,
            });
        own.kind == VariableKind::Input(Input::Resolution)
            || matches!(initializer, Some(&ExprKind::Variable(of)) if self.is_resolution(of))
    }

    /// The term, or its members, that have a type.
    fn parts(&self, term: &Term, ty: Type, values: &mut Vec<Term>, depth: u32) {
        if term.ty == ty {
            values.push(term.clone());
        }
        if let Type::Struct(id) = term.ty
            && depth > 0
        {
            for (at, Member { ty: own, .. }) in self.tree[id].members.iter().enumerate() {
                let member = Term::member(term.clone(), at, *own);
                self.parts(&member, ty, values, depth - 1);
            }
        }
    }
}

/// The variables that some expression of a shader writes, or a part of them.
fn written_variables(tree: &Tree) -> HashSet<VariableId> {
    let lvalues = tree.exprs.iter().flat_map(|(id, _)| written(tree, id));
    lvalues.filter_map(|lvalue| tree.root_variable(lvalue)).collect()
}

/// Whether a term reads an input of the frame.
pub(super) fn is_input(tree: &Tree, term: &Term) -> bool {
    match &term.kind {
        TermKind::Variable(variable) => tree[*variable].kind.is_input(),
        TermKind::Apply(Op::Swizzle(_), operands) => is_input(tree, &operands[0]),
        _ => false,
    }
}

/// Whether an expression is a name: a variable, a member or an element.
pub(super) fn is_name(kind: &ExprKind) -> bool {
    matches!(
        kind,
        ExprKind::Variable(_) | ExprKind::Member { .. } | ExprKind::Index { .. } | ExprKind::Swizzle { .. }
    )
}

/// Whether a type is a float or a vector of floats.
pub(super) fn is_float(ty: Type) -> bool {
    matches!(ty, Type::Scalar(Scalar::Float) | Type::Vector(Scalar::Float, _))
}

/// Whether an expression is a literal.
pub(super) fn is_literal(kind: &ExprKind) -> bool {
    matches!(kind, ExprKind::Literal(_))
}
