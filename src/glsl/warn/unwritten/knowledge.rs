//! What is known on one way through a function: ranges of scalars, and conditions that held.
//!
//! `bool hit = false; … if (hit) use(n);` is no way to `use(n)` past the `hit = true` that stands beside `n = …`.

use std::collections::HashMap;

use super::super::super::tree::{
    BinaryOp, BuiltIn, Constructor, ExprId, ExprKind, Input, Tree, UnaryOp, Value, VariableId, VariableKind,
};
use super::super::program::Program;
use super::super::shape::Shape;

/// How many things are kept in mind at once.
const MAX_KNOWN: usize = 24;
/// How deep a condition is looked into.
const MAX_DEPTH: u32 = 12;

/// The values that a scalar may have; `bool`s are 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Range {
    least: f64,
    most: f64,
}

/// What is known now.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Known {
    ranges: Vec<(VariableId, Range)>,
    /// Conditions by their number, with their answers.
    facts: Vec<(u32, bool)>,
}

/// Numbers conditions that are written alike.
pub(super) struct Conditions<'a> {
    program: &'a Program<'a>,
    numbers: HashMap<ExprId, Option<(u32, bool)>>,
    shapes: HashMap<(bool, Shape, Option<Shape>), u32>,
    /// By number: whose values the condition depends on.
    depends: Vec<Vec<VariableId>>,
}

impl Known {
    /// What would make equal states equal.
    pub(super) fn key(&self) -> Vec<(usize, u64, u64)> {
        let mut key: Vec<_> = self
            .ranges
            .iter()
            .map(|(variable, range)| (variable.index(), range.least.to_bits(), range.most.to_bits()))
            .chain(
                self.facts
                    .iter()
                    .map(|&(number, holds)| (usize::MAX, u64::from(number), u64::from(holds))),
            )
            .collect();
        key.sort_unstable();
        key
    }

    /// A variable is given a value.
    pub(super) fn set(&mut self, conditions: &Conditions, variable: VariableId, value: ExprId) {
        let range = conditions.range(self, value, 0);
        self.forget(conditions, variable);
        if let Some(range) = range {
            self.note(variable, range);
        }
    }

    /// A variable begins with zero.
    pub(super) fn begin(&mut self, conditions: &Conditions, variable: VariableId) {
        self.forget(conditions, variable);
        self.note(
            variable,
            Range {
                least: 0.0,
                most: 0.0,
            },
        );
    }

    /// A variable may be anything now.
    pub(super) fn forget(&mut self, conditions: &Conditions, variable: VariableId) {
        self.ranges.retain(|(known, _)| *known != variable);
        self.facts
            .retain(|(number, _)| !conditions.depends[*number as usize].contains(&variable));
    }

    /// A variable may be anything now, unless it is what it was then.
    pub(super) fn forget_unless(
        &mut self,
        conditions: &Conditions,
        variable: VariableId,
        then: Option<&Self>,
    ) {
        let own = |known: &Self| known.ranges.iter().find(|(known, _)| *known == variable).copied();
        let now = own(self);
        self.forget(conditions, variable);
        if now.is_some() && then.and_then(own) == now {
            self.ranges.extend(now);
        }
    }

    /// Globals may be anything now.
    pub(super) fn forget_globals(&mut self, tree: &Tree) {
        self.ranges
            .retain(|(known, _)| tree[*known].kind != VariableKind::Global);
        self.facts.clear();
    }

    fn note(&mut self, variable: VariableId, range: Range) {
        self.ranges.retain(|(known, _)| *known != variable);
        if self.ranges.len() < MAX_KNOWN {
            self.ranges.push((variable, range));
        }
    }
}

impl<'a> Conditions<'a> {
    pub(super) fn new(program: &'a Program<'a>) -> Self {
        Self {
            program,
            numbers: HashMap::new(),
            shapes: HashMap::new(),
            depends: Vec::new(),
        }
    }

    /// Whether a condition holds, where that is known.
    pub(super) fn holds(&mut self, known: &Known, condition: ExprId) -> Option<bool> {
        self.answer(known, condition, 0)
    }

    fn answer(&mut self, known: &Known, condition: ExprId, depth: u32) -> Option<bool> {
        if depth > MAX_DEPTH {
            return None;
        }
        match &self.program.tree[condition].kind {
            ExprKind::Unary {
                op: UnaryOp::Not,
                operand,
            } => {
                return self.answer(known, *operand, depth + 1).map(|holds| !holds);
            }
            &ExprKind::Binary {
                op: op @ (BinaryOp::And | BinaryOp::Or),
                left,
                right,
            } => {
                let decides = op == BinaryOp::Or;
                let sides = (
                    self.answer(known, left, depth + 1),
                    self.answer(known, right, depth + 1),
                );
                return match sides {
                    (Some(side), _) | (_, Some(side)) if side == decides => Some(decides),
                    (Some(_), Some(_)) => Some(!decides),
                    _ => None,
                };
            }
            &ExprKind::Binary { op, left, right } => {
                if let (Some(a), Some(b)) = (self.range(known, left, depth), self.range(known, right, depth))
                    && let Some(answer) = compare(op, a, b)
                {
                    return Some(answer);
                }
            }
            _ => {
                if let Some(range) = self.range(known, condition, depth)
                    && range.least == range.most
                {
                    return Some(range.least != 0.0);
                }
            }
        }
        let (number, same) = self.number(condition)?;
        let (_, holds) = known.facts.iter().find(|(fact, _)| *fact == number)?;
        Some(*holds == same)
    }

    /// Takes for known that a condition holds, or does not.
    pub(super) fn assume(&mut self, known: &mut Known, condition: ExprId, holds: bool) {
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
                    } else if self.answer(known, left, 0) == Some(!decides) {
                        pending.push((right, holds));
                    } else if self.answer(known, right, 0) == Some(!decides) {
                        pending.push((left, holds));
                    }
                }
                _ => self.assume_one(known, condition, holds),
            }
        }
    }

    fn assume_one(&mut self, known: &mut Known, condition: ExprId, holds: bool) {
        let tree = self.program.tree;
        match &tree[condition].kind {
            ExprKind::Variable(variable) => {
                let value = f64::from(u8::from(holds));
                known.note(
                    *variable,
                    Range {
                        least: value,
                        most: value,
                    },
                );
                return;
            }
            &ExprKind::Binary { op, left, right } => {
                let sides = (self.range(known, left, 0), self.range(known, right, 0));
                if let (&ExprKind::Variable(variable), Some(bound)) = (&tree[left].kind, sides.1) {
                    narrow(tree, known, variable, sides.0, (op, holds), bound);
                }
                if let (&ExprKind::Variable(variable), Some(bound)) = (&tree[right].kind, sides.0) {
                    narrow(tree, known, variable, sides.1, (mirrored(op), holds), bound);
                }
            }
            _ => {}
        }
        if let Some((number, same)) = self.number(condition)
            && known.facts.len() < MAX_KNOWN
            && known.facts.iter().all(|(fact, _)| *fact != number)
        {
            known.facts.push((number, holds == same));
        }
    }

    /// The number of a condition, and whether it is that condition or its opposite.
    fn number(&mut self, condition: ExprId) -> Option<(u32, bool)> {
        if let Some(number) = self.numbers.get(&condition) {
            return *number;
        }
        let number = self.new_number(condition);
        self.numbers.insert(condition, number);
        number
    }

    fn new_number(&mut self, condition: ExprId) -> Option<(u32, bool)> {
        let tree = self.program.tree;
        let shape = |expr| Shape::of(tree, expr);
        let (key, same) = match &tree[condition].kind {
            // `a > b` is `b < a`, and `a <= b` is not `b < a`, but for NaN.
            &ExprKind::Binary { op, left, right } => match op {
                BinaryOp::Less => ((true, shape(left)?, shape(right)), true),
                BinaryOp::Greater => ((true, shape(right)?, shape(left)), true),
                BinaryOp::LessEqual => ((true, shape(right)?, shape(left)), false),
                BinaryOp::GreaterEqual => ((true, shape(left)?, shape(right)), false),
                BinaryOp::Equal => ((false, shape(left)?, shape(right)), true),
                BinaryOp::NotEqual => ((false, shape(left)?, shape(right)), false),
                _ => ((false, shape(condition)?, None), true),
            },
            _ => ((false, shape(condition)?, None), true),
        };
        let next = self.depends.len() as u32;
        let variables = key
            .1
            .variables
            .iter()
            .chain(key.2.iter().flat_map(|shape| &shape.variables));
        let variables = variables.copied().collect();
        let number = *self.shapes.entry(key).or_insert(next);
        if number == next {
            self.depends.push(variables);
        }
        Some((number, same))
    }

    fn range(&self, known: &Known, expr: ExprId, depth: u32) -> Option<Range> {
        let tree = self.program.tree;
        if depth > MAX_DEPTH {
            return None;
        }
        let of = |expr: ExprId| self.range(known, expr, depth + 1);
        let not_negative = Range {
            least: 0.0,
            most: f64::INFINITY,
        };
        match &tree[expr].kind {
            ExprKind::Literal(literal) => Some(exactly(literal.value)),
            ExprKind::Variable(variable) => {
                if let Some((_, range)) = known.ranges.iter().find(|(known, _)| known == variable) {
                    return Some(*range);
                }
                match tree[*variable].kind {
                    VariableKind::Input(Input::Frame | Input::Time | Input::TimeDelta) => Some(not_negative),
                    _ => match self.program.constant(expr)?.scalars[..] {
                        [value] => Some(exactly(value)),
                        _ => None,
                    },
                }
            }
            ExprKind::Unary {
                op: UnaryOp::Minus,
                operand,
            } => {
                let Range { least, most } = of(*operand)?;
                Some(Range {
                    least: -most,
                    most: -least,
                })
            }
            ExprKind::Binary {
                op: BinaryOp::Add,
                left,
                right,
            } => {
                let (a, b) = (of(*left)?, of(*right)?);
                Some(Range {
                    least: a.least + b.least,
                    most: a.most + b.most,
                })
            }
            ExprKind::Binary {
                op: BinaryOp::Subtract,
                left,
                right,
            } => {
                let (a, b) = (of(*left)?, of(*right)?);
                Some(Range {
                    least: a.least - b.most,
                    most: a.most - b.least,
                })
            }
            ExprKind::Construct {
                constructor: Constructor::Scalar,
                arguments,
            } => {
                let range = of(arguments[0])?;
                let whole = range.least.fract() == 0.0 && range.most.fract() == 0.0;
                whole.then_some(range)
            }
            ExprKind::BuiltIn { function, arguments } => match (function, &arguments[..]) {
                (BuiltIn::Min, &[a, b]) => match (of(a), of(b)) {
                    (Some(a), Some(b)) => Some(Range {
                        least: a.least.min(b.least),
                        most: a.most.min(b.most),
                    }),
                    (Some(one), None) | (None, Some(one)) => Some(Range {
                        least: f64::NEG_INFINITY,
                        ..one
                    }),
                    (None, None) => None,
                },
                (BuiltIn::Max, &[a, b]) => match (of(a), of(b)) {
                    (Some(a), Some(b)) => Some(Range {
                        least: a.least.max(b.least),
                        most: a.most.max(b.most),
                    }),
                    (Some(one), None) | (None, Some(one)) => Some(Range {
                        most: f64::INFINITY,
                        ..one
                    }),
                    (None, None) => None,
                },
                (BuiltIn::Abs | BuiltIn::Length | BuiltIn::Distance | BuiltIn::Sqrt | BuiltIn::Exp, _) => {
                    Some(not_negative)
                }
                _ => None,
            },
            _ => None,
        }
    }
}

fn exactly(value: Value) -> Range {
    let value = match value {
        Value::Bool(value) => f64::from(u8::from(value)),
        Value::Int(value) => f64::from(value),
        Value::Uint(value) => f64::from(value),
        Value::Float(value) => value,
    };
    Range {
        least: value,
        most: value,
    }
}

fn compare(op: BinaryOp, a: Range, b: Range) -> Option<bool> {
    let less = |a: Range, b: Range| {
        if a.most < b.least {
            Some(true)
        } else if a.least >= b.most {
            Some(false)
        } else {
            None
        }
    };
    let equal = || {
        if a.least == a.most && a == b {
            Some(true)
        } else if a.most < b.least || b.most < a.least {
            Some(false)
        } else {
            None
        }
    };
    match op {
        BinaryOp::Less => less(a, b),
        BinaryOp::Greater => less(b, a),
        BinaryOp::LessEqual => less(b, a).map(|less| !less),
        BinaryOp::GreaterEqual => less(a, b).map(|less| !less),
        BinaryOp::Equal => equal(),
        BinaryOp::NotEqual => equal().map(|equal| !equal),
        _ => None,
    }
}

/// The operator that says the same with its sides exchanged.
fn mirrored(op: BinaryOp) -> BinaryOp {
    match op {
        BinaryOp::Less => BinaryOp::Greater,
        BinaryOp::Greater => BinaryOp::Less,
        BinaryOp::LessEqual => BinaryOp::GreaterEqual,
        BinaryOp::GreaterEqual => BinaryOp::LessEqual,
        other => other,
    }
}

/// `variable op bound` held, or did not.
fn narrow(
    tree: &Tree,
    known: &mut Known,
    variable: VariableId,
    range: Option<Range>,
    (op, holds): (BinaryOp, bool),
    bound: Range,
) {
    use crate::glsl::tree::Type;
    let mut range = range.unwrap_or(Range {
        least: f64::NEG_INFINITY,
        most: f64::INFINITY,
    });
    // Whole numbers that are less are less by one.
    let gap = if matches!(tree[variable].ty, Type::INT | Type::UINT) {
        1.0
    } else {
        0.0
    };
    match (op, holds) {
        (BinaryOp::Less, true) | (BinaryOp::GreaterEqual, false) => {
            range.most = range.most.min(bound.most - gap);
        }
        (BinaryOp::LessEqual, true) | (BinaryOp::Greater, false) => range.most = range.most.min(bound.most),
        (BinaryOp::Greater, true) | (BinaryOp::LessEqual, false) => {
            range.least = range.least.max(bound.least + gap);
        }
        (BinaryOp::GreaterEqual, true) | (BinaryOp::Less, false) => {
            range.least = range.least.max(bound.least);
        }
        (BinaryOp::Equal, true) | (BinaryOp::NotEqual, false) => range = bound,
        _ => return,
    }
    known.note(variable, range);
}
