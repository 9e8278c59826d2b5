//! Linearization of structured code into steps with jumps and masks.
//!
//! A mask marks the active pixels. Mask 0 has all of them; a divergent branch, and a scope that pixels leave
//! at different times, has its own, numbered by depth. A pixel that leaves a scope is removed from every mask
//! up to the scope's; where a mask becomes empty, control jumps to the end of its owner.

use crate::ir::{Block, Cell, Cells, Function, LoopId, Node, Predicate, Scope, SiteId, Value, ValueDef};
use crate::opt::divergence::Divergence;

/// Identifies a mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mask(pub u16);

/// A jump target: a label while code is generated, the index of a step afterwards.
pub type Target = u32;

/// A step of linear code.
#[derive(Debug, Clone)]
#[doc(hidden)]
pub enum Step {
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
    /// Splits the active pixels by a divergent condition: those for which it is `when` go to the first mask,
    /// the others to the second. Both are the same mask if no branch needs the second. Jumps if the first is
    /// empty.
    Split {
        condition: Value,
        first: Mask,
        second: Mask,
        when: bool,
        if_empty: Target,
    },
    /// Copies the active pixels to a mask.
    Copy {
        to: Mask,
    },
    /// Removes the active pixels whose condition has this value from the masks between two masks, given
    /// innermost first; all of them without a condition. Jumps if none is left.
    Remove {
        condition: Option<(Value, bool)>,
        masks: (Mask, Mask),
        if_empty: Target,
    },
    JumpIfEmpty(Target),
    Jump(Target),
    /// Jumps if a uniform condition is `when`.
    JumpIf {
        condition: Value,
        when: bool,
        to: Target,
    },
    /// Starts an iteration of a loop.
    Iterate(LoopId),
    Check {
        predicate: Predicate,
        values: [Value; 2],
        site: SiteId,
    },
    Trace {
        event: u32,
        component: u32,
        value: Value,
    },
    /// Counts the active pixels of a basic block.
    Count(u32),
}

/// A linearized program.
#[derive(Debug)]
pub struct LinearCode {
    /// The steps, each with the mask of its active pixels.
    pub steps: Vec<(Step, Mask)>,
    /// The number of masks.
    pub masks: u16,
    /// The first and last step of each loop, inner loops before outer ones.
    pub loops: Vec<(u32, u32)>,
    /// The values that are computed once for a frame.
    pub constants: Vec<Value>,
}

/// Linearizes a program. A traced run may replace values, so that nothing is hoisted out of it.
pub(crate) fn linearize(function: &Function, divergence: &Divergence, traced: bool) -> LinearCode {
    let mut pass = Linearizer {
        function,
        divergence,
        traced,
        steps: Vec::new(),
        // Label 0 is the end of the program, whose owner has mask 0.
        labels: vec![UNBOUND],
        owners: vec![Owner {
            mask: Mask(0),
            end: 0,
        }],
        scopes: vec![ScopeExit::default(); function.scopes as usize],
        open_scopes: 0,
        outermost_left: NONE_LEFT,
        masks: 1,
        loops: Vec::new(),
        constants: Vec::new(),
    };
    pass.block(&function.body);
    pass.bind(0);
    pass.finish()
}

/// The step of a label that is not bound yet.
const UNBOUND: u32 = u32::MAX;

/// The depth of the outermost scope that was left, if none was.
const NONE_LEFT: usize = usize::MAX;

/// The branch or scope that a mask belongs to.
#[derive(Debug, Clone, Copy)]
struct Owner {
    mask: Mask,
    /// The label of the owner's end.
    end: Target,
}

/// The exit of an open scope.
#[derive(Debug, Clone, Copy, Default)]
struct ScopeExit {
    /// The number of enclosing scopes.
    depth: usize,
    /// The number of mask owners around the scope's body.
    owners: usize,
    /// The label of the scope's end.
    end: Target,
}

struct Linearizer<'a> {
    function: &'a Function,
    divergence: &'a Divergence,
    traced: bool,
    steps: Vec<(Step, Mask)>,
    /// The step of each label.
    labels: Vec<u32>,
    owners: Vec<Owner>,
    scopes: Vec<ScopeExit>,
    open_scopes: usize,
    /// The depth of the outermost scope that was left.
    outermost_left: usize,
    masks: u16,
    loops: Vec<(u32, u32)>,
    constants: Vec<Value>,
}

impl Linearizer<'_> {
    fn owner(&self) -> Owner {
        self.owners[self.owners.len() - 1]
    }

    fn push(&mut self, step: Step) {
        let mask = self.owner().mask;
        self.steps.push((step, mask));
    }

    fn label(&mut self) -> Target {
        self.labels.push(UNBOUND);
        self.labels.len() as u32 - 1
    }

    fn bind(&mut self, label: Target) {
        self.labels[label as usize] = self.steps.len() as u32;
    }

    fn next_mask(&mut self) -> Mask {
        let mask = Mask(self.owner().mask.0 + 1);
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
            self.function.def(value),
            ValueDef::Float(_)
                | ValueDef::Word(_)
                | ValueDef::Input(..)
                | ValueDef::Extent { .. }
                | ValueDef::Parameter(..)
                | ValueDef::FragCoord(_)
        ) {
            return;
        }
        if self.divergence.is_constant(value) && !self.traced {
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
                if self.divergence.value(condition) {
                    self.divergent_if(condition, yes, no);
                } else {
                    self.uniform_if(condition, yes, no);
                }
            }
            Node::Scope { scope, ref body } => self.scope(scope, body),
            Node::Loop { ref body, .. } => {
                let head = self.label();
                self.bind(head);
                let first = self.steps.len() as u32;
                self.block(body);
                self.push(Step::Jump(head));
                self.loops.push((first, self.steps.len() as u32 - 1));
            }
            Node::LoopHeader(id) => self.push(Step::Iterate(id)),
            Node::Break(scope) => {
                self.note_break(scope);
                self.push_break(scope, None);
            }
            Node::BreakIf {
                scope,
                condition,
                when,
            } => {
                self.note_break(scope);
                if self.divergence.value(condition) {
                    self.push_break(scope, Some((condition, when)));
                } else if self.is_undivided(scope) {
                    let to = self.scopes[scope.0 as usize].end;
                    self.push(Step::JumpIf { condition, when, to });
                } else {
                    let next = self.label();
                    self.push(Step::JumpIf {
                        condition,
                        when: !when,
                        to: next,
                    });
                    self.push_break(scope, None);
                    self.bind(next);
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
            Node::Trace {
                event,
                component,
                value,
            } => self.push(Step::Trace {
                event,
                component,
                value,
            }),
            Node::Count(block) => self.push(Step::Count(block)),
        }
    }

    fn note_break(&mut self, scope: Scope) {
        self.outermost_left = self.outermost_left.min(self.scopes[scope.0 as usize].depth);
    }

    /// Emits code, and returns whether it leaves a scope that is open now.
    fn leaves_open_scope(&mut self, emit: impl FnOnce(&mut Self)) -> bool {
        let before = std::mem::replace(&mut self.outermost_left, NONE_LEFT);
        emit(self);
        let leaves = self.outermost_left < self.open_scopes;
        self.outermost_left = self.outermost_left.min(before);
        leaves
    }

    /// Whether the pixels of a scope cannot have diverged here.
    fn is_undivided(&self, scope: Scope) -> bool {
        self.scopes[scope.0 as usize].owners == self.owners.len()
    }

    fn push_break(&mut self, scope: Scope, condition: Option<(Value, bool)>) {
        let ScopeExit { owners, end, .. } = self.scopes[scope.0 as usize];
        if condition.is_none() && self.is_undivided(scope) {
            self.push(Step::Jump(end));
            return;
        }
        let (inner, outer) = (self.owner(), self.owners[owners - 1]);
        self.push(Step::Remove {
            condition,
            masks: (inner.mask, outer.mask),
            if_empty: inner.end,
        });
    }

    /// Emits an `if` with a uniform condition.
    fn uniform_if(&mut self, condition: Value, yes: &Block, no: &Block) {
        let (otherwise, end) = (self.label(), self.label());
        self.push(Step::JumpIf {
            condition,
            when: yes.is_empty(),
            to: if yes.is_empty() { end } else { otherwise },
        });
        self.block(yes);
        if !yes.is_empty() && !no.is_empty() {
            self.push(Step::Jump(end));
        }
        self.bind(otherwise);
        self.block(no);
        self.bind(end);
    }

    fn divergent_if(&mut self, condition: Value, yes: &Block, no: &Block) {
        // The non-empty branch comes first.
        let (when, first, second) = if yes.is_empty() {
            (false, no, yes)
        } else {
            (true, yes, no)
        };
        let (otherwise, end) = (self.label(), self.label());
        // The first branch has the higher mask: masks inside it are numbered above its own, so that the
        // second branch's survives. Without a second branch, one mask is enough.
        let second_mask = self.next_mask();
        let first_mask = if second.is_empty() {
            second_mask
        } else {
            Mask(second_mask.0 + 1)
        };
        self.masks = self.masks.max(first_mask.0 + 1);
        self.push(Step::Split {
            condition,
            first: first_mask,
            second: second_mask,
            when,
            if_empty: otherwise,
        });
        let leaves = self.leaves_open_scope(|pass| {
            pass.owners.push(Owner {
                mask: first_mask,
                end: otherwise,
            });
            pass.block(first);
            pass.owners.pop();
            pass.bind(otherwise);
            if !second.is_empty() {
                pass.owners.push(Owner {
                    mask: second_mask,
                    end,
                });
                pass.push(Step::JumpIfEmpty(end));
                pass.block(second);
                pass.owners.pop();
            }
        });
        self.bind(end);
        if leaves {
            let end = self.owner().end;
            self.push(Step::JumpIfEmpty(end));
        }
    }

    fn scope(&mut self, scope: Scope, body: &Block) {
        let end = self.label();
        let is_divergent = self.divergence.scope(scope);
        if is_divergent {
            let mask = self.next_mask();
            self.push(Step::Copy { to: mask });
            self.owners.push(Owner { mask, end });
        }
        self.scopes[scope.0 as usize] = ScopeExit {
            depth: self.open_scopes,
            owners: self.owners.len(),
            end,
        };
        let leaves = self.leaves_open_scope(|pass| {
            pass.open_scopes += 1;
            pass.block(body);
            pass.open_scopes -= 1;
        });
        if is_divergent {
            self.owners.pop();
        }
        self.bind(end);
        // A scope without a mask of its own needs no check: what emptied the owner's mask has jumped already.
        if is_divergent && leaves {
            let end = self.owner().end;
            self.push(Step::JumpIfEmpty(end));
        }
    }

    fn finish(self) -> LinearCode {
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
                Step::Split { if_empty: to, .. }
                | Step::Remove { if_empty: to, .. }
                | Step::JumpIfEmpty(to)
                | Step::Jump(to)
                | Step::JumpIf { to, .. } => *to = labels[*to as usize],
                _ => {}
            }
        }
        LinearCode {
            steps,
            masks,
            loops,
            constants,
        }
    }
}
