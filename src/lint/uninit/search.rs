//! Searches for paths from a variable's declaration to a read without a write between them.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use toyproof_glsl::tree::{ExprId, Type, VariableId};

use super::cfg::{BlockId, Cfg, Event, Terminator};
use super::conditions::Conditions;
use super::facts::Facts;
use super::part::{Part, Parts};
use super::path::{Decision, DecisionKind, Path, Trace, Visit};
use crate::program::Program;

/// The maximum number of blocks visited for one query; nothing is reported beyond it.
const MAX_VISITS_PER_QUERY: usize = 2_000;

/// The remaining work for a shader; nothing is reported once it is spent.
#[derive(Debug)]
pub(super) struct Budget {
    blocks: usize,
    /// Events whose effects on facts are followed.
    events: usize,
}

impl Default for Budget {
    /// About one second of work at most.
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

/// The maximum number of paths found by one query, one of which is reported.
const MAX_PATHS: usize = 8;
/// The maximum number of dominating blocks that facts are collected from.
const MAX_DOMINATING_BLOCKS: usize = 32;

/// Searches for paths in one function.
pub(super) struct Search<'a, 'p> {
    program: &'p Program<'p>,
    cfg: &'a Cfg,
    conditions: Conditions<'p>,
    /// By block.
    predecessors: Vec<Vec<BlockId>>,
    /// By loop head: the variables that the loop changes.
    changed: HashMap<BlockId, Vec<VariableId>>,
    /// By block and variable: the events that declare, read or write it.
    variable_events: HashMap<(BlockId, VariableId), Rc<[usize]>>,
    /// The facts of the last call of `facts_before`, with its block and event.
    last_facts: Option<(BlockId, usize, Facts)>,
}

/// A search for uninitialized reads of one variable.
#[derive(Debug, Clone, Copy)]
pub(super) struct Query {
    /// `None` for the function's result, which `return` writes and the caller reads.
    pub(super) variable: Option<VariableId>,
    /// The parts that are uninitialized at the start.
    pub(super) parts: Parts,
    /// The event that the search starts at, as block and index.
    pub(super) from: (BlockId, usize),
    /// Whether leaving the function reads the variable.
    pub(super) read_at_end: bool,
}

impl<'a, 'p> Search<'a, 'p> {
    pub(super) fn new(program: &'p Program<'p>, cfg: &'a Cfg) -> Self {
        let mut predecessors = vec![Vec::new(); cfg.blocks.len()];
        let mut variable_events: HashMap<_, Vec<usize>> = HashMap::new();
        for (block, basic_block) in cfg.blocks.iter().enumerate() {
            basic_block
                .end
                .for_each_successor(|successor| predecessors[successor].push(block));
            for (index, event) in basic_block.events.iter().enumerate() {
                if let Event::Begin(variable)
                | Event::Read {
                    part: Part { variable, .. },
                    ..
                }
                | Event::Write(Part { variable, .. }) = event
                {
                    variable_events.entry((block, *variable)).or_default().push(index);
                }
            }
        }
        Self {
            program,
            cfg,
            conditions: Conditions::new(program),
            predecessors,
            changed: HashMap::new(),
            variable_events: variable_events
                .into_iter()
                .map(|(place, events)| (place, events.into()))
                .collect(),
            last_facts: None,
        }
    }

    /// The paths to uninitialized reads; at most [`MAX_PATHS`].
    pub(super) fn paths(&mut self, query: Query, budget: &mut Budget) -> Vec<Path> {
        let (block, event) = query.from;
        if budget.is_spent() || self.program.deadline.is_over() {
            return Vec::new();
        }
        let mut paths = Vec::new();
        let mut visits = vec![Visit {
            block,
            previous: None,
            decision: None,
            unwritten: query.parts,
            known: self.facts_before(block, event, budget),
            repeated_loop: None,
        }];
        let mut seen = HashSet::new();
        let mut pending = vec![0];
        let mut skip = event;
        for _ in 0..MAX_VISITS_PER_QUERY {
            let Some(visit) = pending
                .pop()
                .filter(|_| !budget.is_spent() && paths.len() < MAX_PATHS)
            else {
                break;
            };
            budget.blocks -= 1;
            let mut unwritten = visits[visit].unwritten;
            let mut known = visits[visit].known.clone();
            let basic_block = &self.cfg.blocks[visits[visit].block];
            let from = std::mem::take(&mut skip);
            // If the block has no successors, the facts at its end are not needed.
            let has_successors = basic_block.end.has_successors();
            let own = match query.variable {
                Some(variable) if !has_successors => {
                    self.variable_events.get(&(visits[visit].block, variable))
                }
                _ => None,
            };
            let own: Rc<[usize]> = own.map_or_else(Rc::default, Rc::clone);
            let own = own.iter().copied().filter(|&index| index >= from);
            let all = if has_successors {
                from..basic_block.events.len()
            } else {
                0..0
            };
            for event in all.chain(own).map(|index| &basic_block.events[index]) {
                if unwritten == 0 {
                    break;
                }
                budget.events = budget.events.saturating_sub(usize::from(has_successors));
                match event {
                    // Declared again, in the next iteration of a loop.
                    Event::Begin(declared) if Some(*declared) == query.variable && visit > 0 => unwritten = 0,
                    Event::Read { part, expr } if Some(part.variable) == query.variable => {
                        let missing = part.parts & unwritten;
                        if missing != 0 && (!part.one_of || missing == part.parts) {
                            paths.extend(
                                self.trace(&visits, visit, query.variable, Some(*expr), missing)
                                    .path(),
                            );
                            unwritten &= !part.parts;
                        }
                    }
                    Event::Write(part) if Some(part.variable) == query.variable => unwritten &= !part.parts,
                    event => self.learn(&mut known, event),
                }
            }
            if unwritten == 0 {
                continue;
            }
            let ends = match basic_block.end {
                Terminator::Return => query.variable.is_some(),
                Terminator::FallOff => true,
                _ => false,
            };
            if ends && query.read_at_end && unwritten == query.parts {
                paths.extend(self.trace(&visits, visit, query.variable, None, unwritten).path());
            }
            for successor in self.successors(&visits, visit, unwritten, known) {
                if seen.insert((
                    successor.block,
                    successor.repeated_loop,
                    successor.unwritten,
                    successor.known.key(),
                )) {
                    visits.push(successor);
                    pending.push(visits.len() - 1);
                }
            }
        }
        paths
    }

    /// The visits that follow a visit.
    fn successors(&mut self, visits: &[Visit], index: usize, unwritten: Parts, known: Facts) -> Vec<Visit> {
        let visit = &visits[index];
        let go = |block, known, decision| Visit {
            block,
            previous: Some(index),
            decision,
            unwritten,
            known,
            repeated_loop: visit.repeated_loop,
        };
        match &self.cfg.blocks[visit.block].end {
            Terminator::Open | Terminator::Return | Terminator::FallOff => Vec::new(),
            Terminator::Goto(to) => vec![go(*to, known, None)],
            Terminator::BackEdge(head) => {
                let mut known = known;
                // Flags and relations between values stay as this path left them. Numbers change between
                // iterations, except those that the last iteration left unchanged: `t` is still its initial
                // 1e9.
                let mut entry = Some(visit);
                while let Some(earlier) = entry.filter(|earlier| earlier.block != *head) {
                    entry = earlier.previous.map(|previous| &visits[previous]);
                }
                let changed = || self.cfg.changed_in_loop(&self.predecessors, *head, visit.block);
                for variable in self.changed.entry(*head).or_insert_with(changed).iter().copied() {
                    let is_flag = self.program.tree[variable].ty == Type::BOOL;
                    let then = entry.and_then(|entry| entry.known.range(variable));
                    if !is_flag && then != known.range(variable) {
                        known.forget_range(variable);
                    }
                }
                known.begin_iteration();
                vec![Visit {
                    repeated_loop: Some(*head),
                    ..go(*head, known, None)
                }]
            }
            &Terminator::Branch {
                condition,
                yes,
                no,
                exited_loop,
            } => {
                let is_first_iteration = exited_loop.is_some() && exited_loop != visit.repeated_loop;
                let kind = |holds: bool| match exited_loop {
                    Some(_) if !holds => DecisionKind::ExitsLoop,
                    _ => DecisionKind::Holds(holds),
                };
                let decided = |holds| {
                    (
                        holds,
                        Some(Decision {
                            expr: condition,
                            kind: kind(holds),
                            label_count: 0,
                        }),
                    )
                };
                let outcomes = match self.conditions.holds(&known, condition) {
                    // A condition that is always true or false is not a decision; one that follows from
                    // earlier decisions is.
                    Some(holds) if self.conditions.holds(&Facts::default(), condition).is_some() => {
                        vec![(holds, None)]
                    }
                    Some(holds) => vec![decided(holds)],
                    // A loop is assumed to run at least once.
                    None if is_first_iteration => vec![(true, None)],
                    None => vec![decided(true), decided(false)],
                };
                let all = outcomes.into_iter().map(|(holds, decision)| {
                    let mut known = known.clone();
                    self.conditions.assume(&mut known, condition, holds);
                    let (to, other) = if holds { (yes, no) } else { (no, yes) };
                    go(to, known, decision.map(|decision| (decision, other)))
                });
                all.collect()
            }
            Terminator::Switch {
                selector,
                cases,
                default,
            } => {
                let decision = |label| Decision {
                    expr: *selector,
                    kind: DecisionKind::Selects(label),
                    label_count: cases.iter().map(|(labels, _)| labels.len()).sum(),
                };
                // The alternative: the first case with a different target.
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

    fn learn(&mut self, known: &mut Facts, event: &Event) {
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
            Event::Call(globals) => {
                for &variable in &**globals {
                    self.conditions.forget(known, variable);
                }
            }
            Event::Read { .. } => {}
        }
    }

    fn trace<'t>(
        &'t self,
        visits: &'t [Visit],
        last: usize,
        variable: Option<VariableId>,
        expr: Option<ExprId>,
        parts: Parts,
    ) -> Trace<'t> {
        Trace {
            program: self.program,
            cfg: self.cfg,
            visits,
            last,
            variable,
            expr,
            parts,
        }
    }

    /// The facts before an event, from the blocks that dominate it.
    fn facts_before(&mut self, block: BlockId, event: usize, budget: &mut Budget) -> Facts {
        let (mut known, from) = match self.last_facts.take() {
            Some((last, from, known)) if last == block && from <= event => (known, from),
            _ => (self.facts_at_entry(block, budget), 0),
        };
        let events = &self.cfg.blocks[block].events[from..event];
        budget.events = budget.events.saturating_sub(events.len());
        for event in events {
            self.learn(&mut known, event);
        }
        self.last_facts = Some((block, event, known.clone()));
        known
    }

    fn facts_at_entry(&mut self, block: BlockId, budget: &mut Budget) -> Facts {
        let mut path = vec![block];
        let mut first = block;
        while let [only] = self.predecessors[first][..]
            && path.len() < MAX_DOMINATING_BLOCKS
        {
            path.push(only);
            first = only;
        }
        let mut known = Facts::default();
        for pair in path.iter().rev().zip(path.iter().rev().skip(1)) {
            let (&from, &to) = pair;
            let events = &self.cfg.blocks[from].events;
            budget.events = budget.events.saturating_sub(events.len());
            for event in events {
                self.learn(&mut known, event);
            }
            if let Terminator::Branch { condition, yes, .. } = self.cfg.blocks[from].end {
                self.conditions.assume(&mut known, condition, yes == to);
            }
        }
        known
    }
}
