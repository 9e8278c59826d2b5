//! An assembler for the instructions that [`super::emit`] needs: AVX2 in the VEX encoding, and a few
//! general-purpose ones (Intel, “Software Developer's Manual”, volume 2); those of AVX-512 are in `evex`.

/// A general-purpose register, by its number in the encoding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Gpr(pub(super) u8);

pub(super) const RAX: Gpr = Gpr(0);
pub(super) const RCX: Gpr = Gpr(1);
pub(super) const RDX: Gpr = Gpr(2);
pub(super) const RBX: Gpr = Gpr(3);
pub(super) const RSP: Gpr = Gpr(4);
pub(super) const RBP: Gpr = Gpr(5);
pub(super) const RSI: Gpr = Gpr(6);
pub(super) const RDI: Gpr = Gpr(7);
pub(super) const R8: Gpr = Gpr(8);
pub(super) const R9: Gpr = Gpr(9);
pub(super) const R12: Gpr = Gpr(12);
pub(super) const R13: Gpr = Gpr(13);
pub(super) const R14: Gpr = Gpr(14);
pub(super) const R15: Gpr = Gpr(15);

/// A vector register: xmm, ymm or zmm, which share their numbers.
pub(super) type Vector = u8;

/// A memory operand: `base + index · 2^scale + displacement`, or a constant after the code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Memory {
    At {
        base: Gpr,
        /// The index register, and the logarithm of its factor; not RSP.
        index: Option<(Gpr, u8)>,
        displacement: i32,
    },
    /// A constant of the pool, by its number.
    Constant(u32),
}

impl Memory {
    pub(super) fn at(base: Gpr, displacement: i32) -> Self {
        Self::At {
            base,
            index: None,
            displacement,
        }
    }
}

/// The operand of an instruction that may be a register or in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    Register(u8),
    Memory(Memory),
}

/// The opcode of a VEX instruction, and of the EVEX instruction with the same name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Opcode {
    /// The implied prefix: none, 66, F3, F2.
    pub(super) prefix: u8,
    /// The implied leading bytes: 0F, 0F 38, 0F 3A.
    pub(super) map: u8,
    /// The bit W of the VEX encoding.
    wide: bool,
    /// The bit W of the EVEX encoding, which is set where lanes have 64 bits.
    pub(super) long: bool,
    pub(super) byte: u8,
}

pub(super) const fn opcode(prefix: u8, map: u8, byte: u8) -> Opcode {
    Opcode {
        prefix,
        map,
        wide: false,
        long: false,
        byte,
    }
}

/// An opcode whose lanes have 64 bits.
pub(super) const fn long(prefix: u8, map: u8, byte: u8) -> Opcode {
    Opcode {
        long: true,
        ..opcode(prefix, map, byte)
    }
}

/// The vectors of the code. *Wide* ones hold as many floats as possible, the others half as many bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Vectors {
    /// 256 and 128 bits.
    #[default]
    Avx2,
    /// 512 and 256 bits.
    Avx512,
}

impl Vectors {
    /// Returns the longest vectors of this processor that there is code for, if any.
    pub(super) fn detect() -> Option<Self> {
        if !is_x86_feature_detected!("avx2") {
            return None;
        }
        let has_long = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq");
        Some(if has_long { Self::Avx512 } else { Self::Avx2 })
    }

    /// The number of bytes of a wide vector.
    pub(super) fn bytes(self) -> i32 {
        match self {
            Self::Avx2 => 32,
            Self::Avx512 => 64,
        }
    }
}

/// Opcodes; names are those of the manual.
pub(super) mod op {
    use super::{Opcode, long, opcode};

    pub(crate) const VADDPS: Opcode = opcode(0, 1, 0x58);
    pub(crate) const VADDPD: Opcode = long(1, 1, 0x58);
    pub(crate) const VMULPS: Opcode = opcode(0, 1, 0x59);
    pub(crate) const VMULPD: Opcode = long(1, 1, 0x59);
    pub(crate) const VSUBPS: Opcode = opcode(0, 1, 0x5C);
    pub(crate) const VSUBPD: Opcode = long(1, 1, 0x5C);
    pub(crate) const VMINPS: Opcode = opcode(0, 1, 0x5D);
    pub(crate) const VMINPD: Opcode = long(1, 1, 0x5D);
    pub(crate) const VDIVPS: Opcode = opcode(0, 1, 0x5E);
    pub(crate) const VDIVPD: Opcode = long(1, 1, 0x5E);
    pub(crate) const VMAXPS: Opcode = opcode(0, 1, 0x5F);
    pub(crate) const VMAXPD: Opcode = long(1, 1, 0x5F);
    pub(crate) const VSQRTPS: Opcode = opcode(0, 1, 0x51);
    pub(crate) const VSQRTPD: Opcode = long(1, 1, 0x51);
    pub(crate) const VCMPPS: Opcode = opcode(0, 1, 0xC2);
    pub(crate) const VCMPPD: Opcode = long(1, 1, 0xC2);
    pub(crate) const VROUNDPS: Opcode = opcode(1, 3, 0x08);
    pub(crate) const VROUNDPD: Opcode = long(1, 3, 0x09);
    pub(crate) const VBLENDVPS: Opcode = opcode(1, 3, 0x4A);
    pub(crate) const VBLENDVPD: Opcode = opcode(1, 3, 0x4B);
    pub(crate) const VSHUFPS: Opcode = opcode(0, 1, 0xC6);
    pub(crate) const VPERMILPS: Opcode = opcode(1, 3, 0x04);
    pub(crate) const VPERMPD: Opcode = Opcode {
        wide: true,
        ..long(1, 3, 0x01)
    };
    pub(crate) const VMOVAPS: Opcode = opcode(0, 1, 0x28);
    pub(crate) const VMOVAPS_STORE: Opcode = opcode(0, 1, 0x29);
    pub(crate) const VMOVUPS: Opcode = opcode(0, 1, 0x10);
    pub(crate) const VMOVUPS_STORE: Opcode = opcode(0, 1, 0x11);
    pub(crate) const VMOVSS: Opcode = opcode(2, 1, 0x10);
    pub(crate) const VMOVSS_STORE: Opcode = opcode(2, 1, 0x11);
    pub(crate) const VMOVSD: Opcode = opcode(3, 1, 0x10);
    pub(crate) const VMOVSD_STORE: Opcode = opcode(3, 1, 0x11);
    pub(crate) const VBROADCASTSS: Opcode = opcode(1, 2, 0x18);
    pub(crate) const VBROADCASTSD: Opcode = long(1, 2, 0x19);
    pub(crate) const VEXTRACTI128: Opcode = opcode(1, 3, 0x39);
    pub(crate) const VPMOVSXDQ: Opcode = opcode(1, 2, 0x25);
    pub(crate) const VCVTDQ2PS: Opcode = opcode(0, 1, 0x5B);
    pub(crate) const VCVTTPS2DQ: Opcode = opcode(2, 1, 0x5B);
    pub(crate) const VCVTDQ2PD: Opcode = opcode(2, 1, 0xE6);
    pub(crate) const VCVTTPD2DQ: Opcode = long(1, 1, 0xE6);
    pub(crate) const VCVTPS2PD: Opcode = opcode(0, 1, 0x5A);
    pub(crate) const VCVTPD2PS: Opcode = long(1, 1, 0x5A);
    pub(crate) const VPAND: Opcode = opcode(1, 1, 0xDB);
    pub(crate) const VPANDN: Opcode = opcode(1, 1, 0xDF);
    pub(crate) const VPOR: Opcode = opcode(1, 1, 0xEB);
    pub(crate) const VPXOR: Opcode = opcode(1, 1, 0xEF);
    pub(crate) const VPADDD: Opcode = opcode(1, 1, 0xFE);
    pub(crate) const VPSUBD: Opcode = opcode(1, 1, 0xFA);
    pub(crate) const VPMULLD: Opcode = opcode(1, 2, 0x40);
    pub(crate) const VPCMPEQD: Opcode = opcode(1, 1, 0x76);
    pub(crate) const VPCMPGTD: Opcode = opcode(1, 1, 0x66);
    pub(crate) const VPMINSD: Opcode = opcode(1, 2, 0x39);
    pub(crate) const VPMINUD: Opcode = opcode(1, 2, 0x3B);
    pub(crate) const VPMAXSD: Opcode = opcode(1, 2, 0x3D);
    pub(crate) const VPMAXUD: Opcode = opcode(1, 2, 0x3F);
    pub(crate) const VPSLLVD: Opcode = opcode(1, 2, 0x47);
    pub(crate) const VPSRLVD: Opcode = opcode(1, 2, 0x45);
    pub(crate) const VPSRAVD: Opcode = opcode(1, 2, 0x46);
    pub(crate) const VPTEST: Opcode = opcode(1, 2, 0x17);
    /// Shifts by an immediate; the digit in the place of a register selects the operation.
    pub(crate) const VPSHIFTD: Opcode = opcode(1, 1, 0x72);
    pub(crate) const SHIFT_RIGHT: u8 = 2;
}

/// A condition of a jump, by its number in the encoding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Condition {
    Below = 2,
    Zero = 4,
    NotZero = 5,
}

/// A place in the code, which may be bound after jumps to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Label(u32);

/// An arithmetic operation on general-purpose registers, by its digit in the encoding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arithmetic {
    Add = 0,
    Or = 1,
    And = 4,
    Sub = 5,
    Xor = 6,
    Compare = 7,
}

/// A constant of the pool: as many bytes as the longest vector has.
pub(super) type Constant = [u8; CONSTANT_BYTES];

pub(super) const CONSTANT_BYTES: usize = 64;

/// Machine code under construction.
#[derive(Debug, Default)]
pub(super) struct Assembler {
    vectors: Vectors,
    code: Vec<u8>,
    /// The position of each label; [`UNBOUND`] until it is known.
    labels: Vec<u32>,
    /// The positions of relative addresses of labels.
    jumps: Vec<(u32, Label)>,
    /// The positions of relative addresses of constants, and the number of bytes of the instruction after it.
    constants: Vec<(u32, u32, u8)>,
}

const UNBOUND: u32 = u32::MAX;

/// The immediate operand of a shuffle that takes the lower halves of lanes of 64 bits of both operands.
const EVEN_LANES: u8 = 0x88;

impl Assembler {
    pub(super) fn new(vectors: Vectors) -> Self {
        Self {
            vectors,
            ..Self::default()
        }
    }

    pub(super) fn label(&mut self) -> Label {
        self.labels.push(UNBOUND);
        Label(self.labels.len() as u32 - 1)
    }

    pub(super) fn bind(&mut self, label: Label) {
        self.labels[label.0 as usize] = self.code.len() as u32;
    }

    /// The number of bytes so far.
    pub(super) fn len(&self) -> usize {
        self.code.len()
    }

    /// Changes 32 bits that were written before.
    pub(super) fn patch(&mut self, at: usize, value: i32) {
        self.code[at..at + 4].copy_from_slice(&value.to_le_bytes());
    }

    /// Resolves all addresses and appends the constants.
    pub(super) fn finish(mut self, pool: &[Constant]) -> Vec<u8> {
        for (at, label) in self.jumps {
            let relative = self.labels[label.0 as usize].wrapping_sub(at + 4);
            self.code[at as usize..][..4].copy_from_slice(&relative.to_le_bytes());
        }
        self.code
            .resize(self.code.len().next_multiple_of(CONSTANT_BYTES), 0);
        let pool_start = self.code.len() as u32;
        for (at, constant, after) in self.constants {
            let relative = pool_start + CONSTANT_BYTES as u32 * constant - (at + 4 + u32::from(after));
            self.code[at as usize..][..4].copy_from_slice(&relative.to_le_bytes());
        }
        self.code.extend(pool.iter().flatten());
        self.code
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.code.extend_from_slice(bytes);
    }

    /// Writes the `ModRM` byte of an operand, with what belongs to it. `after` is the number of bytes of the
    /// instruction that follow. Short displacements have one byte if `shortens`.
    pub(super) fn operand(&mut self, register: u8, source: Source, after: u8, shortens: bool) {
        let register = (register & 7) << 3;
        match source {
            Source::Register(other) => self.bytes(&[0xC0 | register | other & 7]),
            Source::Memory(Memory::Constant(constant)) => {
                self.bytes(&[register | 5]);
                self.constants.push((self.code.len() as u32, constant, after));
                self.bytes(&[0; 4]);
            }
            Source::Memory(Memory::At {
                base,
                index,
                displacement,
            }) => {
                let short = i8::try_from(displacement);
                // Without displacement, RBP and R13 would mean something else.
                let (mode, bytes) = match short {
                    Ok(0) if base.0 & 7 != 5 => (0x00, 0),
                    Ok(_) if shortens => (0x40, 1),
                    _ => (0x80, 4),
                };
                match index {
                    Some((index, scale)) => {
                        self.bytes(&[mode | register | 4, scale << 6 | (index.0 & 7) << 3 | base.0 & 7]);
                    }
                    // RSP and R12 need a second byte: no index.
                    None if base.0 & 7 == 4 => self.bytes(&[mode | register | 4, 0x24]),
                    None => self.bytes(&[mode | register | base.0 & 7]),
                }
                self.code.extend_from_slice(&displacement.to_le_bytes()[..bytes]);
            }
        }
    }

    /// The high bits of the index and of the base or second register.
    pub(super) fn high_bits(source: Source) -> (u8, u8) {
        match source {
            Source::Register(register) => (0, register >> 3),
            Source::Memory(Memory::At { base, index, .. }) => {
                (index.map_or(0, |(index, _)| index.0 >> 3), base.0 >> 3)
            }
            Source::Memory(Memory::Constant(_)) => (0, 0),
        }
    }

    fn vex(&mut self, op: Opcode, wide: bool, register: u8, second: u8, source: Source, after: u8) {
        let (index, base) = Self::high_bits(source);
        let inverted = |bit: u8| bit ^ 1;
        // Vectors of AVX-512 that are not wide have 256 bits.
        let is_256 = wide || self.vectors == Vectors::Avx512;
        let common = (!second & 15) << 3 | u8::from(is_256) << 2 | op.prefix;
        if index == 0 && base == 0 && op.map == 1 && !op.wide {
            self.bytes(&[0xC5, inverted(register >> 3) << 7 | common, op.byte]);
        } else {
            let first = inverted(register >> 3) << 7 | inverted(index) << 6 | inverted(base) << 5 | op.map;
            self.bytes(&[0xC4, first, u8::from(op.wide) << 7 | common, op.byte]);
        }
        self.operand(register, source, after, true);
    }

    /// Whether an instruction is one of AVX-512.
    fn is_evex(&self, wide: bool) -> bool {
        wide && self.vectors == Vectors::Avx512
    }

    /// `to = op(source)`, or a store of `to`. `wide` is whether vectors are wide, here and below.
    pub(super) fn unary(&mut self, op: Opcode, wide: bool, to: Vector, source: Source) {
        if self.is_evex(wide) {
            self.evex(op, to, 0, source, 0);
        } else {
            self.vex(op, wide, to, 0, source, 0);
        }
    }

    /// Sets the condition [`Condition::Zero`] if all bits of a vector are 0.
    pub(super) fn test(&mut self, wide: bool, vector: Vector) {
        if self.is_evex(wide) {
            self.test_evex(vector);
        } else {
            self.vex(op::VPTEST, wide, vector, 0, Source::Register(vector), 0);
        }
    }

    /// Takes the lower half of each lane of 64 bits of a wide vector. Changes `scratch`.
    pub(super) fn narrow(&mut self, to: Vector, from: Vector, scratch: Vector) {
        match self.vectors {
            Vectors::Avx2 => {
                let high = Source::Register(scratch);
                self.unary_immediate(op::VEXTRACTI128, true, from, high, 1);
                self.binary_immediate(op::VSHUFPS, false, to, from, high, EVEN_LANES);
            }
            Vectors::Avx512 => self.narrow_evex(to, from),
        }
    }

    /// As [`Self::unary`], with an immediate operand.
    pub(super) fn unary_immediate(
        &mut self,
        op: Opcode,
        wide: bool,
        to: Vector,
        source: Source,
        immediate: u8,
    ) {
        if self.is_evex(wide) {
            self.evex(op, to, 0, source, 1);
        } else {
            self.vex(op, wide, to, 0, source, 1);
        }
        self.bytes(&[immediate]);
    }

    /// `to = op(a, b)`
    pub(super) fn binary(&mut self, op: Opcode, wide: bool, to: Vector, a: Vector, b: Source) {
        if !self.is_evex(wide) {
            self.vex(op, wide, to, a, b, 0);
        } else if matches!(op, op::VPCMPEQD | op::VPCMPGTD) {
            self.compare_evex(op, to, a, b, None);
        } else {
            self.evex(op, to, a, b, 0);
        }
    }

    /// As [`Self::binary`], with an immediate operand.
    pub(super) fn binary_immediate(
        &mut self,
        op: Opcode,
        wide: bool,
        to: Vector,
        a: Vector,
        b: Source,
        immediate: u8,
    ) {
        if self.is_evex(wide) {
            // Of the instructions with two operands and an immediate, only comparisons are wide.
            self.compare_evex(op, to, a, b, Some(immediate));
        } else {
            self.vex(op, wide, to, a, b, 1);
            self.bytes(&[immediate]);
        }
    }

    /// `to = yes` where the highest bit of `mask` is set, else `no`. All bits of a lane of `mask` are the
    /// same.
    pub(super) fn blend(
        &mut self,
        op: Opcode,
        wide: bool,
        to: Vector,
        no: Vector,
        yes: Source,
        mask: Vector,
    ) {
        if self.is_evex(wide) {
            self.blend_evex(to, no, yes, mask);
        } else {
            self.vex(op, wide, to, no, yes, 1);
            self.bytes(&[mask << 4]);
        }
    }

    /// Shifts words of `from` by an immediate; `digit` selects how.
    pub(super) fn shift(&mut self, wide: bool, digit: u8, to: Vector, from: Vector, count: u8) {
        if self.is_evex(wide) {
            self.evex(op::VPSHIFTD, digit, to, Source::Register(from), 1);
        } else {
            self.vex(op::VPSHIFTD, wide, digit, to, Source::Register(from), 1);
        }
        self.bytes(&[count]);
    }

    pub(super) fn vzeroupper(&mut self) {
        self.bytes(&[0xC5, 0xF8, 0x77]);
    }

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

    /// The number of the lowest bit that is set, of 32.
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

    fn relative(&mut self, to: Label) {
        self.jumps.push((self.code.len() as u32, to));
        self.bytes(&[0; 4]);
    }
}
