//! The search for ways from where a variable begins to where it is read, without a write between.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use toyproof_glsl::tree::{ExprId, Type, VariableId};

use super::super::program::Program;
use super::conditions::Conditions;
use super::flow::{BlockId, End, Event, Flow};
use super::known::Known;
use super::part::{Part, Parts};
use super::way::{Decision, DecisionKind, Trail, Visit, Way};

/// How many blocks are visited for one variable; of those that need more, nothing is told.
const BUDGET: usize = 2_000;

/// How much may still be looked at for a shader; of what is beyond, nothing is told.
#[derive(Debug)]
pub(super) struct Budget {
    blocks: usize,
    /// Events whose effects are followed.
    events: usize,
}

impl Default for Budget {
    /// A second's work at most.
    fn default() -> Self {
        Self {
            blocks: 100_000,
            events: 4_000_000,
        }
    }
}

impl Budget {
    fn is_spent(&self) -> bool {
        self.blocks == 0 || self.events == 0
    }
}

/// How many ways are looked at for one variable, of which one is told.
const MAX_WAYS: usize = 8;
/// How many blocks before a variable are looked at for what is known.
const MAX_BEFORE: usize = 32;

/// Looks for ways in one function.
pub(super) struct Search<'a, 'p> {
    program: &'p Program<'p>,
    flow: &'a Flow,
    conditions: Conditions<'p>,
    /// By block: those that go to it.
    before: Vec<Vec<BlockId>>,
    /// By head of a loop: what the loop changes.
    changed: HashMap<BlockId, Vec<VariableId>>,
    /// By block and variable: the events that begin, read or write it.
    own_events: HashMap<(BlockId, VariableId), Rc<[usize]>>,
    /// What was known before the event of a block that was asked for last.
    last_known: Option<(BlockId, usize, Known)>,
}

/// What is looked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quarry {
    /// None for the function's result, which a `return` writes and its caller reads.
    pub(super) variable: Option<VariableId>,
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
        let mut own_events: HashMap<_, Vec<usize>> = HashMap::new();
        for (block, node) in flow.nodes.iter().enumerate() {
            node.end.each_next(|next| before[next].push(block));
            for (index, event) in node.events.iter().enumerate() {
                if let Event::Begin(variable)
                | Event::Read {
                    part: Part { variable, .. },
                    ..
                }
                | Event::Write(Part { variable, .. }) = event
                {
                    own_events.entry((block, *variable)).or_default().push(index);
                }
            }
        }
        Self {
            program,
            flow,
            conditions: Conditions::new(program),
            before,
            changed: HashMap::new(),
            own_events: own_events
                .into_iter()
                .map(|(place, events)| (place, events.into()))
                .collect(),
            last_known: None,
        }
    }

    /// The ways on which a variable is read unwritten; at most [`MAX_WAYS`].
    pub(super) fn ways(&mut self, quarry: Quarry, left: &mut Budget) -> Vec<Way> {
        let (block, event) = quarry.from;
        if left.is_spent() || self.program.deadline.is_over() {
            return Vec::new();
        }
        let mut ways = Vec::new();
        let mut visits = vec![Visit {
            block,
            before: None,
            decision: None,
            unwritten: quarry.parts,
            known: self.known_before(block, event, left),
            again: None,
        }];
        let mut seen = HashSet::new();
        let mut pending = vec![0];
        let mut skip = event;
        for _ in 0..BUDGET {
            let Some(visit) = pending
                .pop()
                .filter(|_| !left.is_spent() && ways.len() < MAX_WAYS)
            else {
                break;
            };
            left.blocks -= 1;
            let mut unwritten = visits[visit].unwritten;
            let mut known = visits[visit].known.clone();
            let node = &self.flow.nodes[visits[visit].block];
            let from = std::mem::take(&mut skip);
            // Where nothing comes after the block, what is known at its end is of no use.
            let goes_on = node.end.goes_on();
            let own = match quarry.variable {
                Some(variable) if !goes_on => self.own_events.get(&(visits[visit].block, variable)),
                _ => None,
            };
            let own: Rc<[usize]> = own.map_or_else(Rc::default, Rc::clone);
            let own = own.iter().copied().filter(|&index| index >= from);
            let all = if goes_on { from..node.events.len() } else { 0..0 };
            for event in all.chain(own).map(|index| &node.events[index]) {
                if unwritten == 0 {
                    break;
                }
                left.events = left.events.saturating_sub(usize::from(goes_on));
                match event {
                    // Anew, in the next round of a loop.
                    Event::Begin(begun) if Some(*begun) == quarry.variable && visit > 0 => unwritten = 0,
                    Event::Read { part, expr } if Some(part.variable) == quarry.variable => {
                        let missing = part.parts & unwritten;
                        if missing != 0 && (!part.one_of || missing == part.parts) {
                            ways.extend(
                                self.trail(&visits, visit, quarry.variable, Some(*expr), missing)
                                    .way(),
                            );
                            unwritten &= !part.parts;
                        }
                    }
                    Event::Write(part) if Some(part.variable) == quarry.variable => unwritten &= !part.parts,
                    event => self.learn(&mut known, event),
                }
            }
            if unwritten == 0 {
                continue;
            }
            let ends = match node.end {
                End::Return => quarry.variable.is_some(),
                End::Fall => true,
                _ => false,
            };
            if ends && quarry.to_the_end && unwritten == quarry.parts {
                ways.extend(self.trail(&visits, visit, quarry.variable, None, unwritten).way());
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
            End::Open | End::Return | End::Fall => Vec::new(),
            End::Goto(to) => vec![go(*to, known, None)],
            End::Repeat(head) => {
                let mut known = known;
                // A flag, or what holds between values, is as this way made it. Numbers differ from round to round; what the last
                // round left as it was is still known: `t` is still the 1e9 that it began with.
                let mut entry = Some(visit);
                while let Some(earlier) = entry.filter(|earlier| earlier.block != *head) {
                    entry = earlier.before.map(|before| &visits[before]);
                }
                let changed = || self.flow.changed_in(&self.before, *head, visit.block);
                for variable in self.changed.entry(*head).or_insert_with(changed).iter().copied() {
                    let is_flag = self.program.tree[variable].ty == Type::BOOL;
                    let then = entry.and_then(|entry| entry.known.range(variable));
                    if !is_flag && then != known.range(variable) {
                        known.widen(variable);
                    }
                }
                known.begin_round();
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
                            labels: 0,
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
                    labels: cases.iter().map(|(labels, _)| labels.len()).sum(),
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

    fn learn(&mut self, known: &mut Known, event: &Event) {
        let tree = self.program.tree;
        match event {
            Event::Set {
                variable,
                target,
                value,
            } => self.conditions.set(known, *variable, *target, *value),
            Event::Begin(variable) if matches!(tree[*variable].ty, Type::Scalar(_)) => {
                self.conditions.begin(known, *variable);
            }
            Event::Begin(variable) | Event::Forget(variable) => self.conditions.forget(known, *variable),
            Event::Write(part) => self.conditions.forget(known, part.variable),
            Event::Called(globals) => {
                for &variable in &**globals {
                    self.conditions.forget(known, variable);
                }
            }
            Event::Read { .. } => {}
        }
    }

    fn trail<'t>(
        &'t self,
        visits: &'t [Visit],
        last: usize,
        variable: Option<VariableId>,
        expr: Option<ExprId>,
        parts: Parts,
    ) -> Trail<'t> {
        Trail {
            program: self.program,
            flow: self.flow,
            visits,
            last,
            variable,
            expr,
            parts,
        }
    }

    /// What is known before an event, from the blocks that always come before it.
    fn known_before(&mut self, block: BlockId, event: usize, left: &mut Budget) -> Known {
        let (mut known, from) = match self.last_known.take() {
            Some((last, from, known)) if last == block && from <= event => (known, from),
            _ => (self.known_at_entry(block, left), 0),
        };
        let events = &self.flow.nodes[block].events[from..event];
        left.events = left.events.saturating_sub(events.len());
        for event in events {
            self.learn(&mut known, event);
        }
        self.last_known = Some((block, event, known.clone()));
        known
    }

    fn known_at_entry(&mut self, block: BlockId, left: &mut Budget) -> Known {
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
            let events = &self.flow.nodes[from].events;
            left.events = left.events.saturating_sub(events.len());
            for event in events {
                self.learn(&mut known, event);
            }
            if let End::Branch { condition, yes, .. } = self.flow.nodes[from].end {
                self.conditions.assume(&mut known, condition, yes == to);
            }
        }
        known
    }
}
