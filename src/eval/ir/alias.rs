//! Alias analysis: cells that an index may select form a group. They are contiguous, and facts hold for a
//! whole group.

use super::function::{Block, Cell, Cells, Function, Node, ValueDef};

/// The groups of cells that are accessed by an index.
#[derive(Debug, Clone, Default)]
pub(crate) struct AliasGroups {
    /// Sorted and disjoint.
    ranges: Vec<Cells>,
}

impl AliasGroups {
    pub(crate) fn new(function: &Function) -> Self {
        let mut ranges = Vec::new();
        collect(&function.body, function, &mut ranges);
        ranges.sort_by_key(|cells| cells.first);
        let mut apart: Vec<Cells> = Vec::new();
        for cells in ranges {
            match apart.last_mut() {
                Some(last) if cells.first < last.first + last.count => {
                    let end = (last.first + last.count).max(cells.first + cells.count);
                    last.count = end - last.first;
                }
                _ => apart.push(cells),
            }
        }
        Self { ranges: apart }
    }

    /// Returns the group of a cell, if it is in one.
    pub(crate) fn find(&self, cell: Cell) -> Option<usize> {
        let after = self.ranges.partition_point(|cells| cells.first <= cell.0);
        let group = after.checked_sub(1)?;
        let cells = self.ranges[group];
        (cell.0 < cells.first + cells.count).then_some(group)
    }

    /// Returns the cell that represents the alias class: the first of the group, or the cell itself.
    pub(crate) fn representative(&self, cell: Cell) -> Cell {
        let group = self.find(cell);
        group.map_or(cell, |group| Cell(self.ranges[group].first))
    }

    /// Returns all groups.
    pub(crate) fn ranges(&self) -> &[Cells] {
        &self.ranges
    }
}

fn collect(block: &Block, function: &Function, ranges: &mut Vec<Cells>) {
    for node in block {
        match node {
            Node::Let(value) => {
                if let ValueDef::LoadAt { cells, .. } = function.def(*value) {
                    ranges.push(cells);
                }
            }
            Node::StoreAt { cells, .. } => ranges.push(*cells),
            _ => {}
        }
        node.for_each_block(|block| collect(block, function, ranges));
    }
}
