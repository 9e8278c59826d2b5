//! What follows from what.

use crate::ir::function::{Scope, Value};

/// Something that may be found out.
#[derive(Debug, Clone, Copy)]
pub(super) enum Fact {
    /// A value varies.
    Value(Value),
    /// A cell, or a group of them, varies.
    Unit(u32),
    /// Pixels may come to a store of it that others do not, and later to a load with them.
    Shared(u32),
    /// Some pixels may leave a scope while others stay in it.
    Scope(Scope),
    /// A place is entered or left by some pixels and not by others.
    Region(u32),
}

/// Lists of facts, one for each cause: all in one vector, each the way to the next of its list.
#[derive(Debug)]
pub(super) struct Followers {
    first: Vec<u32>,
    all: Vec<(Fact, u32)>,
}

const END: u32 = u32::MAX;

impl Followers {
    pub(super) fn new(causes: usize) -> Self {
        Self {
            first: vec![END; causes],
            all: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, cause: usize, fact: Fact) {
        let next = std::mem::replace(&mut self.first[cause], self.all.len() as u32);
        self.all.push((fact, next));
    }

    /// Takes one fact from the list of a cause.
    pub(super) fn take(&mut self, cause: usize) -> Option<Fact> {
        let (fact, next) = *self.all.get(self.first[cause] as usize)?;
        self.first[cause] = next;
        Some(fact)
    }
}
