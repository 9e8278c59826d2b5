//! The function: values, cells, and structured control flow.

use toyproof_glsl::tree::{Input, Place};

use super::operation::{Kind, Operation};
use super::site::{Predicate, SiteId};

/// Identifies a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(pub u32);

/// Identifies a cell: one component of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Cell(pub u32);

impl Cell {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// Identifies a scope.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Scope(pub(crate) u32);

/// Identifies a loop of the source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LoopId(pub u32);

/// A range of consecutive cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[doc(hidden)]
pub struct Cells {
    pub first: u32,
    pub count: u32,
}

impl Cells {
    /// Returns the cell at `offset + index`; in range by construction, clamped for memory safety.
    pub fn clamped(self, offset: u32, index: u32) -> Cell {
        Cell(self.first + offset + index.min(self.count - 1 - offset))
    }
}

/// The definition of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[doc(hidden)]
pub enum ValueDef {
    /// A float constant, as the bits of an f64.
    Float(u64),
    /// A word constant.
    Word(u32),
    /// One component of an input of the frame.
    Input(Input, u8),
    /// The width, height or depth, in texels, of the cube map or volume of a channel; 1 if it is unbound.
    Extent { channel: u8, axis: u8 },
    /// A parameter, which is given for each point.
    Parameter(Kind, u32),
    /// `gl_FragCoord.x` or `.y`.
    FragCoord(Axis),
    /// The result of an operation; unused operands are [`NONE`].
    Operation(Operation, [Value; 3]),
    /// The content of a cell.
    Load(Cell),
    /// The content of the cell at `first + offset + index`, which is in range.
    LoadAt {
        cells: Cells,
        /// Added to the index.
        offset: u32,
        index: Value,
        kind: Kind,
    },
    /// One component of a texel of a channel's texture, by its coordinates and its level.
    Texel {
        channel: u8,
        component: u8,
        at: [Value; 3],
    },
}

/// Marks an unused operand.
pub const NONE: Value = Value(u32::MAX);

/// An axis of the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[doc(hidden)]
pub enum Axis {
    X,
    Y,
}

/// Nodes in execution order.
pub(crate) type Block = Vec<Node>;

/// A node of the structured code.
#[derive(Debug, Clone)]
pub(crate) enum Node {
    /// Computes a value.
    Let(Value),
    /// Stores a value in a cell, for the active pixels.
    Store { cell: Cell, value: Value },
    /// Stores a value in the cell at `first + offset + index`.
    StoreAt {
        cells: Cells,
        offset: u32,
        index: Value,
        value: Value,
    },
    /// Executes one of two blocks.
    If { condition: Value, yes: Block, no: Block },
    /// A block that can be left by `Break`.
    Scope { scope: Scope, body: Block },
    /// Repeats a block until all pixels have left an enclosing scope.
    Loop { id: LoopId, body: Block },
    /// The start of a loop iteration.
    LoopHeader(LoopId),
    /// Leaves a scope, for the active pixels. Nothing follows it in its block.
    Break(Scope),
    /// Leaves a scope, for the pixels whose condition is `when`.
    BreakIf {
        scope: Scope,
        condition: Value,
        when: bool,
    },
    /// Records the pixels for which a predicate holds.
    Check {
        predicate: Predicate,
        values: [Value; 2],
        site: SiteId,
    },
    /// Records one component of a value in the trace; [`NONE`] for an event without a value.
    Trace {
        event: u32,
        component: u32,
        value: Value,
    },
    /// Counts the pixels that come here: of a part while the function is built, of a basic block afterwards.
    Count(u32),
}

/// A whole shader.
#[derive(Debug, Clone)]
#[doc(hidden)]
pub struct Function {
    pub defs: Vec<ValueDef>,
    /// The kind of each cell.
    pub cells: Vec<Kind>,
    pub scopes: u32,
    /// The source location of each loop.
    pub loops: Vec<Place>,
    pub(crate) body: Block,
    /// Red, green, blue, alpha, and whether the pixel was discarded.
    pub output: [Value; 5],
}

impl Function {
    /// Returns the definition of a value.
    #[must_use]
    pub fn def(&self, value: Value) -> ValueDef {
        self.defs[value.0 as usize]
    }

    /// Returns the kind of a value.
    #[must_use]
    pub fn kind(&self, value: Value) -> Kind {
        match self.def(value) {
            ValueDef::Word(_) | ValueDef::Input(Input::Frame, _) => Kind::Word,
            ValueDef::Float(_)
            | ValueDef::Input(..)
            | ValueDef::Extent { .. }
            | ValueDef::FragCoord(_)
            | ValueDef::Texel { .. } => Kind::Float,
            ValueDef::Operation(operation, _) => operation.kind(),
            ValueDef::Load(cell) => self.cells[cell.0 as usize],
            ValueDef::Parameter(kind, _) | ValueDef::LoadAt { kind, .. } => kind,
        }
    }
}

impl ValueDef {
    /// Calls `visit` with each operand.
    pub fn for_each_operand(&self, mut visit: impl FnMut(Value)) {
        match *self {
            Self::Operation(_, operands) => operands
                .into_iter()
                .filter(|&value| value != NONE)
                .for_each(visit),
            Self::LoadAt { index, .. } => visit(index),
            Self::Texel { at, .. } => at.into_iter().for_each(visit),
            Self::Float(_)
            | Self::Word(_)
            | Self::Input(..)
            | Self::Extent { .. }
            | Self::Parameter(..)
            | Self::FragCoord(_)
            | Self::Load(_) => {}
        }
    }

    /// Returns the definition with each operand replaced by the result of `with`.
    #[must_use]
    pub fn map_operands(self, mut with: impl FnMut(Value) -> Value) -> Self {
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
                component,
                at,
            } => Self::Texel {
                channel,
                component,
                at: at.map(each),
            },
            other => other,
        }
    }
}

macro_rules! for_each_value {
    ($(#[$doc:meta])* $name:ident($self:ident: $($receiver:tt)+) $iter:ident $value:ty) => {
        $(#[$doc])*
        pub(crate) fn $name($($receiver)+, mut visit: impl FnMut($value)) {
            match $self {
                Self::Store { value, .. } => visit(value),
                Self::StoreAt { index, value, .. } => {
                    visit(index);
                    visit(value);
                }
                Self::If { condition, .. } | Self::BreakIf { condition, .. } => visit(condition),
                Self::Check { values, .. } => values.$iter().filter(|value| **value != NONE).for_each(visit),
                Self::Trace { value, .. } if *value != NONE => visit(value),
                Self::Trace { .. }
                | Self::Count(_)
                | Self::Let(_)
                | Self::Scope { .. }
                | Self::Loop { .. }
                | Self::LoopHeader(_)
                | Self::Break(_) => {}
            }
        }
    };
}

impl Node {
    /// Calls `visit` with each direct child block.
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

    /// Calls `visit` with each direct child block, mutably.
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

    for_each_value!(
        /// Calls `visit` with each value that the node itself uses; the value that a [`Node::Let`] defines is
        /// not a use.
        for_each_value(self: &self) iter &Value
    );
    for_each_value!(
        /// Calls `visit` with each value that the node itself uses, mutably.
        for_each_value_mut(self: &mut self) iter_mut &mut Value
    );
}
