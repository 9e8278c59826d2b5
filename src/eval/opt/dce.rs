//! What nothing asks for is taken out: values, stores to cells that are never read, and choices with nothing in them. What is left asks for
//! others: what it is made of, and the conditions of the choices that it stands in.

use crate::ir::alias::Groups;
use crate::ir::function::{Block, Cell, Flow, Node, Origin, Value};
use crate::observe::Predicate;

/// Rewrites a program.
pub(crate) fn prune(flow: &mut Flow) {
    // Cells that only an index leads to which nobody asks for are in no group the second time.
    for _ in 0..2 {
        once(flow);
    }
}

fn once(flow: &mut Flow) {
    let groups = Groups::of(flow);
    let body = std::mem::take(&mut flow.body);
    let mut pass = Prune {
        values: vec![false; flow.origins.len()],
        cells: vec![false; flow.cells.len()],
        stores: vec![Vec::new(); flow.cells.len()],
        homes: vec![0; flow.origins.len()],
        choices: vec![Choice {
            around: 0,
            condition: None,
        }],
        pending: flow.output.to_vec(),
        groups,
        flow,
    };
    pass.roots(&body, 0);
    pass.spread();
    let body = pass.keep(body);
    pass.flow.body = body;
}

/// A choice: an [`Node::If`], or the first, what is around all.
struct Choice {
    around: usize,
    /// Until it is asked for, since something in it is kept.
    condition: Option<Value>,
}

struct Prune<'a> {
    flow: &'a mut Flow,
    groups: Groups,
    values: Vec<bool>,
    cells: Vec<bool>,
    /// What is stored to each cell, and in which choice; to those of a group, to its first.
    stores: Vec<Vec<(Value, usize)>>,
    /// The choice in which each value is computed.
    homes: Vec<usize>,
    choices: Vec<Choice>,
    pending: Vec<Value>,
}

impl Prune<'_> {
    fn roots(&mut self, block: &Block, choice: usize) {
        for node in block {
            match node {
                Node::Let(value) => self.homes[value.0 as usize] = choice,
                Node::Store { cell, value } => self.stores[self.groups.unit(*cell)].push((*value, choice)),
                Node::StoreAt {
                    cells, index, value, ..
                } => {
                    let unit = self.groups.unit(Cell(cells.first));
                    self.stores[unit].extend([(*index, choice), (*value, choice)]);
                }
                Node::If { condition, .. } => {
                    self.choices.push(Choice {
                        around: choice,
                        condition: Some(*condition),
                    });
                    let inner = self.choices.len() - 1;
                    node.for_each_block(|block| self.roots(block, inner));
                }
                Node::Scope { body, .. } => self.roots(body, choice),
                Node::Loop { body, .. } => {
                    self.ask(choice);
                    self.roots(body, choice);
                }
                _ if self.is_certain(node) => {}
                _ => {
                    node.for_each_value(|value| self.pending.push(value));
                    self.ask(choice);
                }
            }
        }
    }

    /// Asks for the conditions of a choice and of those around it.
    fn ask(&mut self, mut choice: usize) {
        while let Some(condition) = self.choices[choice].condition.take() {
            self.pending.push(condition);
            choice = self.choices[choice].around;
        }
    }

    fn spread(&mut self) {
        while let Some(value) = self.pending.pop() {
            if std::mem::replace(&mut self.values[value.0 as usize], true) {
                continue;
            }
            self.ask(self.homes[value.0 as usize]);
            let origin = self.flow.origin(value);
            origin.for_each_operand(|operand| self.pending.push(operand));
            let cell = match origin {
                Origin::Load(cell) => cell,
                Origin::LoadAt { cells, .. } => Cell(cells.first),
                _ => continue,
            };
            let unit = self.groups.unit(cell);
            if !std::mem::replace(&mut self.cells[unit], true) {
                for (value, choice) in std::mem::take(&mut self.stores[unit]) {
                    self.pending.push(value);
                    self.ask(choice);
                }
            }
        }
    }

    /// Whether a node notes what is written for certain.
    fn is_certain(&self, node: &Node) -> bool {
        matches!(node, Node::Check {
            predicate: Predicate::Zero,
            values: [value, _],
            ..
        } if matches!(self.flow.origin(*value), Origin::Word(word) if word != 0))
    }

    fn keep(&self, block: Block) -> Block {
        let mut out = Block::with_capacity(block.len());
        for node in block {
            let kept = match node {
                Node::Let(value) => self.values[value.0 as usize].then_some(node),
                Node::Store { cell, .. } => self.cells[self.groups.unit(cell)].then_some(node),
                Node::StoreAt { cells, .. } => {
                    self.cells[self.groups.unit(Cell(cells.first))].then_some(node)
                }
                Node::If { condition, yes, no } => {
                    let [yes, no] = [yes, no].map(|block| self.keep(block));
                    let empty = yes.is_empty() && no.is_empty();
                    (!empty).then_some(Node::If { condition, yes, no })
                }
                Node::Scope { scope, body } => {
                    let body = self.keep(body);
                    (!body.is_empty()).then_some(Node::Scope { scope, body })
                }
                Node::Loop { id, body } => Some(Node::Loop {
                    id,
                    body: self.keep(body),
                }),
                _ => (!self.is_certain(&node)).then_some(node),
            };
            out.extend(kept);
        }
        out
    }
}
