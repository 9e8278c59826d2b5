//! Donors: expressions of the shader that renders the scene, with the names of the author's shader in place
//! of its own. They repair what no small edit does.

use std::collections::{HashMap, HashSet};

use toyproof_glsl::tree::{
    ExprId, ExprKind, FunctionId, Scalar, StatementKind, Tree, Type, VariableId, VariableKind,
};

use super::super::edit::{Candidate, Change, EditKind, Trials};
use super::super::shader::Shader;
use super::super::term::{Term, TermKind};
use super::Writer;
use super::number::Constants;

/// The sizes of donors in operations, names and numbers, and the largest number of different names.
const MIN_SIZE: usize = 3;
const MAX_SIZE: usize = 28;
const MAX_HOLES: usize = 3;

/// The largest number of values that are tried for a name, and of combinations of them.
const MAX_VALUES: usize = 5;
const MAX_COMBINATIONS: usize = 24;

/// The cost of a donor, and of each part of it.
const DONOR: u32 = 26;
const PARTS_PER_COST: usize = 4;

/// The largest depth of inlined calls.
const MAX_INLINED: u32 = 3;

/// An expression with holes for the author's names.
#[derive(Debug, Clone)]
pub(in crate::repair) struct Donor {
    term: Term,
    /// The types of the holes.
    holes: Vec<Type>,
    size: usize,
}

/// Collects the donors of a shader, each once.
pub(super) fn donors(tree: &Tree) -> Vec<Donor> {
    let mut known = HashSet::new();
    let mut donors = Vec::new();
    for (id, expr) in tree.exprs.iter() {
        if !is_value(expr.ty) || !super::plausibility::is_operation(&expr.kind) {
            continue;
        }
        let mut translation = Translation {
            tree,
            holes: Vec::new(),
            size: 0,
        };
        let Some(term) = translation.term(id, &HashMap::new(), 0) else {
            continue;
        };
        let holes: Vec<Type> = translation.holes.iter().map(|&(_, ty)| ty).collect();
        let fits =
            (MIN_SIZE..=MAX_SIZE).contains(&translation.size) && (1..=MAX_HOLES).contains(&holes.len());
        if fits && known.insert(format!("{term:?}")) {
            donors.push(Donor {
                term,
                holes,
                size: translation.size,
            });
        }
    }
    donors
}

fn is_value(ty: Type) -> bool {
    matches!(
        ty,
        Type::Scalar(Scalar::Float | Scalar::Bool) | Type::Vector(Scalar::Float, _)
    )
}

/// The translation of one expression.
struct Translation<'a> {
    tree: &'a Tree,
    /// The names, as text, and their types.
    holes: Vec<(String, Type)>,
    size: usize,
}

impl Translation<'_> {
    /// The expression as a term; none if it cannot be written in another shader. `bound` are the values of
    /// the parameters and variables of inlined functions.
    fn term(&mut self, expr: ExprId, bound: &HashMap<VariableId, Term>, depth: u32) -> Option<Term> {
        self.size += 1;
        if self.size > MAX_SIZE {
            return None;
        }
        let tree = self.tree;
        let ty = tree[expr].ty;
        let all = |own: &mut Self, arguments: &[ExprId]| -> Option<Vec<Term>> {
            arguments
                .iter()
                .map(|&argument| own.term(argument, bound, depth))
                .collect()
        };
        let kind = match &tree[expr].kind {
            ExprKind::Literal(literal) => match literal.value {
                toyproof_glsl::tree::Value::Float(value) => TermKind::Float(value),
                toyproof_glsl::tree::Value::Int(value) => TermKind::Int(value),
                toyproof_glsl::tree::Value::Bool(value) => TermKind::Bool(value),
                toyproof_glsl::tree::Value::Uint(_) => return None,
            },
            ExprKind::Variable(variable) => return self.variable(*variable, bound, depth),
            ExprKind::Member { .. } | ExprKind::Index { .. } => return self.hole(expr),
            ExprKind::Unary { op, operand } => {
                TermKind::Unary(*op, Box::new(self.term(*operand, bound, depth)?))
            }
            ExprKind::Binary { op, left, right } => {
                let left = Box::new(self.term(*left, bound, depth)?);
                TermKind::Binary(*op, left, Box::new(self.term(*right, bound, depth)?))
            }
            ExprKind::Conditional { condition, yes, no } => {
                let parts = all(self, &[*condition, *yes, *no])?;
                TermKind::Conditional(Box::new(parts.try_into().ok()?))
            }
            ExprKind::BuiltIn { function, arguments } => {
                if function.is_texture() || function.out_parameter().is_some() {
                    return None;
                }
                TermKind::BuiltIn(*function, all(self, arguments)?)
            }
            ExprKind::Construct {
                constructor,
                arguments,
            } if matches!(ty, Type::Scalar(_) | Type::Vector(..)) => {
                TermKind::Construct(*constructor, all(self, arguments)?)
            }
            ExprKind::Swizzle { vector, components } => {
                TermKind::Swizzle(Box::new(self.term(*vector, bound, depth)?), *components)
            }
            ExprKind::Call { function, arguments } => {
                return self.inlined(*function, arguments, bound, depth);
            }
            _ => return None,
        };
        Some(Term::new(kind, ty))
    }

    fn variable(
        &mut self,
        variable: VariableId,
        bound: &HashMap<VariableId, Term>,
        depth: u32,
    ) -> Option<Term> {
        let tree = self.tree;
        if let Some(term) = bound.get(&variable) {
            return Some(term.clone());
        }
        match (tree[variable].kind, tree[variable].initializer) {
            // The number that a constant stands for.
            (VariableKind::Const, Some(initializer)) => self.term(initializer, &HashMap::new(), depth),
            (VariableKind::Local | VariableKind::Parameter(_) | VariableKind::Input(_), _) => {
                self.named(tree[variable].name.clone(), tree[variable].ty)
            }
            _ => None,
        }
    }

    /// A member or an element, whatever it is called.
    fn hole(&mut self, expr: ExprId) -> Option<Term> {
        let mut path = Vec::new();
        let mut part = expr;
        loop {
            part = match self.tree[part].kind {
                ExprKind::Member { structure, member } => {
                    path.push(format!(".{member}"));
                    structure
                }
                ExprKind::Index { base, index } => {
                    path.push(format!("[{}]", index.index()));
                    base
                }
                ExprKind::Variable(variable) => {
                    path.push(format!("{}#{}", self.tree[variable].name, variable.index()));
                    break;
                }
                _ => return None,
            };
        }
        self.named(path.concat(), self.tree[expr].ty)
    }

    fn named(&mut self, name: String, ty: Type) -> Option<Term> {
        if !is_value(ty) {
            return None;
        }
        let at = self
            .holes
            .iter()
            .position(|(known, _)| *known == name)
            .unwrap_or_else(|| {
                self.holes.push((name, ty));
                self.holes.len() - 1
            });
        Some(Term::new(TermKind::Hole(at), ty))
    }

    /// The value of a function that declares variables and returns, with its arguments in place.
    fn inlined(
        &mut self,
        function: FunctionId,
        arguments: &[ExprId],
        bound: &HashMap<VariableId, Term>,
        depth: u32,
    ) -> Option<Term> {
        let tree = self.tree;
        let body = tree[function].body.as_ref().filter(|_| depth < MAX_INLINED)?;
        let mut values = HashMap::new();
        for (&parameter, &argument) in tree[function].parameters.iter().zip(arguments) {
            if is_value(tree[parameter].ty) {
                values.insert(parameter, self.term(argument, bound, depth)?);
            }
        }
        for statement in body {
            match statement.kind {
                StatementKind::Declare(variable) => {
                    let value = self.term(tree[variable].initializer?, &values, depth + 1)?;
                    values.insert(variable, value);
                }
                StatementKind::Return(Some(value)) => return self.term(value, &values, depth + 1),
                _ => return None,
            }
        }
        None
    }
}

/// The replacements of some sites by donors.
pub(in crate::repair) fn candidates(
    shader: &Shader,
    constants: &Constants,
    sites: &[usize],
) -> Vec<Candidate> {
    let writer = Writer::new(shader, constants);
    let mut all = Vec::new();
    for &site in sites {
        let expr = shader.sites[site].exprs[0];
        for donor in constants
            .donors
            .iter()
            .filter(|donor| donor.term.ty == shader.tree[expr].ty)
        {
            for values in writer.fillings(site, &donor.holes) {
                all.push(Candidate {
                    change: Change::Expression {
                        site,
                        term: donor.term.filled(&values),
                    },
                    trials: Trials::Once,
                    cost: DONOR + (donor.size / PARTS_PER_COST) as u32,
                    kind: EditKind::Expression,
                });
            }
        }
    }
    all
}

impl Writer<'_> {
    /// The ways to fill holes with values in scope, those that the site uses already first.
    fn fillings(&self, site: usize, holes: &[Type]) -> Vec<Vec<Term>> {
        let shader = self.shader;
        let own = &shader.sites[site];
        let text = shader.text(own.span);
        let of_type = |&ty: &Type| {
            let mut values = self.values(own.statement, ty);
            if self.tree[own.exprs[0]].ty == ty {
                values.insert(0, Term::keep(self.tree, own.exprs[0]));
            }
            let is_used = |value: &Term| text.contains(&value.text(self.tree, shader.source, 0));
            values.sort_by_key(|value| !is_used(value));
            values.truncate(MAX_VALUES);
            values
        };
        let mut fillings: Vec<Vec<Term>> = vec![Vec::new()];
        for values in holes.iter().map(of_type) {
            let longer = fillings.iter().flat_map(|filling| {
                values.iter().map(move |value| {
                    let mut longer = filling.clone();
                    longer.push(value.clone());
                    longer
                })
            });
            fillings = longer.collect();
        }
        fillings.truncate(MAX_COMBINATIONS);
        fillings
    }
}
