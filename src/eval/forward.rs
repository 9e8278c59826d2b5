//! Loads become the values that were stored, and what was computed before is not computed again.
//!
//! Along each way through the code it is known what cells hold; where ways meet, what holds on all of them. Whatever a loop stores is
//! unknown in it and after it, unless it was known before and is stored again.

use std::collections::{HashMap, HashSet};

use super::flow::{Block, Cell, Cells, Flow, Node, Origin, Scope, Value};
use super::group::Groups;

/// Groups of more cells than this are not followed cell by cell.
const MAX_FOLLOWED: u32 = 256;

/// Rewrites a program.
pub(super) fn forward(flow: &mut Flow) {
    let groups = Groups::of(flow);
    let body = std::mem::take(&mut flow.body);
    let mut pass = Forward {
        epochs: vec![0; groups.ranges().len()],
        groups,
        alias: (0..flow.origins.len() as u32).map(Value).collect(),
        flow,
        known: Log::default(),
        computed: Log::default(),
        exits: HashMap::new(),
        loops: Vec::new(),
        live: true,
    };
    let body = pass.block(body);
    let alias = pass.alias;
    flow.body = body;
    for value in &mut flow.output {
        *value = alias[value.0 as usize];
    }
}

/// A map that can go back to what it was.
#[derive(Debug)]
struct Log<K, V> {
    map: HashMap<K, V>,
    changes: Vec<(K, Option<V>)>,
}

impl<K, V> Default for Log<K, V> {
    fn default() -> Self {
        Self {
            map: HashMap::new(),
            changes: Vec::new(),
        }
    }
}

impl<K: Copy + Eq + std::hash::Hash, V: Copy + PartialEq> Log<K, V> {
    fn set(&mut self, key: K, value: Option<V>) {
        let old = match value {
            Some(value) => self.map.insert(key, value),
            None => self.map.remove(&key),
        };
        if old != value {
            self.changes.push((key, old));
        }
    }

    fn mark(&self) -> usize {
        self.changes.len()
    }

    /// What has changed since a mark, as it is now.
    fn since(&self, mark: usize) -> HashMap<K, Option<V>> {
        let keys = self.changes[mark..].iter().map(|(key, _)| *key);
        keys.map(|key| (key, self.map.get(&key).copied())).collect()
    }

    fn back_to(&mut self, mark: usize) {
        for (key, old) in self.changes.drain(mark..).rev() {
            match old {
                Some(value) => self.map.insert(key, value),
                None => self.map.remove(&key),
            };
        }
    }
}

/// What has changed on a way to where it meets others.
type Way = HashMap<Cell, Option<Value>>;

struct Forward<'a> {
    flow: &'a mut Flow,
    groups: Groups,
    /// How often each group was stored to.
    epochs: Vec<u32>,
    alias: Vec<Value>,
    known: Log<Cell, Value>,
    computed: Log<(Origin, u32), Value>,
    /// Of each open scope, where its changes begin and the ways that leave it.
    exits: HashMap<Scope, (usize, Vec<Way>)>,
    /// Where the changes of each open loop begin.
    loops: Vec<usize>,
    /// Whether anything comes here.
    live: bool,
}

impl Forward<'_> {
    fn block(&mut self, block: Block) -> Block {
        let computed = self.computed.mark();
        let mut out = Block::with_capacity(block.len());
        for node in block {
            if !self.live {
                break;
            }
            self.node(node, &mut out);
        }
        self.computed.back_to(computed);
        out
    }

    fn node(&mut self, mut node: Node, out: &mut Block) {
        node.for_each_value_mut(|value| *value = self.alias[value.0 as usize]);
        match node {
            Node::Let(value) => {
                if self.compute(value) {
                    out.push(node);
                }
            }
            Node::Store { cell, value } => {
                if self.known.map.get(&cell) == Some(&value) {
                    return;
                }
                self.stored(cell);
                self.know(cell, value);
                out.push(node);
            }
            Node::StoreAt { cells, .. } => {
                self.forget(cells);
                out.push(node);
            }
            Node::If { condition, yes, no } => {
                let mark = self.known.mark();
                let mut ways = Vec::new();
                let [yes, no] = [yes, no].map(|branch| {
                    self.live = true;
                    let branch = self.block(branch);
                    if self.live {
                        ways.push(self.known.since(mark));
                    }
                    self.known.back_to(mark);
                    branch
                });
                self.meet(&ways);
                out.push(Node::If { condition, yes, no });
            }
            Node::Scope { scope, body } => {
                let mark = self.known.mark();
                self.exits.insert(scope, (mark, Vec::new()));
                let body = self.block(body);
                let (_, mut ways) = self.exits.remove(&scope).unwrap_or_default();
                if self.live {
                    ways.push(self.known.since(mark));
                }
                self.known.back_to(mark);
                self.meet(&ways);
                out.push(Node::Scope { scope, body });
            }
            Node::Loop { id, body } => {
                let mut stored = Stored::default();
                stored.collect(&body);
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
                out.push(Node::Loop { id, body });
            }
            Node::Leave(scope) => {
                self.leave(scope);
                self.live = false;
                out.push(node);
            }
            Node::LeaveIf { scope, .. } => {
                self.leave(scope);
                out.push(node);
            }
            Node::Check { .. } | Node::Tell { .. } => out.push(node),
        }
    }

    /// Whether a value must be computed here; if not, another stands for it.
    fn compute(&mut self, value: Value) -> bool {
        let alias = &self.alias;
        let origin = self.flow.origins[value.0 as usize].map_operands(|operand| alias[operand.0 as usize]);
        self.flow.origins[value.0 as usize] = origin;
        let found = match origin {
            Origin::Load(cell) => self.known.map.get(&cell).copied(),
            _ => self.computed.map.get(&(origin, self.epoch(origin))).copied(),
        };
        if let Some(found) = found {
            self.alias[value.0 as usize] = found;
            return false;
        }
        match origin {
            Origin::Load(cell) => self.know(cell, value),
            _ => self.computed.set((origin, self.epoch(origin)), Some(value)),
        }
        true
    }

    fn epoch(&self, origin: Origin) -> u32 {
        let Origin::LoadAt { cells, .. } = origin else {
            return 0;
        };
        let group = self.groups.find(Cell(cells.first));
        group.map_or(0, |group| self.epochs[group])
    }

    fn know(&mut self, cell: Cell, value: Value) {
        let group = self.groups.find(cell);
        if group.is_none_or(|group| self.groups.ranges()[group].count <= MAX_FOLLOWED) {
            self.known.set(cell, Some(value));
        }
    }

    fn stored(&mut self, cell: Cell) {
        if let Some(group) = self.groups.find(cell) {
            self.epochs[group] += 1;
        }
    }

    fn forget(&mut self, cells: Cells) {
        let Some(group) = self.groups.find(Cell(cells.first)) else {
            return;
        };
        self.epochs[group] += 1;
        if self.groups.ranges()[group].count <= MAX_FOLLOWED {
            for cell in cells.first..cells.first + cells.count {
                self.known.set(Cell(cell), None);
            }
        }
    }

    fn leave(&mut self, scope: Scope) {
        let Some(&(mark, _)) = self.exits.get(&scope) else {
            return;
        };
        let mut way = self.known.since(mark);
        // What a loop computes may be computed again for others before those who leave go on.
        if let Some(&start) = self.loops.iter().find(|&&start| start >= mark) {
            for (cell, _) in &self.known.changes[start..] {
                way.insert(*cell, None);
            }
        }
        if let Some((_, ways)) = self.exits.get_mut(&scope) {
            ways.push(way);
        }
    }

    /// Goes on with what holds on all ways.
    fn meet(&mut self, ways: &[Way]) {
        self.live = !ways.is_empty();
        let cells: HashSet<Cell> = ways.iter().flat_map(|way| way.keys().copied()).collect();
        let mut cells: Vec<Cell> = cells.into_iter().collect();
        cells.sort_unstable();
        for cell in cells {
            let before = self.known.map.get(&cell).copied();
            let mut values = ways.iter().map(|way| way.get(&cell).copied().unwrap_or(before));
            let first = values.next().flatten();
            let same = values.all(|value| value == first);
            self.known.set(cell, first.filter(|_| same));
        }
    }
}

/// What a block stores to.
#[derive(Debug, Default)]
struct Stored {
    cells: Vec<(Cell, Value)>,
    ranges: Vec<Cells>,
}

impl Stored {
    fn collect(&mut self, block: &Block) {
        for node in block {
            match node {
                Node::Store { cell, value } => self.cells.push((*cell, *value)),
                Node::StoreAt { cells, .. } => self.ranges.push(*cells),
                _ => {}
            }
            node.for_each_block(|block| self.collect(block));
        }
    }
}
