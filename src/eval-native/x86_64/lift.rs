//! Lifting: the steps of a region become operations on vector registers.
//!
//! A *region* is a sequence of steps without loops and without calls, which is executed for one vector of
//! pixels after the other. Branches in it are *guards*: operations that are skipped where a mask is empty.
//! Rows are read when they are first needed, and written at the end of the region if they are still needed
//! then. A guard that changes a row whose content is known changes a *merge*, a node that has the content
//! behind the guard; other rows are written at the end of the guard.

use std::ops::Range;

use toyproof_eval::native::{Kind, Location, LoweredCode, Map, RollbackMap, Step, Value, ValueDef};

use super::node::{Action, Guard, Item, NO_NODE, NodeId, Pool, Precision, Region, Table, TableRow, words};
use super::op;
use super::plan::{Class, Plan};

/// The content of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    Float(NodeId),
    Word(WordNode),
}

/// A word. In double precision, its lanes have 32 bits or 64; those of 64 are sign-extended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WordNode {
    Narrow(NodeId),
    Wide(NodeId),
}

/// What is known about a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Held {
    content: Content,
    /// The last step that may read it.
    end: u32,
    /// Whether the row in memory has another content.
    dirty: bool,
}

/// The end of rows that are always read.
const ALWAYS: u32 = u32::MAX;

/// Guards of fewer steps are executed without a branch.
const MIN_GUARD: usize = 4;

/// Lifts regions.
pub(super) struct Lifter<'a> {
    pub(super) lowered: &'a LoweredCode,
    pub(super) precision: Precision,
    /// Whether it lifts scalars.
    pub(super) scalar: bool,
    plan: &'a Plan,
    pub(super) pool: &'a mut Pool,
    pub(super) region: Region,
    rows: RollbackMap<TableRow, Held>,
    /// The nodes of scalars.
    scalars: Map<(Kind, u32), NodeId>,
    /// Words in the other form.
    pub(super) converted: RollbackMap<NodeId, NodeId>,
}

impl<'a> Lifter<'a> {
    pub(super) fn new(
        lowered: &'a LoweredCode,
        plan: &'a Plan,
        precision: Precision,
        scalar: bool,
        pool: &'a mut Pool,
    ) -> Self {
        Self {
            lowered,
            precision,
            scalar,
            plan,
            pool,
            region: Region::default(),
            rows: RollbackMap::default(),
            scalars: Map::default(),
            converted: RollbackMap::default(),
        }
    }

    /// The number of nodes so far.
    pub(super) fn size(&self) -> usize {
        self.region.nodes.len()
    }

    /// Ends the region: stores what steps from `next` on may read, with masks up to `last_mask`.
    pub(super) fn finish(mut self, next: u32, last_mask: Option<u32>) -> Region {
        let mut changed: Vec<TableRow> = self.rows.keys_since(0).collect();
        changed.sort_unstable();
        changed.dedup();
        for row in changed {
            let Some(held) = self.rows.get(row).filter(|held| held.dirty) else {
                continue;
            };
            let needed = match row {
                (Table::Mask, mask) => last_mask.is_some_and(|last| mask <= last),
                _ => held.end >= next,
            };
            if needed {
                self.store(row, held);
            }
        }
        // Also those that were stored in guards.
        let masks = self.region.items.iter().filter_map(|item| match item {
            Item::Store((Table::Mask, mask), ..) if Some(*mask) <= last_mask => Some(*mask),
            _ => None,
        });
        self.region.masks = masks.collect();
        self.region.masks.sort_unstable();
        self.region.masks.dedup();
        self.region
    }

    fn store(&mut self, row: TableRow, held: Held) {
        let node = match held.content {
            Content::Float(node) => node,
            Content::Word(word) => self.narrow(word),
        };
        let before = self.region.nodes.len() as NodeId;
        self.region.items.push(Item::Store(row, node, before));
        self.rows.set(row, Some(Held { dirty: false, ..held }));
    }

    // Rows.

    fn read(&mut self, row: TableRow) -> Content {
        if let Some(held) = self.rows.get(row) {
            return held.content;
        }
        let wide = row.0 == Table::Float || self.words_are_wide();
        let node = self.node(Action::Row(row), [NO_NODE; 3], wide);
        let content = match row.0 {
            Table::Float => Content::Float(node),
            _ => Content::Word(WordNode::Narrow(node)),
        };
        self.hold(row, content, ALWAYS, false);
        content
    }

    fn write(&mut self, row: TableRow, content: Content, end: u32) {
        self.hold(row, content, end, true);
    }

    fn hold(&mut self, row: TableRow, content: Content, end: u32, dirty: bool) {
        let held = Held { content, end, dirty };
        self.rows.set(row, Some(held));
    }

    fn scalar(&mut self, kind: Kind, scalar: u32) -> NodeId {
        if let Some(&node) = self.scalars.get(&(kind, scalar)) {
            return node;
        }
        let wide = kind == Kind::Float || self.words_are_wide();
        let node = self.node(Action::Scalar(kind, scalar), [NO_NODE; 3], wide);
        self.scalars.insert((kind, scalar), node);
        node
    }

    fn content(&mut self, kind: Kind, location: Option<Location>) -> Content {
        match (kind, location) {
            (Kind::Float, Some(Location::Row(row))) => self.read((Table::Float, row)),
            (Kind::Word, Some(Location::Row(row))) => self.read((Table::Word, row)),
            // Scalars are rows of one lane there.
            (Kind::Float, Some(Location::Scalar(scalar))) if self.scalar => self.read((Table::Float, scalar)),
            (Kind::Word, Some(Location::Scalar(scalar))) if self.scalar => self.read((Table::Word, scalar)),
            (Kind::Float, Some(Location::Scalar(scalar))) => Content::Float(self.scalar(kind, scalar)),
            (Kind::Word, Some(Location::Scalar(scalar))) => {
                Content::Word(WordNode::Narrow(self.scalar(kind, scalar)))
            }
            // The value is never computed.
            (Kind::Float, None) => Content::Float(self.float(0.0)),
            (Kind::Word, None) => Content::Word(WordNode::Narrow(self.constant(words(0)))),
        }
    }

    pub(super) fn value(&mut self, value: Value) -> Content {
        let kind = self.lowered.function.kind(value);
        self.content(kind, self.lowered.locations.value(value))
    }

    pub(super) fn float_value(&mut self, value: Value) -> NodeId {
        match self.value(value) {
            Content::Float(node) => node,
            Content::Word(word) => self.narrow(word),
        }
    }

    pub(super) fn word_value(&mut self, value: Value) -> WordNode {
        match self.value(value) {
            Content::Word(word) => word,
            Content::Float(node) => WordNode::Narrow(node),
        }
    }

    pub(super) fn mask(&mut self, mask: u32) -> WordNode {
        if mask == 0 {
            return WordNode::Narrow(self.constant(words(u32::MAX)));
        }
        match self.read((Table::Mask, mask)) {
            Content::Word(word) => word,
            Content::Float(node) => WordNode::Narrow(node),
        }
    }

    fn set_mask(&mut self, mask: u32, content: WordNode) {
        self.write((Table::Mask, mask), Content::Word(content), ALWAYS);
    }

    /// Returns the pixels of a mask whose condition is `when`.
    fn chosen(&mut self, mask: u32, condition: WordNode, when: bool) -> WordNode {
        match (mask, when) {
            (0, true) => condition,
            (0, false) => self.not(condition),
            (_, true) => {
                let mask = self.mask(mask);
                self.logic(op::VPAND, condition, mask)
            }
            (_, false) => {
                let mask = self.mask(mask);
                self.logic(op::VPANDN, condition, mask)
            }
        }
    }

    // Steps.

    /// Returns the row or scalar of a location, as a row.
    fn row(kind: Kind, location: Option<Location>) -> Option<TableRow> {
        let table = match kind {
            Kind::Float => Table::Float,
            Kind::Word => Table::Word,
        };
        match location? {
            Location::Row(row) | Location::Scalar(row) => Some((table, row)),
        }
    }

    /// Lifts a step, and if it has a guard, the steps in it. Returns the next one.
    pub(super) fn lift(&mut self, at: u32) -> u32 {
        let index = at as usize;
        if self.plan.classes[index] == Class::Vector {
            self.step(at);
            if let Some(until) = self.plan.guards[index] {
                self.guard(at, until);
                return until;
            }
        }
        at + 1
    }

    /// Lifts a step without its guard.
    pub(super) fn step(&mut self, at: u32) {
        let (step, mask) = &self.lowered.linear.steps[at as usize];
        let mask = u32::from(mask.0);
        let locations = &self.lowered.locations;
        match *step {
            Step::Compute(value) => {
                let function = &self.lowered.function;
                let kind = function.kind(value);
                let content = match function.def(value) {
                    ValueDef::Operation(operation, operands) => self.operation(operation, operands),
                    ValueDef::Load(cell) => {
                        self.content(function.cells[cell.0 as usize], locations.cell(cell))
                    }
                    _ => return,
                };
                if let Some(row) = Self::row(kind, locations.value(value)) {
                    self.write(row, content, locations.value_end(value));
                }
            }
            Step::Store { cell, value } => {
                let kind = self.lowered.function.cells[cell.0 as usize];
                let Some(row) = Self::row(kind, locations.cell(cell)) else {
                    return;
                };
                let mut content = self.value(value);
                if !self.scalar && self.lowered.shared[cell.0 as usize] && mask != 0 {
                    let condition = self.mask(mask);
                    let old = self.read(row);
                    content = match (content, old) {
                        (Content::Word(value), Content::Word(old)) => {
                            let [mask, value, old] = [condition, value, old].map(|word| self.narrow(word));
                            Content::Word(WordNode::Narrow(self.blend_words(mask, value, old)))
                        }
                        (Content::Float(value), Content::Float(old)) => {
                            let mask = self.as_lanes(condition);
                            Content::Float(self.blend(mask, value, old))
                        }
                        (content, _) => content,
                    };
                }
                self.write(row, content, locations.cell_end(cell));
            }
            Step::Split {
                condition,
                first,
                second,
                when,
                ..
            } => {
                let condition = self.word_value(condition);
                let chosen = self.chosen(mask, condition, when);
                if first != second {
                    let others = self.chosen(mask, condition, !when);
                    self.set_mask(u32::from(second.0), others);
                }
                self.set_mask(u32::from(first.0), chosen);
            }
            Step::Copy { to } => {
                let content = self.mask(mask);
                self.set_mask(u32::from(to.0), content);
            }
            Step::Remove {
                condition,
                masks: (inner, outer),
                ..
            } => {
                let (inner, outer) = (u32::from(inner.0), u32::from(outer.0));
                let gone = match condition {
                    Some((condition, when)) => {
                        let condition = self.word_value(condition);
                        self.chosen(inner, condition, when)
                    }
                    None => self.mask(inner),
                };
                for mask in outer..=inner {
                    let old = self.mask(mask);
                    let left = self.logic(op::VPANDN, gone, old);
                    self.set_mask(mask, left);
                }
            }
            Step::Iterate(_) => {
                let row = (Table::Iterations, 0);
                let mask = self.mask(mask);
                let mask = self.narrow(mask);
                if let Content::Word(WordNode::Narrow(old)) = self.read(row) {
                    let new = self.word2(op::VPSUBD, old, mask);
                    self.write(row, Content::Word(WordNode::Narrow(new)), ALWAYS);
                }
            }
            Step::Check {
                predicate,
                values,
                site,
            } => {
                let hit = self.predicate(predicate, values);
                let hit = self.chosen(mask, hit, true);
                let hit = self.narrow(hit);
                self.region.items.push(Item::Note(hit, site.0));
            }
            _ => {}
        }
    }

    /// The mask whose pixels a step's guard continues with.
    fn guarded_mask(&self, at: u32) -> u32 {
        let (step, mask) = &self.lowered.linear.steps[at as usize];
        match step {
            Step::Split { first, .. } => u32::from(first.0),
            _ => u32::from(mask.0),
        }
    }

    /// Lifts the steps between a step and the end of its guard, which are skipped if its mask is empty.
    fn guard(&mut self, at: u32, until: u32) {
        let guarded = self.guarded_mask(at);
        let steps = at + 1..until;
        let lifted = steps
            .clone()
            .filter(|&step| self.plan.classes[step as usize] == Class::Vector);
        if guarded == 0 || lifted.take(MIN_GUARD).count() < MIN_GUARD {
            self.range(steps);
            return;
        }
        let mut written = Vec::new();
        for step in steps.clone() {
            self.written(step, &mut written);
        }
        written.sort_unstable();
        written.dedup();
        let (mut merged, mut unknown) = (Vec::new(), Vec::new());
        for &row in written.iter().filter(|row| Self::is_kept(**row, guarded)) {
            if let Some(held) = self.rows.get(row) {
                let content = self.merge(row, held.content);
                merged.push((row, Held { content, ..held }));
            } else {
                unknown.push(row);
            }
        }
        let marks = (self.rows.mark(), self.converted.mark());
        let mask = match self.mask(guarded) {
            WordNode::Narrow(node) => self.converted.get(node).unwrap_or(node),
            WordNode::Wide(node) => node,
        };
        let (start, before) = (self.region.items.len(), self.region.nodes.len() as NodeId);
        self.region.items.push(Item::EndGuard(start));
        self.range(steps);
        let (mut merges, mut results) = (Vec::new(), Vec::new());
        for (row, before) in merged {
            let held = self.rows.get(row).unwrap_or(before);
            merges.push(self.merge_pair(before.content, held.content));
            let held = Held {
                content: before.content,
                dirty: true,
                ..held
            };
            results.push((row, held));
        }
        for row in unknown {
            if let Some(held) = self.rows.get(row).filter(|held| held.dirty && held.end >= until) {
                self.store(row, held);
            }
        }
        let inner = &self.region.items[start + 1..];
        let mut stored: Vec<TableRow> = inner
            .iter()
            .filter_map(|item| match item {
                Item::Store(row, ..) => Some(*row),
                _ => None,
            })
            .collect();
        stored.sort_unstable();
        stored.dedup();
        self.region.items[start] = Item::Guard(Guard {
            mask,
            rows: stored,
            before,
            merges,
        });
        self.region.items.push(Item::EndGuard(start));
        self.rows.roll_back(marks.0);
        self.converted.roll_back(marks.1);
        for row in written {
            self.rows.set(row, None);
        }
        for (row, held) in results {
            self.rows.set(row, Some(held));
        }
    }

    /// Returns a merge whose content is first that of a row.
    fn merge(&mut self, row: TableRow, content: Content) -> Content {
        let merge =
            |lifter: &mut Self, from, wide| lifter.node(Action::Merge, [from, NO_NODE, NO_NODE], wide);
        match content {
            Content::Float(node) => Content::Float(merge(self, node, true)),
            // Masks are mostly used with floats.
            Content::Word(word)
                if self.precision.is_double() && (row.0 == Table::Mask || self.has_wide(word)) =>
            {
                let node = self.as_lanes(word);
                Content::Word(WordNode::Wide(merge(self, node, true)))
            }
            Content::Word(word) => {
                let (node, wide) = (self.narrow(word), self.words_are_wide());
                Content::Word(WordNode::Narrow(merge(self, node, wide)))
            }
        }
    }

    /// Returns a merge and the node that is assigned to it.
    fn merge_pair(&mut self, merge: Content, last: Content) -> [NodeId; 2] {
        let last = match (merge, last) {
            (Content::Word(WordNode::Wide(_)), Content::Word(last)) => self.as_lanes(last),
            (_, Content::Word(last)) => self.narrow(last),
            (_, Content::Float(last)) => last,
        };
        let (Content::Float(merge) | Content::Word(WordNode::Wide(merge) | WordNode::Narrow(merge))) = merge;
        [merge, last]
    }

    fn range(&mut self, steps: Range<u32>) {
        let mut at = steps.start;
        while at < steps.end {
            at = self.lift(at);
        }
    }

    /// Whether a row that a guard changes can be read behind it: of masks, those around the guarded one.
    fn is_kept(row: TableRow, guarded: u32) -> bool {
        row.0 != Table::Mask || row.1 < guarded
    }

    /// Adds the rows that a step writes.
    fn written(&self, at: u32, rows: &mut Vec<TableRow>) {
        if self.plan.classes[at as usize] != Class::Vector {
            return;
        }
        let function = &self.lowered.function;
        let locations = &self.lowered.locations;
        match self.lowered.linear.steps[at as usize].0 {
            Step::Compute(value) => rows.extend(Self::row(function.kind(value), locations.value(value))),
            Step::Store { cell, .. } => {
                rows.extend(Self::row(function.cells[cell.0 as usize], locations.cell(cell)));
            }
            Step::Split { first, second, .. } => {
                rows.extend([first, second].map(|mask| (Table::Mask, u32::from(mask.0))));
            }
            Step::Copy { to } => rows.push((Table::Mask, u32::from(to.0))),
            Step::Remove {
                masks: (inner, outer),
                ..
            } => {
                rows.extend((outer.0..=inner.0).map(|mask| (Table::Mask, u32::from(mask))));
            }
            _ => {}
        }
    }
}
