//! Instructions of AVX-512 in the EVEX encoding (Intel, “Software Developer's Manual”, volume 2, section
//! 2.7), all on 512 bits. Comparisons set mask registers there; the code keeps vectors instead, as with AVX2.

use super::assemble::{Assembler, Source, Vector};
use super::op::{self, Opcode, long, opcode};

const VPTESTMD: Opcode = opcode(1, 2, 0x27);
const VPMOVM2D: Opcode = opcode(2, 2, 0x38);
const VPMOVM2Q: Opcode = long(2, 2, 0x38);
const VPTERNLOGD: Opcode = opcode(1, 3, 0x25);
const VPMOVQD: Opcode = opcode(2, 2, 0x35);
/// `kortestw k1, k1`
const KORTESTW: [u8; 4] = [0xC5, 0xF8, 0x98, 0xC9];

/// The mask register that is used.
const MASK: u8 = 1;

/// Truth tables of [`VPTERNLOGD`]: bit `4a + 2b + c` is the result for the bits a, b, c of its operands.
mod table {
    /// `b ? c : a`
    pub(super) const B_SELECTS_C_OR_A: u8 = 0xB8;
    /// `b ? a : c`
    pub(super) const B_SELECTS_A_OR_C: u8 = 0xE2;
    /// `a ? c : b`
    pub(super) const A_SELECTS_C_OR_B: u8 = 0xAC;
}

impl Assembler {
    /// An instruction with these registers and this operand; `after` is as in [`Self::operand`].
    pub(super) fn evex(&mut self, op: Opcode, register: u8, second: u8, source: Source, after: u8) {
        let (index, base) = Self::high_bits(source);
        let inverted = |bit: u8| bit ^ 1;
        // The registers are below 16: the other inverted bits of their numbers are 1.
        let first =
            inverted(register >> 3) << 7 | inverted(index) << 6 | inverted(base) << 5 | 1 << 4 | op.map;
        let common = u8::from(op.long) << 7 | (!second & 15) << 3 | 1 << 2 | op.prefix;
        let length = 0b10 << 5 | 1 << 3;
        self.bytes(&[0x62, first, common, length, op.byte]);
        // Displacements of one byte are multiples of the operand's length there.
        self.operand(register, source, after, false);
    }

    /// Sets all bits of the lanes for which a comparison holds.
    pub(super) fn compare_evex(
        &mut self,
        op: Opcode,
        to: Vector,
        a: Vector,
        b: Source,
        predicate: Option<u8>,
    ) {
        self.evex(op, MASK, a, b, u8::from(predicate.is_some()));
        self.bytes(predicate.as_slice());
        let spread = if op.long { VPMOVM2Q } else { VPMOVM2D };
        self.evex(spread, to, 0, Source::Register(MASK), 0);
    }

    /// As [`Self::test`].
    pub(super) fn test_evex(&mut self, vector: Vector) {
        self.evex(VPTESTMD, MASK, vector, Source::Register(vector), 0);
        self.bytes(&KORTESTW);
    }

    /// As [`Self::narrow`].
    pub(super) fn narrow_evex(&mut self, to: Vector, from: Vector) {
        self.evex(VPMOVQD, from, 0, Source::Register(to), 0);
    }

    /// As [`Self::blend`], by an instruction that overwrites its first operand.
    pub(super) fn blend_evex(&mut self, to: Vector, no: Vector, yes: Source, mask: Vector) {
        let (b, c, table) = if to == mask {
            (no, yes, table::A_SELECTS_C_OR_B)
        } else if yes == Source::Register(to) {
            (mask, Source::Register(no), table::B_SELECTS_A_OR_C)
        } else {
            if to != no {
                self.evex(op::VMOVAPS, to, 0, Source::Register(no), 0);
            }
            (mask, yes, table::B_SELECTS_C_OR_A)
        };
        self.evex(VPTERNLOGD, to, b, c, 1);
        self.bytes(&[table]);
    }
}
