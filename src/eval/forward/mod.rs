//! Loads become the values that were stored, and what was computed before is not computed again.
//!
//! Along each way through the code it is known what cells hold; where ways meet, what holds on all of them. Whatever a loop stores is
//! unknown in it and after it, unless it was known before and is stored again. Words that are known decide branches, name elements, and
//! tell how often a loop runs.

mod log;
mod repeat;
mod unroll;
mod value;

use self::log::{Log, Map, Set};
use self::unroll::Room;
use super::flow::{Block, Cell, Cells, Flow, NONE, Node, Origin, Scope, Value};
use super::group::Groups;

/// Groups of more cells than this are not followed cell by cell.
const MAX_FOLLOWED: u32 = 256;

/// Rewrites a program. Values of a story may be replaced while it runs: there, what is computed twice is not one value.
pub(super) fn forward(flow: &mut Flow, story: bool) {
    let groups = Groups::of(flow);
    let body = std::mem::take(&mut flow.body);
    let templates = std::mem::take(&mut flow.origins);
    let scopes = std::mem::take(&mut flow.scopes);
    let mut pass = Forward {
        epochs: vec![0; groups.ranges().len()],
        groups,
        alias: vec![NONE; templates.len()],
        templates,
        constant: Vec::new(),
        words: Map::default(),
        flow,
        story,
        known: Log::default(),
        computed: Log::default(),
        exits: Vec::new(),
        depths: vec![0; scopes as usize],
        loops: Vec::new(),
        live: true,
        room: Room::default(),
    };
    pass.leaves();
    let body = pass.block(body);
    let output = pass.flow.output.map(|value| pass.output(value));
    flow.body = body;
    flow.output = output;
}

/// What has changed on a way to where it meets others.
type Way = Map<Cell, Option<Value>>;

/// A scope that is open.
#[derive(Debug)]
struct Exit {
    scope: Scope,
    /// Where its changes begin.
    mark: usize,
    /// The ways that leave it.
    ways: Vec<Way>,
}

struct Forward<'a> {
    /// What is written.
    flow: &'a mut Flow,
    groups: Groups,
    /// How often each group was stored to.
    epochs: Vec<u32>,
    /// The values of the program that is read.
    templates: Vec<Origin>,
    /// What stands for each of them: of a loop that is written out, in the round that was last.
    alias: Vec<Value>,
    /// Which values are made of inputs of the frame and numbers alone.
    constant: Vec<bool>,
    /// The values that are words.
    words: Map<u32, Value>,
    story: bool,
    known: Log<Cell, Value>,
    computed: Log<(Origin, u32), Value>,
    /// The open scopes.
    exits: Vec<Exit>,
    /// Where among them each scope of the program that is read is.
    depths: Vec<usize>,
    /// Where the changes of each open loop begin.
    loops: Vec<usize>,
    /// Whether anything comes here.
    live: bool,
    room: Room,
}

impl Forward<'_> {
    fn block(&mut self, block: Block) -> Block {
        let computed = self.computed.mark();
        let mut out = Block::with_capacity(block.len());
        self.nodes(block, &mut out);
        self.computed.back_to(computed);
        out
    }

    fn nodes(&mut self, block: Block, out: &mut Block) {
        for node in block {
            if !self.live || self.room.is_full() {
                break;
            }
            self.room.read();
            self.node(node, out);
        }
    }

    fn node(&mut self, mut node: Node, out: &mut Block) {
        if let Node::Let(value) = node {
            out.extend(self.compute(value).map(Node::Let));
            return;
        }
        node.for_each_value_mut(|value| *value = self.alias[value.0 as usize]);
        match node {
            Node::Store { cell, value } => self.store(cell, value, out),
            Node::StoreAt {
                cells,
                offset,
                index,
                value,
            } => {
                if let Some(index) = self.known_word(index) {
                    self.store(cells.held(offset, index), value, out);
                } else {
                    self.forget(cells);
                    out.push(node);
                }
            }
            Node::If { condition, yes, no } => match self.known_word(condition) {
                Some(word) => self.nodes(if word == 0 { no } else { yes }, out),
                None => self.branch(condition, [yes, no], out),
            },
            Node::Scope { scope, body } => self.scope(scope, body, out),
            Node::Loop { body } => {
                if let Some(nodes) = self.unrolled(&body) {
                    out.extend(nodes);
                } else {
                    self.repeat(body, out);
                }
            }
            Node::Leave(scope) => {
                let scope = self.leave(scope);
                self.live = false;
                out.push(Node::Leave(scope));
            }
            Node::LeaveIf {
                scope,
                condition,
                when,
            } => {
                let Some(word) = self.known_word(condition) else {
                    let scope = self.leave(scope);
                    out.push(Node::LeaveIf {
                        scope,
                        condition,
                        when,
                    });
                    return;
                };
                self.room.decide(self.depths[scope.0 as usize]);
                if (word != 0) == when {
                    self.node(Node::Leave(scope), out);
                }
            }
            Node::Let(_) | Node::Round(_) | Node::Check { .. } | Node::Tell { .. } => out.push(node),
        }
    }

    fn store(&mut self, cell: Cell, value: Value, out: &mut Block) {
        if self.known.map.get(&cell) != Some(&value) {
            self.stored(cell);
            self.know(cell, value);
            out.push(Node::Store { cell, value });
        }
    }

    fn branch(&mut self, condition: Value, branches: [Block; 2], out: &mut Block) {
        let mark = self.known.mark();
        let mut ways = Vec::new();
        let [yes, no] = branches.map(|branch| {
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

    fn scope(&mut self, template: Scope, body: Block, out: &mut Block) {
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
        if self.live {
            ways.push(self.known.since(mark));
        }
        self.known.back_to(mark);
        self.meet(&ways);
        if leaves == 0 {
            out.extend(body);
        } else {
            out.push(Node::Scope { scope, body });
        }
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

    /// Notes a way out of a scope, and tells what is written for it.
    fn leave(&mut self, template: Scope) -> Scope {
        let depth = self.depths[template.0 as usize];
        let mark = self.exits[depth].mark;
        let mut way = self.known.since(mark);
        // What a loop computes may be computed again for others before those who leave go on.
        if let Some(&start) = self.loops.iter().find(|&&start| start >= mark) {
            for (cell, _) in &self.known.changes[start..] {
                way.insert(*cell, None);
            }
        }
        let exit = &mut self.exits[depth];
        exit.ways.push(way);
        exit.scope
    }

    /// Goes on with what holds on all ways.
    fn meet(&mut self, ways: &[Way]) {
        self.live = !ways.is_empty();
        let cells: Set<Cell> = ways.iter().flat_map(|way| way.keys().copied()).collect();
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
