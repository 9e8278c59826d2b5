//! Register allocation: the location of each value and cell during a run.
//!
//! Divergent values take a row of pixels, uniform ones a scalar. Rows are reused as soon as their value is
//! dead (linear scan; Poletto and Sarkar, “Linear Scan Register Allocation”, TOPLAS 21(5), 1999), so that a
//! batch stays in the cache. A load whose cell is not overwritten before its last use is elided; a value that
//! is only stored to a cell is computed there.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::ir::{AliasGroups, Cell, Cells, Function, Kind, Value, ValueDef};
use crate::lower::linearize::{LinearCode, Step};
use crate::opt::divergence::Divergence;

/// The location of a value or cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// A row of floats or words, depending on the kind.
    Row(u32),
    /// A scalar of floats or words, depending on the kind.
    Scalar(u32),
}

/// The location of every value and cell, and the number of rows and scalars.
#[derive(Debug)]
#[doc(hidden)]
pub struct Allocation {
    values: Vec<Option<Location>>,
    cells: Vec<Option<Location>>,
    /// The last step that may read each value.
    value_ends: Vec<u32>,
    /// The last step that may read each cell.
    cell_ends: Vec<u32>,
    /// Whether a step is elided, since the value is in the location already.
    pub elided: Vec<bool>,
    pub(crate) rows: PerKind,
    pub(crate) scalars: PerKind,
}

/// A number for floats and one for words.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct PerKind {
    pub(crate) floats: u32,
    pub(crate) words: u32,
}

impl PerKind {
    fn get_mut(&mut self, kind: Kind) -> &mut u32 {
        match kind {
            Kind::Float => &mut self.floats,
            Kind::Word => &mut self.words,
        }
    }
}

impl Allocation {
    /// Returns the location of a value that is computed, or a constant.
    #[must_use]
    pub fn value(&self, value: Value) -> Option<Location> {
        self.values[value.0 as usize]
    }

    /// Returns the last step that may read a value, or whatever shares its location.
    #[must_use]
    pub fn value_end(&self, value: Value) -> u32 {
        self.value_ends[value.0 as usize]
    }

    /// Returns the last step that may read a cell.
    #[must_use]
    pub fn cell_end(&self, cell: Cell) -> u32 {
        self.cell_ends[cell.0 as usize]
    }

    /// Returns the location of a cell that is accessed.
    #[must_use]
    pub fn cell(&self, cell: Cell) -> Option<Location> {
        self.cells[cell.0 as usize]
    }
}

/// Assigns locations to all values and cells.
pub(crate) fn allocate_registers(
    function: &Function,
    linear: &LinearCode,
    divergence: &Divergence,
    groups: &AliasGroups,
) -> Allocation {
    let mut uses = Uses::new(function, linear, groups);
    uses.collect();
    let mut pass = Allocator {
        elided: vec![false; linear.steps.len()],
        cell_of: vec![None; function.defs.len()],
        uses,
        divergence,
    };
    pass.elide_loads();
    pass.elide_stores();
    pass.assign()
}

const NEVER: u32 = u32::MAX;

/// The range from the definition to the last use, as step indices.
#[derive(Debug, Clone, Copy)]
struct LiveRange {
    start: u32,
    end: u32,
}

impl LiveRange {
    const NONE: Self = Self { start: NEVER, end: 0 };

    fn add(&mut self, at: u32) {
        self.start = self.start.min(at);
        self.end = self.end.max(at);
    }
}

/// The uses of values and cells.
struct Uses<'a> {
    function: &'a Function,
    linear: &'a LinearCode,
    groups: &'a AliasGroups,
    /// The innermost loop of each step.
    loop_of: Vec<u32>,
    /// The enclosing loop of each loop.
    loop_parent: Vec<u32>,
    values: Vec<LiveRange>,
    cells: Vec<LiveRange>,
    /// The steps that store to each cell, in order; for groups, to any cell of the group.
    stores: Vec<Vec<u32>>,
    /// The steps that load each cell.
    loads: Vec<Vec<u32>>,
    /// The number of uses of each value.
    counts: Vec<u32>,
}

impl<'a> Uses<'a> {
    fn new(function: &'a Function, linear: &'a LinearCode, groups: &'a AliasGroups) -> Self {
        let mut loop_of = vec![NEVER; linear.steps.len()];
        let mut loop_parent = vec![NEVER; linear.loops.len()];
        // Inner loops come first, so in reverse order the later fill is the inner loop.
        for (id, &(first, last)) in linear.loops.iter().enumerate().rev() {
            loop_parent[id] = loop_of[first as usize];
            loop_of[first as usize..=last as usize].fill(id as u32);
        }
        Self {
            function,
            linear,
            groups,
            loop_of,
            loop_parent,
            values: vec![LiveRange::NONE; function.defs.len()],
            cells: vec![LiveRange::NONE; function.cells.len()],
            stores: vec![Vec::new(); function.cells.len()],
            loads: vec![Vec::new(); function.cells.len()],
            counts: vec![0; function.defs.len()],
        }
    }

    /// Returns the last step at which a value defined at `start` and used at `at` is live: the end of the
    /// outermost loop that contains the use but not the definition.
    fn until(&self, start: u32, at: u32) -> u32 {
        let mut end = at;
        let mut around = self.loop_of[at as usize];
        while around != NEVER {
            let (first, last) = self.linear.loops[around as usize];
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
        let linear = self.linear;
        for &value in &linear.constants {
            let mut operands = Vec::new();
            self.function
                .def(value)
                .for_each_operand(|operand| operands.push(operand));
            for operand in operands {
                self.counts[operand.0 as usize] += 1;
            }
        }
        for (at, (step, _)) in (0..).zip(&linear.steps) {
            match step {
                Step::Compute(value) => {
                    let def = self.function.def(*value);
                    let mut operands = Vec::new();
                    def.for_each_operand(|operand| operands.push(operand));
                    for operand in operands {
                        self.read(operand, at);
                    }
                    self.values[value.0 as usize].add(at);
                    if let ValueDef::Load(cell) = def {
                        self.cell_at(cell, at);
                        self.loads[cell.0 as usize].push(at);
                    }
                }
                Step::Store { cell, value } => {
                    self.read(*value, at);
                    self.cell_at(*cell, at);
                    let unit = self.groups.representative(*cell).index();
                    self.stores[unit].push(at);
                }
                Step::StoreAt {
                    cells, index, value, ..
                } => {
                    self.read(*index, at);
                    self.read(*value, at);
                    let unit = self.groups.representative(Cell(cells.first)).index();
                    self.stores[unit].push(at);
                }
                Step::Split { condition, .. }
                | Step::Remove {
                    condition: Some((condition, _)),
                    ..
                }
                | Step::JumpIf { condition, .. } => self.read(*condition, at),
                Step::Check { values, .. } => {
                    for &value in values.iter().filter(|&&value| value != crate::ir::NONE) {
                        self.read(value, at);
                    }
                }
                Step::Trace { value, .. } if *value != crate::ir::NONE => self.read(*value, at),
                _ => {}
            }
        }
        // The output is read after the last step.
        let end = self.linear.steps.len() as u32;
        for value in self.function.output {
            self.counts[value.0 as usize] += 1;
            self.values[value.0 as usize].add(end);
        }
    }
}

struct Allocator<'a> {
    uses: Uses<'a>,
    divergence: &'a Divergence,
    elided: Vec<bool>,
    /// The cell whose location a value shares.
    cell_of: Vec<Option<Cell>>,
}

impl Allocator<'_> {
    /// Elides loads: their values share the location of the cell.
    fn elide_loads(&mut self) {
        for (at, (step, _)) in (0..).zip(&self.uses.linear.steps) {
            let &Step::Compute(value) = step else {
                continue;
            };
            let ValueDef::Load(cell) = self.uses.function.def(value) else {
                continue;
            };
            let LiveRange { end, .. } = self.uses.values[value.0 as usize];
            let stores = &self.uses.stores[self.uses.groups.representative(cell).index()];
            let next = stores.partition_point(|&store| store <= at);
            if stores.get(next).is_none_or(|&store| store > end) {
                self.elided[at as usize] = true;
                self.cell_of[value.0 as usize] = Some(cell);
                self.uses.cells[cell.0 as usize].add(end);
                self.uses.loads[cell.0 as usize].push(end);
            }
        }
        for loads in &mut self.uses.loads {
            loads.sort_unstable();
        }
    }

    /// Elides stores: values are computed in the location of the cell.
    fn elide_stores(&mut self) {
        for (at, (step, mask)) in (0u32..).zip(&self.uses.linear.steps) {
            let &Step::Store { cell, value } = step else {
                continue;
            };
            let LiveRange { start, end } = self.uses.values[value.0 as usize];
            let index = value.0 as usize;
            let single_use = self.uses.counts[index] == 1 && end == at && start < at;
            if !single_use
                || self.cell_of[index].is_some()
                || self.divergence.is_shared(cell)
                || self.divergence.value(value) != self.divergence.cell(cell)
                || self.uses.groups.find(cell).is_some()
            {
                continue;
            }
            let steps = &self.uses.linear.steps[start as usize..at as usize];
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
                self.elided[at as usize] = true;
                self.cell_of[index] = Some(cell);
                self.uses.cells[cell.0 as usize].add(start);
            }
        }
    }

    fn assign(self) -> Allocation {
        let Self {
            uses,
            divergence,
            elided,
            cell_of,
        } = self;
        let function = uses.function;
        let mut locations = Allocation {
            values: vec![None; function.defs.len()],
            cells: vec![None; function.cells.len()],
            value_ends: uses.values.iter().map(|range| range.end).collect(),
            cell_ends: uses.cells.iter().map(|range| range.end).collect(),
            elided,
            rows: PerKind::default(),
            scalars: PerKind::default(),
        };
        for &Cells { first, count } in uses.groups.ranges() {
            // At the same offsets in both kinds, so that one index works for either.
            let varies = divergence.cell(Cell(first));
            let room = if varies {
                &mut locations.rows
            } else {
                &mut locations.scalars
            };
            let start = room.floats.max(room.words);
            for cell in 0..count {
                let location = if varies { Location::Row } else { Location::Scalar };
                locations.cells[(first + cell) as usize] = Some(location(start + cell));
                // An index may select it at any time.
                locations.cell_ends[(first + cell) as usize] = NEVER;
            }
            (room.floats, room.words) = (start + count, start + count);
        }
        for kind in [Kind::Float, Kind::Word] {
            assign_kind(kind, &uses, divergence, &cell_of, &mut locations);
        }
        for (value, cell) in cell_of.iter().enumerate() {
            if let Some(cell) = cell {
                locations.values[value] = locations.cells[cell.0 as usize];
                locations.value_ends[value] = locations.cell_ends[cell.0 as usize];
            }
        }
        locations
    }
}

/// The owner of a live range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum IntervalOwner {
    Value(u32),
    Cell(u32),
}

fn assign_kind(
    kind: Kind,
    uses: &Uses<'_>,
    divergence: &Divergence,
    cell_of: &[Option<Cell>],
    locations: &mut Allocation,
) {
    let function = uses.function;
    let mut intervals: Vec<(u32, u32, IntervalOwner)> = Vec::new();
    for (at, &LiveRange { start, end }) in uses.values.iter().enumerate() {
        let value = Value(at as u32);
        if function.kind(value) != kind || cell_of[at].is_some() {
            continue;
        }
        if matches!(
            function.def(value),
            ValueDef::FragCoord(_) | ValueDef::Parameter(..)
        ) {
            // Written once for each batch, before all steps.
            intervals.push((0, NEVER, IntervalOwner::Value(value.0)));
        } else if start != NEVER && divergence.value(value) {
            intervals.push((start, end, IntervalOwner::Value(value.0)));
        } else if uses.counts[at] > 0 || start != NEVER {
            let next = locations.scalars.get_mut(kind);
            locations.values[at] = Some(Location::Scalar(*next));
            *next += 1;
        }
    }
    for (at, &LiveRange { start, end }) in uses.cells.iter().enumerate() {
        let cell = Cell(at as u32);
        if function.cells[at] != kind || locations.cells[at].is_some() || start == NEVER {
            continue;
        }
        if divergence.cell(cell) {
            intervals.push((start, end, IntervalOwner::Cell(cell.0)));
        } else {
            let next = locations.scalars.get_mut(kind);
            locations.cells[at] = Some(Location::Scalar(*next));
            *next += 1;
        }
    }
    intervals.sort_unstable();
    let mut free: BinaryHeap<Reverse<u32>> = BinaryHeap::new();
    let mut occupied: BinaryHeap<Reverse<(u32, u32)>> = BinaryHeap::new();
    for (start, end, owner) in intervals {
        // A step reads before it writes: a range that begins where this one ends can reuse its row.
        while let Some(&Reverse((until, row))) = occupied.peek()
            && until <= start
        {
            occupied.pop();
            free.push(Reverse(row));
        }
        let row = if let Some(Reverse(row)) = free.pop() {
            row
        } else {
            let next = locations.rows.get_mut(kind);
            *next += 1;
            *next - 1
        };
        occupied.push(Reverse((end, row)));
        match owner {
            IntervalOwner::Value(value) => locations.values[value as usize] = Some(Location::Row(row)),
            IntervalOwner::Cell(cell) => locations.cells[cell as usize] = Some(Location::Row(row)),
        }
    }
}
