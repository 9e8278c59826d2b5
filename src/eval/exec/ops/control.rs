//! Handlers of masks and jumps.

use super::{Handler, Instruction, Level, Run, for_each_chunk, handler};
use crate::exec::batch::{Active, Batch, FUEL_ITERATIONS, Stop};
use crate::exec::lanes::{LANES, any};
use crate::exec::number::Arithmetic;

/// Splits the active pixels by a condition word: those whose word is `WHEN` go to the first mask, the others
/// to the second. Operands: the word and the two masks.
struct Split<const WHEN: bool>;

impl<N: Arithmetic, const WHEN: bool> Run<N> for Split<WHEN> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let [word, first, second] = instruction.operands;
        let condition = batch.word_row(word);
        let from = batch.mask_row(instruction.mask);
        let (first_row, second_row) = (batch.mask_row(first), batch.mask_row(second));
        let active = batch.active[instruction.mask as usize].get();
        // Different widths: with equal ones LLVM combines both reductions, which is three times slower.
        let (mut any_chosen, mut any_other) = (0_u32, 0_u64);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (condition, from) = (condition[chunk].get(), from[chunk].get());
            let (mut chosen, mut others) = ([0; LANES], [0; LANES]);
            for lane in 0..LANES {
                chosen[lane] = from[lane] & if WHEN { condition[lane] } else { !condition[lane] };
                others[lane] = from[lane] ^ chosen[lane];
            }
            any_chosen |= u32::from(any(&chosen)) << chunk;
            any_other |= u64::from(any(&others)) << chunk;
            second_row[chunk].set(others);
            first_row[chunk].set(chosen);
        });
        let second_active = Active {
            chunks: any_other as u32,
            all: active.all && any_chosen == 0,
        };
        let first_active = Active {
            chunks: any_chosen,
            all: active.all && any_other == 0,
        };
        batch.active[second as usize].set(second_active);
        batch.active[first as usize].set(first_active);
        instruction.jump_if(first_active.chunks == 0, at)
    }
}

/// Copies the active pixels whose condition word is `WHEN` into a mask. Operands: the word and the mask.
struct Choose<const WHEN: bool>;

impl<N: Arithmetic, const WHEN: bool> Run<N> for Choose<WHEN> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let [word, to, _] = instruction.operands;
        let condition = batch.word_row(word);
        let (from, to_row) = (batch.mask_row(instruction.mask), batch.mask_row(to));
        let (mut chunks, mut every) = (0_u32, [u32::MAX; LANES]);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (condition, from) = (condition[chunk].get(), from[chunk].get());
            let mut chosen = [0; LANES];
            for lane in 0..LANES {
                chosen[lane] = from[lane] & if WHEN { condition[lane] } else { !condition[lane] };
                every[lane] &= chosen[lane];
            }
            chunks |= u32::from(any(&chosen)) << chunk;
            to_row[chunk].set(chosen);
        });
        let all = batch.active[instruction.mask as usize].get().all && every == [u32::MAX; LANES];
        batch.active[to as usize].set(Active { chunks, all });
        instruction.jump_if(chunks == 0, at)
    }
}

/// Returns the handler that splits a mask into two; `when` is the condition of the first.
pub(crate) fn split<N: Arithmetic>(level: Level, when: bool) -> Handler<N> {
    if when {
        handler::<N, Split<true>>(level)
    } else {
        handler::<N, Split<false>>(level)
    }
}

/// Returns the handler that copies the part of a mask whose condition is `when`.
pub(crate) fn choose<N: Arithmetic>(level: Level, when: bool) -> Handler<N> {
    if when {
        handler::<N, Choose<true>>(level)
    } else {
        handler::<N, Choose<false>>(level)
    }
}

/// Copies the active pixels into the mask of operand 0.
struct CopyMask;

impl<N: Arithmetic> Run<N> for CopyMask {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let to = instruction.operands[0];
        let (from_row, to_row) = (batch.mask_row(instruction.mask), batch.mask_row(to));
        for_each_chunk!(batch, instruction.mask, chunk => {
            to_row[chunk].set(from_row[chunk].get());
        });
        batch.active[to as usize].set(batch.active[instruction.mask as usize].get());
        at + 1
    }
}

pub(crate) fn copy_mask<N: Arithmetic>(level: Level) -> Handler<N> {
    handler::<N, CopyMask>(level)
}

/// Removes active pixels from this mask and the outer ones down to operand 1: all pixels, or those for which
/// the word of operand 0 is all bits (1) or 0 (0).
struct Remove<const WHICH: u8>;

const ALL: u8 = 2;

impl<N: Arithmetic, const WHICH: u8> Run<N> for Remove<WHICH> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let [word, outer, _] = instruction.operands;
        let condition = (WHICH != ALL).then(|| batch.word_row(word));
        let inner = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let mut gone = inner[chunk].get();
            if let Some(condition) = condition {
                let condition = condition[chunk].get();
                for lane in 0..LANES {
                    gone[lane] &= if WHICH == 1 {
                        condition[lane]
                    } else {
                        !condition[lane]
                    };
                }
            }
            if any(&gone) {
                for mask in outer..=instruction.mask {
                    batch.deactivate(mask, chunk, &gone);
                }
            }
        });
        instruction.jump_if(batch.active[instruction.mask as usize].get().chunks == 0, at)
    }
}

/// Returns the handler that removes pixels from masks.
pub(crate) fn remove<N: Arithmetic>(level: Level, when: Option<bool>) -> Handler<N> {
    match when {
        None => handler::<N, Remove<ALL>>(level),
        Some(true) => handler::<N, Remove<1>>(level),
        Some(false) => handler::<N, Remove<0>>(level),
    }
}

struct JumpIfEmpty;

impl<N: Arithmetic> Run<N> for JumpIfEmpty {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        instruction.jump_if(batch.active[instruction.mask as usize].get().chunks == 0, at)
    }
}

pub(crate) fn jump_if_empty<N: Arithmetic>() -> Handler<N> {
    handler::<N, JumpIfEmpty>(Level::Base)
}

struct Jump;

impl<N: Arithmetic> Run<N> for Jump {
    #[inline(always)]
    fn run(_: &Batch<'_, N>, instruction: &Instruction<N>, _: usize) -> usize {
        instruction.to as usize
    }
}

pub(crate) fn jump<N: Arithmetic>() -> Handler<N> {
    handler::<N, Jump>(Level::Base)
}

/// Jumps if a scalar condition is `WHEN`.
struct JumpIf<const WHEN: bool>;

impl<N: Arithmetic, const WHEN: bool> Run<N> for JumpIf<WHEN> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let condition = batch.word_scalars[instruction.operands[0] as usize].get();
        instruction.jump_if((condition != 0) == WHEN, at)
    }
}

pub(crate) fn jump_if<N: Arithmetic>(when: bool) -> Handler<N> {
    if when {
        handler::<N, JumpIf<true>>(Level::Base)
    } else {
        handler::<N, JumpIf<false>>(Level::Base)
    }
}

/// Counts an iteration of the loop of operand 0 for the active pixels; jumps past the end if the run is
/// cancelled.
struct Iterate;

impl<N: Arithmetic> Run<N> for Iterate {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if batch.active[instruction.mask as usize].get().all {
            batch.iterations.set(batch.iterations.get() + 1);
        } else {
            let mask = batch.mask_row(instruction.mask);
            for_each_chunk!(batch, instruction.mask, chunk => {
                let (mask, mut iterations) = (mask[chunk].get(), batch.own_iterations[chunk].get());
                for lane in 0..LANES {
                    iterations[lane] = iterations[lane].wrapping_sub(mask[lane]);
                }
                batch.own_iterations[chunk].set(iterations);
            });
        }
        let fuel = batch.fuel.get();
        if fuel > 0 {
            batch.fuel.set(fuel - 1);
            return at + 1;
        }
        refuel(batch, instruction, at)
    }
}

/// Checks the limits; jumps past the end if one is exceeded.
#[cold]
pub(crate) fn refuel<N: Arithmetic>(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
    batch.fuel.set(FUEL_ITERATIONS);
    let over_limit = batch.max_iterations() > batch.iteration_limit;
    if !over_limit && !batch.cancellation.is_cancelled() {
        return at + 1;
    }
    batch.stopped.set(Some(Stop {
        id: instruction.operands[0],
        over_limit,
    }));
    usize::MAX
}

pub(crate) fn iterate<N: Arithmetic>(level: Level) -> Handler<N> {
    handler::<N, Iterate>(level)
}
