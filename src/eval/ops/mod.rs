//! What runs: each instruction holds the function that does it, made for its operation, its operands, and the number type.
//!
//! Rows are read a chunk at a time by value and then written, so that the compiler knows that nothing overlaps, and makes
//! vector instructions of it. Chunks without a pixel that is here are skipped.

mod apply;
mod check;
mod compute;
mod control;
mod half;
mod memory;
mod tell;
mod texel;

pub(crate) use apply::fold;
pub(crate) use check::check;
pub(crate) use compute::compute;
pub(crate) use control::{copy_mask, iterate, jump, jump_if, jump_if_empty, remove, split};
pub(crate) use memory::{copy, load_at, store, store_at};
pub(crate) use tell::{mention, tell};
pub(crate) use texel::texel;

use crate::batch::{Batch, Lanes};
use crate::number::Number;

/// An instruction that is ready to run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instruction<N: Number> {
    pub(crate) run: Handler<N>,
    /// Where the result goes.
    pub(crate) out: u32,
    pub(crate) operands: [u32; 3],
    /// The mask of the pixels that are here.
    pub(crate) mask: u32,
    /// Where to go on, for those that jump.
    pub(crate) to: u32,
}

/// Does an instruction and tells the position of the next. Made for a processor that [`Level::detect`] found.
pub(crate) type Handler<N> = unsafe fn(&Batch<'_, N>, &Instruction<N>, usize) -> usize;

/// Which vector instructions the processor has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Level {
    /// Those that the target always has.
    Base,
    /// Eight floats at once.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Level {
    /// The best that this processor has.
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

/// The function that does instructions of a kind on a processor.
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

/// Runs instructions from the first until one leads past the last.
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

/// Does something for each chunk that has a pixel that is here.
macro_rules! for_each_chunk {
    ($batch:expr, $mask:expr, $chunk:ident => $body:block) => {{
        let mut chunks = $batch.here[$mask as usize].get().chunks;
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

/// An operand in a row.
#[derive(Debug)]
struct Row;

/// An operand that is one for all pixels.
#[derive(Debug)]
struct One;

/// Where an operand is read.
trait Source<N: Number, T> {
    /// What is looked up before the first chunk.
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

/// Where a result goes.
trait Sink<N: Number>: Sized + Copy + Default {
    fn row<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a [std::cell::Cell<Lanes<Self>>];
    fn scalar<'a>(batch: &'a Batch<'_, N>, out: u32) -> &'a std::cell::Cell<Self>;
    /// The first where the mask has all bits, the second where it has none. Bit by bit: of a choice LLVM makes stores under a mask, which
    /// take many times as long on processors by AMD.
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
