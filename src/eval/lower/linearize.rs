//! Structured code as steps in a row with jumps and masks.
//!
//! A mask says which pixels are here. Mask 0 has all of them; a branch that only some pixels take, and a scope that some
//! leave before others, has its own, numbered by depth. Who leaves is taken out of every mask up to that of the scope; where a mask has become
//! empty, control jumps to the end of what it belongs to.

use crate::ir::function::{Block, Cell, Cells, Flow, LoopId, Node, Origin, Scope, Value};
use crate::observe::{Predicate, SiteId};
use crate::opt::divergence::Varying;

/// Names a mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Mask(pub(crate) u16);

/// Where to go on: the position of a step, once all are there.
pub(crate) type Target = u32;

/// A step.
#[derive(Debug, Clone)]
pub(crate) enum Step {
    Compute(Value),
    Store {
        cell: Cell,
        value: Value,
    },
    StoreAt {
        cells: Cells,
        offset: u32,
        index: Value,
        value: Value,
    },
    /// Divides the pixels that are here by a varying condition. Jumps if none is for the first branch.
    Split {
        condition: Value,
        yes: Mask,
        no: Mask,
        when: bool,
        empty: Target,
    },
    /// All pixels that are here, in another mask.
    Copy {
        to: Mask,
    },
    /// Takes those pixels that are here out of some masks, the innermost first, for which a condition is `when`; jumps if none
    /// is left.
    Remove {
        condition: Option<(Value, bool)>,
        masks: (Mask, Mask),
        empty: Target,
    },
    JumpIfEmpty(Target),
    Jump(Target),
    /// Jumps if a uniform condition is `when`.
    JumpIf {
        condition: Value,
        when: bool,
        to: Target,
    },
    /// One more round of a loop.
    Iterate(LoopId),
    Check {
        predicate: Predicate,
        values: [Value; 2],
        site: SiteId,
    },
    Tell {
        event: u32,
        component: u32,
        value: Value,
    },
}

/// A program in a row.
#[derive(Debug)]
pub(crate) struct Flat {
    /// Each with the mask of the pixels that are there.
    pub(crate) steps: Vec<(Step, Mask)>,
    /// How many masks there are.
    pub(crate) masks: u16,
    /// First and last step of each loop, inner ones before outer ones.
    pub(crate) loops: Vec<(u32, u32)>,
    /// What is computed once for a frame.
    pub(crate) constants: Vec<Value>,
}

/// Lays a program out. Values of a story may be replaced while it runs: there, nothing is computed before its time.
pub(crate) fn flatten(flow: &Flow, varying: &Varying, story: bool) -> Flat {
    let mut pass = Flatten {
        flow,
        varying,
        story,
        steps: Vec::new(),
        labels: vec![u32::MAX],
        owners: vec![Owner {
            mask: Mask(0),
            end: 0,
        }],
        scopes: vec![Exit::default(); flow.scopes as usize],
        open: 0,
        left: usize::MAX,
        masks: 1,
        loops: Vec::new(),
        constants: Vec::new(),
    };
    pass.block(&flow.body);
    pass.place(0);
    pass.finish()
}

/// What a mask belongs to.
#[derive(Debug, Clone, Copy)]
struct Owner {
    mask: Mask,
    /// The label of its end.
    end: Target,
}

/// Where a scope that is open ends.
#[derive(Debug, Clone, Copy, Default)]
struct Exit {
    /// How many scopes are around it.
    depth: usize,
    /// How many owners are around its inside.
    owners: usize,
    /// The label of its end.
    end: Target,
}

struct Flatten<'a> {
    flow: &'a Flow,
    varying: &'a Varying,
    story: bool,
    steps: Vec<(Step, Mask)>,
    /// The position of each label.
    labels: Vec<u32>,
    owners: Vec<Owner>,
    scopes: Vec<Exit>,
    /// How many scopes are open.
    open: usize,
    /// Of the scopes that have been left, how many are around the outermost.
    left: usize,
    masks: u16,
    loops: Vec<(u32, u32)>,
    constants: Vec<Value>,
}

impl Flatten<'_> {
    fn here(&self) -> Owner {
        self.owners[self.owners.len() - 1]
    }

    fn push(&mut self, step: Step) {
        let mask = self.here().mask;
        self.steps.push((step, mask));
    }

    fn label(&mut self) -> Target {
        self.labels.push(u32::MAX);
        self.labels.len() as u32 - 1
    }

    fn place(&mut self, label: Target) {
        self.labels[label as usize] = self.steps.len() as u32;
    }

    fn next_mask(&mut self) -> Mask {
        let mask = Mask(self.here().mask.0 + 1);
        self.masks = self.masks.max(mask.0 + 1);
        mask
    }

    fn block(&mut self, block: &Block) {
        for node in block {
            self.node(node);
        }
    }

    fn compute(&mut self, value: Value) {
        if matches!(
            self.flow.origin(value),
            Origin::Float(_) | Origin::Word(_) | Origin::Input(..) | Origin::FragCoord(_)
        ) {
            return;
        }
        if self.varying.is_constant(value) && !self.story {
            self.constants.push(value);
        } else {
            self.push(Step::Compute(value));
        }
    }

    fn node(&mut self, node: &Node) {
        match *node {
            Node::Let(value) => self.compute(value),
            Node::Store { cell, value } => self.push(Step::Store { cell, value }),
            Node::StoreAt {
                cells,
                offset,
                index,
                value,
            } => self.push(Step::StoreAt {
                cells,
                offset,
                index,
                value,
            }),
            Node::If {
                condition,
                ref yes,
                ref no,
            } => {
                if self.varying.value(condition) {
                    self.divide(condition, yes, no);
                } else {
                    self.choose(condition, yes, no);
                }
            }
            Node::Scope { scope, ref body } => self.scope(scope, body),
            Node::Loop { ref body, .. } => {
                let head = self.label();
                self.place(head);
                let first = self.steps.len() as u32;
                self.block(body);
                self.push(Step::Jump(head));
                self.loops.push((first, self.steps.len() as u32 - 1));
            }
            Node::Round(id) => self.push(Step::Iterate(id)),
            Node::Leave(scope) => {
                self.note_left(scope);
                self.leave(scope, None);
            }
            Node::LeaveIf {
                scope,
                condition,
                when,
            } => {
                self.note_left(scope);
                if self.varying.value(condition) {
                    self.leave(scope, Some((condition, when)));
                } else if self.is_plain(scope) {
                    let to = self.scopes[scope.0 as usize].end;
                    self.push(Step::JumpIf { condition, when, to });
                } else {
                    let on = self.label();
                    self.push(Step::JumpIf {
                        condition,
                        when: !when,
                        to: on,
                    });
                    self.leave(scope, None);
                    self.place(on);
                }
            }
            Node::Check {
                predicate,
                values,
                site,
            } => self.push(Step::Check {
                predicate,
                values,
                site,
            }),
            Node::Tell {
                event,
                component,
                value,
            } => self.push(Step::Tell {
                event,
                component,
                value,
            }),
        }
    }

    fn note_left(&mut self, scope: Scope) {
        self.left = self.left.min(self.scopes[scope.0 as usize].depth);
    }

    /// Does some work, and tells whether a scope was left in it that is open now.
    fn is_left(&mut self, work: impl FnOnce(&mut Self)) -> bool {
        let before = std::mem::replace(&mut self.left, usize::MAX);
        work(self);
        let found = self.left < self.open;
        self.left = self.left.min(before);
        found
    }

    /// Whether all pixels of a scope are here together, if they are.
    fn is_plain(&self, scope: Scope) -> bool {
        self.scopes[scope.0 as usize].owners == self.owners.len()
    }

    fn leave(&mut self, scope: Scope, condition: Option<(Value, bool)>) {
        let Exit { owners, end, .. } = self.scopes[scope.0 as usize];
        if condition.is_none() && owners == self.owners.len() {
            self.push(Step::Jump(end));
            return;
        }
        let (inner, outer) = (self.here(), self.owners[owners - 1]);
        self.push(Step::Remove {
            condition,
            masks: (inner.mask, outer.mask),
            empty: inner.end,
        });
    }

    /// An `if` that all pixels decide in the same way.
    fn choose(&mut self, condition: Value, yes: &Block, no: &Block) {
        let (otherwise, end) = (self.label(), self.label());
        if yes.is_empty() {
            self.push(Step::JumpIf {
                condition,
                when: true,
                to: end,
            });
            self.place(otherwise);
        } else {
            self.push(Step::JumpIf {
                condition,
                when: false,
                to: otherwise,
            });
            self.block(yes);
            if !no.is_empty() {
                self.push(Step::Jump(end));
            }
            self.place(otherwise);
        }
        self.block(no);
        self.place(end);
    }

    fn divide(&mut self, condition: Value, yes: &Block, no: &Block) {
        // The branch that there is comes first.
        let (when, first, second) = if yes.is_empty() {
            (false, no, yes)
        } else {
            (true, yes, no)
        };
        let (otherwise, end) = (self.label(), self.label());
        let mask = self.next_mask();
        // Both live beside each other while the first branch runs; without a second one, one mask is enough.
        let other = if second.is_empty() { mask } else { Mask(mask.0 + 1) };
        self.masks = self.masks.max(other.0 + 1);
        self.push(Step::Split {
            condition,
            yes: mask.max(other),
            no: mask.min(other),
            when,
            empty: otherwise,
        });
        let left = self.is_left(|pass| {
            pass.owners.push(Owner {
                mask: mask.max(other),
                end: otherwise,
            });
            pass.block(first);
            pass.owners.pop();
            pass.place(otherwise);
            if !second.is_empty() {
                pass.owners.push(Owner {
                    mask: mask.min(other),
                    end,
                });
                pass.push(Step::JumpIfEmpty(end));
                pass.block(second);
                pass.owners.pop();
            }
        });
        self.place(end);
        if left {
            let end = self.here().end;
            self.push(Step::JumpIfEmpty(end));
        }
    }

    fn scope(&mut self, scope: Scope, body: &Block) {
        let end = self.label();
        let own = self.varying.scope(scope);
        if own {
            let mask = self.next_mask();
            self.push(Step::Copy { to: mask });
            self.owners.push(Owner { mask, end });
        }
        self.scopes[scope.0 as usize] = Exit {
            depth: self.open,
            owners: self.owners.len(),
            end,
        };
        let left = self.is_left(|pass| {
            pass.open += 1;
            pass.block(body);
            pass.open -= 1;
        });
        if own {
            self.owners.pop();
        }
        self.place(end);
        if own && left {
            let end = self.here().end;
            self.push(Step::JumpIfEmpty(end));
        }
    }

    fn finish(self) -> Flat {
        let Self {
            mut steps,
            labels,
            masks,
            loops,
            constants,
            ..
        } = self;
        for (step, _) in &mut steps {
            match step {
                Step::Split { empty: to, .. }
                | Step::Remove { empty: to, .. }
                | Step::JumpIfEmpty(to)
                | Step::Jump(to)
                | Step::JumpIf { to, .. } => *to = labels[*to as usize],
                _ => {}
            }
        }
        Flat {
            steps,
            masks,
            loops,
            constants,
        }
    }
}

impl Mask {
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
}
