//! Handlers of operations on rows and on scalars.

use std::marker::PhantomData;

use super::apply::{self, Of1, Of2, Of3, ty};
use super::{Handler, Instruction, Level, One, Row, Run, Sink, Source, for_each_chunk, handler};
use crate::batch::{Batch, LANES, Lanes};
use crate::ir::{Operation, for_each_operation};
use crate::number::Number;

/// An operation with one operand from `A`, into a row.
struct Rows1<O, A, T, R>(PhantomData<(O, A, T, R)>);

impl<N: Number, O: Of1<N, T, R>, A: Source<N, T>, T: Copy, R: Sink<N>> Run<N> for Rows1<O, A, T, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            let a = A::chunk(a, chunk);
            let mut result = [R::default(); LANES];
            for lane in 0..LANES {
                result[lane] = O::apply(a[lane], noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// An operation with two operands, into a row.
struct Rows2<O, A, B, T, U, R>(PhantomData<(O, A, B, T, U, R)>);

impl<N, O, A, B, T, U, R> Run<N> for Rows2<O, A, B, T, U, R>
where
    N: Number,
    O: Of2<N, T, U, R>,
    A: Source<N, T>,
    B: Source<N, U>,
    T: Copy,
    U: Copy,
    R: Sink<N>,
{
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let b = B::open(batch, instruction.operands[1]);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (a, b) = (A::chunk(a, chunk), B::chunk(b, chunk));
            let mut result = [R::default(); LANES];
            for lane in 0..LANES {
                result[lane] = O::apply(a[lane], b[lane], noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// An operation with three operands, into a row.
struct Rows3<O, A, B, C, T, U, R>(PhantomData<(O, A, B, C, T, U, R)>);

impl<N, O, A, B, C, T, U, R> Run<N> for Rows3<O, A, B, C, T, U, R>
where
    N: Number,
    O: Of3<N, T, U, U, R>,
    A: Source<N, T>,
    B: Source<N, U>,
    C: Source<N, U>,
    T: Copy,
    U: Copy,
    R: Sink<N>,
{
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let b = B::open(batch, instruction.operands[1]);
        let c = C::open(batch, instruction.operands[2]);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (a, b, c) = (A::chunk(a, chunk), B::chunk(b, chunk), C::chunk(c, chunk));
            let mut result = [R::default(); LANES];
            for lane in 0..LANES {
                result[lane] = O::apply(a[lane], b[lane], c[lane], noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// An operation with one scalar operand.
struct Scalar1<O, T, R>(PhantomData<(O, T, R)>);

impl<N: Number, O: Of1<N, T, R>, T: Sink<N>, R: Sink<N>> Run<N> for Scalar1<O, T, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = T::scalar(batch, instruction.operands[0]).get();
        R::scalar(batch, instruction.out).set(O::apply(a, batch.noise));
        at + 1
    }
}

struct Scalar2<O, T, U, R>(PhantomData<(O, T, U, R)>);

impl<N: Number, O: Of2<N, T, U, R>, T: Sink<N>, U: Sink<N>, R: Sink<N>> Run<N> for Scalar2<O, T, U, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = T::scalar(batch, instruction.operands[0]).get();
        let b = U::scalar(batch, instruction.operands[1]).get();
        R::scalar(batch, instruction.out).set(O::apply(a, b, batch.noise));
        at + 1
    }
}

struct Scalar3<O, T, U, R>(PhantomData<(O, T, U, R)>);

impl<N: Number, O: Of3<N, T, U, U, R>, T: Sink<N>, U: Sink<N>, R: Sink<N>> Run<N> for Scalar3<O, T, U, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = T::scalar(batch, instruction.operands[0]).get();
        let b = U::scalar(batch, instruction.operands[1]).get();
        let c = U::scalar(batch, instruction.operands[2]).get();
        R::scalar(batch, instruction.out).set(O::apply(a, b, c, batch.noise));
        at + 1
    }
}

/// Differences along x (1) or y (2) in each quad: those of the pixel's own row or column, as in lavapipe.
struct Difference<const AXIS: usize>;

impl<N: Number, const AXIS: usize> Run<N> for Difference<AXIS> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = batch.float_row(instruction.operands[0]);
        let out = batch.float_row(instruction.out);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let a = a[chunk].get();
            let mut result: Lanes<N> = [N::default(); LANES];
            for lane in 0..LANES {
                result[lane] = a[lane | AXIS].sub(a[lane & !AXIS], batch.noise);
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Returns the handler of an operation; `rows` says which operands are rows. The result is a row if any
/// operand is.
pub(crate) fn compute<N: Number>(level: Level, operation: Operation, rows: [bool; 3]) -> Handler<N> {
    macro_rules! forms {
        ($name:ident($a:ident) $r:ident) => {
            match rows {
                [true, ..] => handler::<N, Rows1<apply::$name, Row, ty!($a), ty!($r)>>(level),
                _ => handler::<N, Scalar1<apply::$name, ty!($a), ty!($r)>>(Level::Base),
            }
        };
        ($name:ident($a:ident, $b:ident) $r:ident) => {
            match rows {
                [true, true, _] => {
                    handler::<N, Rows2<apply::$name, Row, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [true, false, _] => {
                    handler::<N, Rows2<apply::$name, Row, One, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, true, _] => {
                    handler::<N, Rows2<apply::$name, One, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                _ => handler::<N, Scalar2<apply::$name, ty!($a), ty!($b), ty!($r)>>(Level::Base),
            }
        };
        ($name:ident($a:ident, $b:ident, $c:ident) $r:ident) => {{
            match rows {
                [true, true, true] => {
                    handler::<N, Rows3<apply::$name, Row, Row, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [true, true, false] => {
                    handler::<N, Rows3<apply::$name, Row, Row, One, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [true, false, true] => {
                    handler::<N, Rows3<apply::$name, Row, One, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [true, false, false] => {
                    handler::<N, Rows3<apply::$name, Row, One, One, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, true, true] => {
                    handler::<N, Rows3<apply::$name, One, Row, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, true, false] => {
                    handler::<N, Rows3<apply::$name, One, Row, One, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, false, true] => {
                    handler::<N, Rows3<apply::$name, One, One, Row, ty!($a), ty!($b), ty!($r)>>(level)
                }
                [false, false, false] => {
                    handler::<N, Scalar3<apply::$name, ty!($a), ty!($b), ty!($r)>>(Level::Base)
                }
            }
        }};
    }
    macro_rules! select {
        ($($name:ident($($operand:ident),+) $value:ident,)*) => {
            match (operation, rows[0]) {
                (Operation::DFdx, true) => handler::<N, Difference<1>>(level),
                (Operation::DFdy, true) => handler::<N, Difference<2>>(level),
                $((Operation::$name, _) => forms!($name($($operand),+) $value),)*
            }
        };
    }
    for_each_operation!(select)
}
