//! The registers, the stack frame and the tables of the code.

use crate::x86_64::assemble::{
    Gpr, Label, Memory, R8, R12, R13, R14, R15, RBP, RBX, RCX, RDX, RSI, Vector, Vectors,
};
use crate::x86_64::node::{Precision, Table, TableRow};

// The base registers of the tables in memory, which stay the same.
pub(crate) const FLOATS: Gpr = RBX;
pub(crate) const WORDS: Gpr = RBP;
pub(crate) const MASKS: Gpr = R12;
pub(crate) const FLOAT_SCALARS: Gpr = R13;
pub(crate) const WORD_SCALARS: Gpr = R14;
pub(crate) const CONTEXT: Gpr = R15;

/// The offset of the vector's words from the start of their row.
pub(super) const OFFSET: Gpr = RCX;

/// The offset at which the chunk ends.
pub(super) const CHUNK_END: Gpr = RDX;

/// A bit for each chunk that is left.
pub(super) const CHUNKS: Gpr = R8;

/// The address of the table of each pixel's iterations.
pub(super) const ITERATIONS: Gpr = RSI;

/// The bytes of the words of a chunk.
pub(super) const CHUNK_BYTES: i32 = 64;

// The stack frame: accumulators of masks, then the caller's stack pointer, then spilled vectors.

/// The number of accumulators, of 4 bytes each.
pub(super) const MAX_MASKS: usize = 62;

/// The offset of the caller's stack pointer.
pub(crate) const SAVED_STACK: i32 = 248;

/// The offset of the spilled vectors.
pub(super) const SPILLED: i32 = 256;

/// The number of vectors that may be spilled.
pub(super) const MAX_SLOTS: u32 = 512;

/// The number of registers that nodes may take.
pub(super) const REGISTERS: usize = 15;

/// The register for sequences of instructions: the last one.
pub(super) const SCRATCH: Vector = 15;

/// A vector with pixels to note.
pub(crate) struct Note {
    pub(crate) entry: Label,
    pub(crate) back: Label,
    pub(crate) register: Vector,
    pub(crate) site: u32,
}

/// What regions of a program share.
pub(crate) struct Frame {
    pub(crate) precision: Precision,
    pub(crate) vectors: Vectors,
    /// The number of chunks in a row.
    pub(crate) width: u32,
    /// The number of vectors that were spilled at once.
    pub(crate) slots: u32,
    pub(crate) notes: Vec<Note>,
}

impl Frame {
    /// The bytes of the stack frame.
    pub(crate) fn stack_bytes(&self) -> i32 {
        SPILLED + self.slots as i32 * self.vectors.bytes()
    }

    /// The bytes of the words of a vector.
    pub(super) fn step(&self) -> i32 {
        let bytes = self.vectors.bytes();
        if self.precision.is_double() {
            bytes / 2
        } else {
            bytes
        }
    }
}

pub(super) fn place_at(base: Gpr, scale: u8, displacement: i32) -> Memory {
    Memory::At {
        base,
        index: Some((OFFSET, scale)),
        displacement,
    }
}

/// The place of a vector in a row.
pub(super) fn place(frame: &Frame, (table, row): TableRow) -> Memory {
    let row = row as i32 * CHUNK_BYTES * frame.width as i32;
    match table {
        Table::Float if frame.precision.is_double() => place_at(FLOATS, 1, 2 * row),
        Table::Float => place_at(FLOATS, 0, row),
        Table::Word => place_at(WORDS, 0, row),
        Table::Mask => place_at(MASKS, 0, row),
        Table::Iterations => place_at(ITERATIONS, 0, row),
    }
}
