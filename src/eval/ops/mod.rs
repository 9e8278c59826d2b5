//! The interpreter: each instruction holds the function that executes it, monomorphized for its operation,
//! its operand forms, and the number type.
//!
//! Rows are copied out a chunk at a time and then written, so that the compiler knows that nothing aliases,
//! and vectorizes. Chunks without active pixels are skipped.

mod apply;
mod compute;
mod control;
mod memory;
mod record;

pub(crate) use apply::fold;
pub(crate) use compute::compute;
pub(crate) use control::{copy_mask, iterate, jump, jump_if, jump_if_empty, remove, split};
pub(crate) use memory::{copy, load_at, store, store_at, texel};
pub(crate) use record::{check, record, record_event};

use crate::batch::{Batch, Lanes};
use crate::number::Number;

/// An executable instruction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instruction<N: Number> {
    pub(crate) run: Handler<N>,
    /// The row or scalar of the result.
    pub(crate) out: u32,
    pub(crate) operands: [u32; 3],
    /// The mask of the active pixels.
    pub(crate) mask: u32,
    /// The target of a jump; further operands of other instructions.
    pub(crate) to: u32,
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
}

impl Level {
    /// Returns the best level that this processor supports.
    pub(crate) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
            return Self::Avx2;
        }
        Self::Base
    }
}

/// One kind of instruction.
trait Run<N: Number> {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize;
}

/// Returns the function that executes instructions of a kind on a processor.
fn handler<N: Number, R: Run<N>>(level: Level) -> Handler<N> {
    match level {
        Level::Base => base::<N, R>,
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => avx2::<N, R>,
    }
}

fn base<N: Number, R: Run<N>>(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
    R::run(batch, instruction, at)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<N: Number, R: Run<N>>(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
    R::run(batch, instruction, at)
}

/// Runs instructions from the first until one jumps past the last.
pub(crate) fn run<N: Number>(batch: &Batch<'_, N>, code: &[Instruction<N>]) {
    let mut at = 0;
    while let Some(instruction) = code.get(at) {
        #[expect(
            unsafe_code,
            reason = "a function made for this processor's vector instructions can only be called so"
        )]
        // SAFETY: handlers are chosen for the level that `Level::detect` found on this processor.
        {
            at = unsafe { (instruction.run)(batch, instruction, at) };
        }
    }
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

/// An operand in a row: a value for each pixel.
#[derive(Debug)]
struct Row;

/// A scalar operand: one value for all pixels.
#[derive(Debug)]
struct One;

/// The source of an operand.
trait Source<N: Number, T> {
    /// The state that is looked up before the first chunk.
    type Open<'a>: Copy;

    fn open<'a>(batch: &'a Batch<'_, N>, operand: u32) -> Self::Open<'a>;
    fn chunk(open: Self::Open<'_>, chunk: usize) -> Lanes<T>;
}

macro_rules! sources {
    ($ty:ty, $row:ident, $scalars:ident) => {
        impl<N: Number> Source<N, $ty> for Row {
            type Open<'a> = &'a [std::cell::Cell<Lanes<$ty>>];

            #[inline(always)]
            fn open<'a>(batch: &'a Batch<'_, N>, operand: u32) -> Self::Open<'a> {
                batch.$row(operand)
            }

            #[inline(always)]
            fn chunk(open: Self::Open<'_>, chunk: usize) -> Lanes<$ty> {
                open[chunk].get()
            }
        }

        impl<N: Number> Source<N, $ty> for One {
            type Open<'a> = $ty;

            #[inline(always)]
            fn open<'a>(batch: &'a Batch<'_, N>, operand: u32) -> Self::Open<'a> {
                batch.$scalars[operand as usize].get()
            }

            #[inline(always)]
            fn chunk(open: Self::Open<'_>, _: usize) -> Lanes<$ty> {
                [open; crate::batch::LANES]
            }
        }
    };
}
sources!(N, float_row, float_scalars);
sources!(u32, word_row, word_scalars);

/// The destination of a result.
trait Sink<N: Number>: Sized + Copy + Default {
    fn row<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a [std::cell::Cell<Lanes<Self>>];
    fn scalar<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a std::cell::Cell<Self>;
    /// Returns `yes` where the mask is all bits, `no` where it is 0. Bit by bit: LLVM compiles a conditional
    /// to masked stores, which are many times slower on AMD processors.
    fn blend(mask: u32, yes: Self, no: Self) -> Self;
}

impl<N: Number> Sink<N> for N {
    #[inline(always)]
    fn row<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a [std::cell::Cell<Lanes<N>>] {
        batch.float_row(out)
    }

    #[inline(always)]
    fn scalar<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a std::cell::Cell<N> {
        &batch.float_scalars[out as usize]
    }

    #[inline(always)]
    fn blend(mask: u32, yes: N, no: N) -> N {
        <N as Number>::blend(mask, yes, no)
    }
}

impl<N: Number> Sink<N> for u32 {
    #[inline(always)]
    fn row<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a [std::cell::Cell<Lanes<u32>>] {
        batch.word_row(out)
    }

    #[inline(always)]
    fn scalar<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a std::cell::Cell<u32> {
        &batch.word_scalars[out as usize]
    }

    #[inline(always)]
    fn blend(mask: u32, yes: u32, no: u32) -> u32 {
        (yes & mask) | (no & !mask)
    }
}
