//! The state of the pass: maps that can be rolled back, and the changes made by loops and scopes.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash};
use std::ops::Range;

use rustc_hash::FxHasher;

use crate::ir::{Block, Cell, Cells, LoopId, Node, Scope, Value};

/// A map with a fast hash; its keys cannot be chosen adversarially.
pub(crate) type Map<K, V> = HashMap<K, V, BuildHasherDefault<FxHasher>>;

/// A map that can be rolled back to an earlier state.
#[derive(Debug)]
pub(crate) struct RollbackMap<K, V> {
    map: Map<K, V>,
    changes: Vec<(K, Option<V>)>,
}

impl<K, V> Default for RollbackMap<K, V> {
    fn default() -> Self {
        Self {
            map: Map::default(),
            changes: Vec::new(),
        }
    }
}

impl<K: Copy + Eq + Hash, V: Copy + PartialEq> RollbackMap<K, V> {
    pub(crate) fn get(&self, key: K) -> Option<V> {
        self.map.get(&key).copied()
    }

    pub(crate) fn set(&mut self, key: K, value: Option<V>) {
        let old = match value {
            Some(value) => self.map.insert(key, value),
            None => self.map.remove(&key),
        };
        if old != value {
            self.changes.push((key, old));
        }
    }

    pub(crate) fn mark(&self) -> usize {
        self.changes.len()
    }

    /// Returns the keys changed since a mark.
    pub(crate) fn keys_since(&self, mark: usize) -> impl Iterator<Item = K> {
        self.changes[mark..].iter().map(|(key, _)| *key)
    }

    /// Returns the keys changed since a mark, with their current values.
    pub(crate) fn changes_since(&self, mark: usize) -> Map<K, Option<V>> {
        self.keys_since(mark).map(|key| (key, self.get(key))).collect()
    }

    pub(crate) fn roll_back(&mut self, mark: usize) {
        for (key, old) in self.changes.drain(mark..).rev() {
            match old {
                Some(value) => self.map.insert(key, value),
                None => self.map.remove(&key),
            };
        }
    }
}

// The changes made by loops and scopes, collected in one traversal: those of inner ones are part of the same
// list.

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
    pub(super) fn of(body: &Block, scopes: u32, loops: usize) -> Self {
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
