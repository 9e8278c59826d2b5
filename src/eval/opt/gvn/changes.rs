//! The changes made by loops and scopes, collected in one traversal. The list is flat: an inner scope's range
//! lies within the outer one's.

use std::ops::Range;

use crate::ir::{Block, Cell, Cells, LoopId, Node, Scope, Value};

/// A change made by a node.
#[derive(Debug, Clone, Copy)]
pub(super) enum Change {
    Computed(Value),
    Stored(Cell, Value),
    StoredAt(Cells),
}

/// All changes made by a function, in order.
#[derive(Debug)]
pub(super) struct Changes {
    list: Vec<Change>,
    /// The range of each loop in the list.
    loops: Vec<Range<usize>>,
    scopes: Vec<Range<usize>>,
}

impl Changes {
    pub(super) fn new(body: &Block, scopes: u32, loops: usize) -> Self {
        let mut changes = Self {
            list: Vec::new(),
            loops: vec![0..0; loops],
            scopes: vec![0..0; scopes as usize],
        };
        changes.collect(body);
        changes
    }

    pub(super) fn of_scope(&self, scope: Scope) -> Range<usize> {
        self.scopes[scope.0 as usize].clone()
    }

    pub(super) fn of_loop(&self, id: LoopId) -> Range<usize> {
        self.loops[id.0 as usize].clone()
    }

    pub(super) fn get(&self, at: usize) -> Change {
        self.list[at]
    }

    fn collect(&mut self, block: &Block) {
        for node in block {
            match node {
                Node::Let(value) => self.list.push(Change::Computed(*value)),
                Node::Store { cell, value } => self.list.push(Change::Stored(*cell, *value)),
                Node::StoreAt { cells, .. } => self.list.push(Change::StoredAt(*cells)),
                _ => {}
            }
            let start = self.list.len();
            node.for_each_block(|block| self.collect(block));
            let part = start..self.list.len();
            match node {
                Node::Scope { scope, .. } => self.scopes[scope.0 as usize] = part,
                Node::Loop { id, .. } => self.loops[id.0 as usize] = part,
                _ => {}
            }
        }
    }
}
