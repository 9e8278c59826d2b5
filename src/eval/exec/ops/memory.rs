//! Cells and textures: copies, masked stores, indexed accesses, and texture lookups.

use std::marker::PhantomData;

use toyproof_image::{Texels, Texture};

use super::{
    Component, Handler, Instruction, Level, One, Operand, Row, Run, Source, for_each_chunk, handler,
};
use crate::exec::batch::Batch;
use crate::exec::lanes::LANES;
use crate::exec::number::Arithmetic;
use crate::exec::texture::{fetch, unbound};
use crate::ir::Kind;

/// Copies whole chunks that have an active pixel.
struct Copy<A, T>(PhantomData<(A, T)>);

impl<N: Arithmetic, A: Source<N, T>, T: Component<N>> Run<N> for Copy<A, T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let mut filled = None;
        let a = A::open(batch, instruction.operands[0], &mut filled);
        let out = T::row(batch, instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            out[chunk].set(A::chunk(a, chunk));
        });
        at + 1
    }
}

struct CopyScalar<T>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N>> Run<N> for CopyScalar<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let value = T::scalar(batch, instruction.operands[0]).get();
        T::scalar(batch, instruction.out).set(value);
        at + 1
    }
}

/// Copies for the active pixels only.
struct Store<A, T>(PhantomData<(A, T)>);

impl<N: Arithmetic, A: Source<N, T>, T: Component<N>> Run<N> for Store<A, T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if batch.active[instruction.mask as usize].get().all {
            return Copy::<A, T>::run(batch, instruction, at);
        }
        let mut filled = None;
        let a = A::open(batch, instruction.operands[0], &mut filled);
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

/// Returns the handler that copies a row or a scalar into a row, or a scalar into a scalar.
pub(crate) fn copy<N: Arithmetic>(level: Level, kind: Kind, from_row: bool, to_row: bool) -> Handler<N> {
    match (kind, from_row, to_row) {
        (Kind::Float, true, _) => handler::<N, Copy<Row, N>>(level),
        (Kind::Float, false, true) => handler::<N, Copy<One, N>>(level),
        (Kind::Float, false, false) => handler::<N, CopyScalar<N>>(Level::Base),
        (Kind::Word, true, _) => handler::<N, Copy<Row, u32>>(level),
        (Kind::Word, false, true) => handler::<N, Copy<One, u32>>(level),
        (Kind::Word, false, false) => handler::<N, CopyScalar<u32>>(Level::Base),
    }
}

/// Returns the handler that stores a row or a scalar into a row, for the active pixels.
pub(crate) fn store<N: Arithmetic>(level: Level, kind: Kind, from_row: bool) -> Handler<N> {
    match (kind, from_row) {
        (Kind::Float, true) => handler::<N, Store<Row, N>>(level),
        (Kind::Float, false) => handler::<N, Store<One, N>>(level),
        (Kind::Word, true) => handler::<N, Store<Row, u32>>(level),
        (Kind::Word, false) => handler::<N, Store<One, u32>>(level),
    }
}

/// Returns the row or scalar that an index selects. Operands: the index, the first row or scalar, and the
/// number of those after it.
#[inline(always)]
fn indexed_location<N: Arithmetic>(instruction: &Instruction<N>, index: u32) -> usize {
    // In range by construction; clamped for memory safety.
    (instruction.operands[1] + index.min(instruction.operands[2])) as usize
}

/// Loads one of several rows by a uniform index.
struct LoadRow<T>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N>> Run<N> for LoadRow<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_scalars[instruction.operands[0] as usize].get();
        let row = T::row(batch, (indexed_location(instruction, index) * batch.width) as u32);
        let out = T::row(batch, instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            out[chunk].set(row[chunk].get());
        });
        at + 1
    }
}

/// Loads from rows or scalars, each pixel by its own index.
struct Gather<T, const FROM_ROWS: bool>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N>, const FROM_ROWS: bool> Run<N> for Gather<T, FROM_ROWS> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_row(instruction.operands[0]);
        let out = T::row(batch, instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let index = index[chunk].get();
            let mut result = [T::default(); LANES];
            for lane in 0..LANES {
                let location = indexed_location(instruction, index[lane]);
                result[lane] = if FROM_ROWS {
                    T::row(batch, (location * batch.width) as u32)[chunk].lanes()[lane].get()
                } else {
                    T::scalar(batch, location as u32).get()
                };
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Loads one of several scalars by a uniform index.
struct LoadScalar<T>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N>> Run<N> for LoadScalar<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_scalars[instruction.operands[0] as usize].get();
        let value = T::scalar(batch, indexed_location(instruction, index) as u32).get();
        T::scalar(batch, instruction.out).set(value);
        at + 1
    }
}

/// Returns the handler that loads one of several cells, which are rows or scalars, by an index that is a row
/// or a scalar.
pub(crate) fn load_at<N: Arithmetic>(
    level: Level,
    kind: Kind,
    cells_are_rows: bool,
    index_is_row: bool,
) -> Handler<N> {
    match (kind, cells_are_rows, index_is_row) {
        (Kind::Float, true, false) => handler::<N, LoadRow<N>>(level),
        (Kind::Float, true, true) => handler::<N, Gather<N, true>>(level),
        (Kind::Float, false, true) => handler::<N, Gather<N, false>>(level),
        (Kind::Float, false, false) => handler::<N, LoadScalar<N>>(Level::Base),
        (Kind::Word, true, false) => handler::<N, LoadRow<u32>>(level),
        (Kind::Word, true, true) => handler::<N, Gather<u32, true>>(level),
        (Kind::Word, false, true) => handler::<N, Gather<u32, false>>(level),
        (Kind::Word, false, false) => handler::<N, LoadScalar<u32>>(Level::Base),
    }
}

/// Stores into rows, each active pixel by its own index.
struct Scatter<T>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N>> Run<N> for Scatter<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let (mut filled_index, mut filled_value) = (None, None);
        let index = Operand::<u32>::open(batch, instruction.operands[0], &mut filled_index);
        let value = Operand::<T>::open(batch, instruction.out, &mut filled_value);
        let mask = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (index, value, mask) = (index.chunk(chunk), value.chunk(chunk), mask[chunk].get());
            for lane in 0..LANES {
                if mask[lane] != 0 {
                    let row = T::row(batch, (indexed_location(instruction, index[lane]) * batch.width) as u32);
                    row[chunk].lanes()[lane].set(value[lane]);
                }
            }
        });
        at + 1
    }
}

struct StoreScalar<T>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N>> Run<N> for StoreScalar<T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let index = batch.word_scalars[instruction.operands[0] as usize].get();
        let value = T::scalar(batch, instruction.out).get();
        T::scalar(batch, indexed_location(instruction, index) as u32).set(value);
        at + 1
    }
}

/// Returns the handler that stores into one of several cells, which are rows or scalars; `out` is the stored
/// value.
pub(crate) fn store_at<N: Arithmetic>(level: Level, kind: Kind, cells_are_rows: bool) -> Handler<N> {
    match (kind, cells_are_rows) {
        (Kind::Float, true) => handler::<N, Scatter<N>>(level),
        (Kind::Float, false) => handler::<N, StoreScalar<N>>(Level::Base),
        (Kind::Word, true) => handler::<N, Scatter<u32>>(level),
        (Kind::Word, false) => handler::<N, StoreScalar<u32>>(Level::Base),
    }
}

// Texture lookups.

/// A lookup of single texels. Operands 0 and 1 are rows of texel coordinates, operand 2 of levels; `to` is
/// 4 · channel + component.
struct Fetch;

impl<N: Arithmetic> Run<N> for Fetch {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let [channel, component] = [instruction.to / 4 % 4, instruction.to % 4].map(|part| part as usize);
        match batch.textures[channel].as_ref().map(Texture::texels) {
            Some(Texels::Single(levels)) => fetch_lanes(batch, instruction, |at, level| {
                fetch(levels, at, level, component).map_or(N::default(), N::from_f32)
            }),
            Some(Texels::Double(levels)) => fetch_lanes(batch, instruction, |at, level| {
                fetch(levels, at, level, component).map_or(N::default(), N::from_f64)
            }),
            None => fetch_lanes(batch, instruction, |at, level| unbound(at, level, component)),
        }
        at + 1
    }
}

/// Looks up a component of a texel for each pixel: `texel` takes the coordinates and the level.
#[inline(always)]
fn fetch_lanes<N: Arithmetic>(
    batch: &Batch<'_, N>,
    instruction: &Instruction<N>,
    texel: impl Fn([u32; 2], u32) -> N,
) {
    let [x, y, level] = instruction.operands.map(|row| batch.word_row(row));
    let out = batch.float_row(instruction.out);
    for_each_chunk!(batch, instruction.mask, chunk => {
        let [x, y, level] = [x, y, level].map(|row| row[chunk].get());
        let mut result = [N::default(); LANES];
        for lane in 0..LANES {
            result[lane] = texel([x[lane], y[lane]], level[lane]);
        }
        out[chunk].set(result);
    });
}

/// Returns the handler of a lookup with coordinates in rows.
pub(crate) fn texel<N: Arithmetic>() -> Handler<N> {
    handler::<N, Fetch>(Level::Base)
}
