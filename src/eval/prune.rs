//! What nothing asks for is taken out: values, and stores to cells that are never read.

use super::flow::{Block, Cell, Flow, Node, Origin, Value};
use super::group::Groups;
use super::observe::Predicate;

/// Rewrites a program.
pub(super) fn prune(flow: &mut Flow) {
    // A choice between nothing and nothing asks for its condition no more.
    while once(flow) {}
}

/// Whether a choice was taken out.
fn once(flow: &mut Flow) -> bool {
    let groups = Groups::of(flow);
    let mut pass = Prune {
        values: vec![false; flow.origins.len()],
        cells: vec![false; flow.cells.len()],
        stores: vec![Vec::new(); flow.cells.len()],
        pending: flow.output.to_vec(),
        groups,
        flow,
        emptied: false,
    };
    pass.roots(&pass.flow.body.clone());
    pass.spread();
    let body = std::mem::take(&mut pass.flow.body);
    let body = pass.keep(body);
    pass.flow.body = body;
    pass.emptied
}

struct Prune<'a> {
    flow: &'a mut Flow,
    groups: Groups,
    values: Vec<bool>,
    cells: Vec<bool>,
    /// What is stored to each cell; to those of a group, to its first.
    stores: Vec<Vec<Value>>,
    pending: Vec<Value>,
    emptied: bool,
}

impl Prune<'_> {
    fn home(&self, cell: Cell) -> usize {
        let group = self.groups.find(cell);
        group.map_or(cell.0, |group| self.groups.ranges()[group].first) as usize
    }

    fn roots(&mut self, block: &Block) {
        for node in block {
            match node {
                Node::Store { cell, value } => {
                    let home = self.home(*cell);
                    self.stores[home].push(*value);
                }
                Node::StoreAt {
                    cells, index, value, ..
                } => {
                    let home = self.home(Cell(cells.first));
                    self.stores[home].extend([*index, *value]);
                }
                _ => node.for_each_value(|value| self.pending.push(value)),
            }
            node.for_each_block(|block| self.roots(block));
        }
    }

    fn spread(&mut self) {
        while let Some(value) = self.pending.pop() {
            if std::mem::replace(&mut self.values[value.0 as usize], true) {
                continue;
            }
            let origin = self.flow.origin(value);
            origin.for_each_operand(|operand| self.pending.push(operand));
            let cell = match origin {
                Origin::Load(cell) => cell,
                Origin::LoadAt { cells, .. } => Cell(cells.first),
                _ => continue,
            };
            let home = self.home(cell);
            if !std::mem::replace(&mut self.cells[home], true) {
                self.pending.append(&mut self.stores[home]);
            }
        }
    }

    fn keep(&mut self, block: Block) -> Block {
        let mut out = Block::with_capacity(block.len());
        for node in block {
            let kept = match node {
                Node::Let(value) => self.values[value.0 as usize].then_some(node),
                Node::Store { cell, .. } => self.cells[self.home(cell)].then_some(node),
                Node::StoreAt { cells, .. } => self.cells[self.home(Cell(cells.first))].then_some(node),
                Node::If { condition, yes, no } => {
                    let [yes, no] = [yes, no].map(|block| self.keep(block));
                    let empty = yes.is_empty() && no.is_empty();
                    self.emptied |= empty;
                    (!empty).then_some(Node::If { condition, yes, no })
                }
                Node::Scope { scope, body } => {
                    let body = self.keep(body);
                    (!body.is_empty()).then_some(Node::Scope { scope, body })
                }
                // What is written for certain.
                Node::Check {
                    predicate: Predicate::Zero,
                    values: [value, _],
                    ..
                } if matches!(self.flow.origin(value), Origin::Word(word) if word != 0) => None,
                Node::Loop { id, body } => Some(Node::Loop {
                    id,
                    body: self.keep(body),
                }),
                _ => Some(node),
            };
            out.extend(kept);
        }
        out
    }
}
