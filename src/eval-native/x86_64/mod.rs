//! Machine code for AVX2 and AVX-512: what the handlers of the evaluator do, without their traffic to memory.
//!
//! A handler reads and writes rows of 256 pixels for each operation. Machine code keeps values in registers
//! over a whole *region*, a part of the program without loops, for one vector of pixels after the other. What
//! has no form there is executed by its handler.
//!
//! ```text
//! plan (regions) ─► lift, operation (nodes) ─► emit (registers, instructions) ─► program ─┬─► compiler
//!        op ─► assemble, evex, general (bytes) ──┘          executable (memory, calls) ──┘
//! ```

mod assemble;
mod compiler;
mod context;
mod emit;
mod evex;
mod executable;
mod general;
mod lift;
mod node;
mod op;
mod operation;
mod plan;
mod program;
#[cfg(test)]
mod tests;

pub(crate) use self::compiler::Compiler;
