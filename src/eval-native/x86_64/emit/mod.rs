//! Emission of a region: a loop over its vectors, in which items become instructions.

mod frame;
mod guard;
mod registers;

use self::frame::{CHUNK_BYTES, CHUNK_END, CHUNKS, ITERATIONS, MAX_MASKS, OFFSET, SCRATCH, place, place_at};
pub(super) use self::frame::{
    CONTEXT, FLOAT_SCALARS, FLOATS, Frame, MASKS, Note, SAVED_STACK, WORD_SCALARS, WORDS,
};
use self::registers::Registers;
use super::assemble::{Arithmetic, Assembler, Condition, Memory, R9, RAX, RDX, RSP, Source};
use super::context::offset;
use super::node::{Item, Region, Table};
use super::op;

/// Emits the loop over the vectors of a region, for the chunks of a mask. None if it needs too much memory.
pub(super) fn emit_region(code: &mut Assembler, frame: &mut Frame, region: &Region, base: u32) -> Option<()> {
    if region.items.is_empty() {
        return Some(());
    }
    if region.masks.len() > MAX_MASKS {
        return None;
    }
    let (done, next_chunk, next_vector, skip) = (code.label(), code.label(), code.label(), code.label());
    for at in 0..region.masks.len() {
        code.store_immediate32(Memory::at(RSP, 4 * at as i32), 0);
    }
    let uses_iterations = |item: &Item| matches!(item, Item::Store((Table::Iterations, _), ..));
    if region.items.iter().any(uses_iterations) {
        code.load64(ITERATIONS, Memory::at(CONTEXT, offset!(tables.own_iterations)));
    }
    if base == 0 {
        code.immediate32(CHUNKS, u32::MAX >> (32 - frame.width));
    } else {
        code.load64(RAX, Memory::at(CONTEXT, offset!(tables.active)));
        code.load32(CHUNKS, Memory::at(RAX, 8 * base as i32));
        code.arithmetic32(Arithmetic::Or, CHUNKS, Source::Register(CHUNKS.0));
        code.jump_if(Condition::Zero, done);
    }
    code.bind(next_chunk);
    code.lowest_bit32(OFFSET, CHUNKS);
    code.shift_left32(OFFSET, 6);
    code.address(CHUNK_END, Memory::at(OFFSET, CHUNK_BYTES));
    code.bind(next_vector);
    // Vectors without active pixels leave no trace, unless masks are made from nothing.
    if base != 0 && region.items.len() > 12 && region.masks.iter().all(|&mask| mask <= base) {
        let row = place(frame, (Table::Mask, base));
        let wide = !frame.precision.is_double();
        code.unary(op::VMOVAPS, wide, SCRATCH, Source::Memory(row));
        code.test(wide, SCRATCH);
        code.jump_if(Condition::Zero, skip);
    }
    Registers::new(code, frame, region, false).items()?;
    code.bind(skip);
    let step = frame.step();
    code.arithmetic_immediate32(Arithmetic::Add, Source::Register(OFFSET.0), step as u32);
    code.arithmetic32(Arithmetic::Compare, OFFSET, Source::Register(CHUNK_END.0));
    code.jump_if(Condition::NotZero, next_vector);
    // Which masks have pixels in this chunk.
    if !region.masks.is_empty() {
        code.arithmetic32(Arithmetic::Xor, R9, Source::Register(R9.0));
        code.arithmetic32(Arithmetic::Sub, R9, Source::Register(CHUNKS.0));
        code.arithmetic32(Arithmetic::And, R9, Source::Register(CHUNKS.0));
    }
    for (at, &mask) in (0..).zip(&region.masks) {
        // By vectors as long as those that were stored: longer ones would wait until these are in the cache.
        let wide = !frame.precision.is_double();
        let end = mask as i32 * CHUNK_BYTES * frame.width as i32;
        for (at, start) in (end - CHUNK_BYTES..end).step_by(step as usize).enumerate() {
            let part = Source::Memory(place_at(MASKS, 0, start));
            if at == 0 {
                code.unary(op::VMOVAPS, wide, SCRATCH, part);
            } else {
                code.binary(op::VPOR, wide, SCRATCH, SCRATCH, part);
            }
        }
        code.arithmetic32(Arithmetic::Xor, RAX, Source::Register(RAX.0));
        code.test(wide, SCRATCH);
        code.copy_if(Condition::NotZero, RAX, R9);
        code.arithmetic_memory32(Arithmetic::Or, Memory::at(RSP, 4 * at), RAX);
    }
    // Clears the lowest bit.
    code.address(RAX, Memory::at(CHUNKS, -1));
    code.arithmetic32(Arithmetic::And, CHUNKS, Source::Register(RAX.0));
    code.jump_if(Condition::NotZero, next_chunk);
    code.bind(done);
    if !region.masks.is_empty() {
        code.load64(RDX, Memory::at(CONTEXT, offset!(tables.active)));
        if base == 0 {
            code.immediate32(R9, u32::MAX >> (32 - frame.width));
        } else {
            code.load32(R9, Memory::at(RDX, 8 * base as i32));
        }
        code.not32(R9);
    }
    // Masks around the base may be changed, so that it is read before.
    for (at, &mask) in (0..).zip(&region.masks) {
        let chunks = Memory::at(RDX, 8 * mask as i32);
        code.load32(RAX, Memory::at(RSP, 4 * at));
        if mask <= base {
            code.load32(OFFSET, chunks);
            code.arithmetic32(Arithmetic::And, OFFSET, Source::Register(R9.0));
            code.arithmetic32(Arithmetic::Or, RAX, Source::Register(OFFSET.0));
        } else {
            code.store_immediate32(Memory::at(RDX, 8 * mask as i32 + 4), 0);
        }
        code.store32(chunks, RAX);
    }
    Some(())
}

/// Emits a sequence of operations on scalars.
pub(super) fn emit_scalars(code: &mut Assembler, frame: &mut Frame, region: &Region) -> Option<()> {
    Registers::new(code, frame, region, true).items()
}
