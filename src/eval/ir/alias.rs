//! Cells that an index may lead to: they lie together, and what is found of one holds of all.

use crate::ir::function::{Block, Cell, Cells, Flow, Node, Origin};

/// Which cells are reached by indices.
#[derive(Debug, Clone, Default)]
pub(crate) struct Groups {
    /// In order, apart from each other.
    ranges: Vec<Cells>,
}

impl Groups {
    pub(crate) fn of(flow: &Flow) -> Self {
        let mut ranges = Vec::new();
        collect(&flow.body, flow, &mut ranges);
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

    /// The group of a cell, if it is in one.
    pub(crate) fn find(&self, cell: Cell) -> Option<usize> {
        let after = self.ranges.partition_point(|cells| cells.first <= cell.0);
        let group = after.checked_sub(1)?;
        let cells = self.ranges[group];
        (cell.0 < cells.first + cells.count).then_some(group)
    }

    /// The cell by whose number something is kept that holds of a whole group: its own, or the first of its group.
    pub(crate) fn unit(&self, cell: Cell) -> usize {
        let group = self.find(cell);
        group.map_or(cell.0, |group| self.ranges[group].first) as usize
    }

    /// All groups.
    pub(crate) fn ranges(&self) -> &[Cells] {
        &self.ranges
    }
}

fn collect(block: &Block, flow: &Flow, ranges: &mut Vec<Cells>) {
    for node in block {
        match node {
            Node::Let(value) => {
                if let Origin::LoadAt { cells, .. } = flow.origin(*value) {
                    ranges.push(cells);
                }
            }
            Node::StoreAt { cells, .. } => ranges.push(*cells),
            _ => {}
        }
        node.for_each_block(|block| collect(block, flow, ranges));
    }
}
