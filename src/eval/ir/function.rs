//! A shader as structured code over single components: every call inlined, every vector and structure in pieces.
//!
//! Values are made once and never change; cells are the pieces of variables. Control is in four nodes: `If`, `Scope`, `Loop`
//! and `Leave`, which ends a scope for the pixels that come to it: so `break`, `continue`, `return` and `discard` are one thing.

use toyproof_glsl::tree::{Input, Place};

use crate::ir::operation::{Kind, Operation};
use crate::observe::{Predicate, SiteId};

/// Names a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Value(pub(crate) u32);

/// Names a cell: one component of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Cell(pub(crate) u32);

/// Names a scope.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Scope(pub(crate) u32);

/// Names a loop of the author's text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct LoopId(pub(crate) u32);

/// Some cells that follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Cells {
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl Cells {
    /// The one that `offset + index` leads to; in range by construction, and held to it all the same.
    pub(crate) fn held(self, offset: u32, index: u32) -> Cell {
        Cell(self.first + offset + index.min(self.count - 1 - offset))
    }
}

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Origin {
    /// A number, as the bits of an f64.
    Float(u64),
    /// 32 bits.
    Word(u32),
    /// One component of an input of the frame.
    Input(Input, u8),
    /// `gl_FragCoord.x` or `.y`.
    FragCoord(Axis),
    /// What an operation makes of values; those that it does not take are [`NONE`].
    Operation(Operation, [Value; 3]),
    /// What a cell holds.
    Load(Cell),
    /// What one of some cells holds: `first + index`, where the index is in range.
    LoadAt {
        cells: Cells,
        /// Added to the index.
        offset: u32,
        index: Value,
        kind: Kind,
    },
    /// One component of what a channel's texture holds at a place.
    Texel {
        channel: u8,
        lookup: Lookup,
        component: u8,
        at: [Value; 2],
    },
}

/// Stands where an operation takes no further value.
pub(crate) const NONE: Value = Value(u32::MAX);

/// Of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Axis {
    X,
    Y,
}

/// How a texture is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Lookup {
    /// Between texels, by coordinates of which 1 is the texture's width or height, plus texels.
    Filtered { offset: [i32; 2] },
    /// One texel, by its place.
    Fetched,
}

/// Nodes in order.
pub(crate) type Block = Vec<Node>;

/// A step of a program.
#[derive(Debug, Clone)]
pub(crate) enum Node {
    /// Computes a value.
    Let(Value),
    /// Puts a value into a cell, for the pixels that are here.
    Store { cell: Cell, value: Value },
    /// The same into one of some cells.
    StoreAt {
        cells: Cells,
        offset: u32,
        index: Value,
        value: Value,
    },
    /// One or the other.
    If { condition: Value, yes: Block, no: Block },
    /// What can be left.
    Scope { scope: Scope, body: Block },
    /// Again and again, until all have left a scope around it.
    Loop { id: LoopId, body: Block },
    /// One more round of a loop begins.
    Round(LoopId),
    /// The end of a scope, for the pixels that are here. Nothing follows it in its block.
    Leave(Scope),
    /// The same for those for which a condition is `when`.
    LeaveIf {
        scope: Scope,
        condition: Value,
        when: bool,
    },
    /// Notes the pixels for which something holds.
    Check {
        predicate: Predicate,
        values: [Value; 2],
        site: SiteId,
    },
    /// Tells one component of a value; [`NONE`] for an event without one.
    Tell {
        event: u32,
        component: u32,
        value: Value,
    },
}

/// A whole program.
#[derive(Debug, Clone)]
pub(crate) struct Flow {
    pub(crate) origins: Vec<Origin>,
    /// The kind of each cell.
    pub(crate) cells: Vec<Kind>,
    pub(crate) scopes: u32,
    /// Where each loop stands.
    pub(crate) loops: Vec<Place>,
    pub(crate) body: Block,
    /// Red, green and blue, and whether the pixel was discarded.
    pub(crate) output: [Value; 4],
}

impl Flow {
    /// Where a value comes from.
    pub(crate) fn origin(&self, value: Value) -> Origin {
        self.origins[value.0 as usize]
    }

    /// How a value is kept.
    pub(crate) fn kind(&self, value: Value) -> Kind {
        match self.origin(value) {
            Origin::Word(_) | Origin::Input(Input::Frame, _) => Kind::Word,
            Origin::Float(_) | Origin::Input(..) | Origin::FragCoord(_) | Origin::Texel { .. } => Kind::Float,
            Origin::Operation(operation, _) => operation.kind(),
            Origin::Load(cell) => self.cells[cell.0 as usize],
            Origin::LoadAt { kind, .. } => kind,
        }
    }
}

impl Origin {
    /// Calls `visit` with each value that this one is made of.
    pub(crate) fn for_each_operand(&self, mut visit: impl FnMut(Value)) {
        match *self {
            Self::Operation(_, operands) => operands
                .into_iter()
                .filter(|&value| value != NONE)
                .for_each(visit),
            Self::LoadAt { index, .. } => visit(index),
            Self::Texel { at, .. } => at.into_iter().for_each(visit),
            Self::Float(_) | Self::Word(_) | Self::Input(..) | Self::FragCoord(_) | Self::Load(_) => {}
        }
    }

    /// The same with other values in their places.
    pub(crate) fn map_operands(self, mut with: impl FnMut(Value) -> Value) -> Self {
        let mut each = |value| if value == NONE { NONE } else { with(value) };
        match self {
            Self::Operation(operation, operands) => Self::Operation(operation, operands.map(each)),
            Self::LoadAt {
                cells,
                offset,
                index,
                kind,
            } => Self::LoadAt {
                cells,
                offset,
                index: each(index),
                kind,
            },
            Self::Texel {
                channel,
                lookup,
                component,
                at,
            } => Self::Texel {
                channel,
                lookup,
                component,
                at: at.map(each),
            },
            other => other,
        }
    }
}

impl Node {
    /// Calls `visit` with each block inside.
    pub(crate) fn for_each_block<'a>(&'a self, mut visit: impl FnMut(&'a Block)) {
        match self {
            Self::If { yes, no, .. } => {
                visit(yes);
                visit(no);
            }
            Self::Scope { body, .. } | Self::Loop { body, .. } => visit(body),
            _ => {}
        }
    }

    /// The same, to change them.
    pub(crate) fn for_each_block_mut(&mut self, mut visit: impl FnMut(&mut Block)) {
        match self {
            Self::If { yes, no, .. } => {
                visit(yes);
                visit(no);
            }
            Self::Scope { body, .. } | Self::Loop { body, .. } => visit(body),
            _ => {}
        }
    }

    /// Calls `visit` with each value that it uses itself; that of a [`Node::Let`] is not among them.
    pub(crate) fn for_each_value(&self, mut visit: impl FnMut(Value)) {
        match self {
            Self::Store { value, .. } => visit(*value),
            Self::StoreAt { index, value, .. } => {
                visit(*index);
                visit(*value);
            }
            Self::If { condition, .. } | Self::LeaveIf { condition, .. } => visit(*condition),
            Self::Check { values, .. } => values
                .iter()
                .filter(|&&value| value != NONE)
                .for_each(|&value| visit(value)),
            Self::Tell { value, .. } if *value != NONE => visit(*value),
            Self::Tell { .. }
            | Self::Let(_)
            | Self::Scope { .. }
            | Self::Loop { .. }
            | Self::Round(_)
            | Self::Leave(_) => {}
        }
    }

    /// The same, to put others in their places.
    pub(crate) fn for_each_value_mut(&mut self, mut visit: impl FnMut(&mut Value)) {
        match self {
            Self::Store { value, .. } => visit(value),
            Self::StoreAt { index, value, .. } => {
                visit(index);
                visit(value);
            }
            Self::If { condition, .. } | Self::LeaveIf { condition, .. } => visit(condition),
            Self::Check { values, .. } => values.iter_mut().filter(|value| **value != NONE).for_each(visit),
            Self::Tell { value, .. } if *value != NONE => visit(value),
            Self::Tell { .. }
            | Self::Let(_)
            | Self::Scope { .. }
            | Self::Loop { .. }
            | Self::Round(_)
            | Self::Leave(_) => {}
        }
    }
}
