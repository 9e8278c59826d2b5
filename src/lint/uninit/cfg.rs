//! The control-flow graph of a function: blocks of reads and writes, and their successors.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::rc::Rc;

use toyproof_glsl::tree::{Direction, ExprId, FunctionId, Tree, Type, VariableId, VariableKind};

use super::part::{Part, Parts};

/// An event in a block that matters to the search.
#[derive(Debug, Clone)]
pub(super) enum Event {
    /// A variable is declared without a value.
    Begin(VariableId),
    Read {
        part: Part,
        /// The expression that is reported.
        expr: ExprId,
    },
    Write(Part),
    /// A variable or part of it is set to an expression whose value may be known.
    Set {
        variable: VariableId,
        /// `None` for an initializer.
        target: Option<ExprId>,
        value: ExprId,
    },
    /// A variable changes to an unknown value.
    Forget(VariableId),
    /// A user-defined function is called that may change these globals.
    Call(Rc<[VariableId]>),
}

/// Index of a block in a [`Cfg`].
pub(super) type BlockId = usize;

#[derive(Debug, Clone)]
pub(super) enum Terminator {
    /// Not yet set, or unreachable.
    Open,
    Goto(BlockId),
    /// Back to the head of a loop, whose blocks lie between the head and this one.
    BackEdge(BlockId),
    Branch {
        condition: ExprId,
        yes: BlockId,
        no: BlockId,
        /// The head of the loop whose exit this branch is.
        exited_loop: Option<BlockId>,
    },
    Switch {
        selector: ExprId,
        /// The label values of each case, and its first block.
        cases: Vec<(Vec<u32>, BlockId)>,
        /// The target for all other values.
        default: BlockId,
    },
    Return,
    /// After the last statement, without a `return`.
    FallOff,
}

#[derive(Debug, Clone)]
pub(super) struct BasicBlock {
    pub(super) events: Vec<Event>,
    pub(super) end: Terminator,
}

/// The control-flow graph of a function, which starts at block 0.
pub(super) struct Cfg {
    pub(super) blocks: Vec<BasicBlock>,
    /// Variables and parts of variables that a `return` combines with other values.
    pub(super) returned_beside: HashSet<ExprId>,
}

impl Cfg {
    /// The variables changed in a loop, from its head to the block with the back edge; `predecessors` is
    /// indexed by block.
    pub(super) fn changed_in_loop(
        &self,
        predecessors: &[Vec<BlockId>],
        head: BlockId,
        last: BlockId,
    ) -> Vec<VariableId> {
        let mut changed = BTreeSet::new();
        let mut seen = HashSet::from([head]);
        let mut pending = vec![last];
        while let Some(block) = pending.pop() {
            if !seen.insert(block) && block != head {
                continue;
            }
            for event in &self.blocks[block].events {
                match event {
                    Event::Set { variable, .. } | Event::Forget(variable) | Event::Begin(variable) => {
                        changed.insert(*variable);
                    }
                    Event::Write(part) => {
                        changed.insert(part.variable);
                    }
                    Event::Call(globals) => changed.extend(globals.iter().copied()),
                    Event::Read { .. } => {}
                }
            }
            if block != head {
                pending.extend(predecessors[block].iter().copied());
            }
        }
        changed.into_iter().collect()
    }
}

impl Terminator {
    /// Whether the block has successors.
    pub(super) fn has_successors(&self) -> bool {
        !matches!(self, Self::Open | Self::Return | Self::FallOff)
    }

    /// Visits each successor.
    pub(super) fn for_each_successor(&self, mut visit: impl FnMut(BlockId)) {
        match self {
            Self::Open | Self::Return | Self::FallOff => {}
            Self::Goto(to) | Self::BackEdge(to) => visit(*to),
            Self::Branch { yes, no, .. } => {
                visit(*yes);
                visit(*no);
            }
            Self::Switch { cases, default, .. } => {
                for (_, block) in cases {
                    visit(*block);
                }
                visit(*default);
            }
        }
    }
}

/// Whether uninitialized reads of a variable are reported: locals and `out` parameters, except samplers.
pub(super) fn is_checked(tree: &Tree, variable: VariableId) -> bool {
    let local = matches!(
        tree[variable].kind,
        VariableKind::Local | VariableKind::Parameter(Direction::Out)
    );
    local && !matches!(tree[variable].ty, Type::Sampler(_))
}

/// The variables declared without a value, with the block and index of the event.
pub(super) fn begin_events(cfg: &Cfg) -> Vec<(VariableId, BlockId, usize)> {
    let mut all = Vec::new();
    for (block, basic_block) in cfg.blocks.iter().enumerate() {
        for (index, event) in basic_block.events.iter().enumerate() {
            if let Event::Begin(variable) = event {
                all.push((*variable, block, index));
            }
        }
    }
    all
}

// Summaries of functions, for their callers.

/// The reads and writes of an analyzed function that matter to its callers.
#[derive(Debug, Clone, Default)]
pub(super) struct Summary {
    /// By parameter: the parts of the argument that are read; of an `inout`, those read before they are
    /// written.
    pub(super) reads: Vec<Parts>,
    /// By parameter: the parts that are written on any path.
    pub(super) writes: Vec<Parts>,
    /// The globals changed by the function or its callees.
    pub(super) globals: Rc<[VariableId]>,
}

/// Summarizes a function's own reads and writes of its parameters.
pub(super) fn summary(tree: &Tree, cfg: &Cfg, function: FunctionId) -> Summary {
    let parameters = &tree[function].parameters;
    let index: HashMap<VariableId, usize> = parameters.iter().copied().zip(0..).collect();
    let mut summary = Summary {
        reads: vec![0; parameters.len()],
        writes: vec![0; parameters.len()],
        globals: globals(tree, cfg),
    };
    for event in cfg.blocks.iter().flat_map(|basic_block| &basic_block.events) {
        let (part, sum) = match event {
            Event::Read { part, .. } => (part, &mut summary.reads),
            Event::Write(part) => (part, &mut summary.writes),
            _ => continue,
        };
        if let Some(&index) = index.get(&part.variable) {
            sum[index] |= part.parts;
        }
    }
    summary
}

fn globals(tree: &Tree, cfg: &Cfg) -> Rc<[VariableId]> {
    let mut all = BTreeSet::new();
    for event in cfg.blocks.iter().flat_map(|basic_block| &basic_block.events) {
        match event {
            Event::Write(part) if tree[part.variable].kind == VariableKind::Global => {
                all.insert(part.variable);
            }
            Event::Call(globals) => all.extend(globals.iter().copied()),
            _ => {}
        }
    }
    all.into_iter().collect()
}
