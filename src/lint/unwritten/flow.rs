//! The ways through a function: blocks of what it reads and writes, and how they follow each other.

use std::collections::{BTreeSet, HashSet};
use std::rc::Rc;

use toyproof_glsl::tree::{Direction, ExprId, Tree, Type, VariableId, VariableKind};

use super::part::Part;

/// What happens at one place, as far as the search asks.
#[derive(Debug, Clone)]
pub(super) enum Event {
    /// A variable begins, without a value.
    Begin(VariableId),
    Read {
        part: Part,
        /// The place that is told.
        expr: ExprId,
    },
    Write(Part),
    /// A variable, or a part of it, is given a value that may be known.
    Set {
        variable: VariableId,
        /// None at its declaration.
        target: Option<ExprId>,
        value: ExprId,
    },
    /// A variable changes in a way that is not followed.
    Forget(VariableId),
    /// An author's function ran, and may have changed these globals.
    Called(Rc<[VariableId]>),
}

/// Names a block of a [`Flow`].
pub(super) type BlockId = usize;

#[derive(Debug, Clone)]
pub(super) enum End {
    /// Not told yet, or never reached.
    Open,
    Goto(BlockId),
    /// Back to the head of a loop, the blocks of which begin there and end before the one that goes back.
    Repeat(BlockId),
    Branch {
        condition: ExprId,
        yes: BlockId,
        no: BlockId,
        /// The head of the loop that it may end.
        of_loop: Option<BlockId>,
    },
    Switch {
        selector: ExprId,
        /// The values of the labels of each case, and where it begins.
        cases: Vec<(Vec<u32>, BlockId)>,
        /// Where it goes for any other value.
        default: BlockId,
    },
    Return,
    /// Past the last statement, without a `return`.
    Fall,
}

#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) events: Vec<Event>,
    pub(super) end: End,
}

/// The ways through a function, from block 0.
pub(super) struct Flow {
    pub(super) nodes: Vec<Node>,
    /// Variables and parts of them that a `return` gives beside others.
    pub(super) returned_beside: HashSet<ExprId>,
}

impl Flow {
    /// The variables that the blocks change from the head of a loop to the one that goes back; `before` is by block, those that go to it.
    pub(super) fn changed_in(
        &self,
        before: &[Vec<BlockId>],
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
            for event in &self.nodes[block].events {
                match event {
                    Event::Set { variable, .. } | Event::Forget(variable) | Event::Begin(variable) => {
                        changed.insert(*variable);
                    }
                    Event::Write(part) => {
                        changed.insert(part.variable);
                    }
                    Event::Called(globals) => changed.extend(globals.iter().copied()),
                    Event::Read { .. } => {}
                }
            }
            if block != head {
                pending.extend(before[block].iter().copied());
            }
        }
        changed.into_iter().collect()
    }
}

impl End {
    /// Whether a block may come next.
    pub(super) fn goes_on(&self) -> bool {
        !matches!(self, Self::Open | Self::Return | Self::Fall)
    }

    /// Visits each block that may come next.
    pub(super) fn each_next(&self, mut visit: impl FnMut(BlockId)) {
        match self {
            Self::Open | Self::Return | Self::Fall => {}
            Self::Goto(to) | Self::Repeat(to) => visit(*to),
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

/// Whether a variable that begins without a value is looked for.
pub(super) fn is_followed(tree: &Tree, variable: VariableId) -> bool {
    let local = matches!(
        tree[variable].kind,
        VariableKind::Local | VariableKind::Parameter(Direction::Out)
    );
    local && !matches!(tree[variable].ty, Type::Sampler(_))
}

/// The variables that a function's blocks begin without a value.
pub(super) fn begun(flow: &Flow) -> Vec<(VariableId, BlockId, usize)> {
    let mut all = Vec::new();
    for (block, node) in flow.nodes.iter().enumerate() {
        for (index, event) in node.events.iter().enumerate() {
            if let Event::Begin(variable) = event {
                all.push((*variable, block, index));
            }
        }
    }
    all
}
