//! Evaluates conditions from the facts known on a path.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind, Type, UnaryOp, VariableId};

use super::facts::{Fact, Facts, Literal, Range, Terms, range};
use crate::program::Program;

/// The maximum nesting depth at which conditions are evaluated.
const MAX_DEPTH: u32 = 12;
/// The maximum nesting depth of `min` and `max` calls.
const MAX_MIN_MAX_DEPTH: u32 = 3;

/// Evaluates conditions, and names the expressions that they compare.
pub(super) struct Conditions<'a> {
    program: &'a Program<'a>,
    terms: Terms,
}

/// `min(a, b)` or `max(a, b)`.
struct Extreme {
    is_min: bool,
    operands: [ExprId; 2],
}

impl<'a> Conditions<'a> {
    pub(super) fn new(program: &'a Program<'a>) -> Self {
        Self {
            program,
            terms: Terms::default(),
        }
    }

    /// Whether a condition is true, if that is known.
    pub(super) fn holds(&mut self, known: &Facts, condition: ExprId) -> Option<bool> {
        self.evaluate(known, condition, 0)
    }

    /// Records that a variable, or the part of it that `target` names, is set to a value.
    pub(super) fn set(
        &mut self,
        known: &mut Facts,
        variable: VariableId,
        target: Option<ExprId>,
        value: ExprId,
    ) {
        let tree = self.program.tree;
        let range = range(self.program, known, value, 0);
        self.forget(known, variable);
        let part = target.filter(|&target| !matches!(tree[target].kind, ExprKind::Variable(_)));
        if let (None, Some(range)) = (part, range) {
            known.set_range(variable, range);
            if tree[variable].ty == Type::BOOL {
                let fact = Fact::Holds(self.terms.of_variable(variable));
                known.learn((fact, range.min != 0.0));
            }
        }
        // A copy: neither is less than the other.
        if matches!(tree[value].ty, Type::FLOAT | Type::INT)
            && matches!(
                tree[value].kind,
                ExprKind::Variable(_) | ExprKind::Swizzle { .. } | ExprKind::Member { .. }
            )
            && let Some(one) = match target {
                Some(target) => self.terms.of(self.program.tree, target),
                None => Some(self.terms.of_variable(variable)),
            }
            && let Some(other) = self.terms.of(self.program.tree, value)
            && !self.terms.depends(other, variable)
        {
            known.learn((Fact::Less(one, other), false));
            known.learn((Fact::Less(other, one), false));
        }
    }

    /// Records that a scalar variable is declared, with the value zero.
    pub(super) fn begin(&self, known: &mut Facts, variable: VariableId) {
        self.forget(known, variable);
        known.set_range(variable, Range::exactly(0.0));
    }

    /// Discards all facts about a variable.
    pub(super) fn forget(&self, known: &mut Facts, variable: VariableId) {
        known.forget(variable, |term| self.terms.depends(term, variable));
    }

    /// Assumes that a condition is true, or false.
    pub(super) fn assume(&mut self, known: &mut Facts, condition: ExprId, holds: bool) {
        let mut pending = vec![(condition, holds)];
        for _ in 0..MAX_DEPTH {
            let Some((condition, holds)) = pending.pop() else {
                return;
            };
            match &self.program.tree[condition].kind {
                ExprKind::Unary {
                    op: UnaryOp::Not,
                    operand,
                } => pending.push((*operand, !holds)),
                &ExprKind::Binary {
                    op: op @ (BinaryOp::And | BinaryOp::Or),
                    left,
                    right,
                } => {
                    let decides = op == BinaryOp::Or;
                    if holds != decides {
                        pending.extend([(left, holds), (right, holds)]);
                    } else if self.evaluate(known, left, 0) == Some(!decides) {
                        pending.push((right, holds));
                    } else if self.evaluate(known, right, 0) == Some(!decides) {
                        pending.push((left, holds));
                    } else {
                        known.learn_clause([self.literal(left, holds), self.literal(right, holds)]);
                    }
                }
                _ => self.assume_atom(known, condition, holds),
            }
        }
    }

    fn evaluate(&mut self, known: &Facts, condition: ExprId, depth: u32) -> Option<bool> {
        if depth > MAX_DEPTH {
            return None;
        }
        match &self.program.tree[condition].kind {
            ExprKind::Unary {
                op: UnaryOp::Not,
                operand,
            } => {
                return self.evaluate(known, *operand, depth + 1).map(|holds| !holds);
            }
            &ExprKind::Binary {
                op: op @ (BinaryOp::And | BinaryOp::Or),
                left,
                right,
            } => {
                let left = self.evaluate(known, left, depth + 1);
                return combine(left, self.evaluate(known, right, depth + 1), op == BinaryOp::Or);
            }
            &ExprKind::Binary { op, left, right } => {
                if let (Some(a), Some(b)) = (
                    range(self.program, known, left, depth),
                    range(self.program, known, right, depth),
                ) && let Some(value) = a.compare(op, b)
                {
                    return Some(value);
                }
                if let Some((left, right, same)) = as_less(op, left, right)
                    && let Some(holds) = self.less(known, left, right, 0)
                {
                    return Some(holds == same);
                }
            }
            _ => {
                if let Some(range) = range(self.program, known, condition, depth)
                    && range.min == range.max
                {
                    return Some(range.min != 0.0);
                }
            }
        }
        let (fact, same) = self.fact(condition);
        known.value_of(fact).map(|holds| holds == same)
    }

    /// Whether the left expression is less than the right one, if that is known.
    fn less(&mut self, known: &Facts, left: ExprId, right: ExprId, depth: u32) -> Option<bool> {
        if let (Some(one), Some(other)) = (
            self.terms.of(self.program.tree, left),
            self.terms.of(self.program.tree, right),
        ) && let Some(value) = known.value_of(Fact::Less(one, other))
        {
            return Some(value);
        }
        if depth > MAX_MIN_MAX_DEPTH {
            return None;
        }
        if let Some(of) = self.magnitude(left) {
            return self.less(known, of, right, depth + 1).filter(|less| !less);
        }
        let (operands, decides) = if let Some(extreme) = self.extreme(left) {
            let [one, other] = extreme.operands;
            ([(one, right), (other, right)], extreme.is_min)
        } else {
            let extreme = self.extreme(right)?;
            let [one, other] = extreme.operands;
            ([(left, one), (left, other)], !extreme.is_min)
        };
        let [one, other] = operands.map(|(left, right)| self.less(known, left, right, depth + 1));
        combine(one, other, decides)
    }

    fn assume_atom(&mut self, known: &mut Facts, condition: ExprId, holds: bool) {
        let tree = self.program.tree;
        match &tree[condition].kind {
            ExprKind::Variable(variable) => {
                known.set_range(*variable, Range::exactly(f64::from(u8::from(holds))));
            }
            &ExprKind::Binary { op, left, right } => {
                let (of_left, of_right) = (
                    range(self.program, known, left, 0),
                    range(self.program, known, right, 0),
                );
                let mut narrow = |expr: ExprId, range: Option<Range>, op, bound: Option<Range>| {
                    if let (&ExprKind::Variable(variable), Some(bound)) = (&tree[expr].kind, bound) {
                        let whole = matches!(tree[variable].ty, Type::INT | Type::UINT);
                        let range = range.unwrap_or(Range::ANY);
                        if let Some(range) = range.narrowed(op, holds, bound, whole) {
                            known.set_range(variable, range);
                        }
                    }
                };
                narrow(left, of_left, op, of_right);
                narrow(right, of_right, op.mirrored(), of_left);
                if let Some((left, right, same)) = as_less(op, left, right) {
                    self.assume_less(known, left, right, holds == same, 0);
                }
            }
            _ => {}
        }
        let (fact, same) = self.fact(condition);
        known.learn((fact, holds == same));
    }

    fn assume_less(&mut self, known: &mut Facts, left: ExprId, right: ExprId, holds: bool, depth: u32) {
        if let (Some(one), Some(other)) = (
            self.terms.of(self.program.tree, left),
            self.terms.of(self.program.tree, right),
        ) {
            known.learn((Fact::Less(one, other), holds));
        }
        if depth > MAX_MIN_MAX_DEPTH {
            return;
        }
        let (sides, decides) = if let Some(extreme) = self.extreme(left) {
            (extreme.operands.map(|operand| (operand, right)), extreme.is_min)
        } else if let Some(extreme) = self.extreme(right) {
            (extreme.operands.map(|operand| (left, operand)), !extreme.is_min)
        } else {
            return;
        };
        if holds != decides {
            for (left, right) in sides {
                self.assume_less(known, left, right, holds, depth + 1);
            }
            return;
        }
        let facts = sides.map(|(left, right)| {
            Some(Fact::Less(
                self.terms.of(self.program.tree, left)?,
                self.terms.of(self.program.tree, right)?,
            ))
        });
        if let [Some(one), Some(other)] = facts {
            known.learn_clause([(one, holds), (other, holds)]);
        }
    }

    fn extreme(&self, expr: ExprId) -> Option<Extreme> {
        match &self.program.tree[expr].kind {
            ExprKind::BuiltIn {
                function: function @ (BuiltIn::Min | BuiltIn::Max),
                arguments,
            } => Some(Extreme {
                is_min: *function == BuiltIn::Min,
                operands: [arguments[0], arguments[1]],
            }),
            _ => None,
        }
    }

    /// The argument of an `abs` call, which never exceeds the result.
    fn magnitude(&self, expr: ExprId) -> Option<ExprId> {
        match &self.program.tree[expr].kind {
            ExprKind::BuiltIn {
                function: BuiltIn::Abs,
                arguments,
            } => Some(arguments[0]),
            _ => None,
        }
    }

    /// The literal that states that a condition is true, or false.
    fn literal(&mut self, mut condition: ExprId, mut holds: bool) -> Literal {
        while let ExprKind::Unary {
            op: UnaryOp::Not,
            operand,
        } = self.program.tree[condition].kind
        {
            (condition, holds) = (operand, !holds);
        }
        let (fact, same) = self.fact(condition);
        (fact, holds == same)
    }

    /// The fact that a condition tests, and whether the condition is the fact or its negation.
    fn fact(&mut self, condition: ExprId) -> (Fact, bool) {
        if let &ExprKind::Binary { op, left, right } = &self.program.tree[condition].kind
            && let (Some(one), Some(other)) = (
                self.terms.of(self.program.tree, left),
                self.terms.of(self.program.tree, right),
            )
        {
            if let Some((first, _, same)) = as_less(op, left, right) {
                let (one, other) = if first == left { (one, other) } else { (other, one) };
                return (Fact::Less(one, other), same);
            }
            if matches!(op, BinaryOp::Equal | BinaryOp::NotEqual) {
                return (Fact::Equal(one, other), op == BinaryOp::Equal);
            }
        }
        let fact = self
            .terms
            .of(self.program.tree, condition)
            .map_or(Fact::LastEvaluation(condition), Fact::Holds);
        (fact, true)
    }
}

/// Normalizes a comparison to `left < right` or its negation: `a > b` is `b < a`, and `a <= b` is not `b <
/// a`.
fn as_less(op: BinaryOp, left: ExprId, right: ExprId) -> Option<(ExprId, ExprId, bool)> {
    match op {
        BinaryOp::Less => Some((left, right, true)),
        BinaryOp::Greater => Some((right, left, true)),
        BinaryOp::LessEqual => Some((right, left, false)),
        BinaryOp::GreaterEqual => Some((left, right, false)),
        _ => None,
    }
}

/// Combines two operands of an operator for which the value `decides` of either operand determines the
/// result.
fn combine(one: Option<bool>, other: Option<bool>, decides: bool) -> Option<bool> {
    match (one, other) {
        (Some(side), _) | (_, Some(side)) if side == decides => Some(decides),
        (Some(_), Some(_)) => Some(!decides),
        _ => None,
    }
}
