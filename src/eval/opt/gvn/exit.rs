//! The ends of scopes, where ways meet.

use super::Forward;
use super::log::Map;
use crate::ir::function::{Block, Cell, Node, Scope, Value};

/// The most changes that are kept of all ways that leave scopes, together. Each way has its own of all that changed since the scope began:
/// of thousands of them in one scope that is more than there is memory for.
pub(super) const MAX_KEPT: usize = 1 << 22;

/// What has changed on a way to where it meets others.
pub(super) type Way = Map<Cell, Option<Value>>;

/// A scope that is open.
#[derive(Debug)]
pub(super) struct Exit {
    scope: Scope,
    /// Where its changes begin.
    mark: usize,
    /// The ways that leave it; none after one that there was no room for.
    pub(super) ways: Vec<Option<Way>>,
}

impl Forward<'_> {
    pub(super) fn scope(&mut self, template: Scope, body: &[Node], out: &mut Block) {
        let scope = Scope(self.flow.scopes);
        self.flow.scopes += 1;
        let mark = self.known.mark();
        self.depths[template.0 as usize] = self.exits.len();
        self.exits.push(Exit {
            scope,
            mark,
            ways: Vec::new(),
        });
        let mut body = self.block(body);
        let mut ways = self.exits.pop().map_or_else(Vec::new, |exit| exit.ways);
        let mut leaves = ways.len();
        if matches!(body.last(), Some(&Node::Leave(left)) if left == scope) {
            body.pop();
            leaves -= 1;
        }
        if !ways.is_empty() {
            if self.live {
                ways.push(self.way(mark));
            }
            self.known.back_to(mark);
            if let Some(ways) = ways.into_iter().collect() {
                self.meet(ways);
            } else {
                self.live = true;
                self.forget_all(self.changes.of_scope(template));
            }
        }
        if leaves == 0 {
            out.extend(body);
        } else {
            out.push(Node::Scope { scope, body });
        }
    }

    /// All pixels that are here leave a scope.
    pub(super) fn leave(&mut self, template: Scope, out: &mut Block) {
        let scope = self.note_way(template);
        self.live = false;
        out.push(Node::Leave(scope));
    }

    /// Notes a way out of a scope, and tells what is written for it.
    pub(super) fn note_way(&mut self, template: Scope) -> Scope {
        let depth = self.depths[template.0 as usize];
        let Exit {
            scope,
            mark,
            ref ways,
        } = self.exits[depth];
        let lost = matches!(ways.last(), Some(None));
        let mut way = if lost { None } else { self.way(mark) };
        // What a loop computes may be computed again for others before those who leave go on.
        let inside = self.loops.partition_point(|open| open.depth <= depth);
        if let (Some(way), Some(open)) = (&mut way, self.loops.get(inside)) {
            way.extend(self.known.keys_since(open.mark).map(|cell| (cell, None)));
        }
        self.exits[depth].ways.push(way);
        scope
    }

    /// What has changed since a mark, if there is room for it.
    fn way(&mut self, mark: usize) -> Option<Way> {
        self.kept = self.kept.checked_sub(self.known.mark() - mark)?;
        Some(self.known.since(mark))
    }

    /// Goes on with what holds on all ways.
    pub(super) fn meet(&mut self, ways: Vec<Way>) {
        let count = ways.len();
        self.live = count > 0;
        // What each cell holds on those ways that change it, and how many these are.
        let mut met: Map<Cell, (Option<Value>, usize)> = Map::default();
        for (cell, value) in ways.into_iter().flatten() {
            let (same, changed) = met.entry(cell).or_insert((value, 0));
            *same = same.filter(|_| *same == value);
            *changed += 1;
        }
        let mut met: Vec<_> = met.into_iter().collect();
        met.sort_unstable_by_key(|(cell, _)| *cell);
        for (cell, (value, changed)) in met {
            let everywhere = changed == count || self.known.get(cell) == value;
            self.known.set(cell, value.filter(|_| everywhere));
        }
    }
}
