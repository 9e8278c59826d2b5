//! Donors: expressions of the shader that renders the scene, or of other correct shaders, with the names of
//! the author's shader in place of their own. They repair mistakes that no small edit repairs.

use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};

use toyproof_glsl::tree::{
    ExprId, ExprKind, FunctionId, Scalar, StatementKind, Tree, Type, Value, VariableId, VariableKind,
};

use super::super::edit::{Action, Candidate, Change, EditKind};
use super::super::shader::{Shader, Shape};
use super::super::term::{Op, Term, TermKind};
use super::number::Constants;
use super::writer::Writer;
use crate::engine::tournament::Values;

/// The sizes of donors in operations, names and numbers, and the largest number of different names.
const MIN_SIZE: usize = 3;
const MAX_SIZE: usize = 28;
const MAX_HOLES: usize = 3;

/// The largest number of donors, and of replacements by them.
const MAX_DONORS: usize = 4000;
const MAX_CANDIDATES: usize = 40_000;

/// The largest number of values that are tried for a name, and of combinations of them.
const MAX_VALUES: usize = 5;
const MAX_COMBINATIONS: usize = 24;

/// The cost of a donor, the numbers of its parts and of more likely names that cost one unit more, and its
/// gain if it consists of the same operations as the replaced expression.
const DONOR: u32 = 26;
const PARTS_PER_COST: usize = 4;
const NAMES_PER_COST: usize = 6;
const SIMILARITY: f64 = 8.0;

/// The largest number of the reference's conditions that are tried at a place.
const MAX_CONDITIONS: usize = 12;

/// The cost of an assignment of the reference.
const ASSIGNMENT: u32 = 23;

/// The largest depth of inlined calls.
const MAX_INLINED: u32 = 3;

/// An expression with holes for the author's names.
#[derive(Debug, Clone)]
pub(crate) struct Donor {
    term: Term,
    /// The types of the holes.
    holes: Vec<Type>,
    size: usize,
    /// Its operations, sorted.
    operations: Vec<String>,
}

impl Donor {
    /// The cost of writing it in place of an expression with these operations, which are sorted.
    fn cost(&self, operations: &[String]) -> u32 {
        let gain = (SIMILARITY * similarity(&self.operations, operations)).round();
        DONOR + (self.size / PARTS_PER_COST) as u32 - gain as u32
    }
}

/// The share of the elements of two sorted lists that they have in common (Dice's coefficient).
fn similarity(one: &[String], other: &[String]) -> f64 {
    let (mut a, mut b, mut common) = (0, 0, 0);
    while a < one.len() && b < other.len() {
        match one[a].cmp(&other[b]) {
            std::cmp::Ordering::Less => a += 1,
            std::cmp::Ordering::Greater => b += 1,
            std::cmp::Ordering::Equal => (a, b, common) = (a + 1, b + 1, common + 1),
        }
    }
    2.0 * f64::from(common) / (one.len() + other.len()).max(1) as f64
}

/// Collects the donors of some shaders, each once, the most frequent ones first.
pub(crate) fn donors<'a>(trees: impl IntoIterator<Item = &'a Tree>) -> Vec<Donor> {
    let mut all: BTreeMap<String, (Donor, usize)> = BTreeMap::new();
    for tree in trees {
        let own: BTreeMap<String, Donor> = donors_of(tree)
            .map(|donor| (format!("{:?}", donor.term), donor))
            .collect();
        for (key, donor) in own {
            all.entry(key).or_insert((donor, 0)).1 += 1;
        }
    }
    let mut all: Vec<(String, (Donor, usize))> = all.into_iter().collect();
    all.sort_by(|(a, (one, uses)), (b, (other, other_uses))| {
        let rank = |uses: usize, donor: &Donor| (Reverse(uses), donor.size);
        rank(*uses, one).cmp(&rank(*other_uses, other)).then(a.cmp(b))
    });
    all.truncate(MAX_DONORS);
    all.into_iter().map(|(_, (donor, _))| donor).collect()
}

fn donors_of(tree: &Tree) -> impl Iterator<Item = Donor> {
    let candidates = tree
        .exprs
        .iter()
        .filter(|(_, expr)| is_value(expr.ty) && super::plausibility::is_operation(&expr.kind));
    candidates.filter_map(|(id, _)| {
        let (term, translation) = translated(tree, id)?;
        let holes: Vec<Type> = translation.holes.iter().map(|&(_, ty)| ty).collect();
        let fits =
            (MIN_SIZE..=MAX_SIZE).contains(&translation.size) && (1..=MAX_HOLES).contains(&holes.len());
        fits.then(|| Donor {
            operations: operations(&term),
            term,
            holes,
            size: translation.size,
        })
    })
}

/// Collects the assignments of a shader as donors, whose first hole is the target: those that it has, and
/// those of an expression of a variable to that variable.
pub(super) fn assignments(tree: &Tree) -> Vec<Donor> {
    let own = tree.exprs.iter().filter_map(|(id, _)| assignment(tree, id));
    let of_itself = donors_of(tree).filter(|donor| donor.holes[..] == [donor.term.ty]);
    let of_itself = of_itself.map(|donor| Donor {
        term: Term::assign(None, Term::new(TermKind::Hole(0), donor.term.ty), donor.term),
        ..donor
    });
    let all = own
        .chain(of_itself)
        .map(|donor| (format!("{:?}", donor.term), donor));
    let all: BTreeMap<String, Donor> = all.collect();
    let mut all: Vec<Donor> = all.into_values().collect();
    all.sort_by_key(|donor| donor.size);
    all
}

/// An assignment to a variable as a donor.
fn assignment(tree: &Tree, expr: ExprId) -> Option<Donor> {
    let ExprKind::Assign { op, target, value } = tree[expr].kind else {
        return None;
    };
    let mut translation = Translation {
        tree,
        holes: Vec::new(),
        size: 0,
    };
    let target = translation.term(target, &HashMap::new(), 0)?;
    let value = translation.term(value, &HashMap::new(), 0)?;
    let holes: Vec<Type> = translation.holes.iter().map(|&(_, ty)| ty).collect();
    let is_variable = match &target.kind {
        TermKind::Apply(Op::Swizzle(_), operands) => operands[0].kind == TermKind::Hole(0),
        kind => *kind == TermKind::Hole(0),
    };
    let fits = is_variable && holes.len() <= MAX_HOLES;
    fits.then(|| Donor {
        operations: operations(&value),
        term: Term::assign(op, target, value),
        holes,
        size: translation.size,
    })
}

/// The operations of a term, sorted.
fn operations(term: &Term) -> Vec<String> {
    let mut all = Vec::new();
    term.each(&mut |part| {
        if let TermKind::Apply(op, _) = &part.kind {
            all.extend(match op {
                Op::Unary(op) => Some(format!("{}_", op.symbol())),
                Op::Binary(op) => Some(op.symbol().to_owned()),
                Op::Conditional => Some("?".to_owned()),
                Op::BuiltIn(function) => Some(function.name().to_owned()),
                Op::Construct(_) => Some("new".to_owned()),
                Op::Swizzle(components) => Some(components.name()),
                _ => None,
            });
        }
    });
    all.sort_unstable();
    all
}

/// An expression as a term, with holes for its names; `None` if it cannot be written in another shader.
fn translated(tree: &Tree, expr: ExprId) -> Option<(Term, Translation<'_>)> {
    let mut translation = Translation {
        tree,
        holes: Vec::new(),
        size: 0,
    };
    let term = translation.term(expr, &HashMap::new(), 0)?;
    Some((term, translation))
}

fn is_value(ty: Type) -> bool {
    matches!(
        ty,
        Type::Scalar(Scalar::Float | Scalar::Bool) | Type::Vector(Scalar::Float, _) | Type::Matrix { .. }
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
    /// The expression as a term; `None` if it cannot be written in another shader. `bound` are the values of
    /// the parameters and variables of inlined functions.
    fn term(&mut self, expr: ExprId, bound: &HashMap<VariableId, Term>, depth: u32) -> Option<Term> {
        self.size += 1;
        if self.size > MAX_SIZE {
            return None;
        }
        let tree = self.tree;
        let ty = tree[expr].ty;
        let kind = match &tree[expr].kind {
            ExprKind::Literal(literal) => match literal.value {
                Value::Float(value) => TermKind::Float(value),
                Value::Int(value) => TermKind::Int(value),
                Value::Bool(value) => TermKind::Bool(value),
                Value::Uint(_) => return None,
            },
            ExprKind::Variable(variable) => return self.variable(*variable, bound, depth),
            ExprKind::Call { function, arguments } => {
                return self.inlined(*function, arguments, bound, depth);
            }
            kind => {
                let (op, operands) = Op::parts(kind)?;
                match op {
                    Op::Member(_) | Op::Index => return self.hole(expr),
                    Op::Assign(_) => return None,
                    Op::BuiltIn(function) if function.is_texture() || function.out_parameter().is_some() => {
                        return None;
                    }
                    Op::Construct(_)
                        if !matches!(ty, Type::Scalar(_) | Type::Vector(..) | Type::Matrix { .. }) =>
                    {
                        return None;
                    }
                    _ => {}
                }
                let operands = operands
                    .into_iter()
                    .map(|operand| self.term(operand, bound, depth));
                TermKind::Apply(op, operands.collect::<Option<_>>()?)
            }
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
            // The number that a constant has.
            (VariableKind::Const, Some(initializer)) => self.term(initializer, &HashMap::new(), depth),
            (
                VariableKind::Local
                | VariableKind::Parameter(_)
                | VariableKind::Input(_)
                | VariableKind::Channel(_),
                _,
            ) => self.named(tree[variable].name.clone(), tree[variable].ty),
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
pub(crate) fn candidates(
    shader: &Shader,
    constants: &Constants,
    donors: &[Donor],
    sites: &[usize],
) -> Vec<Candidate> {
    let writer = Writer::new(shader, constants);
    let per_site = MAX_CANDIDATES / sites.len().max(1);
    let mut all = Vec::new();
    for &site in sites {
        let expr = shader.sites[site].exprs[0];
        let operations = translated(shader.tree, expr).map_or_else(Vec::new, |(own, _)| operations(&own));
        let mut fitting: Vec<(u32, &Donor)> = donors
            .iter()
            .filter(|donor| donor.term.ty == shader.tree[expr].ty)
            .map(|donor| (donor.cost(&operations), donor))
            .collect();
        fitting.sort_by_key(|&(cost, _)| cost);
        let fillings: Vec<Vec<Vec<Term>>> = fitting
            .iter()
            .map(|(_, donor)| writer.fillings(site, &donor.holes))
            .collect();
        // Every donor with its most likely names, then with the next.
        let candidates = (0..MAX_COMBINATIONS).flat_map(|at| {
            let filled = fitting.iter().zip(&fillings);
            filled.filter_map(move |(&(cost, donor), fillings)| {
                Some(Candidate {
                    change: Change::Expression {
                        site,
                        term: donor.term.filled(fillings.get(at)?),
                    },
                    values: Values::Fixed,
                    cost: cost + (at / NAMES_PER_COST) as u32,
                    kind: EditKind::Expression,
                })
            })
        });
        all.extend(candidates.take(per_site));
    }
    all
}

/// Assignments of the reference after some statements, to variables that these use.
pub(crate) fn assignment_candidates(
    shader: &Shader,
    constants: &Constants,
    statements: &[usize],
) -> Vec<Candidate> {
    let writer = Writer::new(shader, constants);
    let mut all = Vec::new();
    for &at in statements {
        let statement = &shader.statements[at];
        let is_simple = matches!(statement.kind, Shape::Declaration(_) | Shape::Expression(_));
        if !is_simple || statement.at.is_none() || statement.is_expanded {
            continue;
        }
        let text = shader.text(statement.span);
        let declared = match statement.kind {
            Shape::Declaration(variable) => Some(Term::variable(shader.tree, variable)),
            _ => None,
        };
        for donor in &constants.assignments {
            let fillings = writer.fillings_in(at, text, declared.as_ref(), &donor.holes);
            let filled = fillings.iter().enumerate().filter(|(_, terms)| {
                let target = &terms[0];
                target.is_local(shader.tree) && text.contains(&target.text(shader.tree, shader.source, 0))
            });
            all.extend(filled.map(|(rank, terms)| Candidate {
                change: Change::Statements(vec![(at, Action::After(donor.term.filled(terms)))]),
                values: Values::Fixed,
                cost: ASSIGNMENT + (donor.size / PARTS_PER_COST + rank / NAMES_PER_COST) as u32,
                kind: EditKind::MissingStatement,
            }));
        }
        if all.len() > MAX_CANDIDATES {
            break;
        }
    }
    all
}

impl Writer<'_> {
    /// The ways to fill holes with values in scope, those that the site uses already first.
    fn fillings(&self, site: usize, holes: &[Type]) -> Vec<Vec<Term>> {
        let own = &self.shader.sites[site];
        let whole = Term::keep(self.tree, own.exprs[0]);
        self.fillings_in(own.statement, self.shader.text(own.span), Some(&whole), holes)
    }

    /// Conditions of the reference, as texts with names in scope at a statement, the smallest first.
    pub(super) fn conditions(&self, statement: usize) -> Vec<String> {
        let donors = self
            .constants
            .donors
            .iter()
            .filter(|donor| donor.term.ty == Type::BOOL);
        let mut donors: Vec<&Donor> = donors.collect();
        donors.sort_by_key(|donor| donor.size);
        let text = self.shader.text(self.shader.statements[statement].span);
        let texts = donors.into_iter().take(MAX_CONDITIONS).flat_map(|donor| {
            let fillings = self.fillings_in(statement, text, None, &donor.holes).into_iter();
            fillings
                .take(NAMES_PER_COST)
                .map(|terms| donor.term.filled(&terms))
        });
        texts
            .map(|term| term.text(self.tree, self.shader.source, 0))
            .collect()
    }

    /// The ways to fill holes with a value and those in scope at a statement, those in a text first.
    fn fillings_in(
        &self,
        statement: usize,
        text: &str,
        first: Option<&Term>,
        holes: &[Type],
    ) -> Vec<Vec<Term>> {
        let shader = self.shader;
        let of_type = |&ty: &Type| {
            let mut values = self.values(statement, ty);
            values.splice(0..0, first.filter(|first| first.ty == ty).cloned());
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
