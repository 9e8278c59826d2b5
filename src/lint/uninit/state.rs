//! The state of the analysis at a point of a function, as bit sets over the parts of its variables.

use super::part::Parts;

/// The bits of a variable's parts in a [`State`]. No variable straddles two words.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slot {
    word: usize,
    shift: u32,
}

/// Assigns slots to variables.
#[derive(Debug, Default)]
pub(super) struct Slots {
    words: usize,
    /// The bits used of the last word.
    used: u32,
}

impl Slots {
    /// The slot of a variable with `count` parts, at most as many as [`Parts`] has bits.
    pub(super) fn add(&mut self, count: u32) -> Slot {
        if self.words == 0 || self.used + count > Parts::BITS {
            self.words += 1;
            self.used = 0;
        }
        let slot = Slot {
            word: self.words - 1,
            shift: self.used,
        };
        self.used += count;
        slot
    }
}

/// The parts that are unassigned on some path to a point, and those that are assigned on some path.
///
/// Once a path reads an unassigned part, it counts as neither for this part: the read is reported, and what
/// follows from it is not. So `sum += x` in a loop does not assign the `sum` that its own next iteration
/// reads.
#[derive(Debug, Clone, Default)]
pub(super) struct State {
    /// Whether any path leads here.
    pub(super) is_reachable: bool,
    unassigned: Vec<u64>,
    assigned: Vec<u64>,
}

impl State {
    /// The state at the start of a function: no part is unassigned or assigned.
    pub(super) fn entry(slots: &Slots) -> Self {
        Self {
            is_reachable: true,
            unassigned: vec![0; slots.words],
            assigned: vec![0; slots.words],
        }
    }

    /// Merges the state on other paths to the same point.
    pub(super) fn join(&mut self, other: &Self) {
        if !other.is_reachable {
            return;
        }
        if !self.is_reachable {
            self.clone_from(other);
            return;
        }
        unite(&mut self.unassigned, &other.unassigned);
        unite(&mut self.assigned, &other.assigned);
    }

    /// Merges the assignments on other paths.
    pub(super) fn join_assigned(&mut self, other: &Self) {
        if self.is_reachable && other.is_reachable {
            unite(&mut self.assigned, &other.assigned);
        }
    }

    /// The parts that are unassigned on some path.
    pub(super) fn unassigned(&self, slot: Slot) -> Parts {
        self.unassigned
            .get(slot.word)
            .map_or(0, |word| word >> slot.shift)
    }

    /// The parts that are assigned on some path.
    pub(super) fn assigned(&self, slot: Slot) -> Parts {
        self.assigned.get(slot.word).map_or(0, |word| word >> slot.shift)
    }

    /// Declares a variable: these parts are unassigned on all paths.
    pub(super) fn declare(&mut self, slot: Slot, parts: Parts) {
        self.unassigned[slot.word] |= parts << slot.shift;
        self.assigned[slot.word] &= !(parts << slot.shift);
    }

    /// Assigns parts on all paths.
    pub(super) fn assign(&mut self, slot: Slot, parts: Parts) {
        self.assign_maybe(slot, parts);
        self.unassigned[slot.word] &= !(parts << slot.shift);
    }

    /// Assigns parts on some of the paths that a called function takes.
    pub(super) fn assign_maybe(&mut self, slot: Slot, parts: Parts) {
        let unassigned = self.unassigned[slot.word] & parts << slot.shift;
        self.assigned[slot.word] |= unassigned;
    }

    /// Ends the paths on which these parts are unassigned, as far as these parts are concerned.
    pub(super) fn drop_unassigned(&mut self, slot: Slot, parts: Parts) {
        self.unassigned[slot.word] &= !(parts << slot.shift);
    }
}

fn unite(into: &mut [u64], other: &[u64]) {
    for (into, other) in into.iter_mut().zip(other) {
        *into |= other;
    }
}
