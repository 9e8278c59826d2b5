//! Loads become the values that were stored, and what was computed before is not computed again.
//!
//! Along each way through the code it is known what cells hold; where ways meet, what holds on all of them. Whatever a loop stores is
//! unknown in it and after it, unless the same value was known before and is stored again. Words that are known decide branches, name
//! elements, and tell how often a loop runs.

mod change;
mod exit;
mod log;
mod repeat;
mod unroll;
mod value;

use self::change::Changes;
use self::exit::Exit;
use self::log::Log;
use self::repeat::Open;
use self::unroll::Room;
use crate::ir::alias::Groups;
use crate::ir::function::{Block, Cell, Cells, Flow, NONE, Node, Origin, Value};
use crate::observe::Predicate;

/// Groups of more cells than this are not followed cell by cell.
const MAX_FOLLOWED: u32 = 256;

/// Rewrites a program. Values of a story may be replaced while it runs: there, what is computed twice is not one value.
pub(crate) fn forward(flow: &mut Flow, story: bool) {
    let groups = Groups::of(flow);
    let body = std::mem::take(&mut flow.body);
    let templates = std::mem::take(&mut flow.origins);
    let scopes = std::mem::take(&mut flow.scopes);
    let mut pass = Forward {
        epochs: vec![0; groups.ranges().len()],
        groups,
        alias: vec![NONE; templates.len()],
        templates,
        changes: Changes::of(&body, scopes, flow.loops.len()),
        constant: Vec::new(),
        words: Log::default(),
        flow,
        story,
        known: Log::default(),
        computed: Log::default(),
        exits: Vec::new(),
        depths: vec![0; scopes as usize],
        loops: Vec::new(),
        live: true,
        room: Room::default(),
        kept: exit::MAX_KEPT,
    };
    pass.take_over();
    let body = pass.block(&body);
    let output = pass.flow.output.map(|value| pass.output(value));
    flow.body = body;
    flow.output = output;
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
    /// What the loops and scopes of that program change.
    changes: Changes,
    /// Which values are made of inputs of the frame and numbers alone.
    constant: Vec<bool>,
    /// The values that are words.
    words: Log<u32, Value>,
    story: bool,
    known: Log<Cell, Value>,
    computed: Log<(Origin, u32), Value>,
    /// The open scopes.
    exits: Vec<Exit>,
    /// Where among them each scope of the program that is read is.
    depths: Vec<usize>,
    /// The open loops.
    loops: Vec<Open>,
    /// Whether anything comes here.
    live: bool,
    room: Room,
    /// How much may still be kept of ways that leave scopes.
    kept: usize,
}

impl Forward<'_> {
    fn block(&mut self, block: &[Node]) -> Block {
        let computed = self.computed.mark();
        let mut out = Block::with_capacity(block.len());
        self.nodes(block, &mut out);
        self.computed.back_to(computed);
        out
    }

    fn nodes(&mut self, block: &[Node], out: &mut Block) {
        for node in block {
            if !self.live || self.room.is_full() {
                break;
            }
            self.room.read();
            self.node(node, out);
        }
    }

    fn node(&mut self, node: &Node, out: &mut Block) {
        match node {
            Node::Let(value) => out.extend(self.compute(*value).map(Node::Let)),
            Node::If { condition, yes, no } => {
                let condition = self.alias[condition.0 as usize];
                match self.known_word(condition) {
                    Some(word) => self.nodes(if word == 0 { no } else { yes }, out),
                    None => self.branch(condition, [yes, no], out),
                }
            }
            Node::Scope { scope, body } => self.scope(*scope, body, out),
            Node::Loop { id, body } => {
                if let Some(nodes) = self.unrolled(body) {
                    out.extend(nodes);
                } else {
                    self.repeat(*id, body, out);
                }
            }
            // Only what has nothing inside is copied: what nobody comes to costs nothing, however often it is passed by.
            _ => self.single(node.clone(), out),
        }
    }

    /// A node without others in it.
    fn single(&mut self, mut node: Node, out: &mut Block) {
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
            Node::Leave(scope) => self.leave(scope, out),
            Node::LeaveIf {
                scope,
                condition,
                when,
            } => {
                if let Some(word) = self.known_word(condition) {
                    self.room.decide(self.depths[scope.0 as usize]);
                    if (word != 0) == when {
                        self.leave(scope, out);
                    }
                } else {
                    let scope = self.note_way(scope);
                    out.push(Node::LeaveIf {
                        scope,
                        condition,
                        when,
                    });
                }
            }
            Node::Check {
                predicate: Predicate::ConstantZeros,
                values,
                ..
            } if !self.may_be_folded(values) => {}
            _ => out.push(node),
        }
    }

    /// Whether a quotient may be zero by zero to a compiler that propagates constants.
    fn may_be_folded(&self, [dividend, divisor]: [Value; 2]) -> bool {
        let known = |value: Value| self.constant[value.0 as usize];
        let is_number =
            matches!(self.flow.origin(divisor), Origin::Float(number) if f64::from_bits(number) != 0.0);
        known(dividend) && known(divisor) && !is_number
    }

    fn store(&mut self, cell: Cell, value: Value, out: &mut Block) {
        if self.known.get(cell) != Some(value) {
            self.stored(cell);
            self.know(cell, value);
            out.push(Node::Store { cell, value });
        }
    }

    fn branch(&mut self, condition: Value, branches: [&[Node]; 2], out: &mut Block) {
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
        self.meet(ways);
        out.push(Node::If { condition, yes, no });
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
}
