//! Profiles: the origins of operations, the parts of the program, and the basic blocks that are counted.

use std::collections::HashMap;

use toyproof_glsl::tree::{ExprId, Place};

use super::{Builder, IrWriter, Result, TraceDetail};
use crate::ir::{BasicBlock, Block, Node, Operation, Origin, Part, PartId, PartKind, Value, ValueDef, cost};

impl Builder<'_> {
    fn counts(&self) -> bool {
        self.options.trace == TraceDetail::Counts
    }

    /// Begins the operations of an expression or a statement at this place.
    pub(super) fn begin_origin(&self, at: Place, expr: Option<ExprId>) {
        if self.counts() {
            let call = self.current_call();
            self.writer.borrow_mut().origin = Some(Origin { call, at, expr });
        }
    }

    /// Returns the origin of the operations that are written next.
    pub(super) fn origin(&self) -> Option<Origin> {
        self.writer.borrow().origin
    }

    pub(super) fn set_origin(&self, origin: Option<Origin>) {
        self.writer.borrow_mut().origin = origin;
    }

    /// Writes a part of the program, whose executions a profile counts.
    pub(super) fn part<T>(
        &mut self,
        kind: PartKind,
        at: Place,
        write: impl FnOnce(&mut Self) -> Result<T>,
    ) -> Result<T> {
        if !self.counts() {
            return write(self);
        }
        let id = self.count(kind, at);
        self.open_parts.push(id);
        let written = write(self);
        self.open_parts.pop();
        written
    }

    /// Counts a statement that begins, or a condition on a line of its own.
    pub(super) fn count_statement(&mut self, at: Place) {
        if self.counts() {
            self.count(PartKind::Statement, at);
        }
    }

    fn count(&mut self, kind: PartKind, at: Place) -> PartId {
        let id = PartId(self.parts.len() as u32);
        let parent = self.open_parts.last().copied();
        self.parts.push(Part { kind, at, parent });
        self.push(Node::Count(id.0));
        id
    }
}

/// Replaces the counts of parts by those of basic blocks, and returns the blocks.
pub(super) fn basic_blocks(writer: &mut IrWriter) -> Vec<BasicBlock> {
    let mut body = std::mem::take(&mut writer.block);
    let mut pass = Pass {
        writer,
        constant: constants(&writer.defs),
        costs: HashMap::new(),
        blocks: Vec::new(),
    };
    pass.block(&mut body);
    let blocks = pass.blocks;
    writer.block = body;
    blocks
}

/// Returns which values are constants, or computed from constants alone.
fn constants(defs: &[ValueDef]) -> Vec<bool> {
    let mut constant: Vec<bool> = Vec::with_capacity(defs.len());
    for def in defs {
        constant.push(match def {
            ValueDef::Float(_) | ValueDef::Word(_) => true,
            ValueDef::Operation(..) => {
                let mut all = true;
                // Operands precede their users.
                def.for_each_operand(|operand| all &= constant[operand.0 as usize]);
                all
            }
            _ => false,
        });
    }
    constant
}

struct Pass<'a> {
    writer: &'a IrWriter,
    /// Which values are constants; computing them costs nothing.
    constant: Vec<bool>,
    /// The costs of operations that were needed.
    costs: HashMap<Operation, u64>,
    blocks: Vec<BasicBlock>,
}

impl Pass<'_> {
    fn block(&mut self, nodes: &mut Block) {
        let mut is_open = false;
        for mut node in std::mem::take(nodes) {
            let begins = match node {
                Node::Count(_) => true,
                Node::Let(value) => self.counted(value).is_some(),
                _ => false,
            };
            if begins && !is_open {
                nodes.push(Node::Count(self.blocks.len() as u32));
                self.blocks.push(BasicBlock::default());
                is_open = true;
            }
            match node {
                Node::Count(part) => {
                    self.blocks
                        .last_mut()
                        .expect("a block is open")
                        .parts
                        .push(PartId(part));
                    continue;
                }
                Node::Let(value) => self.add(value),
                _ => {}
            }
            let is_jump = matches!(
                node,
                Node::If { .. }
                    | Node::Scope { .. }
                    | Node::Loop { .. }
                    | Node::Break(_)
                    | Node::BreakIf { .. }
            );
            is_open &= !is_jump;
            node.for_each_block_mut(|block| self.block(block));
            nodes.push(node);
        }
    }

    /// Returns the definition of a value that counts, and its origin.
    fn counted(&self, value: Value) -> Option<(ValueDef, Origin)> {
        let def = self.writer.defs[value.0 as usize];
        let is_computed = matches!(def, ValueDef::Operation(..) | ValueDef::Texel { .. });
        if !is_computed || self.constant[value.0 as usize] {
            return None;
        }
        let origins = &self.writer.origins;
        let after = origins.partition_point(|&(first, _)| first <= value.0);
        Some((def, origins[after.checked_sub(1)?].1))
    }

    /// Adds a value to the last block.
    fn add(&mut self, value: Value) {
        let Some((def, origin)) = self.counted(value) else {
            return;
        };
        let cost = match def {
            ValueDef::Operation(operation, _) => {
                *self.costs.entry(operation).or_insert_with(|| cost(operation))
            }
            _ => 1,
        };
        let block = self.blocks.last_mut().expect("a block is open");
        block.add(origin, cost);
        if let ValueDef::Texel { channel, .. } = def {
            block.texels[usize::from(channel)] += 1;
        }
    }
}
