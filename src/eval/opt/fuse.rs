//! A product that only a sum or difference next to it takes becomes one instruction with that: it need not be stored and read again. Both
//! are rounded as before.

use crate::ir::function::{Block, Flow, Node, Origin, Value};
use crate::ir::operation::Operation;
use crate::opt::divergence::Varying;

/// Rewrites a program.
pub(crate) fn fuse(flow: &mut Flow, varying: &Varying) {
    let mut pass = Fuse {
        uses: vec![0; flow.origins.len()],
        here: vec![0; flow.origins.len()],
        blocks: 0,
        gone: vec![false; flow.origins.len()],
        varying,
        flow,
    };
    for value in pass.flow.output {
        pass.uses[value.0 as usize] += 1;
    }
    let mut body = std::mem::take(&mut pass.flow.body);
    pass.count(&body);
    pass.block(&mut body);
    pass.flow.body = body;
}

struct Fuse<'a> {
    flow: &'a mut Flow,
    varying: &'a Varying,
    /// How often each value is used.
    uses: Vec<u32>,
    /// In which block each value is computed, once that is reached.
    here: Vec<u32>,
    blocks: u32,
    /// Which are not computed by themselves any more.
    gone: Vec<bool>,
}

impl Fuse<'_> {
    fn count(&mut self, block: &Block) {
        for node in block {
            let uses = &mut self.uses;
            let mut count = |value: Value| uses[value.0 as usize] += 1;
            if let Node::Let(value) = node {
                self.flow.origin(*value).for_each_operand(&mut count);
            }
            node.for_each_value(count);
            node.for_each_block(|block| self.count(block));
        }
    }

    fn block(&mut self, block: &mut Block) {
        self.blocks += 1;
        let here = self.blocks;
        for node in block.iter_mut() {
            if let Node::Let(value) = node {
                self.value(*value, here);
                self.here[value.0 as usize] = here;
            }
            node.for_each_block_mut(|block| self.block(block));
        }
        block.retain(|node| !matches!(node, Node::Let(value) if self.gone[value.0 as usize]));
    }

    fn value(&mut self, value: Value, here: u32) {
        let Origin::Operation(operation @ (Operation::Add | Operation::Sub), [a, b, _]) =
            self.flow.origin(value)
        else {
            return;
        };
        let left = self.product(a, here).map(|factors| (a, factors, b));
        let right = || self.product(b, here).map(|factors| (b, factors, a));
        let Some((product, [x, y], other)) = left.or_else(right) else {
            return;
        };
        let fused = match operation {
            Operation::Add => Operation::MulAdd,
            _ if product == a => Operation::MulSub,
            _ => Operation::SubMul,
        };
        self.gone[product.0 as usize] = true;
        self.flow.origins[value.0 as usize] = Origin::Operation(fused, [x, y, other]);
    }

    /// The factors of a product that varies, comes from the same block, and is used once.
    fn product(&self, value: Value, here: u32) -> Option<[Value; 2]> {
        let at = value.0 as usize;
        match self.flow.origin(value) {
            Origin::Operation(Operation::Mul, [x, y, _])
                if self.uses[at] == 1 && self.here[at] == here && self.varying.value(value) =>
            {
                Some([x, y])
            }
            _ => None,
        }
    }
}
