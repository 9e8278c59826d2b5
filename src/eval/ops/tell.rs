//! What is told of one pixel, and what it is told to do instead.

use std::marker::PhantomData;

use super::{Handler, Instruction, Level, Run, Sink, handler};
use crate::batch::Batch;
use crate::ir::operation::Kind;
use crate::number::Number;
use crate::trace::story::{Scribe, Tellable};

/// Tells the row of operand 0 if the pixel is here, and puts there what it is told. `out` is the event, `to` the component.
struct Tell<T>(PhantomData<T>);

impl<N: Number, T: Sink<N> + Tellable> Run<N> for Tell<T> {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if let Some(scribe) = here(batch, instruction) {
            let chunk = &T::row(batch, instruction.operands[0])[scribe.chunk()];
            let mut lanes = chunk.get();
            let value = &mut lanes[scribe.lane()];
            let instead = scribe.tell(instruction.out, instruction.to, value.told());
            if let Some(instead) = instead.and_then(T::from_told) {
                *value = instead;
                chunk.set(lanes);
            }
        }
        at + 1
    }
}

/// The same of a scalar. It is everybody's, but nobody looks at the others while a story is told.
struct TellScalar<T>(PhantomData<T>);

impl<N: Number, T: Sink<N> + Tellable> Run<N> for TellScalar<T> {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if let Some(scribe) = here(batch, instruction) {
            let scalar = T::scalar(batch, instruction.operands[0]);
            let instead = scribe.tell(instruction.out, instruction.to, scalar.get().told());
            if let Some(instead) = instead.and_then(T::from_told) {
                scalar.set(instead);
            }
        }
        at + 1
    }
}

/// Tells of an event without a value.
struct Mention;

impl<N: Number> Run<N> for Mention {
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        if let Some(scribe) = here(batch, instruction) {
            scribe.mention(instruction.out);
        }
        at + 1
    }
}

/// Who takes it down, if the pixel is here.
fn here<'a, N: Number>(batch: &'a Batch<'_, N>, instruction: &Instruction<N>) -> Option<&'a Scribe<'a>> {
    let scribe = batch.scribe.as_ref()?;
    let chunk = scribe.chunk();
    let mask = batch.mask_row(instruction.mask)[chunk].get();
    let any = batch.here[instruction.mask as usize].get().chunks >> chunk & 1 != 0;
    (any && mask[scribe.lane()] != 0).then_some(scribe)
}

/// The handler that tells a value of a kind in a row or not.
pub(crate) fn tell<N: Number>(kind: Kind, row: bool) -> Handler<N> {
    match (kind, row) {
        (Kind::Float, true) => handler::<N, Tell<N>>(Level::Base),
        (Kind::Float, false) => handler::<N, TellScalar<N>>(Level::Base),
        (Kind::Word, true) => handler::<N, Tell<u32>>(Level::Base),
        (Kind::Word, false) => handler::<N, TellScalar<u32>>(Level::Base),
    }
}

/// The handler that tells of an event without a value.
pub(crate) fn mention<N: Number>() -> Handler<N> {
    handler::<N, Mention>(Level::Base)
}
