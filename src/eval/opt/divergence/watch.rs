//! What waits for a place around it to become a region.

use super::follow::Fact;

/// A fact that holds once any place is a region that holds `here` and lies within `outer`, which holds it, too.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watch {
    pub(super) here: usize,
    pub(super) outer: usize,
    pub(super) fact: Fact,
}

/// All that wait: each is found once, in as many steps as the logarithm of their number.
#[derive(Debug)]
pub(super) struct Watches {
    /// By where they are.
    list: Vec<Watch>,
    /// The least `outer` of each half, quarter and so on of the list: those of node `n` are `2 * n` and `2 * n + 1`.
    least: Vec<usize>,
}

/// Of those that are found.
const NEVER: usize = usize::MAX;

impl Watches {
    pub(super) fn new(mut list: Vec<Watch>) -> Self {
        list.sort_by_key(|watch| watch.here);
        let width = list.len().next_power_of_two();
        let mut least = vec![NEVER; 2 * width];
        for (at, watch) in list.iter().enumerate() {
            least[width + at] = watch.outer;
        }
        for node in (1..width).rev() {
            least[node] = least[2 * node].min(least[2 * node + 1]);
        }
        Self { list, least }
    }

    /// One that the region from the place `first` to `last` is enough for.
    pub(super) fn take(&mut self, first: usize, last: usize) -> Option<Fact> {
        let from = self.list.partition_point(|watch| watch.here < first);
        let to = self.list.partition_point(|watch| watch.here <= last);
        let width = self.least.len() / 2;
        let at = self.find(1, [0, width], [from, to], first)?;
        let mut node = width + at;
        self.least[node] = NEVER;
        while node > 1 {
            node /= 2;
            self.least[node] = self.least[2 * node].min(self.least[2 * node + 1]);
        }
        Some(self.list[at].fact)
    }

    /// The first in a part of the list whose `outer` is before a place, looked for in the part that a node stands for.
    fn find(&self, node: usize, [start, end]: [usize; 2], part: [usize; 2], before: usize) -> Option<usize> {
        if end <= part[0] || part[1] <= start || self.least[node] >= before {
            return None;
        }
        if end - start == 1 {
            return Some(start);
        }
        let middle = start.midpoint(end);
        self.find(2 * node, [start, middle], part, before)
            .or_else(|| self.find(2 * node + 1, [middle, end], part, before))
    }
}
