//! Loops that stay loops: what they store is unknown in them.

use std::ops::Range;

use super::Forward;
use super::change::Change;
use crate::ir::function::{Block, LoopId, NONE, Node};

/// A loop that is open.
#[derive(Debug)]
pub(super) struct Open {
    /// How many scopes are around it.
    pub(super) depth: usize,
    /// Where its changes begin.
    pub(super) mark: usize,
}

impl Forward<'_> {
    /// A loop that stays one.
    pub(super) fn repeat(&mut self, id: LoopId, body: &[Node], out: &mut Block) {
        let part = self.changes.of_loop(id);
        for at in part.clone() {
            if let Change::Computed(value) = self.changes.get(at) {
                self.alias[value.0 as usize] = NONE;
            }
        }
        for at in part {
            match self.changes.get(at) {
                Change::Computed(_) => {}
                Change::Stored(cell, value) => {
                    self.stored(cell);
                    if self.known.get(cell) != Some(self.alias[value.0 as usize]) {
                        self.known.set(cell, None);
                    }
                }
                Change::StoredAt(cells) => self.forget(cells),
            }
        }
        self.loops.push(Open {
            depth: self.exits.len(),
            mark: self.known.mark(),
        });
        let body = self.block(body);
        self.loops.pop();
        self.live = false;
        out.push(Node::Loop { id, body });
    }

    /// Forgets whatever a part of the program that is read stores.
    pub(super) fn forget_all(&mut self, part: Range<usize>) {
        for at in part {
            match self.changes.get(at) {
                Change::Computed(_) => {}
                Change::Stored(cell, _) => self.known.set(cell, None),
                Change::StoredAt(cells) => self.forget(cells),
            }
        }
    }
}
