//! The interpreter: each instruction holds the function that executes it, monomorphized for its operation,
//! the number type and, of frequent operations, which operands are rows and which are scalars.
//!
//! Rows are copied out a chunk at a time and then written, so that the compiler knows that nothing aliases,
//! and vectorizes. Chunks without active pixels are skipped.

mod apply;
mod compute;
mod control;
mod memory;
mod record;

use std::cell::Cell;
use std::slice;

pub(crate) use apply::fold;
pub(crate) use compute::{compute, compute_scalar, sine_and_cosine};
pub(crate) use control::{choose, copy_mask, iterate, jump, jump_if, jump_if_empty, refuel, remove, split};
pub(crate) use memory::{copy, load_at, store, store_at, texel};
pub(crate) use record::{check, count, record, record_event};

use crate::exec::batch::Batch;
use crate::exec::lanes::{Chunk, LANES, Lanes};
use crate::exec::number::Arithmetic;

/// An executable instruction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instruction<N: Arithmetic> {
    pub(crate) run: Handler<N>,
    /// The row or scalar of the result.
    pub(crate) out: u32,
    pub(crate) operands: [u32; 3],
    /// The mask of the active pixels.
    pub(crate) mask: u32,
    /// The target of a jump; further operands of other instructions.
    pub(crate) to: u32,
}

impl<N: Arithmetic> Instruction<N> {
    /// Returns the index of the next instruction, which is the target if it jumps.
    #[inline(always)]
    fn jump_if(&self, jumps: bool, at: usize) -> usize {
        if jumps { self.to as usize } else { at + 1 }
    }
}

/// Executes an instruction and returns the index of the next. Compiled for a level that [`Level::detect`]
/// found on this processor.
pub(crate) type Handler<N> = unsafe fn(&Batch<'_, N>, &Instruction<N>, usize) -> usize;

/// The vector instruction set of the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Level {
    /// The instructions that the compilation target always has.
    Base,
    /// AVX2 and FMA: eight floats at once.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512 for functions such as `pow`, else AVX2. A function is a chain of operations that is longer
    /// than the out-of-order window of many processors, and takes these as long for sixteen floats as for
    /// eight.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Level {
    /// Returns the best level that this processor supports.
    pub(crate) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            let has_long = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            return if has_long { Self::Avx512 } else { Self::Avx2 };
        }
        Self::Base
    }
}

/// One kind of instruction.
trait Run<N: Arithmetic> {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize;
}

/// Returns the function that executes instructions of a kind on a processor.
fn handler<N: Arithmetic, R: Run<N>>(level: Level) -> Handler<N> {
    match level {
        Level::Base => base::<N, R>,
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 | Level::Avx512 => avx2::<N, R>,
    }
}

/// As [`handler`], for functions, see [`Level::Avx512`].
fn function_handler<N: Arithmetic, R: Run<N>>(level: Level) -> Handler<N> {
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => avx512::<N, R>,
        _ => handler::<N, R>(level),
    }
}

fn base<N: Arithmetic, R: Run<N>>(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
    R::run(batch, instruction, at)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<N: Arithmetic, R: Run<N>>(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
    R::run(batch, instruction, at)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")]
fn avx512<N: Arithmetic, R: Run<N>>(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
    R::run(batch, instruction, at)
}

/// Runs instructions from the first until one jumps past the last. Returns their number.
pub(crate) fn run<N: Arithmetic>(batch: &Batch<'_, N>, code: &[Instruction<N>]) -> u64 {
    let mut at = 0;
    let mut count = 0;
    while let Some(instruction) = code.get(at) {
        count += 1;
        #[expect(
            unsafe_code,
            reason = "a function made for this processor's vector instructions can only be called so"
        )]
        // SAFETY: handlers are chosen for the level that `Level::detect` found on this processor.
        {
            at = unsafe { (instruction.run)(batch, instruction, at) };
        }
    }
    count
}

/// Executes a block for each chunk that has an active pixel.
macro_rules! for_each_chunk {
    ($batch:expr, $mask:expr, $chunk:ident => $body:block) => {{
        let mut chunks = $batch.active[$mask as usize].get().chunks;
        if chunks == u32::MAX >> (32 - $batch.width) {
            for $chunk in 0..$batch.width $body
        } else {
            while chunks != 0 {
                let $chunk = chunks.trailing_zeros() as usize;
                chunks &= chunks - 1;
                if $chunk < $batch.width $body
            }
        }
    }};
}
use for_each_chunk;

/// The type of a component: a float in the number type of the run, or a word.
trait Component<N: Arithmetic>: Copy + Default + 'static {
    fn row<'a>(batch: &'a Batch<'_, N>, row: u32) -> &'a [Chunk<Self>];
    fn scalar<'a>(batch: &'a Batch<'_, N>, scalar: u32) -> &'a Cell<Self>;
    /// Returns `yes` where the mask is all bits, `no` where it is 0. Bit by bit: LLVM compiles a conditional
    /// to masked stores, which are many times slower on AMD processors.
    fn blend(mask: u32, yes: Self, no: Self) -> Self;
}

impl<N: Arithmetic> Component<N> for N {
    #[inline(always)]
    fn row<'a>(batch: &'a Batch<'_, N>, row: u32) -> &'a [Chunk<N>] {
        batch.float_row(row)
    }

    #[inline(always)]
    fn scalar<'a>(batch: &'a Batch<'_, N>, scalar: u32) -> &'a Cell<N> {
        &batch.float_scalars[scalar as usize]
    }

    #[inline(always)]
    fn blend(mask: u32, yes: N, no: N) -> N {
        <N as Arithmetic>::blend(mask, yes, no)
    }
}

impl<N: Arithmetic> Component<N> for u32 {
    #[inline(always)]
    fn row<'a>(batch: &'a Batch<'_, N>, row: u32) -> &'a [Chunk<u32>] {
        batch.word_row(row)
    }

    #[inline(always)]
    fn scalar<'a>(batch: &'a Batch<'_, N>, scalar: u32) -> &'a Cell<u32> {
        &batch.word_scalars[scalar as usize]
    }

    #[inline(always)]
    fn blend(mask: u32, yes: u32, no: u32) -> u32 {
        (yes & mask) | (no & !mask)
    }
}

/// Marks operands that are scalars, in instructions that take rows as well.
const SCALAR: u32 = 1 << 31;

/// Encodes an operand that may be a row or a scalar.
pub(crate) fn row_or_scalar(place: u32, is_row: bool) -> u32 {
    if is_row { place } else { place | SCALAR }
}

/// An operand that may be a row or a scalar: the chunks of the row, or one chunk filled with the scalar. One
/// handler serves all combinations of such operands.
#[derive(Clone, Copy)]
struct Operand<'a, T>(&'a [Chunk<T>]);

impl<'a, T: Copy> Operand<'a, T> {
    /// Looks an operand up; `filled` has space for the chunk of a scalar.
    #[inline(always)]
    fn open<N: Arithmetic>(batch: &'a Batch<'_, N>, operand: u32, filled: &'a mut Option<Chunk<T>>) -> Self
    where
        T: Component<N>,
    {
        let chunks = if operand & SCALAR == 0 {
            T::row(batch, operand)
        } else {
            let scalar = T::scalar(batch, operand & !SCALAR).get();
            slice::from_ref(filled.insert(Chunk::new([scalar; LANES])))
        };
        // Rows are never empty, which spares a check for each chunk.
        assert!(!chunks.is_empty());
        Self(chunks)
    }

    /// Returns a chunk. Their number is a power of two, so this is the first one for a scalar and the chunk
    /// itself for a row.
    #[inline(always)]
    fn chunk(self, chunk: usize) -> Lanes<T> {
        self.0[chunk & (self.0.len() - 1)].get()
    }
}

/// How a handler reads an operand.
trait Source<N: Arithmetic, T> {
    /// What is looked up before the first chunk.
    type Open<'a>: Copy;

    fn open<'a>(batch: &'a Batch<'_, N>, operand: u32, filled: &'a mut Option<Chunk<T>>) -> Self::Open<'a>;
    fn chunk(open: Self::Open<'_>, chunk: usize) -> Lanes<T>;
}

/// Reads a row or a scalar.
struct Any;

impl<N: Arithmetic, T: Component<N>> Source<N, T> for Any {
    type Open<'a> = Operand<'a, T>;

    #[inline(always)]
    fn open<'a>(batch: &'a Batch<'_, N>, operand: u32, filled: &'a mut Option<Chunk<T>>) -> Operand<'a, T> {
        Operand::open(batch, operand, filled)
    }

    #[inline(always)]
    fn chunk(open: Operand<'_, T>, chunk: usize) -> Lanes<T> {
        open.chunk(chunk)
    }
}

/// Reads a row.
struct Row;

impl<N: Arithmetic, T: Component<N>> Source<N, T> for Row {
    type Open<'a> = &'a [Chunk<T>];

    #[inline(always)]
    fn open<'a>(batch: &'a Batch<'_, N>, operand: u32, _: &'a mut Option<Chunk<T>>) -> &'a [Chunk<T>] {
        T::row(batch, operand)
    }

    #[inline(always)]
    fn chunk(open: &[Chunk<T>], chunk: usize) -> Lanes<T> {
        open[chunk].get()
    }
}

/// Reads a scalar, which stays in a register.
struct One;

impl<N: Arithmetic, T: Component<N>> Source<N, T> for One {
    type Open<'a> = T;

    #[inline(always)]
    fn open<'a>(batch: &'a Batch<'_, N>, operand: u32, _: &'a mut Option<Chunk<T>>) -> T {
        T::scalar(batch, operand & !SCALAR).get()
    }

    #[inline(always)]
    fn chunk(open: T, _: usize) -> Lanes<T> {
        [open; LANES]
    }
}
