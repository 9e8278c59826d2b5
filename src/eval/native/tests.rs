//! Tests of the assembler. That machine code has the bits of the handlers is tested with whole programs, by
//! the suite.

use super::assemble::{
    Arithmetic, Assembler, Condition, Constant, Memory, R8, R9, R12, R13, R14, R15, RAX, RBP, RBX, RCX, RDI,
    RDX, RSI, RSP, Source, Vectors, op,
};

/// Instructions, how they are emitted, and the bytes that GNU as 2.40 makes of them. Where an instruction has
/// two encodings, `{load}` selects the one whose second operand may be in memory.
type Encoding = (&'static str, fn(&mut Assembler), &'static str);

#[test]
#[rustfmt::skip]
fn instructions_are_encoded_as_by_another_assembler() {
    let encodings: &[Encoding] = &[
        ("vmovaps ymm9, ymm3", |code| code.unary(op::VMOVAPS, true, 9, Source::Register(3)), "c57c28cb"),
        ("vmovups ymm14, [rbx]", |code| code.unary(op::VMOVUPS, true, 14, Source::Memory(Memory::at(RBX, 0))), "c57c1033"),
        ("vmovups xmm1, [r13]", |code| code.unary(op::VMOVUPS, false, 1, Source::Memory(Memory::at(R13, 0))), "c4c178104d00"),
        ("vmovups [rsp+96], ymm8", |code| code.unary(op::VMOVUPS_STORE, true, 8, Source::Memory(Memory::at(RSP, 96))), "c57c11442460"),
        ("vmovaps [r12-4096], ymm2", |code| code.unary(op::VMOVAPS_STORE, true, 2, Source::Memory(Memory::at(R12, -4096))), "c4c17c29942400f0ffff"),
        ("vmovups ymm7, [r14+rcx+1024]", |code| code.unary(op::VMOVUPS, true, 7, Source::Memory(Memory::At { base: R14, index: Some((RCX, 0)), displacement: 1024 })), "c4c17c10bc0e00040000"),
        ("vmovups ymm7, [rbp+r9*4]", |code| code.unary(op::VMOVUPS, true, 7, Source::Memory(Memory::At { base: RBP, index: Some((R9, 2)), displacement: 0 })), "c4a17c107c8d00"),
        ("vbroadcastss ymm5, dword ptr [r15+12]", |code| code.unary(op::VBROADCASTSS, true, 5, Source::Memory(Memory::at(R15, 12))), "c4c27d186f0c"),
        ("vbroadcastsd ymm12, qword ptr [rbp+8]", |code| code.unary(op::VBROADCASTSD, true, 12, Source::Memory(Memory::at(RBP, 8))), "c4627d196508"),
        ("vsqrtps ymm0, ymm15", |code| code.unary(op::VSQRTPS, true, 0, Source::Register(15)), "c4c17c51c7"),
        ("vsqrtpd ymm10, ymm1", |code| code.unary(op::VSQRTPD, true, 10, Source::Register(1)), "c57d51d1"),
        ("vcvtdq2ps ymm1, ymm2", |code| code.unary(op::VCVTDQ2PS, true, 1, Source::Register(2)), "c5fc5bca"),
        ("vcvttps2dq ymm1, ymm2", |code| code.unary(op::VCVTTPS2DQ, true, 1, Source::Register(2)), "c5fe5bca"),
        ("vcvtdq2pd ymm1, xmm2", |code| code.unary(op::VCVTDQ2PD, true, 1, Source::Register(2)), "c5fee6ca"),
        ("vcvttpd2dq xmm1, ymm2", |code| code.unary(op::VCVTTPD2DQ, true, 1, Source::Register(2)), "c5fde6ca"),
        ("vcvtps2pd ymm1, xmm2", |code| code.unary(op::VCVTPS2PD, true, 1, Source::Register(2)), "c5fc5aca"),
        ("vcvtpd2ps xmm1, ymm2", |code| code.unary(op::VCVTPD2PS, true, 1, Source::Register(2)), "c5fd5aca"),
        ("vpmovsxdq ymm3, xmm4", |code| code.unary(op::VPMOVSXDQ, true, 3, Source::Register(4)), "c4e27d25dc"),
        ("vptest ymm3, ymm4", |code| code.unary(op::VPTEST, true, 3, Source::Register(4)), "c4e27d17dc"),
        ("vroundps ymm2, ymm9, 9", |code| code.unary_immediate(op::VROUNDPS, true, 2, Source::Register(9), 9), "c4c37d08d109"),
        ("vroundpd ymm2, ymm9, 11", |code| code.unary_immediate(op::VROUNDPD, true, 2, Source::Register(9), 11), "c4c37d09d10b"),
        ("vpermpd ymm11, ymm6, 0x4E", |code| code.unary_immediate(op::VPERMPD, true, 11, Source::Register(6), 0x4E), "c463fd01de4e"),
        ("vpermilps ymm1, ymm2, 0xB1", |code| code.unary_immediate(op::VPERMILPS, true, 1, Source::Register(2), 0xB1), "c4e37d04cab1"),
        ("vaddps ymm1, ymm2, ymm3", |code| code.binary(op::VADDPS, true, 1, 2, Source::Register(3)), "c5ec58cb"),
        ("vaddps ymm9, ymm15, ymm8", |code| code.binary(op::VADDPS, true, 9, 15, Source::Register(8)), "c4410458c8"),
        ("vaddpd ymm1, ymm2, [rbx+127]", |code| code.binary(op::VADDPD, true, 1, 2, Source::Memory(Memory::at(RBX, 127))), "c5ed584b7f"),
        ("vsubps ymm1, ymm2, [rbx+128]", |code| code.binary(op::VSUBPS, true, 1, 2, Source::Memory(Memory::at(RBX, 128))), "c5ec5c8b80000000"),
        ("vsubpd ymm4, ymm5, ymm6", |code| code.binary(op::VSUBPD, true, 4, 5, Source::Register(6)), "c5d55ce6"),
        ("vmulps ymm4, ymm5, ymm6", |code| code.binary(op::VMULPS, true, 4, 5, Source::Register(6)), "c5d459e6"),
        ("vmulpd ymm4, ymm5, ymm6", |code| code.binary(op::VMULPD, true, 4, 5, Source::Register(6)), "c5d559e6"),
        ("vdivps ymm4, ymm5, ymm6", |code| code.binary(op::VDIVPS, true, 4, 5, Source::Register(6)), "c5d45ee6"),
        ("vdivpd ymm4, ymm5, ymm6", |code| code.binary(op::VDIVPD, true, 4, 5, Source::Register(6)), "c5d55ee6"),
        ("vminps ymm4, ymm5, ymm6", |code| code.binary(op::VMINPS, true, 4, 5, Source::Register(6)), "c5d45de6"),
        ("vmaxpd ymm4, ymm5, ymm6", |code| code.binary(op::VMAXPD, true, 4, 5, Source::Register(6)), "c5d55fe6"),
        ("vcmpps ymm4, ymm5, ymm6, 17", |code| code.binary_immediate(op::VCMPPS, true, 4, 5, Source::Register(6), 17), "c5d4c2e611"),
        ("vcmppd ymm4, ymm5, ymm6, 4", |code| code.binary_immediate(op::VCMPPD, true, 4, 5, Source::Register(6), 4), "c5d5c2e604"),
        ("vshufps ymm4, ymm5, ymm6, 0x88", |code| code.binary_immediate(op::VSHUFPS, true, 4, 5, Source::Register(6), 0x88), "c5d4c6e688"),
        ("vblendvps ymm4, ymm5, ymm6, ymm13", |code| code.blend(op::VBLENDVPS, true, 4, 5, Source::Register(6), 13), "c4e3554ae6d0"),
        ("vblendvpd ymm4, ymm5, [rbx+32], ymm2", |code| code.blend(op::VBLENDVPD, true, 4, 5, Source::Memory(Memory::at(RBX, 32)), 2), "c4e3554b632020"),
        ("vpand ymm4, ymm5, ymm6", |code| code.binary(op::VPAND, true, 4, 5, Source::Register(6)), "c5d5dbe6"),
        ("vpandn ymm4, ymm5, ymm6", |code| code.binary(op::VPANDN, true, 4, 5, Source::Register(6)), "c5d5dfe6"),
        ("vpor ymm4, ymm5, ymm6", |code| code.binary(op::VPOR, true, 4, 5, Source::Register(6)), "c5d5ebe6"),
        ("vpxor ymm4, ymm5, ymm6", |code| code.binary(op::VPXOR, true, 4, 5, Source::Register(6)), "c5d5efe6"),
        ("vpaddd ymm4, ymm5, ymm6", |code| code.binary(op::VPADDD, true, 4, 5, Source::Register(6)), "c5d5fee6"),
        ("vpsubd ymm4, ymm5, ymm6", |code| code.binary(op::VPSUBD, true, 4, 5, Source::Register(6)), "c5d5fae6"),
        ("vpmulld ymm4, ymm5, ymm6", |code| code.binary(op::VPMULLD, true, 4, 5, Source::Register(6)), "c4e25540e6"),
        ("vpcmpeqd ymm4, ymm5, ymm6", |code| code.binary(op::VPCMPEQD, true, 4, 5, Source::Register(6)), "c5d576e6"),
        ("vpcmpgtd ymm4, ymm5, ymm6", |code| code.binary(op::VPCMPGTD, true, 4, 5, Source::Register(6)), "c5d566e6"),
        ("vpminsd ymm4, ymm5, ymm6", |code| code.binary(op::VPMINSD, true, 4, 5, Source::Register(6)), "c4e25539e6"),
        ("vpminud ymm4, ymm5, ymm6", |code| code.binary(op::VPMINUD, true, 4, 5, Source::Register(6)), "c4e2553be6"),
        ("vpmaxsd ymm4, ymm5, ymm6", |code| code.binary(op::VPMAXSD, true, 4, 5, Source::Register(6)), "c4e2553de6"),
        ("vpmaxud ymm4, ymm5, ymm6", |code| code.binary(op::VPMAXUD, true, 4, 5, Source::Register(6)), "c4e2553fe6"),
        ("vpsllvd ymm4, ymm5, ymm6", |code| code.binary(op::VPSLLVD, true, 4, 5, Source::Register(6)), "c4e25547e6"),
        ("vpsrlvd ymm4, ymm5, ymm6", |code| code.binary(op::VPSRLVD, true, 4, 5, Source::Register(6)), "c4e25545e6"),
        ("vpsravd ymm4, ymm5, ymm6", |code| code.binary(op::VPSRAVD, true, 4, 5, Source::Register(6)), "c4e25546e6"),
        ("vpsrld ymm9, ymm3, 31", |code| code.shift(true, op::SHIFT_RIGHT, 9, 3, 31), "c5b572d31f"),
        ("vextracti128 xmm10, ymm3, 1", |code| code.unary_immediate(op::VEXTRACTI128, true, 3, Source::Register(10), 1), "c4c37d39da01"),
        ("vzeroupper", |code| code.vzeroupper(), "c5f877"),
        ("mov rax, [rdi+40]", |code| code.load64(RAX, Memory::at(RDI, 40)), "488b4728"),
        ("mov r8d, [r12]", |code| code.load32(R8, Memory::at(R12, 0)), "458b0424"),
        ("mov [rsp+16], r13", |code| code.store64(Memory::at(RSP, 16), R13), "4c896c2410"),
        ("mov [rbp+0], ecx", |code| code.store32(Memory::at(RBP, 0), RCX), "894d00"),
        ("mov dword ptr [rsi+4], 0x12345678", |code| code.store_immediate32(Memory::at(RSI, 4), 0x1234_5678), "c7460478563412"),
        ("mov r9d, 0x12345678", |code| code.immediate32(R9, 0x1234_5678), "41b978563412"),
        ("lea rdx, [rsi+rax*8-8]", |code| code.address(RDX, Memory::At { base: RSI, index: Some((RAX, 3)), displacement: -8 }), "488d54c6f8"),
        ("{load} mov r15, rax", |code| code.copy64(R15, RAX), "4c8bf8"),
        ("{load} xor ecx, edx", |code| code.arithmetic32(Arithmetic::Xor, RCX, Source::Register(RDX.0)), "33ca"),
        ("cmp r8d, [rbx+8]", |code| code.arithmetic32(Arithmetic::Compare, R8, Source::Memory(Memory::at(RBX, 8))), "443b4308"),
        ("or [rdi+8], eax", |code| code.arithmetic_memory32(Arithmetic::Or, Memory::at(RDI, 8), RAX), "094708"),
        ("sub rsp, 4096", |code| code.arithmetic_immediate64(Arithmetic::Sub, RSP, 4096), "4881ec00100000"),
        ("and dword ptr [rdi+8], 0x12345678", |code| code.arithmetic_immediate32(Arithmetic::And, Source::Memory(Memory::at(RDI, 8)), 0x1234_5678), "81670878563412"),
        ("cmovne ecx, r8d", |code| code.copy_if(Condition::NotZero, RCX, R8), "410f45c8"),
        ("not edx", |code| code.not32(RDX), "f7d2"),
        ("shl ecx, 5", |code| code.shift_left32(RCX, 5), "c1e105"),
        ("tzcnt ecx, r8d", |code| code.lowest_bit32(RCX, R8), "f3410fbcc8"),
        ("push r12", |code| code.push(R12), "4154"),
        ("push rbx", |code| code.push(RBX), "53"),
        ("pop r15", |code| code.pop(R15), "415f"),
        ("ldmxcsr [rdi+4]", |code| code.load_mxcsr(Memory::at(RDI, 4)), "0fae5704"),
        ("stmxcsr [r12+4]", |code| code.store_mxcsr(Memory::at(R12, 4)), "410fae5c2404"),
        ("call [rdi+100]", |code| code.call_memory(Memory::at(RDI, 100)), "ff5764"),
        ("ret", |code| code.ret(), "c3"),
    ];
    check(Vectors::Avx2, encodings);
}

#[test]
#[rustfmt::skip]
fn instructions_of_avx512_are_encoded_as_by_another_assembler() {
    let encodings: &[Encoding] = &[
        ("vmovaps zmm9, zmm3", |code| code.unary(op::VMOVAPS, true, 9, Source::Register(3)), "62717c4828cb"),
        ("vmovaps zmm14, [rbx]", |code| code.unary(op::VMOVAPS, true, 14, Source::Memory(Memory::at(RBX, 0))), "62717c482833"),
        ("vmovaps [r12+rcx*2+0x1001], zmm2", |code| code.unary(op::VMOVAPS_STORE, true, 2, Source::Memory(Memory::At { base: R12, index: Some((RCX, 1)), displacement: 0x1001 })), "62d17c4829944c01100000"),
        ("vmovups [rsp+0x123], zmm8", |code| code.unary(op::VMOVUPS_STORE, true, 8, Source::Memory(Memory::at(RSP, 0x123))), "62717c4811842423010000"),
        ("vmovaps zmm7, [rbp+r9+0x777]", |code| code.unary(op::VMOVAPS, true, 7, Source::Memory(Memory::At { base: RBP, index: Some((R9, 0)), displacement: 0x777 })), "62b17c4828bc0d77070000"),
        ("vbroadcastss zmm5, dword ptr [r15+0x121]", |code| code.unary(op::VBROADCASTSS, true, 5, Source::Memory(Memory::at(R15, 0x121))), "62d27d4818af21010000"),
        ("vbroadcastsd zmm12, qword ptr [r13+0x121]", |code| code.unary(op::VBROADCASTSD, true, 12, Source::Memory(Memory::at(R13, 0x121))), "6252fd4819a521010000"),
        ("vsqrtps zmm0, zmm15", |code| code.unary(op::VSQRTPS, true, 0, Source::Register(15)), "62d17c4851c7"),
        ("vsqrtpd zmm10, zmm1", |code| code.unary(op::VSQRTPD, true, 10, Source::Register(1)), "6271fd4851d1"),
        ("vcvtdq2ps zmm1, zmm2", |code| code.unary(op::VCVTDQ2PS, true, 1, Source::Register(2)), "62f17c485bca"),
        ("vcvttps2dq zmm1, zmm2", |code| code.unary(op::VCVTTPS2DQ, true, 1, Source::Register(2)), "62f17e485bca"),
        ("vcvtdq2pd zmm1, ymm2", |code| code.unary(op::VCVTDQ2PD, true, 1, Source::Register(2)), "62f17e48e6ca"),
        ("vcvttpd2dq ymm1, zmm2", |code| code.unary(op::VCVTTPD2DQ, true, 1, Source::Register(2)), "62f1fd48e6ca"),
        ("vcvtps2pd zmm1, ymm2", |code| code.unary(op::VCVTPS2PD, true, 1, Source::Register(2)), "62f17c485aca"),
        ("vcvtpd2ps ymm1, zmm2", |code| code.unary(op::VCVTPD2PS, true, 1, Source::Register(2)), "62f1fd485aca"),
        ("vpmovsxdq zmm3, ymm4", |code| code.unary(op::VPMOVSXDQ, true, 3, Source::Register(4)), "62f27d4825dc"),
        ("vpmovqd ymm11, zmm4", |code| code.narrow(11, 4, 15), "62d27e4835e3"),
        ("vptestmd k1, zmm13, zmm13; kortestw k1, k1", |code| code.test(true, 13), "62d2154827cdc5f898c9"),
        ("vrndscaleps zmm2, zmm9, 9", |code| code.unary_immediate(op::VROUNDPS, true, 2, Source::Register(9), 9), "62d37d4808d109"),
        ("vrndscalepd zmm2, zmm9, 11", |code| code.unary_immediate(op::VROUNDPD, true, 2, Source::Register(9), 11), "62d3fd4809d10b"),
        ("vpermpd zmm11, zmm6, 0x4E", |code| code.unary_immediate(op::VPERMPD, true, 11, Source::Register(6), 0x4E), "6273fd4801de4e"),
        ("vpermilps zmm1, zmm2, 0xB1", |code| code.unary_immediate(op::VPERMILPS, true, 1, Source::Register(2), 0xB1), "62f37d4804cab1"),
        ("vcmpps k1, zmm5, zmm6, 3; vpmovm2d zmm4, k1", |code| code.binary_immediate(op::VCMPPS, true, 4, 5, Source::Register(6), 3), "62f15448c2ce0362f27e4838e1"),
        ("vcmppd k1, zmm5, [rbx], 4; vpmovm2q zmm4, k1", |code| code.binary_immediate(op::VCMPPD, true, 4, 5, Source::Memory(Memory::at(RBX, 0)), 4), "62f1d548c20b0462f2fe4838e1"),
        ("vpcmpeqd k1, zmm5, zmm6; vpmovm2d zmm4, k1", |code| code.binary(op::VPCMPEQD, true, 4, 5, Source::Register(6)), "62f1554876ce62f27e4838e1"),
        ("vpcmpgtd k1, zmm5, zmm6; vpmovm2d zmm4, k1", |code| code.binary(op::VPCMPGTD, true, 4, 5, Source::Register(6)), "62f1554866ce62f27e4838e1"),
        ("vpternlogd zmm5, zmm13, zmm6, 0xB8", |code| code.blend(op::VBLENDVPS, true, 5, 5, Source::Register(6), 13), "62f3154825eeb8"),
        ("vmovaps zmm4, zmm5; vpternlogd zmm4, zmm13, zmm6, 0xB8", |code| code.blend(op::VBLENDVPD, true, 4, 5, Source::Register(6), 13), "62f17c4828e562f3154825e6b8"),
        ("vpternlogd zmm6, zmm13, zmm5, 0xE2", |code| code.blend(op::VBLENDVPD, true, 6, 5, Source::Register(6), 13), "62f3154825f5e2"),
        ("vpternlogd zmm13, zmm5, zmm6, 0xAC", |code| code.blend(op::VBLENDVPD, true, 13, 5, Source::Register(6), 13), "6273554825eeac"),
        ("vpsrld zmm9, zmm3, 31", |code| code.shift(true, op::SHIFT_RIGHT, 9, 3, 31), "62f1354872d31f"),
        ("vaddps zmm9, zmm15, zmm8", |code| code.binary(op::VADDPS, true, 9, 15, Source::Register(8)), "6251044858c8"),
        ("vaddpd zmm9, zmm15, zmm8", |code| code.binary(op::VADDPD, true, 9, 15, Source::Register(8)), "6251854858c8"),
        ("vsubps zmm9, zmm15, zmm8", |code| code.binary(op::VSUBPS, true, 9, 15, Source::Register(8)), "625104485cc8"),
        ("vsubpd zmm9, zmm15, zmm8", |code| code.binary(op::VSUBPD, true, 9, 15, Source::Register(8)), "625185485cc8"),
        ("vmulps zmm9, zmm15, zmm8", |code| code.binary(op::VMULPS, true, 9, 15, Source::Register(8)), "6251044859c8"),
        ("vmulpd zmm9, zmm15, zmm8", |code| code.binary(op::VMULPD, true, 9, 15, Source::Register(8)), "6251854859c8"),
        ("vdivps zmm9, zmm15, zmm8", |code| code.binary(op::VDIVPS, true, 9, 15, Source::Register(8)), "625104485ec8"),
        ("vdivpd zmm9, zmm15, zmm8", |code| code.binary(op::VDIVPD, true, 9, 15, Source::Register(8)), "625185485ec8"),
        ("vminps zmm9, zmm15, zmm8", |code| code.binary(op::VMINPS, true, 9, 15, Source::Register(8)), "625104485dc8"),
        ("vminpd zmm9, zmm15, zmm8", |code| code.binary(op::VMINPD, true, 9, 15, Source::Register(8)), "625185485dc8"),
        ("vmaxps zmm9, zmm15, zmm8", |code| code.binary(op::VMAXPS, true, 9, 15, Source::Register(8)), "625104485fc8"),
        ("vmaxpd zmm9, zmm15, zmm8", |code| code.binary(op::VMAXPD, true, 9, 15, Source::Register(8)), "625185485fc8"),
        ("vpandd zmm4, zmm5, zmm6", |code| code.binary(op::VPAND, true, 4, 5, Source::Register(6)), "62f15548dbe6"),
        ("vpandnd zmm4, zmm5, zmm6", |code| code.binary(op::VPANDN, true, 4, 5, Source::Register(6)), "62f15548dfe6"),
        ("vpord zmm4, zmm5, zmm6", |code| code.binary(op::VPOR, true, 4, 5, Source::Register(6)), "62f15548ebe6"),
        ("vpxord zmm4, zmm5, zmm6", |code| code.binary(op::VPXOR, true, 4, 5, Source::Register(6)), "62f15548efe6"),
        ("vpaddd zmm4, zmm5, zmm6", |code| code.binary(op::VPADDD, true, 4, 5, Source::Register(6)), "62f15548fee6"),
        ("vpsubd zmm4, zmm5, zmm6", |code| code.binary(op::VPSUBD, true, 4, 5, Source::Register(6)), "62f15548fae6"),
        ("vpmulld zmm4, zmm5, zmm6", |code| code.binary(op::VPMULLD, true, 4, 5, Source::Register(6)), "62f2554840e6"),
        ("vpminsd zmm4, zmm5, zmm6", |code| code.binary(op::VPMINSD, true, 4, 5, Source::Register(6)), "62f2554839e6"),
        ("vpminud zmm4, zmm5, zmm6", |code| code.binary(op::VPMINUD, true, 4, 5, Source::Register(6)), "62f255483be6"),
        ("vpmaxsd zmm4, zmm5, zmm6", |code| code.binary(op::VPMAXSD, true, 4, 5, Source::Register(6)), "62f255483de6"),
        ("vpmaxud zmm4, zmm5, zmm6", |code| code.binary(op::VPMAXUD, true, 4, 5, Source::Register(6)), "62f255483fe6"),
        ("vpsllvd zmm4, zmm5, zmm6", |code| code.binary(op::VPSLLVD, true, 4, 5, Source::Register(6)), "62f2554847e6"),
        ("vpsrlvd zmm4, zmm5, zmm6", |code| code.binary(op::VPSRLVD, true, 4, 5, Source::Register(6)), "62f2554845e6"),
        ("vpsravd zmm4, zmm5, zmm6", |code| code.binary(op::VPSRAVD, true, 4, 5, Source::Register(6)), "62f2554846e6"),
        ("vpaddd ymm4, ymm5, ymm6", |code| code.binary(op::VPADDD, false, 4, 5, Source::Register(6)), "c5d5fee6"),
    ];
    check(Vectors::Avx512, encodings);
}

/// Checks that instructions have the expected bytes.
fn check(vectors: Vectors, encodings: &[Encoding]) {
    for (text, emit, expected) in encodings {
        let mut code = Assembler::new(vectors);
        emit(&mut code);
        let mut bytes = code.finish(&[]);
        // Constants are aligned.
        bytes.truncate(expected.len() / 2);
        let found: Vec<_> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(found.concat(), *expected, "{text}");
    }
}

#[test]
fn addresses_are_relative_to_the_next_instruction() {
    let constant: Constant = [7; 64];
    let mut code = Assembler::default();
    let [before, after] = [(); 2].map(|()| code.label());
    code.bind(before);
    code.jump(after);
    code.jump_if(Condition::Zero, before);
    code.bind(after);
    code.binary_immediate(op::VCMPPS, true, 0, 1, Source::Memory(Memory::Constant(1)), 3);
    let bytes = code.finish(&[[0; 64], constant]);
    assert_eq!(bytes[..5], [0xE9, 6, 0, 0, 0]);
    assert_eq!(bytes[5..11], [0x0F, 0x84, 0xF5, 0xFF, 0xFF, 0xFF]);
    // The instruction is 11 to 20, and its constant begins at 128.
    assert_eq!(bytes[11..20], [0xC5, 0xF4, 0xC2, 0x05, 108, 0, 0, 0, 3]);
    assert_eq!(bytes[128..], constant);
}
