//! The entry of a program, its exit, and the calls of functions.

use super::{Refuel, Writer};
use crate::x86_64::assemble::{
    Arithmetic, CONSTANT_BYTES, Condition, Gpr, Label, Memory, R8, R12, R13, R14, R15, RAX, RBP, RBX, RCX,
    RDI, RDX, RSI, RSP, Source,
};
use crate::x86_64::context::offset;
use crate::x86_64::emit::{CONTEXT, FLOAT_SCALARS, FLOATS, MASKS, Note, SAVED_STACK, WORD_SCALARS, WORDS};
use crate::x86_64::node::Precision;
use crate::x86_64::op;

/// The registers that belong to the caller.
const PRESERVED: [Gpr; 6] = [RBX, RBP, R12, R13, R14, R15];

/// The bit of MXCSR that flushes denormal results to zero.
const FLUSH_TO_ZERO: u32 = 1 << 15;

/// The status bits of MXCSR.
const STATUS: u32 = 0x3F;

impl Writer<'_> {
    /// Returns the position of the size of the stack frame.
    pub(super) fn prologue(&mut self) -> usize {
        let code = &mut self.code;
        for register in PRESERVED {
            code.push(register);
        }
        code.copy64(CONTEXT, RDI);
        code.copy64(RAX, RSP);
        code.arithmetic_immediate64(Arithmetic::Sub, RSP, 0);
        let frame_size_at = code.len() - 4;
        // Vectors are aligned.
        code.arithmetic_immediate64(Arithmetic::And, RSP, -(CONSTANT_BYTES as i32));
        code.store64(Memory::at(RSP, SAVED_STACK), RAX);
        for (register, offset) in [
            (FLOATS, offset!(tables.floats)),
            (WORDS, offset!(tables.words)),
            (MASKS, offset!(tables.masks)),
            (FLOAT_SCALARS, offset!(tables.float_scalars)),
            (WORD_SCALARS, offset!(tables.word_scalars)),
        ] {
            code.load64(register, Memory::at(CONTEXT, offset));
        }
        if self.flushes() {
            let code = &mut self.code;
            code.store_mxcsr(Memory::at(CONTEXT, offset!(caller_mxcsr)));
            code.load32(RAX, Memory::at(CONTEXT, offset!(caller_mxcsr)));
            code.arithmetic_immediate32(Arithmetic::And, Source::Register(RAX.0), !STATUS);
            code.arithmetic_immediate32(Arithmetic::Or, Source::Register(RAX.0), FLUSH_TO_ZERO);
            code.store32(Memory::at(CONTEXT, offset!(own_mxcsr)), RAX);
            code.load_mxcsr(Memory::at(CONTEXT, offset!(own_mxcsr)));
        }
        frame_size_at
    }

    /// Whether the processor flushes denormals.
    fn flushes(&self) -> bool {
        self.frame.precision == Precision::Single
    }

    /// Collects the status bits and restores the caller's MXCSR.
    fn leave_mxcsr(&mut self) {
        if self.flushes() {
            let code = &mut self.code;
            code.store_mxcsr(Memory::at(CONTEXT, offset!(scratch)));
            code.load32(RAX, Memory::at(CONTEXT, offset!(scratch)));
            code.arithmetic_memory32(Arithmetic::Or, Memory::at(CONTEXT, offset!(status)), RAX);
            code.load_mxcsr(Memory::at(CONTEXT, offset!(caller_mxcsr)));
        }
        self.code.vzeroupper();
    }

    /// Sets the code's own MXCSR again.
    fn enter_mxcsr(&mut self) {
        if self.flushes() {
            self.code.load_mxcsr(Memory::at(CONTEXT, offset!(own_mxcsr)));
        }
    }

    /// Emits what follows the steps.
    pub(super) fn epilogue(&mut self, note: Label) {
        self.code.bind(self.exit);
        self.leave_mxcsr();
        self.code.load64(RSP, Memory::at(RSP, SAVED_STACK));
        for register in PRESERVED.into_iter().rev() {
            self.code.pop(register);
        }
        self.code.ret();
        for (label, offset) in [(self.call, offset!(call)), (self.refuel, offset!(refuel))] {
            self.code.bind(label);
            self.code.arithmetic_immediate64(Arithmetic::Sub, RSP, 8);
            self.leave_mxcsr();
            self.code.copy64(RDI, CONTEXT);
            self.code.call_memory(Memory::at(CONTEXT, offset));
            self.enter_mxcsr();
            self.code.arithmetic_immediate64(Arithmetic::Add, RSP, 8);
            self.code.ret();
        }
        for Refuel {
            entry,
            back,
            instruction,
        } in std::mem::take(&mut self.refuels)
        {
            self.code.bind(entry);
            self.code.immediate32(RSI, instruction);
            self.code.call(self.refuel);
            self.code
                .arithmetic32(Arithmetic::Or, RAX, Source::Register(RAX.0));
            self.code.jump_if(Condition::NotZero, self.exit);
            self.code.jump(back);
        }
        for Note {
            entry,
            back,
            register,
            site,
        } in std::mem::take(&mut self.frame.notes)
        {
            self.code.bind(entry);
            let hit = Source::Memory(Memory::at(CONTEXT, offset!(hit)));
            self.code.unary(op::VMOVUPS_STORE, true, register, hit);
            self.code.immediate32(RAX, site);
            self.code.call(note);
            self.code.jump(back);
        }
        self.note(note);
    }

    /// Emits the function that notes pixels, which keeps all registers.
    fn note(&mut self, label: Label) {
        // The offset, the end of the chunk, the chunks that are left, and the base of iterations.
        const KEPT: [Gpr; 4] = [RCX, RDX, R8, RSI];
        self.code.bind(label);
        for register in KEPT {
            self.code.push(register);
        }
        self.code.arithmetic_immediate64(Arithmetic::Sub, RSP, 8);
        let bytes = self.frame.vectors.bytes();
        let vectors =
            |vector: u8| Source::Memory(Memory::at(CONTEXT, offset!(vectors) + bytes * i32::from(vector)));
        for vector in 0..16 {
            self.code.unary(op::VMOVUPS_STORE, true, vector, vectors(vector));
        }
        self.code.copy64(RSI, RAX);
        self.code.copy64(RDX, RCX);
        self.leave_mxcsr();
        self.code.copy64(RDI, CONTEXT);
        self.code.call_memory(Memory::at(CONTEXT, offset!(note)));
        self.enter_mxcsr();
        for vector in 0..16 {
            self.code.unary(op::VMOVUPS, true, vector, vectors(vector));
        }
        self.code.arithmetic_immediate64(Arithmetic::Add, RSP, 8);
        for register in KEPT.into_iter().rev() {
            self.code.pop(register);
        }
        self.code.ret();
    }
}
