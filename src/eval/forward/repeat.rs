//! Loops that stay loops: what they store is unknown in them.

use super::Forward;
use crate::eval::flow::{Block, Cell, Cells, NONE, Node, Value};

impl Forward<'_> {
    /// A loop that stays one.
    pub(super) fn repeat(&mut self, body: Block, out: &mut Block) {
        let mut stored = Stored::default();
        stored.collect(&body);
        for value in stored.values {
            self.alias[value.0 as usize] = NONE;
        }
        for (cell, value) in stored.cells {
            self.stored(cell);
            if self.known.map.get(&cell) != Some(&self.alias[value.0 as usize]) {
                self.known.set(cell, None);
            }
        }
        for cells in stored.ranges {
            self.forget(cells);
        }
        self.loops.push(self.known.mark());
        let body = self.block(body);
        self.loops.pop();
        self.live = false;
        out.push(Node::Loop { body });
    }
}

/// What a block computes and stores to.
#[derive(Debug, Default)]
struct Stored {
    values: Vec<Value>,
    cells: Vec<(Cell, Value)>,
    ranges: Vec<Cells>,
}

impl Stored {
    pub(super) fn collect(&mut self, block: &Block) {
        for node in block {
            match node {
                Node::Let(value) => self.values.push(*value),
                Node::Store { cell, value } => self.cells.push((*cell, *value)),
                Node::StoreAt { cells, .. } => self.ranges.push(*cells),
                _ => {}
            }
            node.for_each_block(|block| self.collect(block));
        }
    }
}
