//! Maps that can be rolled back to an earlier state.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash};

use rustc_hash::FxHasher;

/// A map with a fast hash; its keys cannot be chosen adversarially.
pub type Map<K, V> = HashMap<K, V, BuildHasherDefault<FxHasher>>;

/// A map that can be rolled back to an earlier state.
#[derive(Debug)]
pub struct RollbackMap<K, V> {
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
    /// Returns a value.
    #[must_use]
    pub fn get(&self, key: K) -> Option<V> {
        self.map.get(&key).copied()
    }

    /// Changes, inserts or removes a value.
    pub fn set(&mut self, key: K, value: Option<V>) {
        let old = match value {
            Some(value) => self.map.insert(key, value),
            None => self.map.remove(&key),
        };
        if old != value {
            self.changes.push((key, old));
        }
    }

    /// Returns the current state, for [`Self::roll_back`].
    #[must_use]
    pub fn mark(&self) -> usize {
        self.changes.len()
    }

    /// Returns the keys changed since a mark.
    pub fn keys_since(&self, mark: usize) -> impl Iterator<Item = K> {
        self.changes[mark..].iter().map(|(key, _)| *key)
    }

    /// Returns the keys changed since a mark, with their current values.
    pub(crate) fn changes_since(&self, mark: usize) -> Map<K, Option<V>> {
        self.keys_since(mark).map(|key| (key, self.get(key))).collect()
    }

    /// Restores the state of a mark.
    pub fn roll_back(&mut self, mark: usize) {
        for (key, old) in self.changes.drain(mark..).rev() {
            match old {
                Some(value) => self.map.insert(key, value),
                None => self.map.remove(&key),
            };
        }
    }
}
