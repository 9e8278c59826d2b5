//! The ways from where a variable begins to where it is read, without a write between.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::super::super::tree::{BinaryOp, ExprId, ExprKind, Type, VariableId};
use super::super::program::Program;
use super::super::shape::Shape;
use super::flow::{BlockId, End, Event, Flow};
use super::knowledge::{Conditions, Known};
use super::part::Parts;

/// How many blocks are visited for one variable; of those that need more, nothing is told.
const BUDGET: usize = 2_000;

/// How many ways are looked at for one variable, of which one is told.
const MAX_WAYS: usize = 8;
/// How many decisions a way may hang on: what hangs on more is told by nobody in a sentence.
const MAX_DECISIONS: usize = 3;
/// How many blocks before a variable are looked at for what is known.
const MAX_BEFORE: usize = 32;
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
struct Visit {
    block: BlockId,
    before: Option<usize>,
    /// What the block before decided, and where it would have gone else.
    decision: Option<(Decision, BlockId)>,
    unwritten: Parts,
    known: Known,
    /// The loop that is in a later round than its first.
    again: Option<BlockId>,
}

/// Looks for ways in one function.
pub(super) struct Search<'a, 'p> {
    program: &'p Program<'p>,
    flow: &'a Flow,
    conditions: Conditions<'p>,
    /// By block: those that go to it.
    before: Vec<Vec<BlockId>>,
    /// By head of a loop: what the loop changes.
    changed: HashMap<BlockId, Rc<[VariableId]>>,
}

/// What is looked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quarry {
    pub(super) variable: VariableId,
    /// What of it is not written at the beginning.
    pub(super) parts: Parts,
    /// The event after which it is looked for, as block and index.
    pub(super) from: (BlockId, usize),
    /// Whether to leave the function is to read it.
    pub(super) to_the_end: bool,
}

impl<'a, 'p> Search<'a, 'p> {
    pub(super) fn new(program: &'p Program<'p>, flow: &'a Flow) -> Self {
        let mut before = vec![Vec::new(); flow.nodes.len()];
        for (block, node) in flow.nodes.iter().enumerate() {
            each_next(&node.end, |next| before[next].push(block));
        }
        Self {
            program,
            flow,
            conditions: Conditions::new(program),
            before,
            changed: HashMap::new(),
        }
    }

    /// The ways on which a variable is read unwritten; at most [`MAX_WAYS`]. `left` is how many blocks may still be visited for this shader.
    pub(super) fn ways(&mut self, quarry: Quarry, left: &mut usize) -> Vec<Way> {
        let (block, event) = quarry.from;
        let mut ways = Vec::new();
        let mut visits = vec![Visit {
            block,
            before: None,
            decision: None,
            unwritten: quarry.parts,
            known: self.known_before(block, event),
            again: None,
        }];
        let mut seen = HashSet::new();
        let mut pending = vec![0];
        let mut skip = event;
        for _ in 0..BUDGET {
            let Some(visit) = pending.pop().filter(|_| *left > 0 && ways.len() < MAX_WAYS) else {
                break;
            };
            *left -= 1;
            let mut unwritten = visits[visit].unwritten;
            let mut known = visits[visit].known.clone();
            let node = &self.flow.nodes[visits[visit].block];
            for event in node.events.iter().skip(std::mem::take(&mut skip)) {
                match event {
                    // Anew, in the next round of a loop.
                    Event::Begin(begun) if *begun == quarry.variable && visit > 0 => unwritten = 0,
                    Event::Read { part, expr } if part.variable == quarry.variable => {
                        let missing = part.parts & unwritten;
                        if missing != 0 && (!part.one_of || missing == part.parts) {
                            ways.extend(self.way(&visits, visit, quarry.variable, Some(*expr), missing));
                            unwritten &= !part.parts;
                        }
                    }
                    Event::Write(part) if part.variable == quarry.variable => unwritten &= !part.parts,
                    event => self.learn(&mut known, event),
                }
            }
            if unwritten == 0 {
                continue;
            }
            if matches!(node.end, End::Return) && quarry.to_the_end && unwritten == quarry.parts {
                ways.extend(self.way(&visits, visit, quarry.variable, None, unwritten));
            }
            for next in self.next(&visits, visit, unwritten, known) {
                if seen.insert((next.block, next.again, next.unwritten, next.known.key())) {
                    visits.push(next);
                    pending.push(visits.len() - 1);
                }
            }
        }
        ways
    }

    /// Where a visit goes on.
    fn next(&mut self, visits: &[Visit], index: usize, unwritten: Parts, known: Known) -> Vec<Visit> {
        let visit = &visits[index];
        let go = |block, known, decision| Visit {
            block,
            before: Some(index),
            decision,
            unwritten,
            known,
            again: visit.again,
        };
        match &self.flow.nodes[visit.block].end {
            End::Open | End::Return => Vec::new(),
            End::Goto(to) => vec![go(*to, known, None)],
            End::Repeat(head) => {
                let mut known = known;
                // What the last round left as it was is still known: `t` is still the 1e9 that it began with.
                let mut entry = Some(visit);
                while let Some(earlier) = entry.filter(|earlier| earlier.block != *head) {
                    entry = earlier.before.map(|before| &visits[before]);
                }
                for &variable in &*self.changed_in(*head, visit.block) {
                    known.forget_unless(&self.conditions, variable, entry.map(|entry| &entry.known));
                }
                vec![Visit {
                    again: Some(*head),
                    ..go(*head, known, None)
                }]
            }
            &End::Branch {
                condition,
                yes,
                no,
                of_loop,
            } => {
                let first_round = of_loop.is_some() && of_loop != visit.again;
                let kind = |holds: bool| match of_loop {
                    Some(_) if !holds => DecisionKind::Ends,
                    _ => DecisionKind::Is(holds),
                };
                let decided = |holds| {
                    (
                        holds,
                        Some(Decision {
                            expr: condition,
                            kind: kind(holds),
                        }),
                    )
                };
                let ways = match self.conditions.holds(&known, condition) {
                    // What is always so is no decision; what follows from earlier ones is one more.
                    Some(holds) if self.conditions.holds(&Known::default(), condition).is_some() => {
                        vec![(holds, None)]
                    }
                    Some(holds) => vec![decided(holds)],
                    // Who writes a loop means it to run.
                    None if first_round => vec![(true, None)],
                    None => vec![decided(true), decided(false)],
                };
                let all = ways.into_iter().map(|(holds, decision)| {
                    let mut known = known.clone();
                    self.conditions.assume(&mut known, condition, holds);
                    let (to, other) = if holds { (yes, no) } else { (no, yes) };
                    go(to, known, decision.map(|decision| (decision, other)))
                });
                all.collect()
            }
            End::Switch {
                selector,
                cases,
                default,
            } => {
                let decision = |label| Decision {
                    expr: *selector,
                    kind: DecisionKind::Chooses(label),
                };
                // What else could have happened: the first case that goes elsewhere.
                let other = |to| {
                    cases
                        .iter()
                        .map(|(_, block)| *block)
                        .find(|&block| block != to)
                        .unwrap_or(*default)
                };
                let mut all: Vec<_> = cases
                    .iter()
                    .filter(|(labels, _)| !labels.is_empty())
                    .map(|(labels, to)| (*to, labels.first().copied()))
                    .collect();
                all.push((*default, None));
                all.into_iter()
                    .map(|(to, label)| go(to, known.clone(), Some((decision(label), other(to)))))
                    .collect()
            }
        }
    }

    fn learn(&self, known: &mut Known, event: &Event) {
        let tree = self.program.tree;
        match event {
            Event::Set(variable, value) => known.set(&self.conditions, *variable, *value),
            Event::Begin(variable) if matches!(tree[*variable].ty, Type::Scalar(_)) => {
                known.begin(&self.conditions, *variable);
            }
            Event::Begin(variable) | Event::Forget(variable) => known.forget(&self.conditions, *variable),
            Event::Write(part) => known.forget(&self.conditions, part.variable),
            Event::Called => known.forget_globals(tree),
            Event::Read { .. } => {}
        }
    }

    /// What is known before an event, from the blocks that always come before it.
    fn known_before(&mut self, block: BlockId, event: usize) -> Known {
        let mut way = vec![block];
        let mut first = block;
        while let [only] = self.before[first][..]
            && way.len() < MAX_BEFORE
        {
            way.push(only);
            first = only;
        }
        let mut known = Known::default();
        for pair in way.iter().rev().zip(way.iter().rev().skip(1)) {
            let (&from, &to) = pair;
            for event in &self.flow.nodes[from].events {
                self.learn(&mut known, event);
            }
            if let End::Branch { condition, yes, .. } = self.flow.nodes[from].end {
                self.conditions.assume(&mut known, condition, yes == to);
            }
        }
        for event in &self.flow.nodes[block].events[..event] {
            self.learn(&mut known, event);
        }
        known
    }

    /// What the blocks from the head of a loop to the one that goes back change.
    fn changed_in(&mut self, head: BlockId, last: BlockId) -> Rc<[VariableId]> {
        let (flow, before) = (self.flow, &self.before);
        let changed = self.changed.entry(head).or_insert_with(|| {
            let mut changed = HashSet::new();
            let mut seen = HashSet::from([head]);
            let mut pending = vec![last];
            while let Some(block) = pending.pop() {
                if !seen.insert(block) && block != head {
                    continue;
                }
                for event in &flow.nodes[block].events {
                    match event {
                        Event::Set(variable, _) | Event::Forget(variable) | Event::Begin(variable) => {
                            changed.insert(*variable);
                        }
                        Event::Write(part) => {
                            changed.insert(part.variable);
                        }
                        Event::Read { .. } | Event::Called => {}
                    }
                }
                if block != head {
                    pending.extend(before[block].iter().copied());
                }
            }
            let mut changed: Vec<_> = changed.into_iter().collect();
            changed.sort_unstable();
            changed.into()
        });
        Rc::clone(changed)
    }

    /// The way that ends in a visit, with the decisions that matter to the variable; none if its author most likely knows that it is never gone.
    fn way(
        &self,
        visits: &[Visit],
        last: usize,
        variable: VariableId,
        expr: Option<ExprId>,
        parts: Parts,
    ) -> Option<Way> {
        let mut decisions: Vec<Decision> = Vec::new();
        // The blocks that come after the decision in hand.
        let mut after = HashSet::new();
        let mut at = Some(last);
        while let Some(visit) = at.map(|at| &visits[at]) {
            after.insert(visit.block);
            if let Some((decision, other)) = visit.decision
                && !decisions.contains(&decision)
                && self.writes_past(other, &after, (variable, parts), expr.is_none())
            {
                if decisions.len() == MAX_DECISIONS || self.keeps_least(decision, other) {
                    return None;
                }
                decisions.push(decision);
            }
            at = visit.before;
        }
        decisions.reverse();
        (!self.is_dispatch(&decisions)).then_some(Way {
            expr,
            parts,
            decisions,
        })
    }

    /// `if (d < least) { least = d; … }`: the first round of such a search finds something.
    fn keeps_least(&self, decision: Decision, arm: BlockId) -> bool {
        let tree = self.program.tree;
        let &ExprKind::Binary { left, right, .. } = &tree[decision.expr].kind else {
            return false;
        };
        let sets = |target: ExprId, value: ExprId| match tree[target].kind {
            ExprKind::Variable(variable) => self.flow.nodes[arm].events.iter().any(|event| match event {
                Event::Set(set, to) => *set == variable && Shape::of(tree, *to) == Shape::of(tree, value),
                _ => false,
            }),
            _ => false,
        };
        decision.kind == DecisionKind::Is(false) && (sets(left, right) || sets(right, left))
    }

    /// `id == 1` is false, and `id == 2`, …: a list of all that there is, more often than not.
    fn is_dispatch(&self, decisions: &[Decision]) -> bool {
        let tree = self.program.tree;
        let asked = |decision: &Decision| match &tree[decision.expr].kind {
            ExprKind::Binary {
                op: BinaryOp::Equal,
                left,
                right,
            } if tree[*right].constant => Shape::of(tree, *left),
            _ => None,
        };
        match decisions {
            [first, others @ ..] if !others.is_empty() => {
                let first = asked(first);
                first.is_some() && others.iter().all(|other| asked(other) == first)
            }
            _ => false,
        }
    }

    /// Whether a variable could have been written from there on, and the read still be come to: the way is met again, or `to_the_end`.
    fn writes_past(
        &self,
        from: BlockId,
        way: &HashSet<BlockId>,
        (variable, parts): (VariableId, Parts),
        to_the_end: bool,
    ) -> bool {
        let mut seen = HashSet::new();
        let mut pending = vec![from];
        let (mut writes, mut meets) = (false, false);
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
                Event::Write(part) => part.variable == variable && part.parts & parts != 0,
                _ => false,
            });
            match &node.end {
                End::Repeat(_) => {}
                End::Return => meets |= to_the_end,
                end => each_next(end, |next| pending.push(next)),
            }
        }
        writes && meets
    }
}

fn each_next(end: &End, mut visit: impl FnMut(BlockId)) {
    match end {
        End::Open | End::Return => {}
        End::Goto(to) | End::Repeat(to) => visit(*to),
        End::Branch { yes, no, .. } => {
            visit(*yes);
            visit(*no);
        }
        End::Switch { cases, default, .. } => {
            for (_, block) in cases {
                visit(*block);
            }
            visit(*default);
        }
    }
}
