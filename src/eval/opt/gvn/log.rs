//! A map that can go back to what it was.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash};

use rustc_hash::FxHasher;

/// By numbers that nobody chooses to make trouble.
pub(super) type Map<K, V> = HashMap<K, V, BuildHasherDefault<FxHasher>>;

#[derive(Debug)]
pub(super) struct Log<K, V> {
    map: Map<K, V>,
    changes: Vec<(K, Option<V>)>,
}

impl<K, V> Default for Log<K, V> {
    fn default() -> Self {
        Self {
            map: Map::default(),
            changes: Vec::new(),
        }
    }
}

impl<K: Copy + Eq + Hash, V: Copy + PartialEq> Log<K, V> {
    pub(super) fn get(&self, key: K) -> Option<V> {
        self.map.get(&key).copied()
    }

    pub(super) fn set(&mut self, key: K, value: Option<V>) {
        let old = match value {
            Some(value) => self.map.insert(key, value),
            None => self.map.remove(&key),
        };
        if old != value {
            self.changes.push((key, old));
        }
    }

    pub(super) fn mark(&self) -> usize {
        self.changes.len()
    }

    /// What has changed since a mark.
    pub(super) fn keys_since(&self, mark: usize) -> impl Iterator<Item = K> {
        self.changes[mark..].iter().map(|(key, _)| *key)
    }

    /// The same, and what it is now.
    pub(super) fn since(&self, mark: usize) -> Map<K, Option<V>> {
        self.keys_since(mark).map(|key| (key, self.get(key))).collect()
    }

    pub(super) fn back_to(&mut self, mark: usize) {
        for (key, old) in self.changes.drain(mark..).rev() {
            match old {
                Some(value) => self.map.insert(key, value),
                None => self.map.remove(&key),
            };
        }
    }
}
