//! Generates candidates: the edits that undo common mistakes, at every place of a shader.

mod donor;
mod expression;
mod insertion;
mod name;
mod number;
mod plausibility;
mod statement;
mod structure;

use std::collections::HashSet;

use toyproof_glsl::tree::{
    ExprId, ExprKind, Input, Member, Scalar, Swizzle, Tree, Type, VariableId, VariableKind,
};

pub(super) use self::donor::{Donor, assignment_candidates, candidates as donor_candidates, donors};
pub(super) use self::number::Constants;
pub(super) use self::structure::{TextEdit, edits as structural_edits};
use super::edit::{Candidate, Change, EditKind};
use super::shader::{Shader, Site};
use super::term::{Op, Term, TermKind};
use crate::engine::tournament::Values;

/// The candidates for the sites and statements of a shader in that order, the most suspicious first.
pub(super) fn candidates(
    shader: &Shader,
    constants: &Constants,
    sites: &[usize],
    statements: &[usize],
) -> Vec<Candidate> {
    let mut writer = Writer::new(shader, constants);
    for &site in sites {
        if writer.all.len() >= MAX_CANDIDATES {
            break;
        }
        writer.site(site);
    }
    let of_sites = writer.all.len();
    for &statement in statements {
        if writer.all.len() >= of_sites + MAX_CANDIDATES {
            break;
        }
        writer.statement(statement);
    }
    plausibility::adjust(shader, constants, &mut writer.all);
    writer.all.into_iter().flat_map(Candidate::by_cost).collect()
}

/// The largest number of candidates for sites, and for statements, and of values of a type in scope: a shader
/// may be large.
const MAX_CANDIDATES: usize = 40_000;
const MAX_VALUES: usize = 24;

/// The number of variables that index an array.
const MAX_INDICES: usize = 2;

/// The place of an expression that is edited.
#[derive(Debug, Clone, Copy)]
struct At {
    site: usize,
    expr: ExprId,
    ty: Type,
    /// The expression that uses its value.
    user: Option<ExprId>,
    statement: usize,
}

/// Collects candidates.
struct Writer<'a> {
    shader: &'a Shader<'a>,
    tree: &'a Tree,
    constants: &'a Constants,
    /// The bits of the numbers that the shader has; the scene's other numbers are missing in it.
    own_numbers: HashSet<u64>,
    all: Vec<Candidate>,
}

impl<'a> Writer<'a> {
    fn new(shader: &'a Shader<'a>, constants: &'a Constants) -> Self {
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
            all: Vec::new(),
        }
    }

    fn site(&mut self, site: usize) {
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

    fn keep(&self, expr: ExprId) -> Term {
        Term::keep(self.tree, expr)
    }

    /// Adds the replacement of a site's expression, if there is one.
    fn replace(&mut self, at: At, kind: EditKind, cost: u32, term: impl Into<Option<Term>>) {
        self.replace_with(at, kind, cost, term, Values::Fixed);
    }

    fn replace_with(
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
    fn values(&self, statement: usize, ty: Type) -> Vec<Term> {
        let scope = &self.shader.statements[statement].scope;
        let reads_pixels = self.reads_pixels(statement);
        let mut values = Vec::new();
        // The innermost of equal names hides the others.
        let mut names: HashSet<&str> = HashSet::new();
        for &variable in scope.iter().rev() {
            if values.len() >= MAX_VALUES {
                break;
            }
            let name = self.tree[variable].name.as_str();
            let is_resolution = self.tree[variable].kind == VariableKind::Input(Input::Resolution);
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
        let mut words = text.split(|byte: char| !byte.is_ascii_alphanumeric() && byte != '_');
        words.any(|word| word == "iResolution" || word == "gl_FragCoord" || Some(word) == position)
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
            VariableKind::Input(Input::Resolution) if ty == Type::FLOAT => {
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

/// Whether a term reads an input of the frame.
fn is_input(tree: &Tree, term: &Term) -> bool {
    match &term.kind {
        TermKind::Variable(variable) => tree[*variable].kind.is_input(),
        TermKind::Apply(Op::Swizzle(_), operands) => is_input(tree, &operands[0]),
        _ => false,
    }
}

/// Whether an expression is a name: a variable, a member or an element.
fn is_name(kind: &ExprKind) -> bool {
    matches!(
        kind,
        ExprKind::Variable(_) | ExprKind::Member { .. } | ExprKind::Index { .. } | ExprKind::Swizzle { .. }
    )
}

/// Whether a type is a float or a vector of floats.
fn is_float(ty: Type) -> bool {
    matches!(ty, Type::Scalar(Scalar::Float) | Type::Vector(Scalar::Float, _))
}

/// Whether an expression is a literal.
fn is_literal(kind: &ExprKind) -> bool {
    matches!(kind, ExprKind::Literal(_))
}
