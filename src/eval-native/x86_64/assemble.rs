//! An assembler for the instructions of AVX2, in the VEX encoding (Intel, “Software Developer's Manual”,
//! volume 2). Those of AVX-512 are in `evex`, those on general-purpose registers in `general`.

use super::op::{self, Opcode};

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
    constants: Vec<ConstantAddress>,
}

/// The relative address of a constant.
#[derive(Debug)]
struct ConstantAddress {
    position: u32,
    constant: u32,
    /// The number of bytes of the instruction after the address.
    after: u8,
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
        for address in self.constants {
            let start = pool_start + CONSTANT_BYTES as u32 * address.constant;
            let relative = start - (address.position + 4 + u32::from(address.after));
            self.code[address.position as usize..][..4].copy_from_slice(&relative.to_le_bytes());
        }
        self.code.extend(pool.iter().flatten());
        self.code
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.code.extend_from_slice(bytes);
    }

    /// Writes the distance of a label from the end of these 32 bits.
    pub(super) fn relative(&mut self, to: Label) {
        self.jumps.push((self.code.len() as u32, to));
        self.bytes(&[0; 4]);
    }

    /// Writes the `ModRM` byte of an operand, with what belongs to it. `after` is the number of bytes of the
    /// instruction that follow. Short displacements have one byte if `shortens`.
    pub(super) fn operand(&mut self, register: u8, source: Source, after: u8, shortens: bool) {
        let register = (register & 7) << 3;
        match source {
            Source::Register(other) => self.bytes(&[0xC0 | register | other & 7]),
            Source::Memory(Memory::Constant(constant)) => {
                self.bytes(&[register | 5]);
                self.constants.push(ConstantAddress {
                    position: self.code.len() as u32,
                    constant,
                    after,
                });
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
}
