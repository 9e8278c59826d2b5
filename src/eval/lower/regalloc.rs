//! Registers: where values and cells live while a batch runs.
//!
//! What varies takes a row of pixels, what does not one scalar. Rows are used again as soon as what they held is read no more (linear
//! scan; Poletto and Sarkar, “Linear Scan Register Allocation”, TOPLAS 21(5), 1999), so that a batch stays in the cache. A load
//! that nothing is stored over before its last use is the cell itself; a value that goes only into a cell is computed there.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::ir::alias::Groups;
use crate::ir::function::{Cell, Cells, Flow, Origin, Value};
use crate::ir::operation::Kind;
use crate::lower::linearize::{Flat, Step};
use crate::opt::divergence::Varying;

/// Where something lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Home {
    /// A row of the floats or words, told by its kind.
    Row(u32),
    /// A scalar.
    Scalar(u32),
}

/// Where everything lives, and how much room that takes.
#[derive(Debug)]
pub(crate) struct Homes {
    values: Vec<Option<Home>>,
    cells: Vec<Option<Home>>,
    /// Whether a step needs not be done: its value is where it should be.
    pub(crate) idle: Vec<bool>,
    pub(crate) rows: PerKind,
    pub(crate) scalars: PerKind,
}

/// One number for floats, one for words.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct PerKind {
    pub(crate) floats: u32,
    pub(crate) words: u32,
}

impl PerKind {
    fn of(&mut self, kind: Kind) -> &mut u32 {
        match kind {
            Kind::Float => &mut self.floats,
            Kind::Word => &mut self.words,
        }
    }
}

impl Homes {
    /// The home of a value that is computed, or a constant.
    pub(crate) fn value(&self, value: Value) -> Option<Home> {
        self.values[value.0 as usize]
    }

    /// The home of a cell that is accessed.
    pub(crate) fn cell(&self, cell: Cell) -> Option<Home> {
        self.cells[cell.0 as usize]
    }
}

/// Finds homes.
pub(crate) fn allocate(flow: &Flow, flat: &Flat, varying: &Varying, groups: &Groups) -> Homes {
    let mut uses = Uses::new(flow, flat, groups);
    uses.collect();
    let mut pass = Allocate {
        idle: vec![false; flat.steps.len()],
        same: vec![None; flow.origins.len()],
        uses,
        varying,
    };
    pass.elide_loads();
    pass.elide_stores();
    pass.assign()
}

const NEVER: u32 = u32::MAX;

/// From the first to the last position at which something is needed.
#[derive(Debug, Clone, Copy)]
struct Span {
    start: u32,
    end: u32,
}

impl Span {
    const NONE: Self = Self { start: NEVER, end: 0 };

    fn add(&mut self, at: u32) {
        self.start = self.start.min(at);
        self.end = self.end.max(at);
    }
}

/// Who is needed where.
struct Uses<'a> {
    flow: &'a Flow,
    flat: &'a Flat,
    groups: &'a Groups,
    /// Of each step, its innermost loop.
    loop_of: Vec<u32>,
    /// Of each loop, the one around it.
    loop_parent: Vec<u32>,
    values: Vec<Span>,
    cells: Vec<Span>,
    /// Where each cell is stored, in order; of those in groups, where any of the group is.
    stores: Vec<Vec<u32>>,
    /// Where each cell is read.
    loads: Vec<Vec<u32>>,
    /// How often each value is used.
    counts: Vec<u32>,
}

impl<'a> Uses<'a> {
    fn new(flow: &'a Flow, flat: &'a Flat, groups: &'a Groups) -> Self {
        let mut loop_of = vec![NEVER; flat.steps.len()];
        let mut loop_parent = vec![NEVER; flat.loops.len()];
        // Inner loops come first: whoever fills a position later is around.
        for (id, &(first, last)) in flat.loops.iter().enumerate().rev() {
            loop_parent[id] = loop_of[first as usize];
            loop_of[first as usize..=last as usize].fill(id as u32);
        }
        Self {
            flow,
            flat,
            groups,
            loop_of,
            loop_parent,
            values: vec![Span::NONE; flow.origins.len()],
            cells: vec![Span::NONE; flow.cells.len()],
            stores: vec![Vec::new(); flow.cells.len()],
            loads: vec![Vec::new(); flow.cells.len()],
            counts: vec![0; flow.origins.len()],
        }
    }

    /// The last position at which something that began at `start` is needed if it is used at `at`: in a loop that it
    /// began before, until the loop's end.
    fn until(&self, start: u32, at: u32) -> u32 {
        let mut end = at;
        let mut around = self.loop_of[at as usize];
        while around != NEVER {
            let (first, last) = self.flat.loops[around as usize];
            if first <= start {
                break;
            }
            end = last;
            around = self.loop_parent[around as usize];
        }
        end
    }

    fn read(&mut self, value: Value, at: u32) {
        let index = value.0 as usize;
        self.counts[index] += 1;
        let start = self.values[index].start;
        if start != NEVER {
            let end = self.until(start, at);
            self.values[index].add(end);
        }
    }

    fn cell_at(&mut self, cell: Cell, at: u32) {
        let index = cell.0 as usize;
        self.cells[index].add(at);
        let end = self.until(self.cells[index].start, at);
        self.cells[index].add(end);
    }

    fn collect(&mut self) {
        let flat = self.flat;
        for &value in &flat.constants {
            let mut operands = Vec::new();
            self.flow
                .origin(value)
                .for_each_operand(|operand| operands.push(operand));
            for operand in operands {
                self.counts[operand.0 as usize] += 1;
            }
        }
        for (at, (step, _)) in (0..).zip(&flat.steps) {
            match step {
                Step::Compute(value) => {
                    let origin = self.flow.origin(*value);
                    let mut operands = Vec::new();
                    origin.for_each_operand(|operand| operands.push(operand));
                    for operand in operands {
                        self.read(operand, at);
                    }
                    self.values[value.0 as usize].add(at);
                    if let Origin::Load(cell) = origin {
                        self.cell_at(cell, at);
                        self.loads[cell.0 as usize].push(at);
                    }
                }
                Step::Store { cell, value } => {
                    self.read(*value, at);
                    self.cell_at(*cell, at);
                    let unit = self.groups.unit(*cell);
                    self.stores[unit].push(at);
                }
                Step::StoreAt {
                    cells, index, value, ..
                } => {
                    self.read(*index, at);
                    self.read(*value, at);
                    let unit = self.groups.unit(Cell(cells.first));
                    self.stores[unit].push(at);
                }
                Step::Split { condition, .. }
                | Step::Remove {
                    condition: Some((condition, _)),
                    ..
                }
                | Step::JumpIf { condition, .. } => self.read(*condition, at),
                Step::Check { values, .. } => {
                    for &value in values.iter().filter(|&&value| value != crate::ir::function::NONE) {
                        self.read(value, at);
                    }
                }
                Step::Tell { value, .. } if *value != crate::ir::function::NONE => self.read(*value, at),
                _ => {}
            }
        }
        // The picture is read after the end.
        let end = self.flat.steps.len() as u32;
        for value in self.flow.output {
            self.counts[value.0 as usize] += 1;
            self.values[value.0 as usize].add(end);
        }
    }
}

struct Allocate<'a> {
    uses: Uses<'a>,
    varying: &'a Varying,
    idle: Vec<bool>,
    /// The cell that a value lives in.
    same: Vec<Option<Cell>>,
}

impl Allocate<'_> {
    /// Lets loads be the cells themselves.
    fn elide_loads(&mut self) {
        for (at, (step, _)) in (0..).zip(&self.uses.flat.steps) {
            let &Step::Compute(value) = step else {
                continue;
            };
            let Origin::Load(cell) = self.uses.flow.origin(value) else {
                continue;
            };
            let Span { end, .. } = self.uses.values[value.0 as usize];
            let stores = &self.uses.stores[self.uses.groups.unit(cell)];
            let next = stores.partition_point(|&store| store <= at);
            if stores.get(next).is_none_or(|&store| store > end) {
                self.idle[at as usize] = true;
                self.same[value.0 as usize] = Some(cell);
                self.uses.cells[cell.0 as usize].add(end);
                self.uses.loads[cell.0 as usize].push(end);
            }
        }
        for loads in &mut self.uses.loads {
            loads.sort_unstable();
        }
    }

    /// Lets values be computed where they are stored.
    fn elide_stores(&mut self) {
        for (at, (step, mask)) in (0u32..).zip(&self.uses.flat.steps) {
            let &Step::Store { cell, value } = step else {
                continue;
            };
            let Span { start, end } = self.uses.values[value.0 as usize];
            let index = value.0 as usize;
            let alone = self.uses.counts[index] == 1 && end == at && start < at;
            if !alone
                || self.same[index].is_some()
                || self.varying.is_shared(cell)
                || self.varying.value(value) != self.varying.cell(cell)
                || self.uses.groups.find(cell).is_some()
            {
                continue;
            }
            let steps = &self.uses.flat.steps[start as usize..at as usize];
            let straight = steps.iter().all(|(step, other)| {
                other == mask && matches!(step, Step::Compute(_) | Step::Store { .. } | Step::Check { .. })
            });
            let none_between = |positions: &[u32], from: u32| {
                let next = positions.partition_point(|&position| position < from);
                positions.get(next).is_none_or(|&position| position > at)
            };
            let stores = &self.uses.stores[cell.0 as usize];
            let others = stores.partition_point(|&store| store < start);
            if straight
                && none_between(&self.uses.loads[cell.0 as usize], start + 1)
                && stores.get(others) == Some(&at)
            {
                self.idle[at as usize] = true;
                self.same[index] = Some(cell);
                self.uses.cells[cell.0 as usize].add(start);
            }
        }
    }

    fn assign(self) -> Homes {
        let Self {
            uses,
            varying,
            idle,
            same,
        } = self;
        let flow = uses.flow;
        let mut homes = Homes {
            values: vec![None; flow.origins.len()],
            cells: vec![None; flow.cells.len()],
            idle,
            rows: PerKind::default(),
            scalars: PerKind::default(),
        };
        for &Cells { first, count } in uses.groups.ranges() {
            // Beside each other in both kinds, so that one index leads to either.
            let varies = varying.cell(Cell(first));
            let room = if varies {
                &mut homes.rows
            } else {
                &mut homes.scalars
            };
            let start = room.floats.max(room.words);
            for cell in 0..count {
                let home = if varies { Home::Row } else { Home::Scalar };
                homes.cells[(first + cell) as usize] = Some(home(start + cell));
            }
            (room.floats, room.words) = (start + count, start + count);
        }
        for kind in [Kind::Float, Kind::Word] {
            assign_kind(kind, &uses, varying, &same, &mut homes);
        }
        for (value, cell) in same.iter().enumerate() {
            if let Some(cell) = cell {
                homes.values[value] = homes.cells[cell.0 as usize];
            }
        }
        homes
    }
}

/// Who wants a home.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Tenant {
    Value(u32),
    Cell(u32),
}

fn assign_kind(kind: Kind, uses: &Uses<'_>, varying: &Varying, same: &[Option<Cell>], homes: &mut Homes) {
    let flow = uses.flow;
    let mut waiting: Vec<(u32, u32, Tenant)> = Vec::new();
    for (at, &Span { start, end }) in uses.values.iter().enumerate() {
        let value = Value(at as u32);
        if flow.kind(value) != kind || same[at].is_some() {
            continue;
        }
        if start != NEVER && varying.value(value) && !matches!(flow.origin(value), Origin::FragCoord(_)) {
            waiting.push((start, end, Tenant::Value(value.0)));
        } else if matches!(flow.origin(value), Origin::FragCoord(_)) {
            // Written once for each batch, before all steps.
            waiting.push((0, NEVER, Tenant::Value(value.0)));
        } else if uses.counts[at] > 0 || start != NEVER {
            let next = homes.scalars.of(kind);
            homes.values[at] = Some(Home::Scalar(*next));
            *next += 1;
        }
    }
    for (at, &Span { start, end }) in uses.cells.iter().enumerate() {
        let cell = Cell(at as u32);
        if flow.cells[at] != kind || homes.cells[at].is_some() || start == NEVER {
            continue;
        }
        if varying.cell(cell) {
            waiting.push((start, end, Tenant::Cell(cell.0)));
        } else {
            let next = homes.scalars.of(kind);
            homes.cells[at] = Some(Home::Scalar(*next));
            *next += 1;
        }
    }
    waiting.sort_unstable();
    let mut free: BinaryHeap<Reverse<u32>> = BinaryHeap::new();
    let mut taken: BinaryHeap<Reverse<(u32, u32)>> = BinaryHeap::new();
    for (start, end, tenant) in waiting {
        // A step reads before it writes: what ends where this begins makes room for it.
        while let Some(&Reverse((until, row))) = taken.peek()
            && until <= start
        {
            taken.pop();
            free.push(Reverse(row));
        }
        let row = if let Some(Reverse(row)) = free.pop() {
            row
        } else {
            let next = homes.rows.of(kind);
            *next += 1;
            *next - 1
        };
        taken.push(Reverse((end, row)));
        match tenant {
            Tenant::Value(value) => homes.values[value as usize] = Some(Home::Row(row)),
            Tenant::Cell(cell) => homes.cells[cell as usize] = Some(Home::Row(row)),
        }
    }
}
