//! Cells: copies, stores for the pixels that are here, and indices.

use std::cell::Cell;
use std::marker::PhantomData;

use super::{Handler, Instruction, Level, One, Row, Run, Sink, Source, for_each_chunk, handler};
use crate::batch::{Batch, LANES};
use crate::ir::operation::Kind;
use crate::number::Number;

/// Copies for every pixel in chunks where one is.
struct Copy<A, T>(PhantomData<(A, T)>);

impl<N: Number, A: Source<N, T>, T: Sink<N>> Run<N> for Copy<A, T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let out = T::row(batch, instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            out[chunk].set(A::chunk(a, chunk));
        });
        at + 1
    }
}

struct CopyScalar<T>(PhantomData<T>);

impl<N: Number, T: Sink<N>> Run<N> for CopyScalar<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let value = T::scalar(batch, instruction.operands[0]).get();
        T::scalar(batch, instruction.out).set(value);
        at + 1
    }
}

/// Copies for the pixels that are here.
struct Store<A, T>(PhantomData<(A, T)>);

impl<N: Number, A: Source<N, T>, T: Sink<N>> Run<N> for Store<A, T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if batch.here[instruction.mask as usize].get().all {
            return Copy::<A, T>::run(batch, instruction, at);
        }
        let a = A::open(batch, instruction.operands[0]);
        let out = T::row(batch, instruction.out);
        let mask = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (a, old, mask) = (A::chunk(a, chunk), out[chunk].get(), mask[chunk].get());
            let mut result = old;
            for lane in 0..LANES {
                result[lane] = T::blend(mask[lane], a[lane], old[lane]);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// The handler that copies a row or a scalar into a row, or a scalar into a scalar.
pub(crate) fn copy<N: Number>(level: Level, kind: Kind, from_row: bool, to_row: bool) -> Handler<N> {
    match (kind, from_row, to_row) {
        (Kind::Float, true, _) => handler::<N, Copy<Row, N>>(level),
        (Kind::Float, false, true) => handler::<N, Copy<One, N>>(level),
        (Kind::Float, false, false) => handler::<N, CopyScalar<N>>(Level::Base),
        (Kind::Word, true, _) => handler::<N, Copy<Row, u32>>(level),
        (Kind::Word, false, true) => handler::<N, Copy<One, u32>>(level),
        (Kind::Word, false, false) => handler::<N, CopyScalar<u32>>(Level::Base),
    }
}

/// The handler that stores into a row for the pixels that are here.
pub(crate) fn store<N: Number>(level: Level, kind: Kind, from_row: bool) -> Handler<N> {
    match (kind, from_row) {
        (Kind::Float, true) => handler::<N, Store<Row, N>>(level),
        (Kind::Float, false) => handler::<N, Store<One, N>>(level),
        (Kind::Word, true) => handler::<N, Store<Row, u32>>(level),
        (Kind::Word, false) => handler::<N, Store<One, u32>>(level),
    }
}

/// Where indexed cells lie: operands are the index, the first row or scalar, and how many follow it.
#[inline(always)]
fn held<N: Number>(instruction: &Instruction<N>, index: u32) -> usize {
    // In range by construction; held to it all the same.
    (instruction.operands[1] + index.min(instruction.operands[2])) as usize
}

/// Of rows by one index.
struct LoadRow<T>(PhantomData<T>);

impl<N: Number, T: Sink<N>> Run<N> for LoadRow<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_scalars[instruction.operands[0] as usize].get();
        let row = T::row(batch, (held(instruction, index) * batch.width) as u32);
        let out = T::row(batch, instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            out[chunk].set(row[chunk].get());
        });
        at + 1
    }
}

/// Of rows, each pixel by its own index.
struct GatherRows<T>(PhantomData<T>);

impl<N: Number, T: Sink<N>> Run<N> for GatherRows<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_row(instruction.operands[0]);
        let out = T::row(batch, instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let index = index[chunk].get();
            let mut result = [T::default(); LANES];
            for lane in 0..LANES {
                let row = T::row(batch, (held(instruction, index[lane]) * batch.width) as u32);
                let lanes: &Cell<[T]> = &row[chunk];
                result[lane] = lanes.as_slice_of_cells()[lane].get();
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Of scalars, each pixel by its own index.
struct GatherScalars<T>(PhantomData<T>);

impl<N: Number, T: Sink<N>> Run<N> for GatherScalars<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_row(instruction.operands[0]);
        let out = T::row(batch, instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let index = index[chunk].get();
            let mut result = [T::default(); LANES];
            for lane in 0..LANES {
                result[lane] = T::scalar(batch, held(instruction, index[lane]) as u32).get();
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Of scalars by one index.
struct LoadScalar<T>(PhantomData<T>);

impl<N: Number, T: Sink<N>> Run<N> for LoadScalar<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_scalars[instruction.operands[0] as usize].get();
        let value = T::scalar(batch, held(instruction, index) as u32).get();
        T::scalar(batch, instruction.out).set(value);
        at + 1
    }
}

/// The handler that reads one of some cells, which are rows or scalars, by an index that is a row or a scalar.
pub(crate) fn load_at<N: Number>(
    level: Level,
    kind: Kind,
    cells_are_rows: bool,
    index_is_row: bool,
) -> Handler<N> {
    match (kind, cells_are_rows, index_is_row) {
        (Kind::Float, true, false) => handler::<N, LoadRow<N>>(level),
        (Kind::Float, true, true) => handler::<N, GatherRows<N>>(level),
        (Kind::Float, false, true) => handler::<N, GatherScalars<N>>(level),
        (Kind::Float, false, false) => handler::<N, LoadScalar<N>>(Level::Base),
        (Kind::Word, true, false) => handler::<N, LoadRow<u32>>(level),
        (Kind::Word, true, true) => handler::<N, GatherRows<u32>>(level),
        (Kind::Word, false, true) => handler::<N, GatherScalars<u32>>(level),
        (Kind::Word, false, false) => handler::<N, LoadScalar<u32>>(Level::Base),
    }
}

/// Into rows, each pixel by its index, for those that are here.
struct Scatter<I, A, T>(PhantomData<(I, A, T)>);

impl<N: Number, I: Source<N, u32>, A: Source<N, T>, T: Sink<N>> Run<N> for Scatter<I, A, T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = I::open(batch, instruction.operands[0]);
        let value = A::open(batch, instruction.out);
        let mask = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (index, value, mask) = (I::chunk(index, chunk), A::chunk(value, chunk), mask[chunk].get());
            for lane in 0..LANES {
                if mask[lane] != 0 {
                    let row = T::row(batch, (held(instruction, index[lane]) * batch.width) as u32);
                    let lanes: &Cell<[T]> = &row[chunk];
                    lanes.as_slice_of_cells()[lane].set(value[lane]);
                }
            }
        });
        at + 1
    }
}

struct StoreScalar<T>(PhantomData<T>);

impl<N: Number, T: Sink<N>> Run<N> for StoreScalar<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_scalars[instruction.operands[0] as usize].get();
        let value = T::scalar(batch, instruction.out).get();
        T::scalar(batch, held(instruction, index) as u32).set(value);
        at + 1
    }
}

/// The handler that writes one of some cells: `out` is what it writes.
pub(crate) fn store_at<N: Number>(
    level: Level,
    kind: Kind,
    cells_are_rows: bool,
    index_is_row: bool,
    value_is_row: bool,
) -> Handler<N> {
    match (kind, cells_are_rows, index_is_row, value_is_row) {
        (Kind::Float, true, true, true) => handler::<N, Scatter<Row, Row, N>>(level),
        (Kind::Float, true, true, false) => handler::<N, Scatter<Row, One, N>>(level),
        (Kind::Float, true, false, true) => handler::<N, Scatter<One, Row, N>>(level),
        (Kind::Float, true, false, false) => handler::<N, Scatter<One, One, N>>(level),
        (Kind::Float, false, ..) => handler::<N, StoreScalar<N>>(Level::Base),
        (Kind::Word, true, true, true) => handler::<N, Scatter<Row, Row, u32>>(level),
        (Kind::Word, true, true, false) => handler::<N, Scatter<Row, One, u32>>(level),
        (Kind::Word, true, false, true) => handler::<N, Scatter<One, Row, u32>>(level),
        (Kind::Word, true, false, false) => handler::<N, Scatter<One, One, u32>>(level),
        (Kind::Word, false, ..) => handler::<N, StoreScalar<u32>>(Level::Base),
    }
}
