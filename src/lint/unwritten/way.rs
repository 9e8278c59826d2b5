//! A way from where a variable begins to where it is read unwritten, and whether it is worth a word.

use std::collections::HashSet;

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Value, VariableId};

use super::super::program::{Definition, Program};
use super::super::shape::Shape;
use super::flow::{BlockId, End, Event, Flow};
use super::known::Known;
use super::part::Parts;

/// How many decisions a way may hang on: what hangs on more is told by nobody in a sentence.
const MAX_DECISIONS: usize = 3;
/// How many blocks past a decision are looked at for a write.
const MAX_PAST: usize = 200;

/// One way that leads to a read of what was not written.
#[derive(Debug)]
pub(super) struct Way {
    /// The read; none for the end of the function.
    pub(super) expr: Option<ExprId>,
    /// What of the variable was not written.
    pub(super) parts: Parts,
    /// The decisions on the way that keep it from a write.
    pub(super) decisions: Vec<Decision>,
}

/// A decision that a way takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Decision {
    pub(super) expr: ExprId,
    pub(super) kind: DecisionKind,
    /// How many labels there were to choose from.
    pub(super) labels: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DecisionKind {
    Is(bool),
    /// The condition of a loop ended it.
    Ends,
    /// A `switch` went to a label, or to none.
    Chooses(Option<u32>),
}

/// A block on a way, and how it was come by.
#[derive(Debug, Clone)]
pub(super) struct Visit {
    pub(super) block: BlockId,
    pub(super) before: Option<usize>,
    /// What the block before decided, and where it would have gone else.
    pub(super) decision: Option<(Decision, BlockId)>,
    pub(super) unwritten: Parts,
    pub(super) known: Known,
    /// The loop that is in a later round than its first.
    pub(super) again: Option<BlockId>,
}

/// A read of what was not written, and the visits that lead to it.
pub(super) struct Trail<'a> {
    pub(super) program: &'a Program<'a>,
    pub(super) flow: &'a Flow,
    pub(super) visits: &'a [Visit],
    /// The visit with the read.
    pub(super) last: usize,
    /// None for the function's result.
    pub(super) variable: Option<VariableId>,
    /// The read; none for the end of the function.
    pub(super) expr: Option<ExprId>,
    /// What of the variable is not written.
    pub(super) parts: Parts,
}

impl Trail<'_> {
    /// The way that was gone, with the decisions that matter to the variable; none if its author most likely knows that it is never
    /// gone, or that nobody looks at what is handed on.
    pub(super) fn way(&self) -> Option<Way> {
        let mut decisions: Vec<Decision> = Vec::new();
        // The blocks that come after the decision in hand.
        let mut after = HashSet::new();
        let mut at = Some(self.last);
        while let Some(visit) = at.map(|at| &self.visits[at]) {
            after.insert(visit.block);
            if let Some((decision, other)) = visit.decision
                && !decisions.contains(&decision)
                && self.writes_past(other, &after)
            {
                if decisions.len() == MAX_DECISIONS
                    || self.keeps_least(decision, other)
                    || self.looks_up(decision)
                {
                    return None;
                }
                decisions.push(decision);
            }
            at = visit.before;
        }
        decisions.reverse();
        (!self.is_dispatch(&decisions) && !self.is_beside_a_miss(&decisions)).then_some(Way {
            expr: self.expr,
            parts: self.parts,
            decisions,
        })
    }

    /// `if (d < least) { least = d; … }`: the first round of such a search finds something.
    fn keeps_least(&self, decision: Decision, arm: BlockId) -> bool {
        let tree = self.program.tree;
        let &ExprKind::Binary { left, right, .. } = &tree[decision.expr].kind else {
            return false;
        };
        let sets = |target: ExprId, value: ExprId| {
            let shape = Shape::of(tree, target);
            shape.is_some()
                && self.flow.nodes[arm].events.iter().any(|event| match event {
                    Event::Set {
                        target: Some(set),
                        value: to,
                        ..
                    } => Shape::of(tree, *set) == shape && Shape::of(tree, *to) == Shape::of(tree, value),
                    _ => false,
                })
        };
        decision.kind == DecisionKind::Is(false) && (sets(left, right) || sets(right, left))
    }

    /// `if (t >= table[i] && t < table[i + 1])`: one interval of a table is the right one.
    fn looks_up(&self, decision: Decision) -> bool {
        let tree = self.program.tree;
        let ExprKind::Binary {
            op: BinaryOp::And,
            left,
            right,
        } = tree[decision.expr].kind
        else {
            return false;
        };
        // What is asked for, and the array that bounds it.
        let asked = |side: ExprId| {
            let ExprKind::Binary { left, right, .. } = tree[side].kind else {
                return None;
            };
            let array = |expr: ExprId| match tree[expr].kind {
                ExprKind::Index { base, .. } => Shape::of(tree, base),
                _ => None,
            };
            match (array(left), array(right)) {
                (None, Some(array)) => Some((Shape::of(tree, left)?, array)),
                (Some(array), None) => Some((Shape::of(tree, right)?, array)),
                _ => None,
            }
        };
        decision.kind == DecisionKind::Is(false) && asked(left).is_some_and(|one| Some(one) == asked(right))
    }

    /// `id == 1` is false, and `id == 2 || id == 3`, …: a list of all that there is, more often than not. So is `id < 1.5`, and `id < 2.5`,
    /// and one number among those that a loop counts through.
    fn is_dispatch(&self, decisions: &[Decision]) -> bool {
        let tree = self.program.tree;
        if let [only] = decisions
            && let DecisionKind::Chooses(None) = only.kind
        {
            return only.labels > 2;
        }
        let mut asked: Vec<Shape> = Vec::new();
        for decision in decisions {
            let DecisionKind::Is(false) = decision.kind else {
                continue;
            };
            if let Some(of) = self.asked(decision.expr).or_else(|| self.compared(decision.expr)) {
                let is_counter = match tree[decision.expr].kind {
                    ExprKind::Binary { left, .. } => self.is_counter(left),
                    _ => false,
                };
                if is_counter || asked.contains(&of) {
                    return true;
                }
                asked.push(of);
            }
        }
        false
    }

    /// Whether it is a variable that is stepped from a first value.
    fn is_counter(&self, expr: ExprId) -> bool {
        let tree = self.program.tree;
        let ExprKind::Variable(variable) = tree[expr].kind else {
            return false;
        };
        match self.program.definitions(variable) {
            [Definition::Value(_), Definition::Change(change)]
            | [Definition::Change(change), Definition::Value(_)] => matches!(
                tree[*change].kind,
                ExprKind::Step { .. }
                    | ExprKind::Assign {
                        op: Some(BinaryOp::Add | BinaryOp::Subtract),
                        ..
                    }
            ),
            _ => false,
        }
    }

    /// What is compared with a bound between two whole numbers, as the number of a thing is where numbers are floats.
    fn compared(&self, condition: ExprId) -> Option<Shape> {
        let tree = self.program.tree;
        let ExprKind::Binary {
            op: BinaryOp::Less | BinaryOp::LessEqual | BinaryOp::Greater | BinaryOp::GreaterEqual,
            left,
            right,
        } = tree[condition].kind
        else {
            return None;
        };
        match *self.program.constant(right)?.components() {
            [Value::Float(bound)] if bound > 1.0 && bound.fract() != 0.0 => Shape::of(tree, left),
            _ => None,
        }
    }

    /// What is asked whether it equals a constant, or one of several.
    fn asked(&self, condition: ExprId) -> Option<Shape> {
        let tree = self.program.tree;
        let mut all = None;
        let mut pending = vec![condition];
        while let Some(condition) = pending.pop() {
            match tree[condition].kind {
                ExprKind::Binary {
                    op: BinaryOp::Or,
                    left,
                    right,
                } => pending.extend([left, right]),
                ExprKind::Binary {
                    op: BinaryOp::Equal,
                    left,
                    right,
                } if tree[right].constant => {
                    let asked = Shape::of(tree, left)?;
                    if *all.get_or_insert_with(|| asked.clone()) != asked {
                        return None;
                    }
                }
                _ => return None,
            }
        }
        all
    }

    /// `return vec4(distance, normal);`: beside a distance that says "no hit" nobody looks at the normal. A search that ran out of rounds says no
    /// such thing.
    fn is_beside_a_miss(&self, decisions: &[Decision]) -> bool {
        self.expr
            .is_some_and(|expr| self.flow.returned_beside.contains(&expr))
            && !decisions.is_empty()
            && decisions
                .iter()
                .all(|decision| decision.kind != DecisionKind::Ends)
    }

    /// Whether the variable could have been written from there on, and the read still be come to: the way is met again, or the end
    /// of the function, where that is what reads.
    fn writes_past(&self, from: BlockId, way: &HashSet<BlockId>) -> bool {
        let mut seen = HashSet::new();
        let mut pending = vec![from];
        // What a function gives is read by whoever called it.
        let (mut writes, mut meets) = (false, self.variable.is_none());
        while let Some(block) = pending.pop()
            && seen.len() < MAX_PAST
            && !(writes && meets)
        {
            if way.contains(&block) {
                meets = true;
                continue;
            }
            if !seen.insert(block) {
                continue;
            }
            let node = &self.flow.nodes[block];
            writes |= node.events.iter().any(|event| match event {
                Event::Write(part) => Some(part.variable) == self.variable && part.parts & self.parts != 0,
                _ => false,
            });
            match &node.end {
                End::Repeat(_) => {}
                End::Return if self.variable.is_none() => writes = true,
                End::Return | End::Fall => meets |= self.expr.is_none(),
                end => end.each_next(|next| pending.push(next)),
            }
        }
        writes && meets
    }
}
