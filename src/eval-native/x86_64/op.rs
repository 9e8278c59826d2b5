//! Opcodes; names are those of the manual (Intel, “Software Developer's Manual”, volume 2).

/// The opcode of a VEX instruction, and of the EVEX instruction with the same name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Opcode {
    /// The implied prefix: none, 66, F3, F2.
    pub(super) prefix: u8,
    /// The implied leading bytes: 0F, 0F 38, 0F 3A.
    pub(super) map: u8,
    /// The bit W of the VEX encoding.
    pub(super) wide: bool,
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

pub(super) const VADDPS: Opcode = opcode(0, 1, 0x58);
pub(super) const VADDPD: Opcode = long(1, 1, 0x58);
pub(super) const VMULPS: Opcode = opcode(0, 1, 0x59);
pub(super) const VMULPD: Opcode = long(1, 1, 0x59);
pub(super) const VSUBPS: Opcode = opcode(0, 1, 0x5C);
pub(super) const VSUBPD: Opcode = long(1, 1, 0x5C);
pub(super) const VMINPS: Opcode = opcode(0, 1, 0x5D);
pub(super) const VMINPD: Opcode = long(1, 1, 0x5D);
pub(super) const VDIVPS: Opcode = opcode(0, 1, 0x5E);
pub(super) const VDIVPD: Opcode = long(1, 1, 0x5E);
pub(super) const VMAXPS: Opcode = opcode(0, 1, 0x5F);
pub(super) const VMAXPD: Opcode = long(1, 1, 0x5F);
pub(super) const VSQRTPS: Opcode = opcode(0, 1, 0x51);
pub(super) const VSQRTPD: Opcode = long(1, 1, 0x51);
pub(super) const VCMPPS: Opcode = opcode(0, 1, 0xC2);
pub(super) const VCMPPD: Opcode = long(1, 1, 0xC2);
pub(super) const VROUNDPS: Opcode = opcode(1, 3, 0x08);
pub(super) const VROUNDPD: Opcode = long(1, 3, 0x09);
pub(super) const VBLENDVPS: Opcode = opcode(1, 3, 0x4A);
pub(super) const VBLENDVPD: Opcode = opcode(1, 3, 0x4B);
pub(super) const VSHUFPS: Opcode = opcode(0, 1, 0xC6);
pub(super) const VPERMILPS: Opcode = opcode(1, 3, 0x04);
pub(super) const VPERMPD: Opcode = Opcode {
    wide: true,
    ..long(1, 3, 0x01)
};
pub(super) const VMOVAPS: Opcode = opcode(0, 1, 0x28);
pub(super) const VMOVAPS_STORE: Opcode = opcode(0, 1, 0x29);
pub(super) const VMOVUPS: Opcode = opcode(0, 1, 0x10);
pub(super) const VMOVUPS_STORE: Opcode = opcode(0, 1, 0x11);
pub(super) const VMOVSS: Opcode = opcode(2, 1, 0x10);
pub(super) const VMOVSS_STORE: Opcode = opcode(2, 1, 0x11);
pub(super) const VMOVSD: Opcode = opcode(3, 1, 0x10);
pub(super) const VMOVSD_STORE: Opcode = opcode(3, 1, 0x11);
pub(super) const VBROADCASTSS: Opcode = opcode(1, 2, 0x18);
pub(super) const VBROADCASTSD: Opcode = long(1, 2, 0x19);
pub(super) const VEXTRACTI128: Opcode = opcode(1, 3, 0x39);
pub(super) const VPMOVSXDQ: Opcode = opcode(1, 2, 0x25);
pub(super) const VCVTDQ2PS: Opcode = opcode(0, 1, 0x5B);
pub(super) const VCVTTPS2DQ: Opcode = opcode(2, 1, 0x5B);
pub(super) const VCVTDQ2PD: Opcode = opcode(2, 1, 0xE6);
pub(super) const VCVTTPD2DQ: Opcode = long(1, 1, 0xE6);
pub(super) const VCVTPS2PD: Opcode = opcode(0, 1, 0x5A);
pub(super) const VCVTPD2PS: Opcode = long(1, 1, 0x5A);
pub(super) const VPAND: Opcode = opcode(1, 1, 0xDB);
pub(super) const VPANDN: Opcode = opcode(1, 1, 0xDF);
pub(super) const VPOR: Opcode = opcode(1, 1, 0xEB);
pub(super) const VPXOR: Opcode = opcode(1, 1, 0xEF);
pub(super) const VPADDD: Opcode = opcode(1, 1, 0xFE);
pub(super) const VPSUBD: Opcode = opcode(1, 1, 0xFA);
pub(super) const VPMULLD: Opcode = opcode(1, 2, 0x40);
pub(super) const VPCMPEQD: Opcode = opcode(1, 1, 0x76);
pub(super) const VPCMPGTD: Opcode = opcode(1, 1, 0x66);
pub(super) const VPMINSD: Opcode = opcode(1, 2, 0x39);
pub(super) const VPMINUD: Opcode = opcode(1, 2, 0x3B);
pub(super) const VPMAXSD: Opcode = opcode(1, 2, 0x3D);
pub(super) const VPMAXUD: Opcode = opcode(1, 2, 0x3F);
pub(super) const VPSLLVD: Opcode = opcode(1, 2, 0x47);
pub(super) const VPSRLVD: Opcode = opcode(1, 2, 0x45);
pub(super) const VPSRAVD: Opcode = opcode(1, 2, 0x46);
pub(super) const VPTEST: Opcode = opcode(1, 2, 0x17);
/// Shifts by an immediate; the digit in the place of a register selects the operation.
pub(super) const VPSHIFTD: Opcode = opcode(1, 1, 0x72);
pub(super) const SHIFT_RIGHT: u8 = 2;
