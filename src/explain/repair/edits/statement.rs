//! Edits of statements: deleted, moved, repeated and inserted ones, and other targets and operators of
//! assignments.

use toyproof_glsl::tree::{
    BinaryOp, Direction, ExprId, ExprKind, Scalar, Type, UnaryOp, VariableId, VariableKind, walk,
};

use super::super::edit::{Action, Candidate, Change, EditKind};
use super::super::shader::Shape;
use super::super::term::{Op, Term, TermKind, binary_type};
use super::writer::{At, Writer};
use crate::engine::tournament::Values;

/// The costs: another operator of an assignment, another target, another value, deletions, moves,
/// repetitions, copies to another place, and insertions of assignments of values, and of others.
const OPERATOR: u32 = 11;
const TARGET: u32 = 16;
const VALUE: u32 = 20;
const DELETION: u32 = 17;
const MOVE: u32 = 20;
const REPETITION: u32 = 21;
const COPY: u32 = 25;
const ASSIGNMENT: u32 = 24;
const COMPOUND: u32 = 27;

/// The gain of an assignment to a variable that nothing assigns, though it is no constant.
const UNASSIGNED: u32 = 10;

/// The additional cost of an operator with which a variable that has no value is read.
const UNSET: u32 = 10;

/// The largest number of variables and members that are assigned.
const MAX_TARGETS: usize = 24;

impl Writer<'_> {
    pub(super) fn statement(&mut self, at: usize) {
        let statement = &self.shader.statements[at];
        if statement.at.is_none() || statement.is_expanded {
            return;
        }
        if matches!(
            statement.kind,
            Shape::Expression(_) | Shape::If { .. } | Shape::Jump | Shape::Return
        ) {
            self.change(
                EditKind::SuperfluousStatement,
                DELETION,
                vec![(at, Action::Delete)],
            );
        }
        if let Some(next) = statement.next {
            let is_declaration = |at: usize| matches!(self.shader.statements[at].kind, Shape::Declaration(_));
            let is_jump = |at: usize| matches!(self.shader.statements[at].kind, Shape::Jump | Shape::Return);
            if !is_jump(next) {
                let actions = if !is_declaration(next) {
                    Some(vec![(at, Action::CopyBefore(next)), (next, Action::Delete)])
                } else if !is_declaration(at) {
                    Some(vec![(next, Action::CopyAfter(at)), (at, Action::Delete)])
                } else {
                    None
                };
                if let Some(actions) = actions {
                    self.change(EditKind::MisplacedStatement, MOVE, actions);
                }
            }
        }
        if matches!(statement.kind, Shape::Expression(_) | Shape::Declaration(_)) {
            self.copies(at);
            self.assignments(at);
        }
        self.transformations(at);
    }

    /// Repeats a statement, and copies after it others of its function whose variables are in scope there.
    fn copies(&mut self, at: usize) {
        let tree = self.tree;
        let statements = &self.shader.statements;
        let own = &statements[at];
        let function = own.at.map(|id| id.function);
        let declared = match own.kind {
            Shape::Declaration(variable) => Some(variable),
            _ => None,
        };
        let is_in_scope = |id: VariableId| own.scope.contains(&id) || declared == Some(id);
        for (other, statement) in statements.iter().enumerate() {
            let Shape::Expression(expr) = statement.kind else {
                continue;
            };
            let uses_others = |kind: &ExprKind| matches!(*kind, ExprKind::Variable(id) if !is_in_scope(id));
            if statement.at.map(|id| id.function) != function
                || statement.is_expanded
                || !walk::has_side_effects(tree, expr)
                || walk::any(tree, expr, uses_others)
            {
                continue;
            }
            let cost = if other == at { REPETITION } else { COPY };
            self.change(
                EditKind::MissingStatement,
                cost,
                vec![(at, Action::CopyAfter(other))],
            );
        }
    }

    fn change(&mut self, kind: EditKind, cost: u32, actions: Vec<(usize, Action)>) {
        self.all.push(Candidate {
            change: Change::Statements(actions),
            values: Values::Fixed,
            cost,
            kind,
        });
    }

    /// Inserts an assignment of one variable to another behind a statement.
    fn assignments(&mut self, at: usize) {
        let tree = self.tree;
        let statement = &self.shader.statements[at];
        let declared = match statement.kind {
            Shape::Declaration(variable) => Some(variable),
            _ => None,
        };
        let is_target = |kind| {
            matches!(
                kind,
                VariableKind::Local
                    | VariableKind::Global
                    | VariableKind::Parameter(Direction::Out | Direction::InOut | Direction::In)
            )
        };
        let is_value = |ty: Type| {
            matches!(
                ty,
                Type::Scalar(_) | Type::Vector(Scalar::Float, _) | Type::Struct(_)
            )
        };
        let targets = statement
            .scope
            .iter()
            .rev()
            .filter(|&&id| is_target(tree[id].kind));
        let targets: Vec<Term> = targets
            .flat_map(|&id| self.assignable(id))
            .take(MAX_TARGETS)
            .collect();
        for target in targets {
            let ty = target.ty;
            if !is_value(ty) {
                continue;
            }
            if matches!(ty, Type::Scalar(Scalar::Float) | Type::Vector(Scalar::Float, _)) {
                let negated = Term::unary(UnaryOp::Minus, target.clone());
                self.insert(at, None, &target, negated, ASSIGNMENT);
            }
            if ty == Type::FLOAT && matches!(target.kind, TermKind::Apply(Op::Member(_), _)) {
                for number in [0.0, 1.0] {
                    self.insert(at, None, &target, Term::float(number), COMPOUND);
                }
            }
            let mut values = self.values(at, ty);
            values.extend(
                declared
                    .filter(|&id| tree[id].ty == ty)
                    .map(|id| Term::variable(tree, id)),
            );
            for value in values {
                if value == target {
                    continue;
                }
                for op in [BinaryOp::Multiply, BinaryOp::Add] {
                    if binary_type(op, ty, value.ty) == Some(ty) {
                        self.insert(at, Some(op), &target, value.clone(), COMPOUND);
                    }
                }
                self.insert(at, None, &target, value, ASSIGNMENT);
            }
        }
    }

    /// Inserts an assignment behind a statement.
    fn insert(&mut self, at: usize, op: Option<BinaryOp>, target: &Term, value: Term, cost: u32) {
        let is_unassigned = match target.kind {
            TermKind::Variable(id) => {
                self.tree[id].kind == VariableKind::Local && !self.written.contains(&id)
            }
            _ => false,
        };
        let cost = if is_unassigned { cost - UNASSIGNED } else { cost };
        let assignment = Action::After(Term::assign(op, target.clone(), value));
        self.change(EditKind::MissingStatement, cost, vec![(at, assignment)]);
    }

    /// A variable and its members.
    fn assignable(&self, variable: VariableId) -> Vec<Term> {
        let whole = Term::variable(self.tree, variable);
        let mut all = vec![whole.clone()];
        if let Type::Struct(id) = whole.ty {
            let members = self.tree[id].members.iter().enumerate();
            all.extend(members.map(|(at, member)| Term::member(whole.clone(), at, member.ty)));
        }
        all
    }

    /// Edits of an assignment itself.
    pub(super) fn assignment(&mut self, at: At, op: Option<BinaryOp>, target: ExprId, value: ExprId) {
        use BinaryOp::{Add, Divide, Multiply, Subtract};
        let (tree, source) = (self.tree, self.shader.source);
        let [own_target, own_value] = [target, value].map(|expr| self.keep(expr));
        for other in [None, Some(Add), Some(Multiply), Some(Subtract), Some(Divide)] {
            let fits = match other {
                None => own_value.ty == at.ty,
                Some(op) => binary_type(op, at.ty, own_value.ty) == Some(at.ty),
            };
            if other != op && fits {
                let cost = if op.is_none() && self.is_unset(target) {
                    OPERATOR + UNSET
                } else {
                    OPERATOR
                };
                let term = Term::assign(other, own_target.clone(), own_value.clone());
                self.replace(at, EditKind::Operator, cost, term);
            }
        }
        // A value of another type, such as a color in place of a number.
        if op.is_some() && own_value.ty != at.ty {
            for other in self.values(at.statement, at.ty) {
                self.replace(
                    at,
                    EditKind::Variable,
                    VALUE,
                    Term::assign(op, own_target.clone(), other),
                );
            }
        }
        let old = self.shader.text(tree[target].at.span);
        let is_variable = |term: &Term| match &term.kind {
            TermKind::Variable(id) => {
                matches!(tree[*id].kind, VariableKind::Local | VariableKind::Parameter(_))
            }
            TermKind::Apply(Op::Member(_), operands) => matches!(operands[0].kind, TermKind::Variable(_)),
            _ => false,
        };
        for other in self.values(at.statement, own_target.ty) {
            if is_variable(&other) && other.text(tree, source, 0) != old {
                self.replace(
                    at,
                    EditKind::Variable,
                    TARGET,
                    Term::assign(op, other, own_value.clone()),
                );
            }
        }
    }

    /// Whether the target of an assignment has no value unless another assignment ran before.
    fn is_unset(&self, target: ExprId) -> bool {
        let ExprKind::Variable(id) = self.tree[target].kind else {
            return false;
        };
        let own = &self.tree[id];
        let has_value = own.initializer.is_some()
            || matches!(
                own.kind,
                VariableKind::Parameter(Direction::In | Direction::InOut)
            );
        !has_value
    }
}
