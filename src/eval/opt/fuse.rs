//! Fusion: a product whose only use is a sum or difference in the same block becomes one instruction with it,
//! which saves a store and a load. Both operations are still rounded.

use crate::ir::{Block, Function, Node, Operation, Value, ValueDef};
use crate::opt::divergence::Divergence;

/// Fuses products in a function.
pub(crate) fn fuse(function: &mut Function, divergence: &Divergence) {
    let mut pass = Fuse {
        uses: vec![0; function.defs.len()],
        block_of: vec![0; function.defs.len()],
        blocks: 0,
        fused: vec![false; function.defs.len()],
        divergence,
        function,
    };
    for value in pass.function.output {
        pass.uses[value.0 as usize] += 1;
    }
    let mut body = std::mem::take(&mut pass.function.body);
    pass.count(&body);
    pass.block(&mut body);
    pass.function.body = body;
}

struct Fuse<'a> {
    function: &'a mut Function,
    divergence: &'a Divergence,
    /// The number of uses of each value.
    uses: Vec<u32>,
    /// The block that computes each value, once it has been visited.
    block_of: Vec<u32>,
    blocks: u32,
    /// Products that were fused.
    fused: Vec<bool>,
}

impl Fuse<'_> {
    fn count(&mut self, block: &Block) {
        for node in block {
            let uses = &mut self.uses;
            let mut count = |value: Value| uses[value.0 as usize] += 1;
            if let Node::Let(value) = node {
                self.function.def(*value).for_each_operand(&mut count);
            }
            node.for_each_value(|value| count(*value));
            node.for_each_block(|block| self.count(block));
        }
    }

    fn block(&mut self, block: &mut Block) {
        self.blocks += 1;
        let block_id = self.blocks;
        for node in block.iter_mut() {
            if let Node::Let(value) = node {
                self.value(*value, block_id);
                self.block_of[value.0 as usize] = block_id;
            }
            node.for_each_block_mut(|block| self.block(block));
        }
        block.retain(|node| !matches!(node, Node::Let(value) if self.fused[value.0 as usize]));
    }

    fn value(&mut self, value: Value, block_id: u32) {
        let ValueDef::Operation(operation @ (Operation::Add | Operation::Sub), [a, b, _]) =
            self.function.def(value)
        else {
            return;
        };
        let left = self.product(a, block_id).map(|factors| (a, factors, b));
        let right = || self.product(b, block_id).map(|factors| (b, factors, a));
        let Some((product, [x, y], other)) = left.or_else(right) else {
            return;
        };
        let fused = match operation {
            Operation::Add => Operation::MulAdd,
            _ if product == a => Operation::MulSub,
            _ => Operation::SubMul,
        };
        self.fused[product.0 as usize] = true;
        self.function.defs[value.0 as usize] = ValueDef::Operation(fused, [x, y, other]);
    }

    /// Returns the factors of a divergent product from the same block that is used once.
    fn product(&self, value: Value, block_id: u32) -> Option<[Value; 2]> {
        let at = value.0 as usize;
        match self.function.def(value) {
            ValueDef::Operation(Operation::Mul, [x, y, _])
                if self.uses[at] == 1 && self.block_of[at] == block_id && self.divergence.value(value) =>
            {
                Some([x, y])
            }
            _ => None,
        }
    }
}
