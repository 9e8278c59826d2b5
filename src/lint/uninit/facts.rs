//! The facts known on one path through a function: ranges of scalars, and conditions that are true.
//!
//! `bool hit = false; … if (hit) use(n);`: no path reaches `use(n)` without the `hit = true` that stands
//! beside `n = …`.

use std::collections::HashMap;

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Input, Tree, UnaryOp, Value, VariableId, VariableKind,
};

use crate::program::{Program, Shape};

/// The maximum number of ranges, and of literals, that are stored.
const MAX_FACTS: usize = 32;
/// The maximum number of clauses (pairs of which at least one literal is true) that are stored.
const MAX_CLAUSES: usize = 4;

/// Identifies structurally equal expressions in [`Terms`].
pub(super) type Term = u32;

/// A proposition. Floats are assumed to be totally ordered, as they are except for NaN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Fact {
    Less(Term, Term),
    Equal(Term, Term),
    /// A condition that is not a comparison.
    Holds(Term),
    /// The last evaluation of an expression that has no [`Term`].
    LastEvaluation(ExprId),
}

/// A fact, and whether it is true.
pub(super) type Literal = (Fact, bool);

/// The current facts.
#[derive(Debug, Clone, Default)]
pub(super) struct Facts {
    ranges: Vec<(VariableId, Range)>,
    literals: Vec<Literal>,
    /// At least one literal of each pair is true.
    clauses: Vec<[Literal; 2]>,
}

/// Identifies equal sets of facts: variables with the bits of their ranges, literals, clauses.
pub(super) type Key = (Vec<(VariableId, u64, u64)>, Vec<Literal>, Vec<[Literal; 2]>);

impl Facts {
    pub(super) fn key(&self) -> Key {
        let mut ranges: Vec<_> = self
            .ranges
            .iter()
            .map(|(variable, range)| (*variable, range.min.to_bits(), range.max.to_bits()))
            .collect();
        ranges.sort_unstable();
        let (mut literals, mut clauses) = (self.literals.clone(), self.clauses.clone());
        literals.sort_unstable();
        clauses.sort_unstable();
        (ranges, literals, clauses)
    }

    pub(super) fn range(&self, variable: VariableId) -> Option<Range> {
        let mut ranges = self.ranges.iter();
        ranges
            .find(|(known, _)| *known == variable)
            .map(|(_, range)| *range)
    }

    pub(super) fn set_range(&mut self, variable: VariableId, range: Range) {
        self.forget_range(variable);
        if self.ranges.len() < MAX_FACTS {
            self.ranges.push((variable, range));
        }
    }

    /// Discards the variable's range.
    pub(super) fn forget_range(&mut self, variable: VariableId) {
        self.ranges.retain(|(known, _)| *known != variable);
    }

    /// Discards facts about evaluations in the previous iteration.
    pub(super) fn begin_iteration(&mut self) {
        let persists = |(fact, _): &Literal| !matches!(fact, Fact::LastEvaluation(_));
        self.literals.retain(persists);
        self.clauses.retain(|pair| pair.iter().all(persists));
    }

    /// Discards the variable's range, and the facts about terms that depend on it according to `depends`.
    pub(super) fn forget(&mut self, variable: VariableId, depends: impl Fn(Term) -> bool) {
        self.forget_range(variable);
        let depends_on_it = |(fact, _): &Literal| match *fact {
            Fact::Less(a, b) | Fact::Equal(a, b) => depends(a) || depends(b),
            Fact::Holds(a) => depends(a),
            Fact::LastEvaluation(_) => false,
        };
        self.literals.retain(|literal| !depends_on_it(literal));
        self.clauses.retain(|pair| !pair.iter().any(&depends_on_it));
    }

    /// Whether a fact is true, if that is stored or follows.
    pub(super) fn value_of(&self, fact: Fact) -> Option<bool> {
        match fact {
            Fact::Less(a, b) => self.less(a, b),
            _ => self.recorded(fact),
        }
    }

    /// Stores a literal and its consequences.
    pub(super) fn learn(&mut self, (fact, holds): Literal) {
        if self.literals.len() < MAX_FACTS && self.recorded(fact).is_none() {
            self.literals.push((fact, holds));
            self.deduce();
        }
    }

    /// Stores that at least one of two literals is true.
    pub(super) fn learn_clause(&mut self, pair: [Literal; 2]) {
        if self.clauses.len() < MAX_CLAUSES && !self.clauses.contains(&pair) {
            self.clauses.push(pair);
            self.deduce();
        }
    }

    fn recorded(&self, fact: Fact) -> Option<bool> {
        let mut literals = self.literals.iter();
        literals
            .find(|(known, _)| *known == fact)
            .map(|(_, holds)| *holds)
    }

    /// Whether `a < b`, from facts about the two, or about both and one other term.
    fn less(&self, a: Term, b: Term) -> Option<bool> {
        if let Some(holds) = self.recorded(Fact::Less(a, b)) {
            return Some(holds);
        }
        // They differ, and `b < a` is false.
        let differ = [Fact::Equal(a, b), Fact::Equal(b, a)].map(|equal| self.recorded(equal) == Some(false));
        if differ.contains(&true) && self.recorded(Fact::Less(b, a)) == Some(false) {
            return Some(true);
        }
        // (x, y, strictly): x < y if strictly, else x <= y.
        let order = || {
            self.literals
                .iter()
                .filter_map(|&(fact, holds)| match (fact, holds) {
                    (Fact::Less(x, y), true) => Some((x, y, true)),
                    (Fact::Less(x, y), false) => Some((y, x, false)),
                    _ => None,
                })
        };
        for (x, y, strictly) in order() {
            if x == a && order().any(|(from, to, also)| from == y && to == b && (strictly || also)) {
                return Some(true);
            }
            if (x, y) == (b, a) || x == b && order().any(|(from, to, _)| from == y && to == a) {
                return Some(false);
            }
        }
        None
    }

    /// Deduces a literal of a clause that must be true.
    fn deduce(&mut self) {
        let found = self.clauses.iter().find_map(|&[one, other]| {
            let of = |(fact, holds): Literal| self.value_of(fact).map(|value| value == holds);
            match (of(one), of(other)) {
                (Some(false), None) => return Some(other),
                (None, Some(false)) => return Some(one),
                (None, None) => {}
                _ => return None,
            }
            // `x < r` or `y < r`: the smaller of x and y is less than r. `x >= r` or `y >= r`: the larger is
            // not.
            let ((Fact::Less(x, r), holds), (Fact::Less(y, s), also)) = (one, other) else {
                return None;
            };
            let less = self.less(x, y).filter(|_| r == s && holds == also)?;
            Some(if less == holds { one } else { other })
        });
        if let Some(literal) = found.or_else(|| self.resolve()) {
            self.learn(literal);
        }
    }

    /// Resolution: from (a or b) and (a or not b) follows a.
    fn resolve(&self) -> Option<Literal> {
        let opposite = |(a, holds): Literal, (b, also): Literal| a == b && holds != also;
        let of_two = |one: &[Literal; 2], other: &[Literal; 2]| {
            (0..2).find_map(|i| {
                let both = |j: usize| one[i] == other[j] && opposite(one[1 - i], other[1 - j]);
                (both(0) || both(1)).then_some(one[i])
            })
        };
        let mut pairs = self.clauses.iter().enumerate();
        pairs
            .find_map(|(index, one)| self.clauses[..index].iter().find_map(|other| of_two(one, other)))
            .filter(|(fact, _)| self.recorded(*fact).is_none())
    }
}

// Ranges of scalars.

/// The maximum nesting depth at which ranges of expressions are computed.
const MAX_RANGE_DEPTH: u32 = 12;

/// The possible values of a scalar; a `bool` is 0 or 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub(super) min: f64,
    pub(super) max: f64,
}

impl Range {
    pub(super) const ANY: Self = Self {
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
    };
    pub(super) const NOT_NEGATIVE: Self = Self {
        min: 0.0,
        max: f64::INFINITY,
    };

    /// A single value.
    pub(super) fn exactly(value: f64) -> Self {
        Self {
            min: value,
            max: value,
        }
    }

    /// The range of a literal or constant.
    pub(super) fn of(value: Value) -> Self {
        Self::exactly(match value {
            Value::Bool(value) => f64::from(u8::from(value)),
            Value::Int(value) => f64::from(value),
            Value::Uint(value) => f64::from(value),
            Value::Float(value) => value,
        })
    }

    /// The result of a comparison, if it is the same for all pairs of values.
    pub(super) fn compare(self, op: BinaryOp, other: Self) -> Option<bool> {
        let less = |a: Self, b: Self| {
            if a.max < b.min {
                Some(true)
            } else if a.min >= b.max {
                Some(false)
            } else {
                None
            }
        };
        let equal = || {
            if self.min == self.max && self == other {
                Some(true)
            } else if self.max < other.min || other.max < self.min {
                Some(false)
            } else {
                None
            }
        };
        match op {
            BinaryOp::Less => less(self, other),
            BinaryOp::Greater => less(other, self),
            BinaryOp::LessEqual => less(other, self).map(|less| !less),
            BinaryOp::GreaterEqual => less(self, other).map(|less| !less),
            BinaryOp::Equal => equal(),
            BinaryOp::NotEqual => equal().map(|equal| !equal),
            _ => None,
        }
    }

    /// The range that remains if `op bound` is true (`holds`), or false; `None` if that gives no information.
    /// For integers (`whole`), a strict bound is tightened by 1.
    pub(super) fn narrowed(self, op: BinaryOp, holds: bool, bound: Self, whole: bool) -> Option<Self> {
        let gap = if whole { 1.0 } else { 0.0 };
        let mut range = self;
        match (op, holds) {
            (BinaryOp::Less, true) | (BinaryOp::GreaterEqual, false) => {
                range.max = range.max.min(bound.max - gap);
            }
            (BinaryOp::LessEqual, true) | (BinaryOp::Greater, false) => {
                range.max = range.max.min(bound.max);
            }
            (BinaryOp::Greater, true) | (BinaryOp::LessEqual, false) => {
                range.min = range.min.max(bound.min + gap);
            }
            (BinaryOp::GreaterEqual, true) | (BinaryOp::Less, false) => {
                range.min = range.min.max(bound.min);
            }
            (BinaryOp::Equal, true) | (BinaryOp::NotEqual, false) => range = bound,
            _ => return None,
        }
        Some(range)
    }
}

/// The range of an expression's values, if known.
pub(super) fn range(program: &Program, known: &Facts, expr: ExprId, depth: u32) -> Option<Range> {
    let tree = program.tree;
    if depth > MAX_RANGE_DEPTH {
        return None;
    }
    let of = |expr: ExprId| range(program, known, expr, depth + 1);
    match &tree[expr].kind {
        ExprKind::Literal(literal) => Some(Range::of(literal.value)),
        ExprKind::Variable(variable) => known.range(*variable).or_else(|| match tree[*variable].kind {
            VariableKind::Input(Input::Frame | Input::Time | Input::TimeDelta) => Some(Range::NOT_NEGATIVE),
            _ => match *program.constant(expr)?.components() {
                [value] => Some(Range::of(value)),
                _ => None,
            },
        }),
        ExprKind::Unary {
            op: UnaryOp::Minus,
            operand,
        } => {
            let Range { min, max } = of(*operand)?;
            Some(Range { min: -max, max: -min })
        }
        &ExprKind::Binary {
            op: op @ (BinaryOp::Add | BinaryOp::Subtract),
            left,
            right,
        } => {
            let (a, b) = (of(left)?, of(right)?);
            Some(if op == BinaryOp::Add {
                Range {
                    min: a.min + b.min,
                    max: a.max + b.max,
                }
            } else {
                Range {
                    min: a.min - b.max,
                    max: a.max - b.min,
                }
            })
        }
        ExprKind::Construct {
            constructor: Constructor::Scalar,
            arguments,
        } => {
            let range = of(arguments[0])?;
            let whole = range.min.fract() == 0.0 && range.max.fract() == 0.0;
            whole.then_some(range)
        }
        ExprKind::BuiltIn { function, arguments } => match (function, &arguments[..]) {
            (BuiltIn::Min | BuiltIn::Max, &[a, b]) => {
                let (a, b) = (of(a), of(b));
                a.or(b)?;
                let (a, b) = (a.unwrap_or(Range::ANY), b.unwrap_or(Range::ANY));
                Some(if *function == BuiltIn::Min {
                    Range {
                        min: a.min.min(b.min),
                        max: a.max.min(b.max),
                    }
                } else {
                    Range {
                        min: a.min.max(b.min),
                        max: a.max.max(b.max),
                    }
                })
            }
            (BuiltIn::Abs | BuiltIn::Length | BuiltIn::Distance | BuiltIn::Sqrt | BuiltIn::Exp, _) => {
                Some(Range::NOT_NEGATIVE)
            }
            _ => None,
        },
        _ => None,
    }
}

// Terms: names of expressions, equal for structurally equal ones.

/// The named expressions of a function.
#[derive(Default)]
pub(super) struct Terms {
    /// The expressions queried so far; `None` for those without a shape.
    named: HashMap<ExprId, Option<Term>>,
    shapes: HashMap<Shape, Term>,
    /// By term: the variables that its value depends on.
    depends: Vec<Vec<VariableId>>,
}

impl Terms {
    /// The term of an expression; `None` if it has side effects or is too large.
    pub(super) fn of(&mut self, tree: &Tree, expr: ExprId) -> Option<Term> {
        if let Some(term) = self.named.get(&expr) {
            return *term;
        }
        let term = Shape::of(tree, expr).map(|shape| self.of_shape(shape));
        self.named.insert(expr, term);
        term
    }

    /// The term of a variable.
    pub(super) fn of_variable(&mut self, variable: VariableId) -> Term {
        self.of_shape(Shape::of_variable(variable))
    }

    /// Whether a term's value depends on a variable.
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
