//! Operations on vector registers: the graph that a region is lifted to, and the constants that it uses.

use toyproof_eval::native::{Kind, Map};

use super::assemble::Constant;
use super::op::Opcode;

/// The arithmetic of the code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Precision {
    /// Floats of 32 bits. The processor flushes denormal results to zero and records that it did.
    Single,
    /// Floats of 32 bits, with denormals flushed by operations of their own.
    SingleExact,
    Double,
}

impl Precision {
    pub(super) fn is_double(self) -> bool {
        self == Self::Double
    }
}

/// A node of the graph of operations.
pub(super) type NodeId = u32;

/// An operand that a node does not have.
pub(super) const NO_NODE: NodeId = u32::MAX;

/// A table of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Table {
    Float,
    Word,
    Mask,
    /// The iterations of each pixel: one row.
    Iterations,
}

/// A place in memory that nodes are stored to.
pub(super) type TableRow = (Table, u32);

/// What a node computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    /// Loads from a row.
    Row(TableRow),
    /// Loads a scalar into all lanes.
    Scalar(Kind, u32),
    /// A constant of the pool.
    Constant(u32),
    Unary(Opcode),
    UnaryImmediate(Opcode, u8),
    Binary(Opcode),
    BinaryImmediate(Opcode, u8),
    /// The second operand where the third has its highest bit set, else the first.
    Blend(Opcode),
    /// Shifts words to the right.
    ShiftRight(u8),
    /// Takes the lower half of each lane of 64 bits.
    Narrow,
    /// The operand, until the end of a guard assigns another node to it.
    Merge,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Node {
    pub(super) action: Action,
    pub(super) operands: [NodeId; 3],
    /// Whether the vector is wide, see [`Vectors`](super::assemble::Vectors).
    pub(super) wide: bool,
}

impl Node {
    /// Whether the node can be loaded at any time, so that it needs no register until it is used.
    pub(super) fn is_lazy(&self) -> bool {
        matches!(
            self.action,
            Action::Row(_) | Action::Scalar(..) | Action::Constant(_)
        )
    }
}

/// An item of a region, in execution order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Item {
    Compute(NodeId),
    /// Stores a node in a row. Earlier nodes than the last operand may have loaded the row's old content.
    Store(TableRow, NodeId, NodeId),
    Guard(Guard),
    /// The end of a guard, given by its index: assigns its merges.
    EndGuard(usize),
    /// Notes the pixels of a mask as faults of a site, if there are any.
    Note(NodeId, u32),
}

/// Skips the items up to and including the matching [`Item::EndGuard`] if a mask is empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Guard {
    pub(super) mask: NodeId,
    /// The rows that are stored to in it.
    pub(super) rows: Vec<TableRow>,
    /// Earlier nodes than this may have loaded the old content of the rows.
    pub(super) before: NodeId,
    /// Each [`Action::Merge`] that the end assigns to, and what it assigns.
    pub(super) merges: Vec<[NodeId; 2]>,
}

/// A lifted region.
#[derive(Debug, Default)]
pub(super) struct Region {
    pub(super) nodes: Vec<Node>,
    pub(super) items: Vec<Item>,
    /// The masks whose rows it writes for steps after it.
    pub(super) masks: Vec<u32>,
}

impl Region {
    /// The merges of the guard at an index.
    pub(super) fn merges(&self, start: usize) -> &[[NodeId; 2]] {
        match &self.items[start] {
            Item::Guard(guard) => &guard.merges,
            _ => &[],
        }
    }

    /// Calls a function with each node that an item uses. Merges whose result is not needed use none.
    pub(super) fn for_each_operand(&self, item: &Item, live: &[bool], visit: &mut dyn FnMut(NodeId)) {
        match item {
            Item::Compute(node) if live[*node as usize] => {
                let operands = self.nodes[*node as usize].operands;
                let operands = operands.into_iter().filter(|&operand| operand != NO_NODE);
                operands.for_each(visit);
            }
            Item::Compute(_) => {}
            Item::Store(_, node, _) | Item::Note(node, _) => visit(*node),
            Item::Guard(guard) => visit(guard.mask),
            Item::EndGuard(start) => {
                let merges = self.merges(*start).iter();
                let needed = merges.filter(|[merge, _]| live[*merge as usize]);
                needed.flatten().copied().for_each(visit);
            }
        }
    }

    /// Returns which nodes what is stored or noted depends on.
    pub(super) fn live_nodes(&self) -> Vec<bool> {
        let mut live = vec![false; self.nodes.len()];
        let mut used = Vec::new();
        for item in self.items.iter().rev() {
            self.for_each_operand(item, &live, &mut |node| used.push(node));
            for node in used.drain(..) {
                live[node as usize] = true;
            }
        }
        live
    }
}

/// The constants of a program.
#[derive(Debug, Default)]
pub(super) struct Pool {
    pub(super) constants: Vec<Constant>,
    numbers: Map<Constant, u32>,
}

impl Pool {
    pub(super) fn number(&mut self, constant: Constant) -> u32 {
        *self.numbers.entry(constant).or_insert_with(|| {
            self.constants.push(constant);
            self.constants.len() as u32 - 1
        })
    }
}

/// Returns a constant with a word in all lanes.
pub(super) fn words(word: u32) -> Constant {
    std::array::from_fn(|at| word.to_le_bytes()[at % 4])
}

/// Returns a constant with a word of 64 bits in all lanes.
pub(super) fn long_words(word: u64) -> Constant {
    std::array::from_fn(|at| word.to_le_bytes()[at % 8])
}
