//! Counting of the basic blocks that the pixels of a tile execute.

use std::cell::Cell;

use crate::exec::lanes::{Chunk, LANES, Lanes, chunks};

/// Counts the executions of basic blocks in the tiles of a batch.
pub(crate) struct Counter<'a> {
    /// The operations of each block.
    costs: &'a [u64],
    /// The number of pixels that executed each block, in all tiles.
    executions: Vec<Cell<u64>>,
    /// The operations of each pixel of the current tile.
    operations: Vec<Chunk<u64>>,
    /// All bits set where the pixel of the current tile lies in the image.
    inside: Vec<Chunk<u32>>,
}

impl<'a> Counter<'a> {
    /// Creates a counter for a batch of this many chunks, and blocks with these numbers of operations.
    pub(crate) fn new(costs: &'a [u64], width: usize) -> Self {
        Self {
            costs,
            executions: vec![Cell::new(0); costs.len()],
            operations: chunks([0; LANES], width),
            inside: chunks([0; LANES], width),
        }
    }

    /// Begins a tile, whose pixels lie in the image or not.
    pub(crate) fn begin_tile(&self, is_inside: impl Fn(usize, usize) -> bool) {
        for (chunk, (operations, inside)) in self.operations.iter().zip(&self.inside).enumerate() {
            operations.set([0; LANES]);
            inside.set(std::array::from_fn(|lane| {
                u32::from(is_inside(chunk, lane)).wrapping_neg()
            }));
        }
    }

    /// Counts a block for the active pixels of a chunk.
    #[inline(always)]
    pub(crate) fn count(&self, block: u32, chunk: usize, mask: &Lanes<u32>) {
        let cost = self.costs[block as usize];
        let (inside, mut operations) = (self.inside[chunk].get(), self.operations[chunk].get());
        let mut pixels = 0;
        for lane in 0..LANES {
            let counts = u64::from(mask[lane] & inside[lane] & 1);
            operations[lane] += cost * counts;
            pixels += counts;
        }
        self.operations[chunk].set(operations);
        let executions = &self.executions[block as usize];
        executions.set(executions.get() + pixels);
    }

    /// Returns the number of pixels that executed each block.
    pub(crate) fn into_executions(self) -> Vec<u64> {
        self.executions.into_iter().map(Cell::into_inner).collect()
    }

    /// Returns the operations of the pixels of a chunk.
    pub(crate) fn operations(&self, chunk: usize) -> Lanes<u64> {
        self.operations[chunk].get()
    }
}
