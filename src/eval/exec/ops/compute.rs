//! Handlers of operations on rows and on scalars.

use std::marker::PhantomData;

use super::apply::{self, Of1, Of2, Of3, ty};
use super::{
    Any, Component, Handler, Instruction, Level, One, Row, Run, Source, for_each_chunk, function_handler,
    handler,
};
use crate::exec::batch::Batch;
use crate::exec::lanes::{LANES, Lanes};
use crate::exec::number::Arithmetic;
use crate::ir::{Operation, for_each_operation};

/// An operation with one operand, a row.
struct Rows1<O, T, R>(PhantomData<(O, T, R)>);

impl<N: Arithmetic, O: Of1<N, T, R>, T: Component<N>, R: Component<N>> Run<N> for Rows1<O, T, R> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = T::row(batch, instruction.operands[0]);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            out[chunk].set(O::apply_to_lanes(a[chunk].get(), noise));
        });
        at + 1
    }
}

/// An operation with two operands, rows or scalars, into a row.
struct Rows2<O, A, B, T, U, R>(PhantomData<(O, A, B, T, U, R)>);

impl<N, O, A, B, T, U, R> Run<N> for Rows2<O, A, B, T, U, R>
where
    N: Arithmetic,
    O: Of2<N, T, U, R>,
    A: Source<N, T>,
    B: Source<N, U>,
    T: Component<N>,
    U: Component<N>,
    R: Component<N>,
{
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let (mut filled_a, mut filled_b) = (None, None);
        let a = A::open(batch, instruction.operands[0], &mut filled_a);
        let b = B::open(batch, instruction.operands[1], &mut filled_b);
        let out = R::row(batch, instruction.out);
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            out[chunk].set(O::apply_to_lanes(A::chunk(a, chunk), B::chunk(b, chunk), noise));
        });
        at + 1
    }
}

/// An operation with three operands, rows or scalars, into a row.
struct Rows3<O, A, B, C, T, U, R>(PhantomData<(O, A, B, C, T, U, R)>);

impl<N, O, A, B, C, T, U, R> Run<N> for Rows3<O, A, B, C, T, U, R>
where
    N: Arithmetic,
    O: Of3<N, T, U, U, R>,
    A: Source<N, T>,
    B: Source<N, U>,
    C: Source<N, U>,
    T: Component<N>,
    U: Component<N>,
    R: Component<N>,
{
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let (mut filled_a, mut filled_b, mut filled_c) = (None, None, None);
        let a = A::open(batch, instruction.operands[0], &mut filled_a);
        let b = B::open(batch, instruction.operands[1], &mut filled_b);
        let c = C::open(batch, instruction.operands[2], &mut filled_c);
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

/// The sine and the cosine of a row into the rows `out` and `to`, or the other way round.
struct SineAndCosine<const SINE_FIRST: bool>;

impl<N: Arithmetic, const SINE_FIRST: bool> Run<N> for SineAndCosine<SINE_FIRST> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let angle = batch.float_row(instruction.operands[0]);
        let [out, to] = [instruction.out, instruction.to].map(|row| batch.float_row(row));
        let [sines, cosines] = if SINE_FIRST { [out, to] } else { [to, out] };
        let noise = batch.noise;
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (sine, cosine) = N::sin_cos(angle[chunk].get(), noise);
            sines[chunk].set(sine);
            cosines[chunk].set(cosine);
        });
        at + 1
    }
}

/// Returns the handler of the sine and the cosine of a row.
pub(crate) fn sine_and_cosine<N: Arithmetic>(level: Level, sine_first: bool) -> Handler<N> {
    if sine_first {
        function_handler::<N, SineAndCosine<true>>(level)
    } else {
        function_handler::<N, SineAndCosine<false>>(level)
    }
}

/// Any operation on scalars, into a scalar. `to` is the operation: scalars take so little of the time that
/// one handler serves all.
struct Scalars;

impl<N: Arithmetic> Run<N> for Scalars {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let noise = batch.noise;
        macro_rules! operand {
            ($kind:ident, $index:literal) => {
                <ty!($kind) as Component<N>>::scalar(batch, instruction.operands[$index]).get()
            };
        }
        macro_rules! result {
            ($name:ident($a:ident)) => {
                <apply::$name as Of1<N, _, _>>::apply(operand!($a, 0), noise)
            };
            ($name:ident($a:ident, $b:ident)) => {
                <apply::$name as Of2<N, _, _, _>>::apply(operand!($a, 0), operand!($b, 1), noise)
            };
            ($name:ident($a:ident, $b:ident, $c:ident)) => {
                <apply::$name as Of3<N, _, _, _, _>>::apply(
                    operand!($a, 0),
                    operand!($b, 1),
                    operand!($c, 2),
                    noise,
                )
            };
        }
        macro_rules! select {
            ($($name:ident($($operand:ident),+) $value:ident,)*) => {
                match Operation::ALL[instruction.to as usize] {
                    $(Operation::$name => {
                        let result: ty!($value) = result!($name($($operand),+));
                        <ty!($value) as Component<N>>::scalar(batch, instruction.out).set(result);
                    })*
                }
            };
        }
        for_each_operation!(select);
        at + 1
    }
}

/// Differences along x (1) or y (2) in each quad: those of the pixel's own row or column, as in lavapipe.
struct Difference<const AXIS: usize>;

impl<N: Arithmetic, const AXIS: usize> Run<N> for Difference<AXIS> {
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

/// Returns the handler of any operation on scalars.
pub(crate) fn compute_scalar<N: Arithmetic>() -> Handler<N> {
    handler::<N, Scalars>(Level::Base)
}

/// Returns the handler of an operation into a row; `rows` is which operands are rows, as at least one is.
pub(crate) fn compute<N: Arithmetic>(level: Level, operation: Operation, rows: [bool; 3]) -> Handler<N> {
    macro_rules! sources {
        ($d:tt $($name:ident)+) => {
            macro_rules! source {
                $(($name) => { Row };)+
                ($d name:ident) => { Any };
            }
        };
    }
    // The operands of the operations in `frequent_mixed` are all rows here.
    sources!($ Add Sub Mul Div Min Max Less LessEqual MulAdd MulSub SubMul Select);
    macro_rules! rows {
        (DFdx(F) F) => {
            Difference<1>
        };
        (DFdy(F) F) => {
            Difference<2>
        };
        ($name:ident($a:ident) $r:ident) => {
            Rows1<apply::$name, ty!($a), ty!($r)>
        };
        ($name:ident($a:ident, $b:ident) $r:ident) => {
            Rows2<apply::$name, source!($name), source!($name), ty!($a), ty!($b), ty!($r)>
        };
        ($name:ident($a:ident, $b:ident, $c:ident) $r:ident) => {
            Rows3<apply::$name, source!($name), source!($name), source!($name), ty!($a), ty!($b), ty!($r)>
        };
    }
    macro_rules! select {
        ($($name:ident($($operand:ident),+) $value:ident,)*) => {
            match operation {
                $(Operation::$name => handler::<N, rows!($name($($operand),+) $value)>(level),)*
            }
        };
    }
    function(level, operation)
        .or_else(|| frequent_mixed(level, operation, rows))
        .unwrap_or_else(|| for_each_operation!(select))
}

/// Returns the handler of a function; none for other operations, and for functions that are rare.
fn function<N: Arithmetic>(level: Level, operation: Operation) -> Option<Handler<N>> {
    macro_rules! one {
        ($name:ident) => {
            function_handler::<N, Rows1<apply::$name, N, N>>(level)
        };
    }
    macro_rules! two {
        ($name:ident) => {
            function_handler::<N, Rows2<apply::$name, Any, Any, N, N, N>>(level)
        };
    }
    Some(match operation {
        Operation::Sin => one!(Sin),
        Operation::Cos => one!(Cos),
        Operation::Tan => one!(Tan),
        Operation::Asin => one!(Asin),
        Operation::Acos => one!(Acos),
        Operation::Atan => one!(Atan),
        Operation::Atan2 => two!(Atan2),
        Operation::Exp => one!(Exp),
        Operation::Exp2 => one!(Exp2),
        Operation::Log => one!(Log),
        Operation::Log2 => one!(Log2),
        Operation::Pow => two!(Pow),
        _ => return None,
    })
}

/// Returns the handler of a frequent operation on rows and scalars. Scalars stay in registers there, which is
/// up to a third faster than filling a chunk.
fn frequent_mixed<N: Arithmetic>(level: Level, operation: Operation, rows: [bool; 3]) -> Option<Handler<N>> {
    macro_rules! two {
        ($name:ident $r:ident) => {
            match rows {
                [true, false, _] => handler::<N, Rows2<apply::$name, Row, One, N, N, ty!($r)>>(level),
                [false, true, _] => handler::<N, Rows2<apply::$name, One, Row, N, N, ty!($r)>>(level),
                _ => return None,
            }
        };
    }
    macro_rules! three {
        ($name:ident($a:ident)) => {
            match rows {
                [true, true, false] => handler::<N, Rows3<apply::$name, Row, Row, One, ty!($a), N, N>>(level),
                [true, false, true] => handler::<N, Rows3<apply::$name, Row, One, Row, ty!($a), N, N>>(level),
                [true, false, false] => {
                    handler::<N, Rows3<apply::$name, Row, One, One, ty!($a), N, N>>(level)
                }
                [false, true, true] => handler::<N, Rows3<apply::$name, One, Row, Row, ty!($a), N, N>>(level),
                [false, true, false] => {
                    handler::<N, Rows3<apply::$name, One, Row, One, ty!($a), N, N>>(level)
                }
                [false, false, true] => {
                    handler::<N, Rows3<apply::$name, One, One, Row, ty!($a), N, N>>(level)
                }
                _ => return None,
            }
        };
    }
    Some(match operation {
        Operation::Add => two!(Add F),
        Operation::Sub => two!(Sub F),
        Operation::Mul => two!(Mul F),
        Operation::Div => two!(Div F),
        Operation::Min => two!(Min F),
        Operation::Max => two!(Max F),
        Operation::Less => two!(Less W),
        Operation::LessEqual => two!(LessEqual W),
        Operation::MulAdd => three!(MulAdd(F)),
        Operation::MulSub => three!(MulSub(F)),
        Operation::SubMul => three!(SubMul(F)),
        Operation::Select => three!(Select(W)),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::exec::number::RandomRounding;

    /// Counts the handlers of operations in a number type.
    fn count<N: Arithmetic>() -> usize {
        let mut handlers = HashSet::from([compute_scalar::<N>() as usize]);
        for level in [Level::Base, Level::detect()] {
            for &operation in Operation::ALL {
                for bits in 1..8_u8 {
                    let rows = [1, 2, 4].map(|bit| bits & bit != 0);
                    handlers.insert(compute::<N>(level, operation, rows) as usize);
                }
            }
        }
        handlers.len()
    }

    #[test]
    fn at_most_700_handlers_are_instantiated() {
        let counts = [count::<f32>(), count::<f64>(), count::<RandomRounding>()];
        assert!(counts.iter().sum::<usize>() <= 700, "{counts:?}");
    }
}
