//! Observation of a run: checks for undefined operations, and the trace of one pixel.

use std::marker::PhantomData;

use super::{Any, Component, Handler, Instruction, Level, Row, Run, Source, for_each_chunk, handler};
use crate::exec::batch::Batch;
use crate::exec::lanes::{LANES, Lanes, any};
use crate::exec::number::Arithmetic;
use crate::exec::recorder::{Recorder, TraceComponent};
use crate::ir::{Kind, Predicate, SiteId};

/// The test of a [`Predicate`]: whether one or two operands are at fault.
trait Holds<N: Arithmetic, T> {
    fn holds(a: T, b: T, limit: u32) -> bool;
}

macro_rules! holds {
    ($($name:ident($a:ident, $b:ident, $limit:ident: $ty:ty) = $value:expr;)*) => {$(
        struct $name;
        impl<N: Arithmetic> Holds<N, $ty> for $name {
            #[inline(always)]
            fn holds($a: $ty, $b: $ty, $limit: u32) -> bool {
                $value
            }
        }
    )*};
}

holds! {
    AtLeast(a, _b, limit: u32) = a >= limit;
    Zero(a, _b, _limit: u32) = a == 0;
    // Truncated, since f32 has no number between -2147483649 and -2147483648, and f64 has.
    NotInt(a, _b, _limit: N) =
        !(a.trunc() >= N::from_f64(-2_147_483_648.0) && a < N::from_f64(2_147_483_648.0));
    NotUint(a, _b, _limit: N) = !(a > N::from_f64(-1.0) && a < N::from_f64(4_294_967_296.0));
    Unordered(a, b, _limit: N) = a.is_nan() || b.is_nan();
    Equal(a, b, _limit: N) = a == b;
    Greater(a, b, _limit: N) = a > b;
    Negative(a, _b, _limit: N) = a < N::default();
    NotPositive(a, _b, _limit: N) = a <= N::default();
    BeyondOne(a, _b, _limit: N) = a.abs() > N::from_f64(1.0);
    AtLeastOne(a, _b, _limit: N) = a.abs() >= N::from_f64(1.0);
    BelowOne(a, _b, _limit: N) = a < N::from_f64(1.0);
    BothZero(a, b, _limit: N) = a == N::default() && b == N::default();
    PowUndefined(a, b, _limit: N) = a < N::default() || (a == N::default() && b <= N::default());
}

/// Checks the active pixels. `out` is the site, `to` the predicate's limit.
struct Check<P, S, T>(PhantomData<(P, S, T)>);

impl<N: Arithmetic, P: Holds<N, T>, S: Source<N, T>, T: Component<N>> Run<N> for Check<P, S, T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let (mut filled_a, mut filled_b) = (None, None);
        let a = S::open(batch, instruction.operands[0], &mut filled_a);
        let b = S::open(batch, instruction.operands[1], &mut filled_b);
        let mask = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (a, b, mask) = (S::chunk(a, chunk), S::chunk(b, chunk), mask[chunk].get());
            let mut hit = [0; LANES];
            for lane in 0..LANES {
                hit[lane] = mask[lane] & u32::from(P::holds(a[lane], b[lane], instruction.to)).wrapping_neg();
            }
            if any(&hit) {
                note(batch, SiteId(instruction.out), chunk, &hit);
            }
        });
        at + 1
    }
}

/// Notes the pixels of a chunk that are at fault.
#[cold]
fn note<N: Arithmetic>(batch: &Batch<'_, N>, site: SiteId, chunk: usize, hit: &Lanes<u32>) {
    batch.notes.borrow_mut().add(site, chunk, hit);
    if let Some(recorder) = &batch.recorder {
        recorder.record_fault(site, chunk, hit);
    }
}

/// Finds quads in which only some pixels are active.
struct PartialQuad;

impl<N: Arithmetic> Run<N> for PartialQuad {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let active = batch.active[instruction.mask as usize].get();
        if active.all {
            return at + 1;
        }
        let mask = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let mask = mask[chunk].get();
            let mut hit = [0; LANES];
            for (hit, quad) in hit.chunks_exact_mut(4).zip(mask.chunks_exact(4)) {
                if quad.contains(&0) {
                    hit.copy_from_slice(quad);
                }
            }
            if hit != [0; LANES] {
                note(batch, SiteId(instruction.out), chunk, &hit);
            }
        });
        at + 1
    }
}

/// Returns the handler of a check; `rows` is whether all operands are rows.
pub(crate) fn check<N: Arithmetic>(level: Level, predicate: Predicate, rows: bool) -> Handler<N> {
    macro_rules! form {
        ($name:ident, $ty:ty) => {
            if rows {
                handler::<N, Check<$name, Row, $ty>>(level)
            } else {
                handler::<N, Check<$name, Any, $ty>>(level)
            }
        };
    }
    match predicate {
        Predicate::AtLeast(_) => form!(AtLeast, u32),
        Predicate::Zero => form!(Zero, u32),
        Predicate::NotInt => form!(NotInt, N),
        Predicate::NotUint => form!(NotUint, N),
        Predicate::Unordered => form!(Unordered, N),
        Predicate::Equal => form!(Equal, N),
        Predicate::Greater => form!(Greater, N),
        Predicate::Negative => form!(Negative, N),
        Predicate::NotPositive => form!(NotPositive, N),
        Predicate::BeyondOne => form!(BeyondOne, N),
        Predicate::AtLeastOne => form!(AtLeastOne, N),
        Predicate::BelowOne => form!(BelowOne, N),
        Predicate::BothZero | Predicate::ConstantZeros => form!(BothZero, N),
        Predicate::PowUndefined => form!(PowUndefined, N),
        Predicate::PartialQuad => handler::<N, PartialQuad>(level),
    }
}

// The trace of one pixel.

/// Records the row of operand 0 if the traced pixel is active, and writes back the forced value, if any.
/// `out` is the event, `to` the component.
struct Record<T>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N> + TraceComponent> Run<N> for Record<T> {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if let Some(recorder) = active_recorder(batch, instruction) {
            let chunk = &T::row(batch, instruction.operands[0])[recorder.chunk()];
            let mut lanes = chunk.get();
            let value = &mut lanes[recorder.lane()];
            let instead = recorder.record_component(instruction.out, instruction.to, value.to_trace());
            if let Some(instead) = instead.and_then(T::from_trace) {
                *value = instead;
                chunk.set(lanes);
            }
        }
        at + 1
    }
}

/// Records a scalar. A forced value changes it for all pixels, but only the traced pixel's results are used.
struct RecordScalar<T>(PhantomData<T>);

impl<N: Arithmetic, T: Component<N> + TraceComponent> Run<N> for RecordScalar<T> {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if let Some(recorder) = active_recorder(batch, instruction) {
            let scalar = T::scalar(batch, instruction.operands[0]);
            let instead = recorder.record_component(instruction.out, instruction.to, scalar.get().to_trace());
            if let Some(instead) = instead.and_then(T::from_trace) {
                scalar.set(instead);
            }
        }
        at + 1
    }
}

/// Records an event without a value.
struct RecordEvent;

impl<N: Arithmetic> Run<N> for RecordEvent {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if let Some(recorder) = active_recorder(batch, instruction) {
            recorder.record_event(instruction.out);
        }
        at + 1
    }
}

/// Returns the recorder, if the traced pixel is active.
fn active_recorder<'a, N: Arithmetic>(
    batch: &'a Batch<'_, N>,
    instruction: &Instruction<N>,
) -> Option<&'a Recorder<'a>> {
    let recorder = batch.recorder.as_ref()?;
    let chunk = recorder.chunk();
    let mask = batch.mask_row(instruction.mask)[chunk].get();
    let any = batch.active[instruction.mask as usize].get().chunks >> chunk & 1 != 0;
    (any && mask[recorder.lane()] != 0).then_some(recorder)
}

/// Returns the handler that records a value in a row or a scalar.
pub(crate) fn record<N: Arithmetic>(kind: Kind, row: bool) -> Handler<N> {
    match (kind, row) {
        (Kind::Float, true) => handler::<N, Record<N>>(Level::Base),
        (Kind::Float, false) => handler::<N, RecordScalar<N>>(Level::Base),
        (Kind::Word, true) => handler::<N, Record<u32>>(Level::Base),
        (Kind::Word, false) => handler::<N, RecordScalar<u32>>(Level::Base),
    }
}

/// Returns the handler that records an event without a value.
pub(crate) fn record_event<N: Arithmetic>() -> Handler<N> {
    handler::<N, RecordEvent>(Level::Base)
}

/// Counts a basic block for the active pixels. `out` is the block.
struct Count;

impl<N: Arithmetic> Run<N> for Count {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if let Some(counter) = &batch.counter {
            let mask = batch.mask_row(instruction.mask);
            for_each_chunk!(batch, instruction.mask, chunk => {
                counter.count(instruction.out, chunk, &mask[chunk].get());
            });
        }
        at + 1
    }
}

/// Returns the handler that counts a basic block.
pub(crate) fn count<N: Arithmetic>(level: Level) -> Handler<N> {
    handler::<N, Count>(level)
}
