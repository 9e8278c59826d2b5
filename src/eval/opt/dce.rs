//! Dead code elimination: removes unused values, stores to cells that are never read, and empty `if`s.
//!
//! A kept node requires its operands and the conditions of the `if`s around it.

use crate::ir::{AliasGroups, Block, Cell, Function, Node, Predicate, Value, ValueDef};

/// Removes dead code from a function.
pub(crate) fn eliminate_dead_code(function: &mut Function) {
    // Cells that were only reached by dead indexed accesses are in no alias group in the second pass.
    for _ in 0..2 {
        once(function);
    }
}

fn once(function: &mut Function) {
    let groups = AliasGroups::new(function);
    let body = std::mem::take(&mut function.body);
    let mut pass = DeadCodeElimination {
        values: vec![false; function.defs.len()],
        cells: vec![false; function.cells.len()],
        stores: vec![Vec::new(); function.cells.len()],
        branch_of: vec![0; function.defs.len()],
        branches: vec![Branch {
            parent: 0,
            condition: None,
        }],
        pending: function.output.to_vec(),
        groups,
        function,
    };
    pass.collect_roots(&body, 0);
    pass.propagate();
    let body = pass.retain(body);
    pass.function.body = body;
}

/// A control dependency: an [`Node::If`], or for index 0, the whole body.
struct Branch {
    parent: usize,
    /// Taken once the condition is required.
    condition: Option<Value>,
}

struct DeadCodeElimination<'a> {
    function: &'a mut Function,
    groups: AliasGroups,
    values: Vec<bool>,
    cells: Vec<bool>,
    /// The values stored to each cell, and the branch of the store; for groups, by the first cell.
    stores: Vec<Vec<(Value, usize)>>,
    /// The branch that computes each value.
    branch_of: Vec<usize>,
    branches: Vec<Branch>,
    pending: Vec<Value>,
}

impl DeadCodeElimination<'_> {
    fn collect_roots(&mut self, block: &Block, branch: usize) {
        for node in block {
            match node {
                Node::Let(value) => self.branch_of[value.0 as usize] = branch,
                Node::Store { cell, value } => {
                    self.stores[self.groups.representative(*cell).index()].push((*value, branch));
                }
                Node::StoreAt {
                    cells, index, value, ..
                } => {
                    let unit = self.groups.representative(Cell(cells.first)).index();
                    self.stores[unit].extend([(*index, branch), (*value, branch)]);
                }
                Node::If { condition, .. } => {
                    self.branches.push(Branch {
                        parent: branch,
                        condition: Some(*condition),
                    });
                    let inner = self.branches.len() - 1;
                    node.for_each_block(|block| self.collect_roots(block, inner));
                }
                Node::Scope { body, .. } => self.collect_roots(body, branch),
                Node::Loop { body, .. } => {
                    self.require(branch);
                    self.collect_roots(body, branch);
                }
                _ if self.never_fires(node) => {}
                _ => {
                    node.for_each_value(|value| self.pending.push(*value));
                    self.require(branch);
                }
            }
        }
    }

    /// Requires the conditions of a branch and of those around it.
    fn require(&mut self, mut branch: usize) {
        while let Some(condition) = self.branches[branch].condition.take() {
            self.pending.push(condition);
            branch = self.branches[branch].parent;
        }
    }

    fn propagate(&mut self) {
        while let Some(value) = self.pending.pop() {
            if std::mem::replace(&mut self.values[value.0 as usize], true) {
                continue;
            }
            self.require(self.branch_of[value.0 as usize]);
            let def = self.function.def(value);
            def.for_each_operand(|operand| self.pending.push(operand));
            let cell = match def {
                ValueDef::Load(cell) => cell,
                ValueDef::LoadAt { cells, .. } => Cell(cells.first),
                _ => continue,
            };
            let unit = self.groups.representative(cell).index();
            if !std::mem::replace(&mut self.cells[unit], true) {
                for (value, branch) in std::mem::take(&mut self.stores[unit]) {
                    self.pending.push(value);
                    self.require(branch);
                }
            }
        }
    }

    /// Whether a node is a check of a constant flag that is set, which never fires.
    fn never_fires(&self, node: &Node) -> bool {
        matches!(node, Node::Check {
            predicate: Predicate::Zero,
            values: [value, _],
            ..
        } if matches!(self.function.def(*value), ValueDef::Word(word) if word != 0))
    }

    fn retain(&self, block: Block) -> Block {
        let mut out = Block::with_capacity(block.len());
        for node in block {
            let kept = match node {
                Node::Let(value) => self.values[value.0 as usize].then_some(node),
                Node::Store { cell, .. } => {
                    self.cells[self.groups.representative(cell).index()].then_some(node)
                }
                Node::StoreAt { cells, .. } => {
                    self.cells[self.groups.representative(Cell(cells.first)).index()].then_some(node)
                }
                Node::If { condition, yes, no } => {
                    let [yes, no] = [yes, no].map(|block| self.retain(block));
                    let empty = yes.is_empty() && no.is_empty();
                    (!empty).then_some(Node::If { condition, yes, no })
                }
                Node::Scope { scope, body } => {
                    let body = self.retain(body);
                    (!body.is_empty()).then_some(Node::Scope { scope, body })
                }
                Node::Loop { id, body } => Some(Node::Loop {
                    id,
                    body: self.retain(body),
                }),
                _ => (!self.never_fires(&node)).then_some(node),
            };
            out.extend(kept);
        }
        out
    }
}
