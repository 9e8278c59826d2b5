//! General-purpose instructions (Intel, “Software Developer's Manual”, volume 2).

use super::assemble::{Arithmetic, Assembler, Condition, Gpr, Label, Memory, Source};

impl Assembler {
    /// A general-purpose instruction; `long` is whether it has 64 bits.
    fn legacy(&mut self, prefix: &[u8], opcode: &[u8], long: bool, register: u8, source: Source, after: u8) {
        let (index, base) = Self::high_bits(source);
        self.bytes(prefix);
        let rex = u8::from(long) << 3 | (register >> 3) << 2 | index << 1 | base;
        if rex != 0 {
            self.bytes(&[0x40 | rex]);
        }
        self.bytes(opcode);
        self.operand(register, source, after, true);
    }

    /// Loads 64 bits.
    pub(super) fn load64(&mut self, to: Gpr, from: Memory) {
        self.legacy(&[], &[0x8B], true, to.0, Source::Memory(from), 0);
    }

    /// Loads 32 bits; the others become 0.
    pub(super) fn load32(&mut self, to: Gpr, from: Memory) {
        self.legacy(&[], &[0x8B], false, to.0, Source::Memory(from), 0);
    }

    /// Stores 64 bits.
    pub(super) fn store64(&mut self, to: Memory, from: Gpr) {
        self.legacy(&[], &[0x89], true, from.0, Source::Memory(to), 0);
    }

    /// Stores the low 32 bits.
    pub(super) fn store32(&mut self, to: Memory, from: Gpr) {
        self.legacy(&[], &[0x89], false, from.0, Source::Memory(to), 0);
    }

    /// Stores a constant of 32 bits.
    pub(super) fn store_immediate32(&mut self, to: Memory, value: u32) {
        self.legacy(&[], &[0xC7], false, 0, Source::Memory(to), 4);
        self.bytes(&value.to_le_bytes());
    }

    /// Loads a constant of 32 bits; the other bits become 0.
    pub(super) fn immediate32(&mut self, to: Gpr, value: u32) {
        if to.0 >= 8 {
            self.bytes(&[0x41]);
        }
        self.bytes(&[0xB8 | to.0 & 7]);
        self.bytes(&value.to_le_bytes());
    }

    /// The address of an operand.
    pub(super) fn address(&mut self, to: Gpr, of: Memory) {
        self.legacy(&[], &[0x8D], true, to.0, Source::Memory(of), 0);
    }

    /// Copies 64 bits.
    pub(super) fn copy64(&mut self, to: Gpr, from: Gpr) {
        self.legacy(&[], &[0x8B], true, to.0, Source::Register(from.0), 0);
    }

    /// `to = to op from`, on 32 bits.
    pub(super) fn arithmetic32(&mut self, op: Arithmetic, to: Gpr, from: Source) {
        self.legacy(&[], &[(op as u8) << 3 | 3], false, to.0, from, 0);
    }

    /// `to = to op from`, on 32 bits in memory.
    pub(super) fn arithmetic_memory32(&mut self, op: Arithmetic, to: Memory, from: Gpr) {
        self.legacy(&[], &[(op as u8) << 3 | 1], false, from.0, Source::Memory(to), 0);
    }

    /// `to = to op value`, on 32 bits.
    pub(super) fn arithmetic_immediate32(&mut self, op: Arithmetic, to: Source, value: u32) {
        self.legacy(&[], &[0x81], false, op as u8, to, 4);
        self.bytes(&value.to_le_bytes());
    }

    /// `to = to op value`, on 64 bits.
    pub(super) fn arithmetic_immediate64(&mut self, op: Arithmetic, to: Gpr, value: i32) {
        self.legacy(&[], &[0x81], true, op as u8, Source::Register(to.0), 4);
        self.bytes(&value.to_le_bytes());
    }

    /// Copies 32 bits if a condition holds.
    pub(super) fn copy_if(&mut self, condition: Condition, to: Gpr, from: Gpr) {
        self.legacy(
            &[],
            &[0x0F, 0x40 | condition as u8],
            false,
            to.0,
            Source::Register(from.0),
            0,
        );
    }

    /// Inverts 32 bits.
    pub(super) fn not32(&mut self, register: Gpr) {
        self.legacy(&[], &[0xF7], false, 2, Source::Register(register.0), 0);
    }

    /// Shifts 32 bits to the left.
    pub(super) fn shift_left32(&mut self, register: Gpr, count: u8) {
        self.legacy(&[], &[0xC1], false, 4, Source::Register(register.0), 1);
        self.bytes(&[count]);
    }

    /// The index of the lowest set bit of a 32-bit word.
    pub(super) fn lowest_bit32(&mut self, to: Gpr, from: Gpr) {
        self.legacy(&[0xF3], &[0x0F, 0xBC], false, to.0, Source::Register(from.0), 0);
    }

    pub(super) fn push(&mut self, register: Gpr) {
        self.legacy_short(0x50, register);
    }

    pub(super) fn pop(&mut self, register: Gpr) {
        self.legacy_short(0x58, register);
    }

    fn legacy_short(&mut self, opcode: u8, register: Gpr) {
        if register.0 >= 8 {
            self.bytes(&[0x41]);
        }
        self.bytes(&[opcode | register.0 & 7]);
    }

    /// Loads the control and status of vector arithmetic.
    pub(super) fn load_mxcsr(&mut self, from: Memory) {
        self.legacy(&[], &[0x0F, 0xAE], false, 2, Source::Memory(from), 0);
    }

    /// Stores the control and status of vector arithmetic.
    pub(super) fn store_mxcsr(&mut self, to: Memory) {
        self.legacy(&[], &[0x0F, 0xAE], false, 3, Source::Memory(to), 0);
    }

    pub(super) fn jump(&mut self, to: Label) {
        self.bytes(&[0xE9]);
        self.relative(to);
    }

    pub(super) fn jump_if(&mut self, condition: Condition, to: Label) {
        self.bytes(&[0x0F, 0x80 | condition as u8]);
        self.relative(to);
    }

    pub(super) fn call(&mut self, to: Label) {
        self.bytes(&[0xE8]);
        self.relative(to);
    }

    /// Calls the function whose address is in memory.
    pub(super) fn call_memory(&mut self, to: Memory) {
        self.legacy(&[], &[0xFF], false, 2, Source::Memory(to), 0);
    }

    pub(super) fn ret(&mut self) {
        self.bytes(&[0xC3]);
    }
}
