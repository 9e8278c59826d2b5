//! The intermediate representation: structured control flow over scalar components, with every call inlined
//! and all vectors and structures scalarized.
//!
//! Values are in SSA form; cells are the scalarized variables. Control flow has four nodes: `If`, `Scope`,
//! `Loop`, and `Break`, which ends a scope for the pixels that reach it. `Break` expresses `break`,
//! `continue`, `return` and `discard`.

use toyproof_glsl::tree::{Input, Place};

use crate::observe::{Predicate, SiteId};

/// Identifies a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Value(pub(crate) u32);

/// Identifies a cell: one component of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Cell(pub(crate) u32);

/// Identifies a scope.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Scope(pub(crate) u32);

/// Identifies a loop of the source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct LoopId(pub(crate) u32);

/// A range of consecutive cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Cells {
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl Cells {
    /// Returns the cell at `offset + index`; in range by construction, clamped for memory safety.
    pub(crate) fn clamped(self, offset: u32, index: u32) -> Cell {
        Cell(self.first + offset + index.min(self.count - 1 - offset))
    }
}

/// The definition of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ValueDef {
    /// A float constant, as the bits of an f64.
    Float(u64),
    /// A word constant.
    Word(u32),
    /// One component of an input of the frame.
    Input(Input, u8),
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
pub(crate) const NONE: Value = Value(u32::MAX);

/// An axis of the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Axis {
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
}

/// A whole shader.
#[derive(Debug, Clone)]
pub(crate) struct Function {
    pub(crate) defs: Vec<ValueDef>,
    /// The kind of each cell.
    pub(crate) cells: Vec<Kind>,
    pub(crate) scopes: u32,
    /// The source location of each loop.
    pub(crate) loops: Vec<Place>,
    pub(crate) body: Block,
    /// Red, green, blue, alpha, and whether the pixel was discarded.
    pub(crate) output: [Value; 5],
}

impl Function {
    /// Returns the definition of a value.
    pub(crate) fn def(&self, value: Value) -> ValueDef {
        self.defs[value.0 as usize]
    }

    /// Returns the kind of a value.
    pub(crate) fn kind(&self, value: Value) -> Kind {
        match self.def(value) {
            ValueDef::Word(_) | ValueDef::Input(Input::Frame, _) => Kind::Word,
            ValueDef::Float(_) | ValueDef::Input(..) | ValueDef::FragCoord(_) | ValueDef::Texel { .. } => {
                Kind::Float
            }
            ValueDef::Operation(operation, _) => operation.kind(),
            ValueDef::Load(cell) => self.cells[cell.0 as usize],
            ValueDef::Parameter(kind, _) | ValueDef::LoadAt { kind, .. } => kind,
        }
    }
}

impl ValueDef {
    /// Calls `visit` with each operand.
    pub(crate) fn for_each_operand(&self, mut visit: impl FnMut(Value)) {
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
            | Self::Parameter(..)
            | Self::FragCoord(_)
            | Self::Load(_) => {}
        }
    }

    /// Returns the definition with each operand replaced by the result of `with`.
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

    /// Calls `visit` with each value that the node itself uses; the value that a [`Node::Let`] defines is not
    /// a use.
    pub(crate) fn for_each_value(&self, mut visit: impl FnMut(Value)) {
        match self {
            Self::Store { value, .. } => visit(*value),
            Self::StoreAt { index, value, .. } => {
                visit(*index);
                visit(*value);
            }
            Self::If { condition, .. } | Self::BreakIf { condition, .. } => visit(*condition),
            Self::Check { values, .. } => values
                .iter()
                .filter(|&&value| value != NONE)
                .for_each(|&value| visit(value)),
            Self::Trace { value, .. } if *value != NONE => visit(*value),
            Self::Trace { .. }
            | Self::Let(_)
            | Self::Scope { .. }
            | Self::Loop { .. }
            | Self::LoopHeader(_)
            | Self::Break(_) => {}
        }
    }

    /// Calls `visit` with each value that the node itself uses, mutably.
    pub(crate) fn for_each_value_mut(&mut self, mut visit: impl FnMut(&mut Value)) {
        match self {
            Self::Store { value, .. } => visit(value),
            Self::StoreAt { index, value, .. } => {
                visit(index);
                visit(value);
            }
            Self::If { condition, .. } | Self::BreakIf { condition, .. } => visit(condition),
            Self::Check { values, .. } => values.iter_mut().filter(|value| **value != NONE).for_each(visit),
            Self::Trace { value, .. } if *value != NONE => visit(value),
            Self::Trace { .. }
            | Self::Let(_)
            | Self::Scope { .. }
            | Self::Loop { .. }
            | Self::LoopHeader(_)
            | Self::Break(_) => {}
        }
    }
}

// Operations on components, with the kinds of their operands and results.

/// The representation of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Kind {
    /// A float, in the number type of the run.
    Float,
    /// A 32-bit word: an `int`, a `uint`, or a `bool` as 0 or all bits.
    Word,
}

macro_rules! kind {
    (F) => {
        Kind::Float
    };
    (W) => {
        Kind::Word
    };
}

/// Calls `$then!` with every operation: `Name(kinds of operands) kind of result`.
macro_rules! for_each_operation {
    ($then:ident) => {
        $then! {
            // Arithmetic.
            Add(F, F) F, Sub(F, F) F, Mul(F, F) F, Div(F, F) F,
            // Unfused: two roundings. a·b + c, a·b − c, c − a·b.
            MulAdd(F, F, F) F, MulSub(F, F, F) F, SubMul(F, F, F) F,
            Min(F, F) F, Max(F, F) F,
            Neg(F) F, Abs(F) F, Sqrt(F) F, Floor(F) F, Ceil(F) F, Trunc(F) F, RoundEven(F) F,
            // Elementary functions.
            Sin(F) F, Cos(F) F, Tan(F) F, Asin(F) F, Acos(F) F, Atan(F) F, Atan2(F, F) F,
            Sinh(F) F, Cosh(F) F, Tanh(F) F, Asinh(F) F, Acosh(F) F, Atanh(F) F,
            Exp(F) F, Exp2(F) F, Log(F) F, Log2(F) F, Pow(F, F) F,
            // Comparisons of floats; all but `NotEqual` are false for NaN.
            Less(F, F) W, LessEqual(F, F) W, Equal(F, F) W, NotEqual(F, F) W, IsNan(F) W, IsInf(F) W,
            // Conversions between floats and words. Bits are those of the nearest f32.
            FromInt(W) F, FromUint(W) F, ToInt(F) W, ToUint(F) W, FromBits(W) F, ToBits(F) W,
            PackHalf(F, F) W, UnpackLow(W) F, UnpackHigh(W) F,
            // Operations on words.
            AddWord(W, W) W, SubWord(W, W) W, MulWord(W, W) W,
            DivInt(W, W) W, DivUint(W, W) W, RemInt(W, W) W, RemUint(W, W) W,
            And(W, W) W, Or(W, W) W, Xor(W, W) W, Not(W) W, NegWord(W) W,
            ShiftLeft(W, W) W, ShiftRightInt(W, W) W, ShiftRightUint(W, W) W,
            MinInt(W, W) W, MaxInt(W, W) W, MinUint(W, W) W, MaxUint(W, W) W,
            EqualWord(W, W) W, LessInt(W, W) W, LessUint(W, W) W,
            // Selections: the second operand where the first is all bits, the third where it is 0.
            Select(W, F, F) F, SelectWord(W, W, W) W,
            // Differences within a quad.
            DFdx(F) F, DFdy(F) F,
        }
    };
}
pub(crate) use for_each_operation;

macro_rules! define {
    ($($name:ident($($operand:ident),+) $value:ident,)*) => {
        /// An operation on components.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub(crate) enum Operation {
            $(
                $name,
            )*
        }

        impl Operation {
            /// All operations, in the order of their discriminants.
            pub(crate) const ALL: &[Self] = &[$(Self::$name,)*];

            /// Returns the kinds of the operands, one to three.
            pub(crate) fn operands(self) -> &'static [Kind] {
                match self {
                    $(Self::$name => &[$(kind!($operand)),+],)*
                }
            }

            /// Returns the kind of the result.
            pub(crate) fn kind(self) -> Kind {
                match self {
                    $(Self::$name => kind!($value),)*
                }
            }
        }
    };
}
for_each_operation!(define);

// Alias analysis: cells that an index may select form a group. They are contiguous, and facts hold for a
// whole group.

/// The groups of cells that are accessed by an index.
#[derive(Debug, Clone, Default)]
pub(crate) struct AliasGroups {
    /// Sorted and disjoint.
    ranges: Vec<Cells>,
}

impl AliasGroups {
    pub(crate) fn of(function: &Function) -> Self {
        let mut ranges = Vec::new();
        collect(&function.body, function, &mut ranges);
        ranges.sort_by_key(|cells| cells.first);
        let mut apart: Vec<Cells> = Vec::new();
        for cells in ranges {
            match apart.last_mut() {
                Some(last) if cells.first < last.first + last.count => {
                    let end = (last.first + last.count).max(cells.first + cells.count);
                    last.count = end - last.first;
                }
                _ => apart.push(cells),
            }
        }
        Self { ranges: apart }
    }

    /// Returns the group of a cell, if it is in one.
    pub(crate) fn find(&self, cell: Cell) -> Option<usize> {
        let after = self.ranges.partition_point(|cells| cells.first <= cell.0);
        let group = after.checked_sub(1)?;
        let cells = self.ranges[group];
        (cell.0 < cells.first + cells.count).then_some(group)
    }

    /// Returns the cell that represents the alias class: the first of the group, or the cell itself.
    pub(crate) fn unit(&self, cell: Cell) -> usize {
        let group = self.find(cell);
        group.map_or(cell.0, |group| self.ranges[group].first) as usize
    }

    /// Returns all groups.
    pub(crate) fn ranges(&self) -> &[Cells] {
        &self.ranges
    }
}

fn collect(block: &Block, function: &Function, ranges: &mut Vec<Cells>) {
    for node in block {
        match node {
            Node::Let(value) => {
                if let ValueDef::LoadAt { cells, .. } = function.def(*value) {
                    ranges.push(cells);
                }
            }
            Node::StoreAt { cells, .. } => ranges.push(*cells),
            _ => {}
        }
        node.for_each_block(|block| collect(block, function, ranges));
    }
}
