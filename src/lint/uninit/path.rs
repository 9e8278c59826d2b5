//! A path from a variable's declaration to an uninitialized read, and whether it is worth reporting.

use std::collections::HashSet;

use toyproof_glsl::tree::{BinaryOp, ExprId, ExprKind, Value, VariableId};

use super::cfg::{BlockId, Cfg, Event, Terminator};
use super::facts::Facts;
use super::part::Parts;
use crate::program::{Definition, Program, Shape};

/// The maximum number of decisions on a reported path: more do not fit in a sentence.
const MAX_DECISIONS: usize = 3;
/// The maximum number of blocks searched for a write after the untaken branch of a decision.
const MAX_BLOCKS_PAST_DECISION: usize = 200;

/// A path to an uninitialized read.
#[derive(Debug)]
pub(super) struct Path {
    /// The read; `None` for the end of the function.
    pub(super) expr: Option<ExprId>,
    /// The uninitialized parts that are read.
    pub(super) parts: Parts,
    /// The decisions on the path that avoid a write.
    pub(super) decisions: Vec<Decision>,
}

/// A decision on a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Decision {
    pub(super) expr: ExprId,
    pub(super) kind: DecisionKind,
    /// The number of case labels of a `switch`; 0 for other decisions.
    pub(super) label_count: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DecisionKind {
    Holds(bool),
    /// The condition of a loop is false.
    ExitsLoop,
    /// A `switch` selects a label, or none.
    Selects(Option<u32>),
}

/// A block on a path, and how the path reached it.
#[derive(Debug, Clone)]
pub(super) struct Visit {
    pub(super) block: BlockId,
    pub(super) previous: Option<usize>,
    /// The decision in the previous block, and the successor not taken.
    pub(super) decision: Option<(Decision, BlockId)>,
    pub(super) unwritten: Parts,
    pub(super) known: Facts,
    /// The head of the loop that is in its second or a later iteration.
    pub(super) repeated_loop: Option<BlockId>,
}

/// An uninitialized read, and the visits that lead to it.
pub(super) struct Trace<'a> {
    pub(super) program: &'a Program<'a>,
    pub(super) cfg: &'a Cfg,
    pub(super) visits: &'a [Visit],
    /// Index of the visit with the read.
    pub(super) last: usize,
    /// `None` for the function's result.
    pub(super) variable: Option<VariableId>,
    /// The read; `None` for the end of the function.
    pub(super) expr: Option<ExprId>,
    /// The uninitialized parts that are read.
    pub(super) parts: Parts,
}

impl Trace<'_> {
    /// The path with the decisions that matter to the variable; `None` if its author most likely knows that
    /// it is never taken, or that the value is not used.
    pub(super) fn path(&self) -> Option<Path> {
        let mut decisions: Vec<Decision> = Vec::new();
        // The blocks after the current decision.
        let mut after = HashSet::new();
        let mut at = Some(self.last);
        while let Some(visit) = at.map(|at| &self.visits[at]) {
            after.insert(visit.block);
            if let Some((decision, other)) = visit.decision
                && !decisions.contains(&decision)
                && self.is_written_past(other, &after)
            {
                if decisions.len() == MAX_DECISIONS
                    || self.tracks_minimum(decision, other)
                    || self.is_table_lookup(decision)
                {
                    return None;
                }
                decisions.push(decision);
            }
            at = visit.previous;
        }
        decisions.reverse();
        (!self.is_dispatch(&decisions) && !self.is_returned_beside_a_miss(&decisions)).then_some(Path {
            expr: self.expr,
            parts: self.parts,
            decisions,
        })
    }

    /// `if (d < least) { least = d; … }`: the first iteration of a search for a minimum takes the branch.
    fn tracks_minimum(&self, decision: Decision, arm: BlockId) -> bool {
        let tree = self.program.tree;
        let &ExprKind::Binary { left, right, .. } = &tree[decision.expr].kind else {
            return false;
        };
        let sets = |target: ExprId, value: ExprId| {
            let shape = Shape::of(tree, target);
            shape.is_some()
                && self.cfg.blocks[arm].events.iter().any(|event| match event {
                    Event::Set {
                        target: Some(set),
                        value: to,
                        ..
                    } => Shape::of(tree, *set) == shape && Shape::of(tree, *to) == Shape::of(tree, value),
                    _ => false,
                })
        };
        decision.kind == DecisionKind::Holds(false) && (sets(left, right) || sets(right, left))
    }

    /// `if (t >= table[i] && t < table[i + 1])`: one interval of a table contains the value.
    fn is_table_lookup(&self, decision: Decision) -> bool {
        let tree = self.program.tree;
        let ExprKind::Binary {
            op: BinaryOp::And,
            left,
            right,
        } = tree[decision.expr].kind
        else {
            return false;
        };
        // The value looked up, and the array that bounds it.
        let lookup = |side: ExprId| {
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
        decision.kind == DecisionKind::Holds(false)
            && lookup(left).is_some_and(|one| Some(one) == lookup(right))
    }

    /// Whether the decisions are a dispatch that most likely covers all cases: `id == 1` is false, then `id
    /// == 2 || id == 3`; or `id < 1.5`, then `id < 2.5`; or a comparison of a loop counter with one number.
    fn is_dispatch(&self, decisions: &[Decision]) -> bool {
        let tree = self.program.tree;
        if let [only] = decisions
            && let DecisionKind::Selects(None) = only.kind
        {
            return only.label_count > 2;
        }
        let mut subjects: Vec<Shape> = Vec::new();
        for decision in decisions {
            let DecisionKind::Holds(false) = decision.kind else {
                continue;
            };
            if let Some(of) = self
                .equality_subject(decision.expr)
                .or_else(|| self.threshold_subject(decision.expr))
            {
                let is_counter = match tree[decision.expr].kind {
                    ExprKind::Binary { left, .. } => self.is_counter(left),
                    _ => false,
                };
                if is_counter || subjects.contains(&of) {
                    return true;
                }
                subjects.push(of);
            }
        }
        false
    }

    /// Whether an expression is a variable with one initial value and one step.
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

    /// The expression compared with a constant above 1 that is not an integer, as authors do with an ID
    /// stored as a float.
    fn threshold_subject(&self, condition: ExprId) -> Option<Shape> {
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

    /// The expression tested for equality with one or several constants.
    fn equality_subject(&self, condition: ExprId) -> Option<Shape> {
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
                    let subject = Shape::of(tree, left)?;
                    if *all.get_or_insert_with(|| subject.clone()) != subject {
                        return None;
                    }
                }
                _ => return None,
            }
        }
        all
    }

    /// `return vec4(distance, normal);`: if the distance is the sentinel for a miss, callers ignore the
    /// normal. A path on which a search loop ran to its end is still reported.
    fn is_returned_beside_a_miss(&self, decisions: &[Decision]) -> bool {
        self.expr
            .is_some_and(|expr| self.cfg.returned_beside.contains(&expr))
            && !decisions.is_empty()
            && decisions
                .iter()
                .all(|decision| decision.kind != DecisionKind::ExitsLoop)
    }

    /// Whether the variable may be written after `from` and the read still be reached: by rejoining the path,
    /// or at the end of the function if that is the read.
    fn is_written_past(&self, from: BlockId, path: &HashSet<BlockId>) -> bool {
        let mut seen = HashSet::new();
        let mut pending = vec![from];
        // A function's result is read by its caller.
        let (mut writes, mut reaches_read) = (false, self.variable.is_none());
        while let Some(block) = pending.pop()
            && seen.len() < MAX_BLOCKS_PAST_DECISION
            && !(writes && reaches_read)
        {
            if path.contains(&block) {
                reaches_read = true;
                continue;
            }
            if !seen.insert(block) {
                continue;
            }
            let basic_block = &self.cfg.blocks[block];
            writes |= basic_block.events.iter().any(|event| match event {
                Event::Write(part) => Some(part.variable) == self.variable && part.parts & self.parts != 0,
                _ => false,
            });
            match &basic_block.end {
                Terminator::BackEdge(_) => {}
                Terminator::Return if self.variable.is_none() => writes = true,
                Terminator::Return | Terminator::FallOff => reaches_read |= self.expr.is_none(),
                end => end.for_each_successor(|next| pending.push(next)),
            }
        }
        writes && reaches_read
    }
}
