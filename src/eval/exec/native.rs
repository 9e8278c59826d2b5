//! The interface of machine code, which the crate `toyproof-eval-native` makes.
//!
//! Machine code is an optimization: it executes the same steps at the same locations as the handlers of
//! [`ops`](crate::exec::ops), with the same bits, and calls them for what it has no instructions for.

use std::fmt::Debug;
use std::ops::Range;

use crate::exec::batch::Batch;
use crate::exec::lanes::Lanes;
use crate::exec::number::{Arithmetic, FloatFormat};
use crate::exec::settings::Engine;
use crate::ir::SiteId;
use crate::lower::LoweredCode;

/// A compiler to machine code.
pub trait NativeCompiler: Debug + Sync {
    /// Returns the place for the machine code of one program, which is made when a frame first needs it.
    fn program(&self) -> Box<dyn NativeProgram>;
}

/// The machine code of a program.
pub trait NativeProgram: Debug + Send + Sync {
    /// Returns the code for a frame, or `None` if the program, the format, the engine or this processor has
    /// none. All calls are given the same program.
    fn frame<'a>(&'a self, code: NativeInput<'a>, engine: Engine) -> Option<Box<dyn NativeFrame + 'a>>;
}

/// The machine code of a program for a frame.
pub trait NativeFrame: Sync {
    /// Begins a batch and executes the program for it.
    fn run(&self, batch: &dyn NativeBatch);
}

/// What machine code is made of: a lowered program, and its layout in the batches of a frame.
#[derive(Debug, Clone, Copy)]
pub struct NativeInput<'a> {
    /// The program.
    pub lowered: &'a LoweredCode,
    /// The first of the handlers' instructions for each step, and the end.
    pub positions: &'a [u32],
    /// The number of chunks in a row.
    pub width: usize,
    /// The number of rows of the largest table.
    pub rows: usize,
    /// The format of floats.
    pub format: FloatFormat,
}

/// The tables of a batch: the addresses of their first elements. They are valid as long as the batch, have
/// the layout of the [`NativeInput`] of its frame, and consist of cells, which may be changed.
#[derive(Debug, Clone, Copy)]
pub struct BatchTables {
    /// Rows of floats.
    pub floats: *const u8,
    /// Rows of words.
    pub words: *const u8,
    /// A row of words for each mask: all bits set where the pixel is active.
    pub masks: *const u8,
    /// Floats that all pixels have.
    pub float_scalars: *const u8,
    /// Words that all pixels have.
    pub word_scalars: *const u8,
    /// The loop iterations of each pixel: a row of words.
    pub own_iterations: *const u8,
    /// The [`Active`](crate::exec::batch::Active) chunks of each mask.
    pub active: *const u8,
    /// The number of loop iterations until [`NativeBatch::refuel`] must be called: a word.
    pub fuel: *const u8,
    /// The loop iterations of all pixels: a word.
    pub iterations: *const u8,
}

impl<N: Arithmetic> From<&Batch<'_, N>> for BatchTables {
    fn from(batch: &Batch<'_, N>) -> Self {
        Self {
            floats: batch.floats.as_ptr().cast(),
            words: batch.words.as_ptr().cast(),
            masks: batch.masks.as_ptr().cast(),
            float_scalars: batch.float_scalars.as_ptr().cast(),
            word_scalars: batch.word_scalars.as_ptr().cast(),
            own_iterations: batch.own_iterations.as_ptr().cast(),
            active: batch.active.as_ptr().cast(),
            fuel: batch.fuel.as_ptr().cast_const().cast(),
            iterations: batch.iterations.as_ptr().cast_const().cast(),
        }
    }
}

/// A batch that machine code is run for.
pub trait NativeBatch {
    /// Returns the tables.
    fn tables(&self) -> BatchTables;
    /// Initializes the batch; what a previous run computed and recorded is dropped.
    fn begin(&self);
    /// Executes instructions by their handlers.
    fn execute(&self, instructions: Range<u32>);
    /// Checks the limits at an instruction that begins a loop iteration; returns whether the run must stop.
    fn refuel(&self, instruction: u32) -> bool;
    /// Records the pixels of a chunk whose lanes are not zero.
    fn note(&self, site: SiteId, chunk: usize, lanes: &Lanes<u32>);
}

/// A lowered program, with its machine code if there is a compiler.
#[derive(Debug)]
pub struct Executable {
    pub(crate) lowered: LoweredCode,
    pub(crate) native: Option<Box<dyn NativeProgram>>,
}
